#pragma once

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// Leaves two bodies a translation along an axis and a rotation about it.
class CylindricalJoint final : public JointDef {
 public:
  Vector3 anchor = Vector3::Zero();  ///< a point of the axis, world frame at time 0 [m]
  Vector3 axis = Vector3::UnitZ();   ///< direction, world frame at time 0; any length but 0
  double compliance = 0.0;           ///< of each locked translation [m/N], >= 0
  double angular_compliance = 0.0;   ///< of each locked rotation [rad/(N m)], >= 0
  JointCoordinate travel;  ///< of body_b relative to body_a along the axis [m], 0 at time 0
  JointCoordinate angle;   ///< of body_b relative to body_a about the axis [rad], 0 at time 0

  static constexpr std::string_view type_name = "cylindrical";
  static constexpr std::string_view type_meaning =
      "leaves two bodies a translation along an axis and a rotation about it";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
