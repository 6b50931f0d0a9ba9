#pragma once

#include "engine/joint.h"

namespace sheave {

/// Keeps two points of two bodies together.
class BallJoint final : public JointDef {
 public:
  Vector3 anchor = Vector3::Zero();  ///< common point, world frame at time 0 [m]
  double compliance = 0.0;           ///< of each direction [m/N], >= 0

  static constexpr std::string_view type_name = "ball";
  static constexpr std::string_view type_meaning =
      "keeps two points of two bodies together; they turn freely about it";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
