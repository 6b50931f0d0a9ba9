#pragma once
// Damped spans that share a tension, such as the two sides of a rope through a pinhole; internal to
// statics.
//
// Span p with the stretch e_p has T_p = w_p T = e_p / a_p + b_p e_p'. The sum E of all e_p follows
// from the bodies, E = -(J q + C_d d), and rope moves between the spans such that they share T. Only
// if all spans have the same relaxation time a_p b_p, they act as one spring and one damper. For
// spans whose time t_g is the same, e_g' = r_g T - e_g / t_g with r_g = sum of w_p / b_p. Of G such
// groups the last one follows from the others, so with R = sum of r_g
//
//   T = (E' + E / t_G + sum over g < G of c_g e_g) / R,  c_g = 1 / t_g - 1 / t_G.
//
// For motions exp(s t) the groups are in series: T / E = 1 / sum of r_g / (s + 1 / t_g). Slow motions
// see the compliance and the damping of ForceUnknown, the first two terms of the series in s.

#include <vector>

#include "statics/acting.h"

namespace sheave {

struct Relaxation {
  struct Group {
    double rate = 0.0;  ///< r_g [m/(N s)]
    double time = 0.0;  ///< t_g [s]
  };
  Eigen::Index unknown = 0;
  std::vector<Group> groups;  ///< at least two
  Eigen::Index first = 0;     ///< index of its first coordinate e_1, of all relaxations

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(groups.size()) - 1; }
  [[nodiscard]] double rates() const;                                    ///< R
  [[nodiscard]] double last_time() const { return groups.back().time; }  ///< t_G
  [[nodiscard]] double pull(Eigen::Index g) const;                       ///< c_g [1/s]
  /// T for E, E' and the coordinates e of all relaxations.
  [[nodiscard]] double tension(double stretch, double rate, const VectorX& e) const;
  /// Im(T / E) / w of a vibration with the angular frequency w [N s/m].
  [[nodiscard]] double damping_at(double w) const;
};

/// The active unknowns whose spans have different relaxation times.
[[nodiscard]] std::vector<Relaxation> relaxations_of(const Acting& acting);

/// Number of their coordinates.
[[nodiscard]] Eigen::Index count_of(const std::vector<Relaxation>& relaxations);

}  // namespace sheave
