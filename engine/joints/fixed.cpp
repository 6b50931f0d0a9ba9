// Rows 0-2: the anchors coincide (point_rows.h). Rows 3-5: the quaternion E = q_a q_b^-1 of the
// relative rotation of the joint frames, with w >= 0, is the identity: C_k = 2 E_k (the rotation
// vector for small errors). A world rotation d of A changes E to (1, d/2) E, one of B to
// E (1, -d/2), so with E = (w, v)
//   dC_k = (w e_k + v x e_k) . d_a - (w e_k - v x e_k) . d_b.

#include "engine/joints/fixed.h"

#include <array>

#include "engine/joints/joint_batch.h"
#include "engine/joints/point_rows.h"

namespace sheave {
namespace {

struct FixedKernel {
  static constexpr int row_count = 6;
  Anchor a;
  Anchor b;
  double compliance = 0.0;
  double angular_compliance = 0.0;

  void evaluate(const Substep& substep, int index, Row& row) const {
    if (index < 3) {
      evaluate_point_row(substep, a, b, index, row);
      row.compliance = compliance;
      return;
    }
    Quaternion error = a.orientation(substep) * b.orientation(substep).conjugate();
    if (error.w() < 0.0) error.coeffs() = -error.coeffs();
    const Vector3 axis = Vector3::Unit(index - 3);
    const Vector3 v = error.vec();
    row.value = 2.0 * v[index - 3];
    row.compliance = angular_compliance;
    substep.add_torque(row, a.body, error.w() * axis + v.cross(axis));
    substep.add_torque(row, b.body, -error.w() * axis + v.cross(axis));
  }
};

}  // namespace

std::span<const Field> FixedJoint::field_table() {
  static const std::array table{
      field<&FixedJoint::anchor>("anchor", "m", any_number(), required,
                                 "where the bodies are joined, world frame at time 0"),
      field<&FixedJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                     "of each direction of translation; 0 (default) is rigid"),
      field<&FixedJoint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                             optional, "of each rotation; 0 (default) is rigid"),
  };
  return table;
}

std::unique_ptr<ConstraintBatch> FixedJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<FixedKernel> kernels;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const FixedJoint&>(*def);
    kernels.push_back({Anchor::at_start(bodies, joint.body_a, joint.anchor),
                       Anchor::at_start(bodies, joint.body_b, joint.anchor), joint.compliance,
                       joint.angular_compliance});
  }
  return std::make_unique<JointBatch<FixedKernel>>("fixed joints", std::move(kernels));
}

}  // namespace sheave
