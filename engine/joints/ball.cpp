// Locks: the anchors coincide. Coordinates: the twist (angle_about in lock_rows.h), and the swing s
// of B's axis b from A's axis a, s = atan2(|a x b|, a . b), which a rotation d of B changes by d .
// n, n = a x b / |a x b|. The rotations about the three axes of A's frame serve friction and
// damping.

#include "engine/joints/ball.h"

#include "engine/joints/drive_reach.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

struct BallKernel : MeetingAnchors {
  static constexpr int lock_count = 3;
  static constexpr std::array<JointCoordinateInfo, 5> coordinates{{
      {"twist", true},
      {"swing", true, JointCoordinateInfo::Measure::pose},
      {"turn0", true, JointCoordinateInfo::Measure::changes},
      {"turn1", true, JointCoordinateInfo::Measure::changes},
      {"turn2", true, JointCoordinateInfo::Measure::changes},
  }};
  enum : int { twist, swing, first_turn };
  double compliance = 0.0;

  [[nodiscard]] bool elastic() const { return compliance > 0.0; }
  void lock(int index, JointTerms& terms) const {
    lock_point(*this, index, terms);
    terms.set_compliance(compliance);
  }
  void coordinate(int index, JointTerms& terms) const {
    if (index == twist) {
      angle_about(a, b, terms);
    } else if (index == swing) {
      measure_swing(terms);
    } else {
      const Vector3 direction = a.orientation(terms.substep()) * Vector3::Unit(index - first_turn);
      terms.add_torque(a.body, -direction);
      terms.add_torque(b.body, direction);
    }
  }
  void measure_swing(JointTerms& terms) const {
    const Vector3 own = a.orientation(terms.substep()) * Vector3::UnitZ();
    const Vector3 other = b.orientation(terms.substep()) * Vector3::UnitZ();
    const Vector3 across = own.cross(other);
    const double sine = across.norm();
    terms.set_value(portable::atan2(sine, own.dot(other)));
    // Any direction across parallel axes increases the swing.
    const Vector3 normal = sine > 0.0 ? Vector3(across / sine) : any_perpendicular(own);
    terms.add_torque(a.body, -normal);
    terms.add_torque(b.body, normal);
  }
  [[nodiscard]] JointHold hold_here(const BallKernel& defined, const Substep& now) const {
    return JointHold::of(defined.a, now, b.position(now), a.orientation(now));
  }
};

}  // namespace

std::span<const Field> BallJoint::field_table() {
  static const std::vector<Field> table = joined(
      {{field<&BallJoint::anchor>("anchor", "m", any_number(), required,
                                  "common point, world frame at time 0"),
        field<&BallJoint::axis>("axis", "", any_number(), optional,
                                "reference direction of swing and twist, world frame at time 0"),
        field<&BallJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                      "of each direction; 0 (default) is rigid"),
        field<&BallJoint::swing_limit>(
            "swing_limit", "rad", {0.0, pi, false, false}, optional,
            "largest angle between the axes of the bodies (default: no limit)"),
        field<&BallJoint::swing_limit_compliance>(
            "swing_limit_compliance", "rad/(N m)", at_least(0.0), optional,
            "of the stop at swing_limit; 0 (default) is rigid"),
        field<&BallJoint::damping>("damping", "N m s/rad", at_least(0.0), optional,
                                   "viscous friction against any relative rotation"),
        field<&BallJoint::friction>("friction", "N m", at_least(0.0), optional,
                                    "dry friction against any relative rotation")},
       coordinate_fields<BallJoint, &BallJoint::twist>(CoordinateKind::rotation, "twist_",
                                                       "the twist of body_b about the axis")});
  return table;
}

std::span<const JointCoordinateInfo> BallJoint::coordinates() const {
  // Swing and twist are undefined without an axis; the turns are for friction alone.
  return std::span(BallKernel::coordinates).first(axis ? BallKernel::first_turn : 0);
}

Errors BallJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  if (axis) check_direction(*axis, name, path + "/axis", errors);
  if (!axis && (swing_limit || twist.acts())) {
    errors.push_back(
        {path + "/axis", "joint \"" + name + "\": swing and twist need an axis to refer to"});
  }
  if (swing_limit_compliance > 0.0 && !swing_limit) {
    errors.push_back({path + "/swing_limit_compliance",
                      "joint \"" + name + "\": there is no stop; give swing_limit"});
  }
  check_coordinate(twist, name, path, "twist_", errors);
  check_reach(twist, *this, axis.value_or(Vector3::Zero()), Turning::freely, bodies,
              path + "/twist_drive", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> BallJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<BallKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const BallJoint&>(*def);
    const Quaternion frame = frame_along(joint.axis.value_or(Vector3::UnitZ()));
    JointParts<BallKernel> part{
        {MeetingAnchors::at_start(bodies, joint, joint.body_a, joint.body_b, joint.anchor, frame),
         joint.compliance},
        {}};
    JointCoordinate swing;
    swing.upper = joint.swing_limit;
    swing.limit_compliance = joint.swing_limit_compliance;
    append_effects(joint.twist, BallKernel::twist, part.effects);
    append_effects(swing, BallKernel::swing, part.effects);
    append_resistance(joint.damping, joint.friction, BallKernel::first_turn, 3, part.effects);
    part.counts_coordinates = joint.axis.has_value() || !part.effects.empty();
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<BallKernel>>("ball joints", bodies, joints, std::move(parts));
}

}  // namespace sheave
