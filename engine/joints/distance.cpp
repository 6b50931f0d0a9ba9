// C = |p_a - p_b| - L, gradient n at p_a and -n at p_b with n = (p_a - p_b) / |p_a - p_b|. A force
// l / h^2 along the gradient pushes the points apart, so a string (C <= 0) has l in (-inf, 0] and a
// bumper (C >= 0) has l in [0, inf).

#include "engine/joints/distance.h"

#include "engine/joints/anchor.h"
#include "engine/joints/joint_batch.h"

namespace sheave {
namespace {

struct DistanceKernel {
  static constexpr int row_count = 1;
  Anchor a;
  Anchor b;
  double length = 0.0;
  double compliance = 0.0;
  double damping = 0.0;
  double lower = -Row::unbounded;
  double upper = Row::unbounded;

  void evaluate(const Substep& substep, int /*index*/, Row& row) const {
    const Vector3 at_a = a.position(substep);
    const Vector3 at_b = b.position(substep);
    const Vector3 apart = at_a - at_b;
    const double distance = apart.norm();
    row.value = distance - length;
    row.compliance = compliance;
    row.damping = damping;
    row.lower = lower;
    row.upper = upper;
    // Coincident points have no direction; any unit vector separates them again.
    const Vector3 direction =
        distance > 0.0 ? Vector3(apart / distance) : Vector3(Vector3::UnitX());
    add_relative_translation(substep, row, a.body, b.body, at_a, at_b, direction);
  }
};

}  // namespace

std::span<const Field> DistanceJoint::field_table() {
  static const std::array table{
      field<&DistanceJoint::anchor_a>("anchor_a", "m", any_number(), required,
                                      "point of body_a, world frame at time 0"),
      field<&DistanceJoint::anchor_b>("anchor_b", "m", any_number(), required,
                                      "point of body_b, world frame at time 0"),
      field<&DistanceJoint::length>("length", "m", above(0.0), optional,
                                    "default: the distance at time 0"),
      choice_field<&DistanceJoint::limit>("limit", distance_limit_names, optional,
                                          "which distances are permitted: a rod, a string or a "
                                          "bumper"),
      field<&DistanceJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                        "0 (default) is rigid"),
      field<&DistanceJoint::damping>("damping", "N s/m", at_least(0.0), optional,
                                     "needs compliance"),
  };
  return table;
}

Errors DistanceJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  if (!length && !((anchor_a - anchor_b).norm() > 0.0)) {
    errors.push_back({path, "joint \"" + name +
                                "\": the anchors coincide; give them a distance, "
                                "or \"length\", or use a ball joint"});
  }
  if (damping > 0.0 && compliance == 0.0) {
    errors.push_back({path + "/damping", "joint \"" + name +
                                             "\": damping acts on an elastic joint "
                                             "only; give \"compliance\" too"});
  }
  return errors;
}

std::unique_ptr<ConstraintBatch> DistanceJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<DistanceKernel> kernels;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const DistanceJoint&>(*def);
    DistanceKernel kernel;
    kernel.a = Anchor::at_start(bodies, joint.body_a, joint.anchor_a);
    kernel.b = Anchor::at_start(bodies, joint.body_b, joint.anchor_b);
    kernel.length = joint.length.value_or((joint.anchor_a - joint.anchor_b).norm());
    kernel.compliance = joint.compliance;
    kernel.damping = joint.damping;
    if (joint.limit == DistanceLimit::at_most) kernel.upper = 0.0;
    if (joint.limit == DistanceLimit::at_least) kernel.lower = 0.0;
    kernels.push_back(kernel);
  }
  return std::make_unique<JointBatch<DistanceKernel>>("distance joints", std::move(kernels));
}

}  // namespace sheave
