#include "tests/property/wide_joints.h"

#include <algorithm>
#include <cmath>

#include "engine/joints/ball.h"
#include "engine/joints/coupling.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"

namespace sheave::test {
namespace {

/// Draws joints of one model.
class JointMaker {
 public:
  JointMaker(Random& random, const Model& model, bool flat)
      : random_(random), model_(model), flat_(flat) {}

  std::shared_ptr<JointDef> make() {
    const int kind = random_.below(20);
    if (kind == 0) {
      // Machines with few rotors have couplings instead of gears.
      std::shared_ptr<JointDef> geared = gear();
      return geared ? geared : coupling();
    }
    if (kind == 1) return rack();
    const BodyId b = mover();
    if (b.is_world() || is_held(b)) return nullptr;
    const BodyId a = random_.chance(0.6) ? BodyId::world() : mover();
    if (a == b) return nullptr;
    std::shared_ptr<JointDef> joint = between(a, b, kind);
    joint->body_a = a;
    joint->body_b = b;
    return joint;
  }

 private:
  std::shared_ptr<JointDef> between(BodyId a, BodyId b, int kind) {
    const Vector3 anchor = place(b) + offset(0.3);
    if (kind < 7) return hinge(anchor);
    if (kind < 10) return slider(anchor);
    if (kind < 13) return distance(a, b, anchor);
    switch (kind) {
      case 13:
        return fixed(anchor);
      case 14:
      case 15:
        return ball(anchor);
      case 16:
        return universal(anchor);
      case 17:
        return cylindrical(anchor);
      default:
        return plane(anchor);
    }
  }

  /// Whether a joint locks the body already. Two that lock it about different axes contradict each
  /// other as soon as it moves, and rounding decides which of them gives way.
  [[nodiscard]] bool is_held(BodyId body) const {
    return std::any_of(model_.joints.begin(), model_.joints.end(), [&](const auto& joint) {
      const bool couples = joint->type() == GearJoint::type_name ||
                           joint->type() == RackJoint::type_name ||
                           joint->type() == DistanceJoint::type_name;
      return joint->body_b == body && !couples;
    });
  }
  /// A body that moves and carries joints; the world if there is none.
  BodyId mover() {
    if (model_.bodies.empty()) return BodyId::world();
    for (int tries = 0; tries < 8; ++tries) {
      const int i = random_.below(static_cast<int>(model_.bodies.size()));
      const BodyDef& body = model_.bodies[static_cast<std::size_t>(i)];
      const bool massless = body.spin_inertia.value_or(1.0) == 0.0;
      const bool driven = body.drive != DriveKind::none || body.mobility == Mobility::kinematic;
      if (body.mobility != Mobility::fixed && !massless && !driven) return {i};
    }
    return BodyId::world();
  }
  BodyId of_mobility(Mobility mobility) {
    for (int tries = 0; tries < 8; ++tries) {
      const BodyId body = mover();
      if (!body.is_world() && def(body).mobility == mobility && !def(body).mount) return body;
    }
    return BodyId::world();
  }
  [[nodiscard]] const BodyDef& def(BodyId body) const {
    return model_.bodies[static_cast<std::size_t>(body.index)];
  }
  [[nodiscard]] Vector3 place(BodyId body) const {
    return body.is_world() ? Vector3::Zero() : def(body).position;
  }
  Vector3 offset(double size) {
    Vector3 v = random_.vector(size);
    if (flat_) v.z() = 0.0;
    return v;
  }
  /// Of a rotation: the normal of a plane machine.
  Vector3 axle() { return flat_ ? Vector3(Vector3::UnitZ()) : direction(); }
  /// Of a translation.
  Vector3 direction() {
    Vector3 v = offset(1.0);
    while (v.norm() < 0.2) v = offset(1.0);
    return v;
  }
  /// A give of both kinds for some joints: 1e-8 to 1e-4.
  double compliance() { return random_.chance(0.2) ? std::pow(10.0, random_.between(-8, -4)) : 0; }
  JointCoordinate travel() { return random_coordinate(random_, 0.3, 1.0); }
  JointCoordinate angle() { return random_coordinate(random_, 1.0, 0.3); }

