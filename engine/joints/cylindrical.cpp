// Locks: B's anchor stays on the axis, in two directions of A across it; A's axis is perpendicular
// to two directions of B across B's axis (lock_rows.h). Coordinates: travel along the axis of A,
// angle about it.

#include "engine/joints/cylindrical.h"

#include "engine/joints/drive_reach.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {
namespace {

struct CylindricalKernel : AnchorPair {  // the frame's z axis is the joint's axis
  static constexpr int lock_count = 4;
  static constexpr std::array<JointCoordinateInfo, 2> coordinates{
      {{"travel", false}, {"angle", true}}};
  double compliance = 0.0;
  double angular_compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index < 2) {
      offset_along(a, b, index, terms);
      terms.set_compliance(compliance);
    } else {
      lock_perpendicular(a, 2, b, index - 2, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  void coordinate(int index, JointTerms& terms) const {
    if (index == 0) {
      offset_along(a, b, 2, terms);
    } else {
      angle_about(a, b, terms);
    }
  }
  [[nodiscard]] JointHold hold_here(const CylindricalKernel& defined, const Substep& now) const {
    const Quaternion frame = b.orientation(now);
    const Vector3 way = coordinate_of(*this, 0, now) * (frame * Vector3::UnitZ());
    return JointHold::of(defined.a, now, b.position(now) - way,
                         turned_about(frame, 2, -coordinate_of(*this, 1, now)));
  }
};

}  // namespace

std::span<const Field> CylindricalJoint::field_table() {
  using Joint = CylindricalJoint;
  static const std::vector<Field> table = joined(
      {{field<&Joint::anchor>("anchor", "m", any_number(), required,
                              "a point of the axis, world frame at time 0"),
        field<&Joint::axis>("axis", "", any_number(), required,
                            "direction of the axis, fixed to body_a; world frame at time 0"),
        field<&Joint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                  "across the axis; 0 (default) is rigid"),
        field<&Joint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                          optional, "of tilting the axis; 0 (default) is rigid")},
       coordinate_fields<Joint, &Joint::travel>(CoordinateKind::translation, "travel_",
                                                "the travel of body_b against body_a"),
       coordinate_fields<Joint, &Joint::angle>(CoordinateKind::rotation, "angle_",
                                               "the angle of body_b against body_a")});
  return table;
}

std::span<const JointCoordinateInfo> CylindricalJoint::coordinates() const {
  return CylindricalKernel::coordinates;
}

Errors CylindricalJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_direction(axis, name, path + "/axis", errors);
  check_coordinate(travel, name, path, "travel_", errors);
  check_coordinate(angle, name, path, "angle_", errors);
  check_reach(angle, *this, axis,
              angular_compliance > 0.0 ? Turning::freely : Turning::about_one_axis, bodies,
              path + "/angle_drive", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> CylindricalJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<CylindricalKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const CylindricalJoint&>(*def);
    JointParts<CylindricalKernel> part{
        {AnchorPair::at_start(bodies, joint, joint.body_a, joint.body_b, joint.anchor,
                              frame_along(joint.axis)),
         joint.compliance, joint.angular_compliance},
        {}};
    append_effects(joint.travel, 0, part.effects);
    append_effects(joint.angle, 1, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<CylindricalKernel>>("cylindrical joints", bodies, joints,
                                                         std::move(parts));
}

}  // namespace sheave
