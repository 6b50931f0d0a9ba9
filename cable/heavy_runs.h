#pragma once
// Spans of a rope with weight that share rope through pinholes and over massless wheels; internal to
// the cable library. The derivation is in cable/heavy_runs.cpp.

#include <array>
#include <span>

#include "cable/hanging_rope.h"

namespace sheave {

/// The shape of a span of a run: its ends, or its wheels.
struct HeavyShape {
  WheelPlane wheels;
  HangingRope rope;       ///< without wheels
  double straight = 0.0;  ///< length of the straight tangent [m]

  /// Tensions at both points of the straight tangent, for a chord tension [N].
  [[nodiscard]] std::array<double, 2> ends(double tension) const;
  /// Unstretched length between these points [m], and its derivative by the chord tension [m/N].
  struct Length {
    double length = 0.0;
    double slope = 0.0;
    double most = 0.0;  ///< larger tension at the ends of the free rope [N]
  };
  [[nodiscard]] Length length(double tension) const;
  /// A tension of the rope's own weight, > 0 [N].
  [[nodiscard]] double own_weight() const;
};

/// Chord tensions along a run, from that of its first span on.
class RunTensions {
 public:
  RunTensions() = default;
  /// `unknown`: chord tension of the first span [N], > 0.
  explicit RunTensions(double unknown) : unknown_(unknown) {}

  struct Span {
    double tension = 0.0;  ///< chord tension [N]
    double weight = 1.0;   ///< its derivative by that of the first span
    bool found = true;     ///< false: rope that passes freely would run into the span
  };
  /// The next span. `lift`: rise of the tension over the link before it [N]. `guess`: its chord
  /// tension, or 0 [N].
  Span next(const HeavyShape& shape, double lift, double guess);
  [[nodiscard]] double unknown() const { return unknown_; }

 private:
  double unknown_ = 0.0;
  bool begun_ = false;
  double arrives_ = 0.0;  ///< tension at the second end of the last span [N]
  double slope_ = 1.0;    ///< its derivative by the unknown
};

/// A span of a run whose rope is being shared.
struct SharedSpan {
  HeavyShape shape;
  double lift = 0.0;     ///< RunTensions::next()
  double rest = 0.0;     ///< unstretched length, as given [m]
  double tension = 0.0;  ///< chord tension: a guess, then that of the shared rope [N]
  double length = 0.0;   ///< unstretched length of the shared rope [m]
  double most = 0.0;     ///< larger tension at its ends [N]
};

/// Shares the rope of a run so that it rests on its links. False: no taut run has this length.
bool share_rope(std::span<SharedSpan> spans);

/// Rise of the tension along the rope on a massless wheel [N], which balances the weight of that rope
/// about the axle. `in`, `out`: directions of the rope before the wheel and behind it; `share`:
/// unstretched length over stretched length of the rope on the wheel.
[[nodiscard]] double lift_over(const WheelPlane& wheels, double share, const Vector3& in,
                               const Vector3& out);

}  // namespace sheave
