#pragma once

#include <optional>

#include "cable/links/wheel_link.h"

namespace sheave {

/// The cable runs over a wheel without slipping. At the end of an open cable it is wound onto the
/// wheel, which then needs a stored length; a round one holds the end by its rim when that is used
/// up, as a hybrid link does.
class RollingLink final : public WheelLink {
 public:
  /// Cable on the wheel at time 0 [m], >= 0; default: the arc between the tangents. Required at the
  /// end of an open cable, where there is no second tangent.
  std::optional<double> stored_length;
  /// Capstan coefficient, >= 0; default: the cable does not slip. With it, it slips as soon as the
  /// ratio of the tensions passes e^(friction x wrap angle), any number of turns.
  std::optional<double> friction;
  /// Of a rotor: the tension of the cable that comes to it over that of the cable that goes from it
  /// while it turns steadily, in (0, 1]; default: 1. What is lost in bearing and rope is told as one
  /// number, 0.98 for wire rope on roller bearings. At rest the ratio is anything between it and
  /// its inverse. A wheel with spin inertia is braked by a torque of at most radius (1 - e) / (1 +
  /// e) times the sum of both tensions, which is the same.
  std::optional<double> efficiency;
  /// The cable passes the wheel by at time 0; it is wound on, as `winding` says, when it comes to
  /// touch it.
  bool lifted = false;
  /// Whole turns in addition to the arc between the tangents, 0 ... 1000. An arc of more than 300
  /// degrees without any is an error: the cable would not reach the wheel.
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
