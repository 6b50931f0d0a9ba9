// One row: C = angle of B - ratio x angle of A. Both angles are relative to the carrier and include
// whole turns, so the teeth cannot skip. With backlash: two unilateral rows, half the backlash to
// each side.

#include "engine/joints/gear.h"

#include "engine/joints/gear_mesh.h"

namespace sheave {
namespace {

struct GearKernel {
  static constexpr int lock_count = 0;
  static constexpr std::array<JointCoordinateInfo, 2> coordinates{
      {{"angle_a", true}, {"angle_b", true}}};
  AnchorPair a;  // anchors on the carrier and on body_a
  AnchorPair b;

  double mesh = 0.0;  // shift of the mesh relative to the definition [rad]

  [[nodiscard]] bool elastic() const { return false; }
  [[nodiscard]] int anchor_body() const { return b.anchor_body(); }
  [[nodiscard]] Vector3 anchor(const Substep& substep) const { return b.anchor(substep); }
  void lock(int /*index*/, JointTerms& /*terms*/) const {}
  void apply(const JointHold& hold) { mesh = hold.offset; }
  [[nodiscard]] JointHold hold_here(const GearKernel& /*defined*/, const Substep& /*now*/) const {
    return {};  // the only constraint is the coupling
  }
  void coordinate(int index, JointTerms& terms) const {
    const AnchorPair& side = index == 0 ? a : b;
    angle_about(side.a, side.b, terms);
  }
};

}  // namespace

std::span<const Field> GearJoint::field_table() {
  static const std::array table{
      field<&GearJoint::axis_a>("axis_a", "", any_number(), optional,
                                "of body_a's rotation, world frame at time 0 (default z)"),
      field<&GearJoint::axis_b>("axis_b", "", any_number(), optional,
                                "of body_b's rotation, world frame at time 0 (default z)"),
      field<&GearJoint::ratio>("ratio", "", any_number(), required,
                               "turns of body_b per turn of body_a, not 0; negative for wheels "
                               "that mesh from outside"),
      field<&GearJoint::carrier>("carrier", "", {}, optional,
                                 "the body that carries both axles (default: the world)"),
      field<&GearJoint::compliance>("compliance", "rad/(N m)", at_least(0.0), optional,
                                    "of the angle of body_b; 0 (default) is rigid"),
      field<&GearJoint::backlash>("backlash", "rad", at_least(0.0), optional, "play of body_b"),
  };
  return table;
}

std::span<const JointCoordinateInfo> GearJoint::coordinates() const {
  return GearKernel::coordinates;
}

Errors GearJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_coupling(*this, carrier, ratio, "ratio", bodies, path, errors);
  check_direction(axis_a, name, path + "/axis_a", errors);
  check_direction(axis_b, name, path + "/axis_b", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> GearJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<GearKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const GearJoint&>(*def);
    const auto side = [&](BodyId body, const Vector3& axis) {
      const int index = bodies.index(body);
      const BodyFrame frame = bodies.frame(index, joint.defined_in);
      const Vector3 center = frame.position + frame.orientation * bodies[index].center_of_mass;
      return AnchorPair::at_start(bodies, joint, joint.carrier, body, center, frame_along(axis));
    };
    JointParts<GearKernel> part{
        {side(joint.body_a, joint.axis_a), side(joint.body_b, joint.axis_b)}, {}};
    append_coupling(joint.ratio, joint.compliance, joint.backlash, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<GearKernel>>("gear joints", bodies, joints, std::move(parts));
}

}  // namespace sheave
