#pragma once

#include "engine/joint.h"

namespace sheave {

/// Couples the rotations of two bodies: angle of body_b = ratio x angle of body_a.
class GearJoint final : public JointDef {
 public:
  Vector3 axis_a =
      Vector3::UnitZ();  ///< of body_a's rotation, world frame at time 0; any length but 0
  /// Of body_b's rotation, world frame at time 0; any length but 0
  Vector3 axis_b = Vector3::UnitZ();
  double ratio = -1.0;  ///< turns of body_b per turn of body_a, not 0; < 0: opposite senses
  /// The body that carries both axles. Both angles are relative to the carrier.
  BodyId carrier;
  double compliance = 0.0;  ///< compliance of the angle of body_b [rad/(N m)], >= 0
  double backlash = 0.0;    ///< play of body_b, half to each side at time 0 [rad], >= 0

  static constexpr std::string_view type_name = "gear";
  static constexpr std::string_view type_meaning =
      "couples the rotations of two bodies about given axes: gears, a chain drive";
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
