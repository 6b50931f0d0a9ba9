#pragma once

#include <optional>

#include "cable/links/wheel_link.h"

namespace sheave {

/// A wheel over which the cable runs without slip. At the end of an open cable the cable is wound
/// onto the wheel, which then needs a stored length. When that length is used up, a round wheel
/// holds the end by its rim, as a hybrid link does.
class RollingLink final : public WheelLink {
 public:
  /// Cable on the wheel at time 0 [m], >= 0; default: the arc between the tangent points. Required
  /// at the end of an open cable, where the second tangent point does not exist.
  std::optional<double> stored_length;
  /// Capstan coefficient, >= 0; default: the cable does not slip. With a coefficient it slips as
  /// soon as the ratio of the tensions exceeds e^(friction x wrap angle). The wrap angle counts
  /// whole turns.
  std::optional<double> friction;
  /// Directions in which cable slides over the wheel; needs friction, which may be 0, and a wheel
  /// with inertia. Over a wheel with one direction the cable slides only there: a ratchet pulley.
  /// The directions are relative to the body, so a rotor also carries the cable back as it turns.
  Passage passes = Passage::both;
  /// Only on a rotor: incoming tension / outgoing tension at steady rotation, in (0, 1]; default:
  /// 1. One number stands for the losses in bearing and rope, 0.98 for wire rope on roller
  /// bearings. At rest the ratio lies between the efficiency e and 1 / e. The bearing of a wheel
  /// with spin inertia brakes it with a torque of at most radius (1 - e) / (1 + e) times the sum of
  /// both tensions, which gives the same ratio.
  std::optional<double> efficiency;
  /// Only on a rotor, in place of `efficiency`: share of the tension that the rope loses by being
  /// bent onto the wheel and straightened again, half of it on each side, 0 <= ... < 1; default: 0.
  double bending_loss = 0.0;
  /// Only on a rotor, in place of `efficiency`: coefficient of friction between pin and wheel, >= 0;
  /// default: 0. The load of the pin is the vector sum of both tensions, and of the weight of a
  /// wheel with spin inertia (cable/bearing_loss.h).
  double bearing_friction = 0.0;
  /// Radius of the pin on which the wheel turns [m], > 0; needed with `bearing_friction`.
  std::optional<double> journal_radius;
  /// Whether the cable does not touch the wheel at time 0. When it comes to touch the wheel, it is
  /// wound on as `winding` says.
  bool lifted = false;
  /// Whole turns in addition to the arc between the tangent points, 0 ... 1000. An arc of more than
  /// 300 degrees without whole turns is an error, because such a cable does not reach the wheel.
  int turns = 0;

  static constexpr std::string_view type_name = "rolling";
  static constexpr std::string_view type_meaning =
      "the cable runs over a wheel without slipping, or is wound onto it at a cable's end";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
