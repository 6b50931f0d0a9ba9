#pragma once

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// Keeps two points of two bodies together. Two parts of the relative rotation can be limited: the
/// swing of the axis, and the twist about it.
class BallJoint final : public JointDef {
 public:
  Vector3 anchor = Vector3::Zero();  ///< common point, world frame at time 0 [m]
  /// Reference direction of swing and twist, world frame at time 0; any length but 0.
  std::optional<Vector3> axis;
  double compliance = 0.0;  ///< of the anchors' distance, in each direction [m/N], >= 0
  std::optional<double>
      swing_limit;  ///< largest angle between the axes of the bodies [rad], > 0, < pi
  double swing_limit_compliance = 0.0;  ///< [rad/(N m)], >= 0
  JointCoordinate twist;  ///< of body_b about the axis of body_a [rad]; undefined at a swing of pi
  double damping = 0.0;   ///< torque per relative angular velocity, any axis [N m s/rad], >= 0
  double friction = 0.0;  ///< dry friction against any relative rotation [N m], >= 0

  static constexpr std::string_view type_name = "ball";
  static constexpr std::string_view type_meaning =
      "keeps two points of two bodies together; they turn about it, freely or within limits";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
