// Locks: the anchors coincide; the axis u of A is perpendicular to the axis v of B (lock_rows.h).
// Coordinate angle_a is the turn of v about u from A's v0, atan2(v . (u x v0), v . v0). A rotation
// d of B relative to A changes it, whether or not u and v are perpendicular, by
//   d . ((v . v0) v x w0 - (v . w0) v x v0) / ((v . v0)^2 + (v . w0)^2),   w0 = u x v0.
// Coordinate angle_b is minus the turn of u about v from B's u0, by the same formula with the
// bodies exchanged.

#include "engine/joints/universal.h"

#include "engine/joints/drive_reach.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Adds the angle by which the axis `pointer` of body `other` has turned about the axis `about` of
/// `own` since time 0, times `sense`. At time 0 the axes of both frames are equal.
void turn_of_axis(const Anchor& own, int about, const Anchor& other, int pointer, double sense,
                  JointTerms& terms) {
  const Quaternion frame = own.orientation(terms.substep());
  const Vector3 axis = frame * Vector3::Unit(about);
  const Vector3 start = frame * Vector3::Unit(pointer);
  const Vector3 ahead = axis.cross(start);
  const Vector3 now = other.orientation(terms.substep()) * Vector3::Unit(pointer);
  const double x = now.dot(start);
  const double y = now.dot(ahead);
  terms.set_value(sense * portable::atan2(y, x));
  const double size = x * x + y * y;
  if (!(size > 1e-12)) return;
  const Vector3 gradient = sense * now.cross(x * ahead - y * start) / size;
  terms.add_torque(own.body, -gradient);
  terms.add_torque(other.body, gradient);
}

struct UniversalKernel : MeetingAnchors {  // the frames' x axis is axis_a, y is axis_b
  static constexpr int lock_count = 4;
  static constexpr std::array<JointCoordinateInfo, 2> coordinates{
      {{"angle_a", true}, {"angle_b", true}}};
  double compliance = 0.0;
  double angular_compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0 || angular_compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    if (index < 3) {
      lock_point(*this, index, terms);
      terms.set_compliance(compliance);
    } else {
      lock_perpendicular(a, 0, b, 1, terms);
      terms.set_compliance(angular_compliance);
    }
  }
  void coordinate(int index, JointTerms& terms) const {
    if (index == 0) {
      turn_of_axis(a, 0, b, 1, 1.0, terms);
    } else {
      turn_of_axis(b, 1, a, 0, -1.0, terms);
    }
  }
  [[nodiscard]] JointHold hold_here(const UniversalKernel& defined, const Substep& now) const {
    // The rotation from A's frame to B's is a turn about x, followed by one about y.
    const Quaternion across = turned_about(b.orientation(now), 1, -coordinate_of(*this, 1, now));
    return JointHold::of(defined.a, now, b.position(now),
                         turned_about(across, 0, -coordinate_of(*this, 0, now)));
  }
};

}  // namespace

std::span<const Field> UniversalJoint::field_table() {
  using Joint = UniversalJoint;
  static const std::vector<Field> table =
      joined({{field<&Joint::anchor>("anchor", "m", any_number(), required,
                                     "common point, world frame at time 0"),
               field<&Joint::axis_a>("axis_a", "", any_number(), required,
                                     "axis fixed to body_a, world frame at time 0"),
               field<&Joint::axis_b>("axis_b", "", any_number(), required,
                                     "axis fixed to body_b, perpendicular to axis_a"),
               field<&Joint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                         "of each direction of translation; 0 (default) is rigid"),
               field<&Joint::angular_compliance>(
                   "angular_compliance", "rad/(N m)", at_least(0.0), optional,
                   "of the angle between the axes; 0 (default) is rigid")},
              coordinate_fields<Joint, &Joint::angle_a>(CoordinateKind::rotation, "angle_a_",
                                                        "the turn about axis_a"),
              coordinate_fields<Joint, &Joint::angle_b>(CoordinateKind::rotation, "angle_b_",
                                                        "the turn about axis_b")});
  return table;
}

std::span<const JointCoordinateInfo> UniversalJoint::coordinates() const {
  return UniversalKernel::coordinates;
}

Errors UniversalJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  check_direction(axis_a, name, path + "/axis_a", errors);
  check_direction(axis_b, name, path + "/axis_b", errors);
  // Rounding error of a right angle printed with six decimals.
  if (std::abs(axis_a.normalized().dot(axis_b.normalized())) > 1e-5) {
    errors.push_back(
        {path + "/axis_b", "joint \"" + name + "\": axis_b must be perpendicular to axis_a"});
  }
  check_coordinate(angle_a, name, path, "angle_a_", errors);
  check_coordinate(angle_b, name, path, "angle_b_", errors);
  check_reach(angle_a, *this, axis_a, Turning::freely, bodies, path + "/angle_a_drive", errors);
  check_reach(angle_b, *this, axis_b, Turning::freely, bodies, path + "/angle_b_drive", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> UniversalJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<UniversalKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const UniversalJoint&>(*def);
    Matrix3 axes;
    axes.col(0) = joint.axis_a.normalized();
    axes.col(2) = axes.col(0).cross(joint.axis_b).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    JointParts<UniversalKernel> part{
        {MeetingAnchors::at_start(bodies, joint, joint.body_a, joint.body_b, joint.anchor,
                                  Quaternion(axes)),
         joint.compliance, joint.angular_compliance},
        {}};
    append_effects(joint.angle_a, 0, part.effects);
    append_effects(joint.angle_b, 1, part.effects);
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<UniversalKernel>>("universal joints", bodies, joints,
                                                       std::move(parts));
}

}  // namespace sheave
