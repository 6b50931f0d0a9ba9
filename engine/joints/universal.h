#pragma once

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// Keeps two points together and an axis of body_a perpendicular to one of body_b: a Cardan joint.
class UniversalJoint final : public JointDef {
 public:
  Vector3 anchor = Vector3::Zero();   ///< common point, world frame at time 0 [m]
  Vector3 axis_a = Vector3::UnitX();  ///< fixed to body_a, world frame at time 0; any length but 0
  Vector3 axis_b =
      Vector3::UnitY();             ///< fixed to body_b, perpendicular to axis_a; any length but 0
  double compliance = 0.0;          ///< of each direction of translation [m/N], >= 0
  double angular_compliance = 0.0;  ///< of the angle between the axes [rad/(N m)], >= 0
  JointCoordinate angle_a;  ///< of the cross relative to body_a, about axis_a [rad], 0 at time 0
  JointCoordinate angle_b;  ///< of body_b relative to the cross, about axis_b [rad], 0 at time 0

  static constexpr std::string_view type_name = "universal";
  static constexpr std::string_view type_meaning =
      "keeps two points together and two axes at a right angle: a Cardan joint";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
