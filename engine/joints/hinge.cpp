// Rows 0-2: the anchors coincide (point_rows.h). Rows 3-4: the axis a of body A is perpendicular to
// two directions p of body B that are perpendicular to B's axis, C = a . p. Rotations change it by
//   dC = (d_a x a) . p + a . (d_b x p) = (a x p) . (d_a - d_b).

#include "engine/joints/hinge.h"

#include <array>

#include "engine/joints/joint_batch.h"
#include "engine/joints/point_rows.h"

namespace sheave {
namespace {

struct HingeKernel {
  static constexpr int row_count = 5;
  Anchor a;  // frame: z is the axis
  Anchor b;
  double compliance = 0.0;

  void evaluate(const Substep& substep, int index, Row& row) const {
    if (index < 3) {
      evaluate_point_row(substep, a, b, index, row);
      row.compliance = compliance;
      return;
    }
    const Vector3 axis = a.orientation(substep) * Vector3::UnitZ();
    const Vector3 across = b.orientation(substep) * Vector3::Unit(index - 3);
    row.value = axis.dot(across);
    const Vector3 gradient = axis.cross(across);
    substep.add_torque(row, a.body, gradient);
    substep.add_torque(row, b.body, -gradient);
  }
};

}  // namespace

std::span<const Field> HingeJoint::field_table() {
  static const std::array table{
      field<&HingeJoint::anchor>("anchor", "m", any_number(), required,
                                 "a point of the axis, world frame at time 0"),
      field<&HingeJoint::axis>("axis", "", any_number(), required,
                               "direction of the axis, world frame at time 0"),
      field<&HingeJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                     "of each direction of translation; 0 (default) is rigid"),
  };
  return table;
}

Errors HingeJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  if (!(axis.norm() > 1e-12)) {
    errors.push_back({path + "/axis", "joint \"" + name +
                                          "\": the axis must have a direction; its "
                                          "length is 0"});
  }
  return errors;
}

std::unique_ptr<ConstraintBatch> HingeJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<HingeKernel> kernels;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const HingeJoint&>(*def);
    const Quaternion frame = Quaternion::FromTwoVectors(Vector3::UnitZ(), joint.axis.normalized());
    kernels.push_back({Anchor::at_start(bodies, joint.body_a, joint.anchor, frame),
                       Anchor::at_start(bodies, joint.body_b, joint.anchor, frame),
                       joint.compliance});
  }
  return std::make_unique<JointBatch<HingeKernel>>("hinge joints", std::move(kernels));
}

}  // namespace sheave
