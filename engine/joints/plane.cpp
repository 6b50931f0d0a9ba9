// Locks: B's anchor stays in the plane of A; the normal of A is perpendicular to two directions of
// B across B's own normal (lock_rows.h). Coordinates: the angle about the normal. The sliding of
// B's anchor along two directions in the plane, fixed to A, serves friction and damping.

#include "engine/joints/plane.h"

#include "engine/joints/drive_reach.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {
namespace {

struct PlaneKernel : AnchorPair {  // the frame's z axis is the normal
  static constexpr int lock_count = 3;
  static constexpr std::array<JointCoordinateInfo, 3> coordinates{
      {{"angle", true},
       {"slide0", false, JointCoordinateInfo::Measure::changes},
       {"slide1", false, JointCoordinateInfo::Measure::changes}}};
  double compliance = 0.0;
  double angular_compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index == 0) {
      offset_along(a, b, 2, terms);
      terms.set_compliance(compliance);
    } else {
      lock_perpendicular(a, 2, b, index - 1, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  void coordinate(int index, JointTerms& terms) const {
    if (index == 0) {
      angle_about(a, b, terms);
      return;
    }
    const Vector3 at_b = b.position(terms.substep());
    const Vector3 direction = a.orientation(terms.substep()) * Vector3::Unit(index - 1);
    terms.add_force(a.body, at_b, -direction);
    terms.add_force(b.body, at_b, direction);
  }
  [[nodiscard]] JointHold hold_here(const PlaneKernel& defined, const Substep& now) const {
    const Quaternion frame = turned_about(b.orientation(now), 2, -coordinate_of(*this, 0, now));
    const Vector3 normal = frame * Vector3::UnitZ();
    const Vector3 at_a = a.position(now);
    return JointHold::of(defined.a, now, at_a + normal.dot(b.position(now) - at_a) * normal, frame);
  }
};

}  // namespace

std::span<const Field> PlaneJoint::field_table() {
  static const std::vector<Field> table = joined(
      {{field<&PlaneJoint::anchor>("anchor", "m", any_number(), required,
                                   "a point of the plane, world frame at time 0"),
        field<&PlaneJoint::normal>("normal", "", any_number(), required,
                                   "of the plane, fixed to body_a; world frame at time 0"),
        field<&PlaneJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                       "of the distance from the plane; 0 (default) is rigid"),
        field<&PlaneJoint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                               optional, "of the tilt; 0 (default) is rigid"),
        field<&PlaneJoint::damping>("damping", "N s/m", at_least(0.0), optional,
                                    "viscous friction against sliding"),
        field<&PlaneJoint::friction>("friction", "N", at_least(0.0), optional,
                                     "dry friction against sliding")},
       coordinate_fields<PlaneJoint, &PlaneJoint::angle>(CoordinateKind::rotation, "angle_",
                                                         "the angle of body_b about the normal")});
  return table;
}

std::span<const JointCoordinateInfo> PlaneJoint::coordinates() const {
  return std::span(PlaneKernel::coordinates)
      .first(1);  // without the slides, which are for friction
}

Errors PlaneJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_direction(normal, name, path + "/normal", errors);
  check_coordinate(angle, name, path, "angle_", errors);
  check_reach(angle, *this, normal,
              angular_compliance > 0.0 ? Turning::freely : Turning::about_one_axis, bodies,
              path + "/angle_drive", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> PlaneJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<PlaneKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const PlaneJoint&>(*def);
    JointParts<PlaneKernel> part{{AnchorPair::at_start(bodies, joint, joint.body_a, joint.body_b,
                                                       joint.anchor, frame_along(joint.normal)),
                                  joint.compliance, joint.angular_compliance},
                                 {}};
    append_effects(joint.angle, 0, part.effects);
    append_resistance(joint.damping, joint.friction, 1, 2, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<PlaneKernel>>("plane joints", bodies, joints,
                                                   std::move(parts));
}

}  // namespace sheave
