#pragma once
// The motion that rows have caused in the last substeps, from which solvers guess the next motion.
//
// A row solver begins at a guess of the poses at the end of the substep. The nearer the guess, the
// fewer rounds of Newton's method follow. The displacement that rows cause in a substep of length h
// is h^2 a with an acceleration a, a smooth function of time as long as no row begins or ends to
// act. With the backward differences D0 = a, D1 = a - a', ... of the last substeps, the guess of
// order p is
//
//   a = D0 + ... + Dp,   with an error of h^(p + 1) times a derivative of a.
//
// The error of the guess of order p at the last substep is D(p + 1) of that substep, so the best
// order follows from the differences. The velocity of the start is a guess, too: the best one after
// an impact. The result of a substep does not depend on the guess, except for rounding and the
// residual that the solver tolerates.

#include <cstdint>
#include <span>
#include <vector>

namespace sheave {

struct MotionHistory {
  /// Number of differences that are kept.
  static constexpr std::int64_t most_known = 4;
  /// Order of the guess that is the velocity of the start.
  static constexpr std::int64_t by_velocity = -1;

  double step = 0.0;                 ///< length of the substeps [s]
  std::int64_t known = 0;            ///< number of differences that are known, 0 ... most_known
  std::int64_t order = by_velocity;  ///< of the best guess, by_velocity ... known - 1
  /// D0 of all degrees of freedom (engine/dynamics/coordinates.h) [m/s2 or rad/s2], then D1, ...;
  /// `most_known` of each. Empty: nothing is known.
  std::vector<double> differences;

  /// Whether a substep of this length [s] can be guessed from the differences.
  [[nodiscard]] bool tells(double length, std::size_t dofs) const;
  /// Writes the guessed accelerations, one per degree of freedom.
  void guess(std::span<double> accelerations) const;
  /// Adds the accelerations of a substep of this length [s]. `by_start`: the accelerations that the
  /// velocities of the start would have needed. `levers`: displacement per unit [m].
  void add(double length, std::span<const double> accelerations, std::span<const double> by_start,
           std::span<const double> levers);
  /// Whether the numbers are those of a history of so many degrees of freedom.
  [[nodiscard]] bool is_sound(std::size_t dofs) const;
};

}  // namespace sheave
