// Locks: the anchors coincide; no relative rotation (lock_rows.h).

#include "engine/joints/fixed.h"

#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {
namespace {

struct FixedKernel : MeetingAnchors {
  static constexpr int lock_count = 6;
  static constexpr std::array<JointCoordinateInfo, 0> coordinates{};
  double compliance = 0.0;
  double angular_compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index < 3) {
      lock_point(*this, index, terms);
      terms.set_compliance(compliance);
    } else {
      lock_rotation(a, b, index - 3, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  [[nodiscard]] JointHold hold_here(const FixedKernel& defined, const Substep& now) const {
    return JointHold::of(defined.a, now, b.position(now), b.orientation(now));
  }
};

}  // namespace

std::span<const Field> FixedJoint::field_table() {
  static const std::array table{
      field<&FixedJoint::anchor>("anchor", "m", any_number(), required,
                                 "point at which the bodies are joined, world frame at time 0"),
      field<&FixedJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                     "of each direction of translation; 0 (default) is rigid"),
      field<&FixedJoint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                             optional, "of each rotation; 0 (default) is rigid"),
  };
  return table;
}

std::span<const JointCoordinateInfo> FixedJoint::coordinates() const { return {}; }

Errors FixedJoint::validate(const BodySet& bodies, const std::string& path) const {
  return JointDef::validate(bodies, path);
}

std::unique_ptr<ConstraintBatch> FixedJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<FixedKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const FixedJoint&>(*def);
    parts.push_back(
        {{MeetingAnchors::at_start(bodies, joint, joint.body_a, joint.body_b, joint.anchor),
          joint.compliance, joint.angular_compliance},
         {}});
  }
  return std::make_unique<JointBatch<FixedKernel>>("fixed joints", bodies, joints,
                                                   std::move(parts));
}

}  // namespace sheave
