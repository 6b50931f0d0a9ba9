// Locks: the anchors coincide; A's axis is perpendicular to two directions of B that are
// perpendicular to B's axis (lock_rows.h). Coordinate: the angle about the axis. If both bodies
// keep the plane perpendicular to the axis, two directions of this plane are the only locks.

#include "engine/joints/hinge.h"

#include "engine/joints/drive_reach.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

struct HingeKernel : MeetingAnchors {  // the frame's z axis is the joint's axis
  static constexpr int lock_count = 5;
  static constexpr std::array<JointCoordinateInfo, 1> coordinates{{{"angle", true}}};
  double compliance = 0.0;
  double angular_compliance = 0.0;
  /// If no body can turn about another axis (`counts_angles`), the angle is a sum of numbers: the
  /// angle between the frames at the bodies' start orientations, and the bodies' angles times their
  /// senses.
  struct Turns {
    Vector3 axis = Vector3::Zero();  ///< unit vector, world frame
    std::array<double, 2> senses{};  ///< of A and B; 0 for a body that never turns
    std::array<Quaternion, 2> starts{Quaternion::Identity(), Quaternion::Identity()};
    double apart = 0.0;  ///< angle between the frames at the start [rad]
  };
  bool counts_angles = false;
  Turns turns{};

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index < 3) {
      lock_point(*this, index, terms);
      terms.set_compliance(compliance);
    } else {
      lock_perpendicular(a, 2, b, index - 3, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  void coordinate(int /*index*/, JointTerms& terms) const {
    if (!counts_angles) return angle_about(a, b, terms);
    const Substep& substep = terms.substep();
    const auto angle = [&](int index, double sense) {
      if (sense == 0.0) return 0.0;
      const MovingBody& body = substep.moving[at(index)];
      return sense * (substep.start.bodies[at(index)].angle + dot(body.axis, body.turn));
    };
    terms.set_value(turns.apart + angle(b.body, turns.senses[1]) - angle(a.body, turns.senses[0]));
    terms.add_torque(a.body, -turns.axis);
    terms.add_torque(b.body, turns.axis);
  }
  void apply(const JointHold& hold) {
    MeetingAnchors::apply(hold);
    if (counts_angles) measure_apart();
  }
  void measure_apart() {
    const Quaternion relative =
        (turns.starts[0] * a.frame).conjugate() * (turns.starts[1] * b.frame);
    turns.apart = 2.0 * portable::atan2(relative.z(), relative.w());
  }
  void count_angles(const BodySet& bodies, const Vector3& axis) {
    turns.axis = axis;
    for (const std::size_t i : {0U, 1U}) {
      const BodyProperties& body = bodies[(i == 0 ? a : b).body];
      const bool wheel = body.mobility == Mobility::rotor && body.mount < 0;
      const bool turns_not = body.mobility == Mobility::fixed || body.mobility == Mobility::slider;
      if (!turns_not && !wheel && body.mobility != Mobility::planar) return;
      if (!turns_not) turns.senses[i] = body.axis.dot(axis) > 0.0 ? 1.0 : -1.0;
      turns.starts[i] = body.start_orientation;
    }
    counts_angles = true;
    measure_apart();
  }
  [[nodiscard]] JointHold hold_here(const HingeKernel& defined, const Substep& now) const {
    const double angle = coordinate_of(*this, 0, now);
    return JointHold::of(defined.a, now, b.position(now),
                         turned_about(b.orientation(now), 2, -angle));
  }
};

}  // namespace

std::span<const Field> HingeJoint::field_table() {
  static const std::vector<Field> table = joined(
      {{field<&HingeJoint::anchor>("anchor", "m", any_number(), required,
                                   "a point of the axis, world frame at time 0"),
        field<&HingeJoint::axis>("axis", "", any_number(), required,
                                 "direction of the axis, world frame at time 0"),
        field<&HingeJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                       "of each direction of translation; 0 (default) is rigid"),
        field<&HingeJoint::angular_compliance>("angular_compliance", "rad/(N m)", at_least(0.0),
                                               optional,
                                               "of tilting the axis; 0 (default) is rigid")},
       coordinate_fields<HingeJoint, &HingeJoint::angle>(CoordinateKind::rotation, "",
                                                         "the angle of body_b against body_a")});
  return table;
}

std::span<const JointCoordinateInfo> HingeJoint::coordinates() const {
  return HingeKernel::coordinates;
}

Errors HingeJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_direction(axis, name, path + "/axis", errors);
  check_coordinate(angle, name, path, "", errors);
  check_reach(angle, *this, axis,
              angular_compliance > 0.0 ? Turning::freely : Turning::about_one_axis, bodies,
              path + "/drive", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> HingeJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<HingeKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const HingeJoint&>(*def);
    JointParts<HingeKernel> part{
        {MeetingAnchors::at_start(bodies, joint, joint.body_a, joint.body_b, joint.anchor,
                                  frame_along(joint.axis)),
         joint.compliance, joint.angular_compliance},
        {}};
    const Vector3 normal = joint.axis.normalized();
    if (bodies.stays_in_plane(bodies.index(joint.body_a), normal) &&
        bodies.stays_in_plane(bodies.index(joint.body_b), normal)) {
      const Vector3 across = any_perpendicular(normal);
      part.kernel.directions = {across, cross(normal, across), normal};
      part.lock_count = part.kernel.direction_count = 2;
      part.kernel.count_angles(bodies, normal);
      const auto whole = [&](BodyId body) {
        const Mobility mobility = bodies[bodies.index(body)].mobility;
        return mobility == Mobility::planar || mobility == Mobility::fixed;
      };
      part.exact = whole(joint.body_a) && whole(joint.body_b);
    }
    append_effects(joint.angle, 0, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<HingeKernel>>("hinge joints", bodies, joints,
                                                   std::move(parts));
}

}  // namespace sheave
