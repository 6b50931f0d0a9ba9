#pragma once
// Ropes whose tension depends on how they were stretched before: yielding, or an unloading curve.
//
// Both laws remember one strain m of the rope and do not depend on the rate. U(e) is the table of the
// rope, its tension when it is stretched for the first time.
//
// Yielding, with the unloading stiffness E. The rope is let off, and stretched again, on a line of the
// slope E. The permanent strain m grows as soon as this line would lie above the table:
//   T = E (e - m) = min(U(e), E (e - m before)).
// The energy per unstretched length is Y = E (e - m)^2 / 2, so that T de = dY + T dm. No slope of the
// table exceeds E, so m never shrinks, and the loss T dm is never negative. The rope is slack below m.
// In the terms of Lemaitre and Chaboche (Mechanics of Solid Materials, 1990) this is plasticity with
// isotropic hardening in tension; the springs of Radioss have it under the hardening flag 1.
//
// Unloading curve V(e) <= U(e), with the transition strain w (flag 7 there, "elastic hysteresis").
//   T = V(e) + s (U(e) - V(e)),   s = (e - m) / w,   0 <= s <= 1.
// A rope that is stretched at s = 1 takes m along, m = e - w, and its tension is U. A rope that is let
// off at s = 0 takes m along, m = e, and its tension is V. In between m stays, so a turn goes from one
// curve to the other over the strain w, and back on the same line. With
//   Y(e, m) = int_0^m V dx + int_m^e (V + (U - V) (x - m) / w) dx
// T de = dY + D with D = dm / w times int_m^(m + w) (U - V) dx, dm >= 0, at s = 1, and D = 0 at s = 0.
// A closed loop therefore never gains energy, and one between 0 and e > w loses
//   int_0^e (U - V) dx - int_0^w (1 - x / w) (U - V) dx - int_(e - w)^e (x - e + w) / w (U - V) dx.

#include <optional>
#include <vector>

#include "cable/tension_law.h"

namespace sheave {

/// T(e, m) for strains e and memories m >= 0. A slack rope has a strain below 0, which counts as 0.
class RopeMemory {
 public:
  /// Why no law follows from the settings of a cable that has_memory(), and whose table has no
  /// fault; nothing if a law follows.
  [[nodiscard]] static std::optional<TensionLaw::Fault> fault_of(const CableDef& cable);
  /// `cable` has_memory() without a fault.
  explicit RopeMemory(const CableDef& cable);

  /// m after the rope has been stretched, or let off, to `strain` without a turn on the way.
  [[nodiscard]] double after(double strain, double m) const;
  /// Strain at which a rope that is let off becomes slack: the permanent strain, >= 0.
  [[nodiscard]] double slack(double m) const { return unloading_ ? 0.0 : m; }
  /// Tension at the end of that way [N], >= 0.
  [[nodiscard]] double tension(double strain, double m) const;
  /// Derivative of the tension there [N], > 0: along the way, or of a rope whose m stays that of the
  /// line on which it goes back.
  [[nodiscard]] double stiffness(double strain, double m) const;
  /// Mean tension on the way between two strains [N]. `m` is that of the strain `from`.
  [[nodiscard]] double mean(double from, double to, double m) const;
  /// Derivative of mean() by `to` [N], > 0.
  [[nodiscard]] double mean_stiffness(double from, double to, double m) const;
  /// Energy that the rope gives when it is let off from `strain` to its slack, per unstretched length
  /// [N].
  [[nodiscard]] double returned(double strain, double m) const;
  /// The stored energy Y per unstretched length [N].
  [[nodiscard]] double stored(double strain, double m) const;
  /// Energy that is lost on the way between two strains, per unstretched length [N]; >= 0, but for
  /// rounding. `m` is that of the strain `from`.
  [[nodiscard]] double lost(double from, double to, double m) const;
  /// Strain of a rope that is stretched to a tension [N] for the first time; 0 if that is not above 0.
  [[nodiscard]] double first_strain(double tension) const;

 private:
  /// Strain from which on a rope that is stretched takes m along.
  [[nodiscard]] double upper(double m) const;
  /// Tension [N] on the line on which m stays, and its derivative; m <= strain.
  [[nodiscard]] double inner(double strain, double m) const;
  [[nodiscard]] double inner_slope(double strain, double m) const;
  /// Mean of a tension between two strains; exact for polynomials of degree 5 between the points.
  template <class Tension>
  [[nodiscard]] double mean_of(double from, double to, const Tension& tension) const;

  TensionLaw loading_;                   ///< U
  std::optional<TensionLaw> unloading_;  ///< V
  std::vector<double> corners_;          ///< strains of the table
  double width_ = 0.0;                   ///< w
  double stiffness_ = 0.0;               ///< E [N]
};

}  // namespace sheave
