#pragma once
// The tension of a rope as a function of its strain, from a table.
//
// Between the points the tension is the monotone cubic of engine/time_table.h; beyond the last point
// it goes on along its tangent there. The energy is the integral and the stiffness the derivative of
// the same function, so they agree to rounding.

#include <optional>
#include <string>
#include <vector>

#include "cable/cable.h"
#include "engine/time_table.h"

namespace sheave {

/// T(e) for strains e >= 0; T(0) = 0, and T rises everywhere. Below strain 0 the rope is slack.
class TensionLaw {
 public:
  /// Largest number of points of a table.
  static constexpr std::size_t most_points = 10000;
  /// Largest strain of a table.
  static constexpr double most_strain = 100.0;

  struct Fault {
    std::string field;  ///< of CableDef, with the index of the point: "/strain_table/2"
    std::string message;
  };
  /// Why no law follows from the tables of this cable; nothing if it has none, or a law follows.
  [[nodiscard]] static std::optional<Fault> fault_of(const CableDef& cable);
  /// `cable` must have a table without a fault.
  explicit TensionLaw(const CableDef& cable);

  [[nodiscard]] double tension(double strain) const;  ///< [N]; 0 of a slack rope
  /// Derivative of the tension by the strain [N], > 0. Where a curve is almost level, a small share
  /// of the stiffness of its chord.
  [[nodiscard]] double stiffness(double strain) const;
  [[nodiscard]] double energy(double strain) const;  ///< per unstretched length [N], >= 0
  /// Strain at a tension [N]; 0 for tensions that are not above 0.
  [[nodiscard]] double strain(double tension) const;
  /// The mean tension between two strains: the change of the energy over the change of strain [N].
  [[nodiscard]] double mean(double from, double to) const;
  /// Derivative of mean() by `to` [N], > 0.
  [[nodiscard]] double mean_stiffness(double from, double to) const;
  /// Stiffness of the first chord [N]: the scale of the law.
  [[nodiscard]] double scale() const { return scale_; }

 private:
  [[nodiscard]] double last_strain() const { return table_.times.back(); }

  TimeTable table_;           ///< tensions [N] over strains
  double last_slope_ = 0.0;   ///< [N]
  double last_energy_ = 0.0;  ///< of the last point [N]
  double scale_ = 0.0;
};

/// Tension by the law of an elastic cable, without dampers, of a span with this length and rest
/// length [m]; none if the cable is rigid [N].
[[nodiscard]] std::optional<double> spring_tension(const CableDef& cable, double length,
                                                   double rest_length);

}  // namespace sheave