  std::shared_ptr<JointDef> hinge(const Vector3& anchor) {
    auto joint = std::make_shared<HingeJoint>();
    joint->anchor = anchor;
    joint->axis = axle();
    joint->compliance = compliance();
    joint->angular_compliance = compliance();
    joint->angle = angle();
    return joint;
  }
  std::shared_ptr<JointDef> slider(const Vector3& anchor) {
    auto joint = std::make_shared<SliderJoint>();
    joint->anchor = anchor;
    joint->axis = direction();
    joint->compliance = compliance();
    joint->angular_compliance = compliance();
    joint->travel = travel();
    return joint;
  }
  std::shared_ptr<JointDef> cylindrical(const Vector3& anchor) {
    auto joint = std::make_shared<CylindricalJoint>();
    joint->anchor = anchor;
    joint->axis = direction();
    joint->compliance = compliance();
    joint->travel = travel();
    joint->angle = angle();
    return joint;
  }
  std::shared_ptr<JointDef> distance(BodyId a, BodyId b, const Vector3& anchor) {
    auto joint = std::make_shared<DistanceJoint>();
    joint->anchor_b = anchor;
    joint->anchor_a =
        (a.is_world() ? anchor : place(a)) + offset(0.2) + (a.is_world() ? 0.7 : 0.0) * direction();
    const double kind = random_.between(0.0, 1.0);
    if (kind < 0.2) joint->limit = DistanceLimit::at_most;
    if (kind > 0.85) joint->limit = DistanceLimit::at_least;
    if (kind > 0.6 && kind < 0.85) {
      joint->limit = DistanceLimit::none;
      joint->extension = travel();
    } else if (random_.chance(0.4)) {
      joint->compliance = std::pow(10.0, random_.between(-5, -2));
      if (random_.chance(0.5)) joint->damping = random_.between(0.0, 30.0);
    }
    static_cast<void>(b);
    return joint;
  }
  std::shared_ptr<JointDef> fixed(const Vector3& anchor) {
    auto joint = std::make_shared<FixedJoint>();
    joint->anchor = anchor;
    joint->compliance = compliance();
    joint->angular_compliance = compliance();
    return joint;
  }
  std::shared_ptr<JointDef> ball(const Vector3& anchor) {
    auto joint = std::make_shared<BallJoint>();
    joint->anchor = anchor;
    joint->compliance = compliance();
    if (random_.chance(0.5)) {
      joint->axis = direction();
      if (random_.chance(0.5)) joint->swing_limit = random_.between(0.1, 1.5);
      if (random_.chance(0.5)) joint->twist = angle();
    }
    // Its dry friction at rest is limited along three directions, not by its size, and so not the
    // same everywhere.
    if (random_.chance(0.3)) joint->damping = random_.between(0.0, 2.0);
    return joint;
  }
  std::shared_ptr<JointDef> universal(const Vector3& anchor) {
    auto joint = std::make_shared<UniversalJoint>();
    joint->anchor = anchor;
    joint->axis_a = axle();
    Vector3 across = joint->axis_a.cross(direction());
    while (across.norm() < 0.1) across = joint->axis_a.cross(direction());
    joint->axis_b = across;
    joint->angle_a = angle();
    joint->angle_b = angle();
    return joint;
  }
  std::shared_ptr<JointDef> plane(const Vector3& anchor) {
    auto joint = std::make_shared<PlaneJoint>();
    joint->anchor = anchor;
    joint->normal = axle();
    if (random_.chance(0.3)) joint->damping = random_.between(0.0, 20.0);
    joint->angle = angle();
    return joint;
  }
  std::shared_ptr<JointDef> gear() {
    auto joint = std::make_shared<GearJoint>();
    joint->body_a = of_mobility(Mobility::rotor);
    joint->body_b = of_mobility(Mobility::rotor);
    if (joint->body_a.is_world() || joint->body_b.is_world()) return nullptr;
    joint->axis_a = def(joint->body_a).axis.value_or(Vector3::UnitZ());
    joint->axis_b = def(joint->body_b).axis.value_or(Vector3::UnitZ());
    joint->ratio = (random_.chance(0.5) ? 1.0 : -1.0) * random_.between(0.3, 3.0);
    joint->compliance = compliance();
    if (random_.chance(0.4)) joint->backlash = random_.between(0.0, 0.1);
    return joint;
  }
  /// Of two hinges or sliders without mounted bodies; null if there are none.
  std::shared_ptr<JointDef> coupling() {
    std::vector<const JointDef*> all;
    for (const auto& joint : model_.joints) {
      const bool simple =
          joint->type() == HingeJoint::type_name || joint->type() == SliderJoint::type_name;
      const auto mounted = [&](BodyId body) { return !body.is_world() && def(body).mount; };
      if (simple && !mounted(joint->body_a) && !mounted(joint->body_b)) all.push_back(joint.get());
    }
    if (all.size() < 2) return nullptr;
    const JointDef& first = *all[all.size() - 2];
    const JointDef& last = *all.back();
    auto joint = std::make_shared<CouplingJoint>();
    joint->joints = {first.name, last.name};
    joint->body_a = last.body_a;
    joint->body_b = last.body_b;
    joint->factors = {random_.between(0.3, 2.0), -random_.between(0.3, 2.0)};
    joint->radius = random_.between(0.1, 1.0);
    joint->held = random_.chance(0.5);
    if (joint->held) {
      joint->compliance = compliance();
    } else {
      joint->travel = travel();
    }
    return joint;
  }
  std::shared_ptr<JointDef> rack() {
    auto joint = std::make_shared<RackJoint>();
    joint->body_a = of_mobility(Mobility::rotor);
    joint->body_b = of_mobility(random_.chance(0.5) ? Mobility::slider : Mobility::planar);
    if (joint->body_a.is_world() || joint->body_b.is_world()) return nullptr;
    joint->axis = def(joint->body_a).axis.value_or(Vector3::UnitZ());
    joint->direction = direction();
    if (def(joint->body_b).mobility == Mobility::slider)
      joint->direction = *def(joint->body_b).axis;
    joint->anchor = place(joint->body_b) + offset(0.2);
    joint->radius = (random_.chance(0.5) ? 1.0 : -1.0) * random_.between(0.05, 0.3);
    joint->compliance = compliance();
    if (random_.chance(0.4)) joint->backlash = random_.between(0.0, 0.02);
    return joint;
  }

