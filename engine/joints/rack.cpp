// One row: C = travel of B - radius x angle of A. Both are relative to the carrier, and the angle
// includes whole turns. With backlash: two unilateral rows, half the backlash to each side.

#include "engine/joints/rack.h"

#include "engine/joints/gear_mesh.h"

namespace sheave {
namespace {

struct RackKernel {
  static constexpr int lock_count = 0;
  static constexpr std::array<JointCoordinateInfo, 2> coordinates{
      {{"angle", true}, {"travel", false}}};
  AnchorPair pinion;  // anchors on the carrier and on body_a
  AnchorPair rack;    // anchors on the carrier and on body_b

  double mesh = 0.0;  // shift of the mesh relative to the definition [m]

  [[nodiscard]] bool elastic() const { return false; }
  [[nodiscard]] int anchor_body() const { return rack.anchor_body(); }
  [[nodiscard]] Vector3 anchor(const Substep& substep) const { return rack.anchor(substep); }
  void lock(int /*index*/, JointTerms& /*terms*/) const {}
  void apply(const JointHold& hold) { mesh = hold.offset; }
  [[nodiscard]] JointHold hold_here(const RackKernel& /*defined*/, const Substep& /*now*/) const {
    return {};  // the only constraint is the coupling
  }
  void coordinate(int index, JointTerms& terms) const {
    if (index == 0) {
      angle_about(pinion.a, pinion.b, terms);
    } else {
      offset_along(rack.a, rack.b, 2, terms);
    }
  }
};

}  // namespace

std::span<const Field> RackJoint::field_table() {
  static const std::array table{
      field<&RackJoint::axis>("axis", "", any_number(), required,
                              "of body_a's rotation, world frame at time 0"),
      field<&RackJoint::direction>("direction", "", any_number(), required,
                                   "of body_b's translation, world frame at time 0"),
      field<&RackJoint::anchor>("anchor", "m", any_number(), required,
                                "point of body_b at which the force acts, world frame at time 0"),
      field<&RackJoint::radius>("radius", "m/rad", any_number(), required,
                                "travel per angle, not 0; a screw has its pitch / 2 pi"),
      field<&RackJoint::carrier>("carrier", "", {}, optional,
                                 "the body that carries axle and guide (default: the world)"),
      field<&RackJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                    "of the travel; 0 (default) is rigid"),
      field<&RackJoint::backlash>("backlash", "m", at_least(0.0), optional, "play of body_b"),
  };
  return table;
}

std::span<const JointCoordinateInfo> RackJoint::coordinates() const {
  return RackKernel::coordinates;
}

Errors RackJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_coupling(*this, carrier, radius, "radius", bodies, path, errors);
  check_direction(axis, name, path + "/axis", errors);
  check_direction(direction, name, path + "/direction", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> RackJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<RackKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const RackJoint&>(*def);
    JointParts<RackKernel> part{{AnchorPair::at_start(bodies, joint, joint.carrier, joint.body_a,
                                                      joint.anchor, frame_along(joint.axis)),
                                 AnchorPair::at_start(bodies, joint, joint.carrier, joint.body_b,
                                                      joint.anchor, frame_along(joint.direction))},
                                {}};
    append_coupling(joint.radius, joint.compliance, joint.backlash, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<RackKernel>>("rack joints", bodies, joints, std::move(parts));
}

}  // namespace sheave
