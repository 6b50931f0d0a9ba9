#pragma once
// The law of a muscle: force by length, velocity and activation, as in MuJoCo's published model.
//
// With the normalised length L and the normalised velocity V, lengthening > 0, the tension is
//
//   T = force (a FL(L) FV(V) + FP(L)),   0 <= a <= 1.
//
// FL is four pieces of parabolas with the peak 1 at L = 1, and 0 outside of shortest ... longest.
// FV is 0 for V <= -1, (1 + V)^2 up to V = 0, and rises to `lengthening_force` at V =
// lengthening_force - 1. FP is 0 up to L = 1, then a parabola up to half of `passive_force` at
// L = (1 + longest) / 2, then its tangent.

namespace sheave {

/// Shape of the curves; all values are multiples of the optimal length, and of the peak force.
struct MuscleCurves {
  double shortest = 0.5;           ///< L below which there is no active force, 0 <= it < 1
  double longest = 1.6;            ///< L above which there is no active force, > 1
  double passive_force = 1.3;      ///< twice FP at (1 + longest) / 2, >= 0
  double lengthening_force = 1.2;  ///< largest FV, >= 1

  [[nodiscard]] double by_length(double length) const;      ///< FL
  [[nodiscard]] double by_velocity(double velocity) const;  ///< FV
  [[nodiscard]] double passive(double length) const;        ///< FP
};

/// How fast a muscle's activation a follows its excitation u: a' = (u - a) / tau, with tau =
/// activation_time (1/2 + 3/2 a) while u > a, else deactivation_time / (1/2 + 3/2 a).
struct MuscleActivation {
  double activation_time = 0.01;    ///< [s], > 0
  double deactivation_time = 0.04;  ///< [s], > 0

  [[nodiscard]] double time_constant(double activation, double excitation) const;  ///< [s]
  /// Activation after `h` seconds with a constant excitation, both 0 ... 1. Exact for a constant
  /// tau; the error is of second order in h. The result lies between both for any h.
  [[nodiscard]] double after(double activation, double excitation, double h) const;
};

}  // namespace sheave