  Random& random_;
  const Model& model_;
  bool flat_;
};

void choose_drive(Random& random, double size, double force, JointCoordinate& c) {
  const int kind = random.below(4);
  const bool sine = random.chance(0.4);
  if (sine) c.drive_frequency = random.between(0.5, 4.0);
  // With a limit that stalls it, or one that hardly ever does.
  if (random.chance(0.6)) c.drive_limit = force * std::pow(10.0, random.between(-0.5, 1.5));
  if (kind == 0) {
    c.drive = CoordinateDrive::force;
    c.drive_limit.reset();
    c.drive_values = {random.between(-force, force)};
    if (sine) c.drive_amplitude = random.between(0.0, force);
    return;
  }
  if (kind == 1) {
    // Begins where the coordinate is.
    c.drive = CoordinateDrive::position;
    c.drive_times = {0.0, 0.2};
    c.drive_values = {0.0, random.between(-size, size)};
    if (sine) c.drive_amplitude = random.between(0.0, 0.3 * size);
    if (random.chance(0.3)) c.drive_compliance = 1e-4 * size / force;
    return;
  }
  c.drive = CoordinateDrive::speed;
  c.drive_values = {random.between(-2.0, 2.0) * size};
  if (sine) c.drive_amplitude = random.between(0.0, size);
}

}  // namespace

JointCoordinate random_coordinate(Random& random, double size, double arm) {
  JointCoordinate c;
  const double force = 20.0 * arm;
  if (random.chance(0.25)) c.lower = -random.between(0.0, size);
  if (random.chance(0.25)) c.upper = random.between(0.0, size);
  if ((c.lower || c.upper) && random.chance(0.3)) {
    c.limit_compliance = std::pow(10.0, random.between(-6, -3));
  }
  if (random.chance(0.25)) {
    c.stiffness = force / size * std::pow(10.0, random.between(-1.0, 2.0));
    c.rest = random.between(-0.3, 0.3) * size;
  }
  if (random.chance(0.25)) c.damping = random.between(0.0, force);
  if (random.chance(0.25)) c.friction = random.between(0.0, force);
  if (random.chance(0.2)) choose_drive(random, size, force, c);
  return c;
}

std::shared_ptr<JointDef> random_joint(Random& random, const Model& model, bool flat) {
  auto joint = JointMaker(random, model, flat).make();
  if (joint && random.chance(0.05)) joint->breaking_force = random.between(20.0, 200.0);
  return joint;
}

}  // namespace sheave::test
