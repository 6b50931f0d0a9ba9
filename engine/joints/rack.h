#pragma once

#include "engine/joint.h"

namespace sheave {

/// Couples a rotation of body_a with a translation of body_b: travel = radius x angle.
class RackJoint final : public JointDef {
 public:
  Vector3 axis =
      Vector3::UnitZ();  ///< of body_a's rotation, world frame at time 0; any length but 0
  /// Of body_b's translation, world frame at time 0; any length but 0
  Vector3 direction = Vector3::UnitX();
  /// Point of body_b at which the force acts, world frame at time 0 [m]
  Vector3 anchor = Vector3::Zero();
  double radius = 0.1;  ///< travel per rad [m/rad], not 0; a screw has pitch / 2 pi
  /// The body that carries axle and guide. Angle and travel are relative to the carrier.
  BodyId carrier;
  double compliance = 0.0;  ///< compliance of the travel [m/N], >= 0
  double backlash = 0.0;    ///< play of body_b, half to each side at time 0 [m], >= 0

  static constexpr std::string_view type_name = "rack";
  static constexpr std::string_view type_meaning =
      "couples a rotation of one body with a translation of another: a rack, a screw";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] BodyId carrier_body() const override { return carrier; }
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
