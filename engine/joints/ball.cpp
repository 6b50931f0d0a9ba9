// Three rows: C_k = e_k . (p_a - p_b) with the world axes e_k; gradient e_k at p_a, -e_k at p_b.

#include "engine/joints/ball.h"

#include <array>

#include "engine/joints/anchor.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/point_rows.h"

namespace sheave {
namespace {

struct BallKernel {
  static constexpr int row_count = 3;
  Anchor a;
  Anchor b;
  double compliance = 0.0;

  void evaluate(const Substep& substep, int index, Row& row) const {
    evaluate_point_row(substep, a, b, index, row);
    row.compliance = compliance;
  }
};

}  // namespace

std::span<const Field> BallJoint::field_table() {
  static const std::array table{
      field<&BallJoint::anchor>("anchor", "m", any_number(), required,
                                "common point, world frame at time 0"),
      field<&BallJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                    "of each direction; 0 (default) is rigid"),
  };
  return table;
}

std::unique_ptr<ConstraintBatch> BallJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<BallKernel> kernels;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const BallJoint&>(*def);
    kernels.push_back({Anchor::at_start(bodies, joint.body_a, joint.anchor),
                       Anchor::at_start(bodies, joint.body_b, joint.anchor), joint.compliance});
  }
  return std::make_unique<JointBatch<BallKernel>>("ball joints", std::move(kernels));
}

}  // namespace sheave
