#pragma once

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// Leaves two bodies translations in a plane and the rotation about its normal.
class PlaneJoint final : public JointDef {
 public:
  Vector3 anchor = Vector3::Zero();  ///< a point of the plane, world frame at time 0 [m]
  Vector3 normal =
      Vector3::UnitZ();  ///< of the plane, fixed to body_a; world frame at time 0, any length but 0
  double compliance = 0.0;          ///< of the distance from the plane [m/N], >= 0
  double angular_compliance = 0.0;  ///< of the tilt [rad/(N m)], >= 0
  double damping = 0.0;             ///< force per sliding velocity of the anchor [N s/m], >= 0
  double friction = 0.0;            ///< dry friction against sliding of the anchor [N], >= 0
  JointCoordinate angle;  ///< of body_b relative to body_a about the normal [rad], 0 at time 0

  static constexpr std::string_view type_name = "plane";
  static constexpr std::string_view type_meaning =
      "leaves two bodies translations in a plane and the rotation about its normal";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
