// Locks: B's anchor stays on the axis, in two directions of A across it; no relative rotation
// (lock_rows.h). Coordinate: the displacement of B's anchor along the axis of A.

#include "engine/joints/slider.h"

#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {
namespace {

struct SliderKernel : AnchorPair {  // the frame's z axis is the joint's axis
  static constexpr int lock_count = 5;
  static constexpr std::array<JointCoordinateInfo, 1> coordinates{{{"travel", false}}};
  double compliance = 0.0;
  double angular_compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index < 2) {
      offset_along(a, b, index, terms);
      terms.set_compliance(compliance);
    } else {
      lock_rotation(a, b, index - 2, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  void coordinate(int /*index*/, JointTerms& terms) const { offset_along(a, b, 2, terms); }
  [[nodiscard]] JointHold hold_here(const SliderKernel& defined, const Substep& now) const {
    const Quaternion frame = b.orientation(now);
    const Vector3 way = coordinate_of(*this, 0, now) * (frame * Vector3::UnitZ());
    return JointHold::of(defined.a, now, b.position(now) - way, frame);
  }
};

/// Whether the mobility of a body restricts it to the axis, or the body never moves.
bool slides_only(const BodyProperties& body, const Vector3& axis) {
  constexpr double rounding = 1e-12;
  if (body.mobility == Mobility::fixed) return true;
  return body.mobility == Mobility::slider && body.axis.cross(axis).norm() <= rounding;
}

}  // namespace

std::span<const Field> SliderJoint::field_table() {
  static const std::vector<Field> table = joined(
      {{field<&SliderJoint::anchor>("anchor", "m", any_number(), required,
                                    "point at which the bodies are joined, world frame at time 0"),
        field<&SliderJoint::axis>("axis", "", any_number(), required,
                                  "direction of the axis, fixed to body_a; world frame at time 0"),
        field<&SliderJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                        "across the axis; 0 (default) is rigid"),
        field<&SliderJoint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                                optional,
                                                "of each rotation; 0 (default) is rigid")},
       coordinate_fields<SliderJoint, &SliderJoint::travel>(
           CoordinateKind::translation, "", "the travel of body_b against body_a")});
  return table;
}

std::span<const JointCoordinateInfo> SliderJoint::coordinates() const {
  return SliderKernel::coordinates;
}

Errors SliderJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_direction(axis, name, path + "/axis", errors);
  check_coordinate(travel, name, path, "", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> SliderJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<SliderKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const SliderJoint&>(*def);
    JointParts<SliderKernel> part{{AnchorPair::at_start(bodies, joint, joint.body_a, joint.body_b,
                                                        joint.anchor, frame_along(joint.axis)),
                                   joint.compliance, joint.angular_compliance},
                                  {}};
    const Vector3 along = joint.axis.normalized();
    part.locks_are_idle = slides_only(bodies[bodies.index(joint.body_a)], along) &&
                          slides_only(bodies[bodies.index(joint.body_b)], along);
    part.exact = part.locks_are_idle;
    append_effects(joint.travel, 0, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<SliderKernel>>("slider joints", bodies, joints,
                                                    std::move(parts));
}

}  // namespace sheave
