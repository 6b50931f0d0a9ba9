#pragma once

#include "engine/joint.h"

namespace sheave {

/// Welds two bodies together at a point.
class FixedJoint final : public JointDef {
 public:
  /// Point at which the bodies are joined, world frame at time 0 [m]
  Vector3 anchor = Vector3::Zero();
  double compliance = 0.0;          ///< of each direction of translation [m/N], >= 0
  double angular_compliance = 0.0;  ///< of each rotation [rad/(N m)], >= 0

  static constexpr std::string_view type_name = "fixed";
  static constexpr std::string_view type_meaning = "welds two bodies together";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
