// Joints that are released and locked again: they hold what their type holds, from where the bodies
// are then.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const Vector3 place{0.4, 0.1, 0.2};
const Vector3 direction{0.6, -0.3, 1.0};

void configure(DistanceJoint& joint) {
  joint.anchor_a = place;
  joint.anchor_b = place + Vector3(0.3, -0.1, 0.4);
}
void configure(BallJoint& joint) {
  joint.anchor = place;
  joint.axis = direction;
}
void configure(HingeJoint& joint) {
  joint.anchor = place;
  joint.axis = direction;
}
void configure(SliderJoint& joint) {
  joint.anchor = place;
  joint.axis = direction;
}
void configure(CylindricalJoint& joint) {
  joint.anchor = place;
  joint.axis = direction;
}
void configure(UniversalJoint& joint) {
  joint.anchor = place;
  joint.axis_a = direction;
  joint.axis_b = direction.cross(Vector3(0.1, 0.7, 0.4));
}
void configure(PlaneJoint& joint) {
  joint.anchor = place;
  joint.normal = direction;
}
void configure(FixedJoint& joint) { joint.anchor = place; }

/// Two bodies that fly and tumble without anything outside, joined by one joint.
template <class Joint>
test::Machine tumbling(IntegratorKind integrator) {
  test::Machine machine;
  machine.model.step = test::direct_settings(integrator, 1.0 / 240.0, 2);
  BodyDef a = test::lump("a", {0.1, 0.2, -0.1}, 2.0);
  a.angular_velocity = {0.9, -1.2, 1.5};
  BodyDef b = test::lump("b", {0.9, -0.3, 0.4}, 1.0);
  b.velocity = {-0.4, 0.2, 0.9};
  b.angular_velocity = {-0.5, 2.0, 0.3};
  auto joint = std::make_shared<Joint>();
  joint->name = "joint";
  joint->body_a = machine.model.add(a);
  joint->body_b = machine.model.add(b);
  configure(*joint);
  machine.model.joints.push_back(joint);
  return machine;
}

struct TotalMomentum {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
};
TotalMomentum momentum_of(const World& world) {
  TotalMomentum sum;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyProperties& body = world.bodies()[i];
    const BodyState& state = world.state().bodies[static_cast<std::size_t>(i)];
    const Vector3 own = state.orientation.conjugate() * state.angular_velocity;
    sum.linear += body.mass * state.velocity;
    sum.angular += body.mass * state.position.cross(state.velocity) +
                   state.orientation * Vector3(body.inertia * own);
  }
  return sum;
}

void advance(Simulation& s, int steps, Certificate* all = nullptr) {
  for (int i = 0; i < steps; ++i) {
    const StepReport report = s.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
    if (all != nullptr) all->merge(*s.certificate());
  }
}

template <class Joint>
class JointLock : public testing::Test {};
using Types = testing::Types<DistanceJoint, BallJoint, HingeJoint, SliderJoint, CylindricalJoint,
                             UniversalJoint, PlaneJoint, FixedJoint>;
TYPED_TEST_SUITE(JointLock, Types);

// The bodies have flown apart by decimetres and turned by a radian. What is held after the lock is
// checked by the certificate, which has its own account of anchors and axes; a joint that held
// anything else than what is there would move them by a blow, of some 0.1 m / 2 ms = 50 m/s.
TYPED_TEST(JointLock, HoldsThePresentPoseWithoutABlow) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    SCOPED_TRACE(integrator == IntegratorKind::xpbd ? "xpbd" : "rattle");
    Simulation s = test::start(tumbling<TypeParam>(integrator));
    advance(s, 20);
    ASSERT_THAT(s.world.release_joint(0), IsEmpty());
    advance(s, 120);
    const JointReport apart = joint_reports(s.world)[0];
    const Energy before = s.world.energy();
    const TotalMomentum then = momentum_of(s.world);
    ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
    const JointReport held = joint_reports(s.world)[0];
    EXPECT_FALSE(held.broken_at.has_value());
    // Rounding of positions below 10 m and of angles.
    EXPECT_LT(held.error, 1e-14);
    EXPECT_LT(held.angle_error, 1e-14);
    ASSERT_EQ(held.coordinates.size(), apart.coordinates.size());
    for (std::size_t k = 0; k < held.coordinates.size(); ++k) {
      EXPECT_NEAR(held.coordinates[k].value, apart.coordinates[k].value, 1e-13);
    }
    Certificate all;
    advance(s, 1, &all);
    // The impact is inelastic: some of the energy is lost, and none comes from anywhere.
    EXPECT_LT(s.world.energy().kinetic, 0.999 * before.kinetic);
    EXPECT_GT(s.world.energy().kinetic, 0.05 * before.kinetic);
    advance(s, 200, &all);
    const TotalMomentum now = momentum_of(s.world);
    // Velocities follow from positions of a metre: 2e-16 m / 2 ms in each of 400 substeps.
    EXPECT_LT((now.linear - then.linear).norm(), 4e-11);
    // Of xpbd they are means over the substep, and what they miss of turning bodies is w h = 2.5
    // rad/s x 2 ms of them.
    const bool means = integrator == IntegratorKind::xpbd;
    const double slop = means ? 5e-3 * then.angular.norm() : 1e-10;
    EXPECT_LT((now.angular - then.angular).norm(), slop);
    EXPECT_TRUE(all.clean()) << (all.worst() ? all.worst()->sentence() : "");
  }
}

// What goes on from a state with a locked joint is the same, restored, in another world, and by way
// of bytes; and a world that had locked one goes back to before.
TYPED_TEST(JointLock, IsPartOfTheState) {
  const test::Machine machine = tumbling<TypeParam>(IntegratorKind::rattle);
  Simulation s = test::start(machine);
  advance(s, 20);
  const State joined = s.world.state();
  const auto go_on = [&](Simulation& simulation) {
    EXPECT_THAT(simulation.world.release_joint(0), IsEmpty());
    advance(simulation, 50);
    EXPECT_THAT(simulation.world.lock_joint(0), IsEmpty());
    const State locked = simulation.world.state();
    advance(simulation, 50);
    return locked;
  };
  const State locked = go_on(s);
  const std::uint64_t end = hash(s.world.state());
  ASSERT_THAT(s.world.restore(joined), IsEmpty());
  go_on(s);
  EXPECT_EQ(hash(s.world.state()), end);
  Simulation other = test::start(machine);
  const Result<State> read = state_from_bytes(to_bytes(locked));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(hash(*read), hash(locked));
  ASSERT_THAT(other.world.restore(*read), IsEmpty());
  advance(other, 50);
  EXPECT_EQ(hash(other.world.state()), end);
  // The state tells more than that the joint holds.
  State without = locked;
  without.features[0].reals.resize(joined.features[0].reals.size());
  EXPECT_NE(hash(without), hash(locked));
  // One that cannot be is refused.
  State damaged = locked;
  damaged.features[0].reals.back() = std::nan("");
  EXPECT_FALSE(other.world.restore(damaged).empty());
  damaged = locked;
  damaged.features[0].reals.pop_back();
  EXPECT_FALSE(other.world.restore(damaged).empty());
}

// Fixed: the bodies stay as they were when it was locked, seen from A.
TEST(JointLock, AWeldKeepsThePose) {
  Simulation s = test::start(tumbling<FixedJoint>(IntegratorKind::rattle));
  ASSERT_THAT(s.world.release_joint(0), IsEmpty());
  advance(s, 100);
  const auto seen = [&] {
    const Quaternion a = s.world.orientation({0});
    return std::pair{Vector3(a.conjugate() * (s.world.position({1}) - s.world.position({0}))),
                     Quaternion(a.conjugate() * s.world.orientation({1}))};
  };
  ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
  const auto then = seen();
  EXPECT_GT((then.first - Vector3(0.8, -0.5, 0.5)).norm(), 0.1);  // not where it was defined
  advance(s, 300);
  EXPECT_LT((seen().first - then.first).norm(), 1e-10);
  EXPECT_LT(seen().second.angularDistance(then.second), 1e-10);
}

// A string may hang slack, and is made longer only if it has to be.
TEST(JointLock, AStringIsNoLongerThanNecessary) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  BodyDef ball = test::lump("ball", {2.0, 0.0, 0.0}, 1.0);
  ball.velocity = {1.0, 0.0, 0.0};
  auto string = std::make_shared<DistanceJoint>();
  string->name = "string";
  string->body_b = machine.model.add(ball);
  string->anchor_b = {2.0, 0.0, 0.0};
  string->length = 3.0;
  string->limit = DistanceLimit::at_most;
  machine.model.joints.push_back(string);
  Simulation s = test::start(machine);
  ASSERT_THAT(s.world.release_joint(0), IsEmpty());
  advance(s, 50);
  // At 2.5 m it is slack: 3 m it is.
  ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
  advance(s, 100);
  EXPECT_NEAR(s.world.position({0}).x(), 3.0, 1e-9);
  EXPECT_NEAR(s.world.velocity({0}).x(), 0.0, 1e-9);
  // At 4 m it is as long as that, and from 3.5 m again 3.5 m: it counts from the definition.
  State state = s.world.state();
  for (const double x : {4.0, 3.5}) {
    ASSERT_THAT(s.world.release_joint(0), IsEmpty());
    state = s.world.state();
    state.bodies[0].position.x() = x;
    state.bodies[0].velocity = {1.0, 0.0, 0.0};
    ASSERT_THAT(s.world.restore(state), IsEmpty());
    ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
    advance(s, 20);
    EXPECT_NEAR(s.world.position({0}).x(), x, 1e-9);
    EXPECT_NEAR(s.world.velocity({0}).x(), 0.0, 1e-9);
  }
}

// Wheels of 0.1 and 0.3 kg m2 with the ratio r = -0.5 (w_b = r w_a) mesh again at 2 and 0 rad/s:
// the impulse p of the teeth gives J_b w_b = p and J_a (w_a - 2) = -r p, so w_a = 2 J_a / (J_a +
// r^2 J_b).
TEST(JointLock, AGearMeshesWhereItIs) {
  for (const double backlash : {0.0, 0.01}) {
    test::Machine machine;
    machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
    BodyDef one = test::wheel("one", Vector3::Zero(), 0.1, 0.1);
    one.angular_velocity = {0.0, 0.0, 2.0};
    auto gear = std::make_shared<GearJoint>();
    gear->name = "gear";
    gear->body_a = machine.model.add(one);
    gear->body_b = machine.model.add(test::wheel("two", {0.3, 0.0, 0.0}, 0.2, 0.3));
    gear->ratio = -0.5;
    gear->backlash = backlash;
    machine.model.joints.push_back(gear);
    Simulation s = test::start(machine);
    ASSERT_THAT(s.world.release_joint(0), IsEmpty());
    advance(s, 100);
    EXPECT_NEAR(s.world.state().bodies[0].angle, 2.0, 1e-12);
    EXPECT_EQ(s.world.state().bodies[1].angle, 0.0);
    ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
    Certificate all;
    advance(s, 100, &all);
    const double speed = 2.0 * 0.1 / (0.1 + 0.25 * 0.3);
    EXPECT_NEAR(s.world.angular_velocity({0}).z(), speed, 1e-9);
    EXPECT_NEAR(s.world.angular_velocity({1}).z(), -0.5 * speed, 1e-9);
    // The lag of 1 rad (2 x 0.5) stays, but for what the play leaves: teeth touch on the side that
    // pushes.
    EXPECT_NEAR(s.world.state().bodies[1].angle + 0.5 * s.world.state().bodies[0].angle, 1.0, 1e-9);
    EXPECT_TRUE(all.clean()) << (all.worst() ? all.worst()->sentence() : "");
  }
}

// The same with a rack of 3 kg and a pinion of 0.1 m and 0.02 kg m2: w = J w0 / (J + r^2 m).
TEST(JointLock, ARackMeshesWhereItIs) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  BodyDef pinion = test::wheel("pinion", Vector3::Zero(), 0.1, 0.02);
  pinion.angular_velocity = {0.0, 0.0, 5.0};
  auto rack = std::make_shared<RackJoint>();
  rack->name = "rack";
  rack->body_a = machine.model.add(pinion);
  rack->body_b = machine.model.add(test::weight("bar", {0.1, 0.0, 0.0}, 3.0));
  rack->axis = Vector3::UnitZ();
  rack->direction = Vector3::UnitY();
  rack->radius = 0.1;
  machine.model.joints.push_back(rack);
  Simulation s = test::start(machine);
  ASSERT_THAT(s.world.release_joint(0), IsEmpty());
  advance(s, 100);
  ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
  Certificate all;
  advance(s, 100, &all);
  const double speed = 0.02 * 5.0 / (0.02 + 0.01 * 3.0);
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), speed, 1e-9);
  EXPECT_NEAR(s.world.velocity({1}).y(), 0.1 * speed, 1e-9);
  EXPECT_NEAR(s.world.position({1}).y(), 0.1 * speed, 1e-9);
  EXPECT_TRUE(all.clean()) << (all.worst() ? all.worst()->sentence() : "");
}

/// A carriage of 2 kg on a rail along x, at 1 m/s.
std::shared_ptr<SliderJoint> carriage(test::Machine& machine) {
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  BodyDef body = test::lump("carriage", Vector3::Zero(), 2.0);
  body.velocity = {1.0, 0.0, 0.0};
  auto rail = std::make_shared<SliderJoint>();
  rail->name = "rail";
  rail->body_b = machine.model.add(body);
  rail->axis = Vector3::UnitX();
  machine.model.joints.push_back(rail);
  return rail;
}

TEST(JointLock, IsRefusedIfItWouldCauseABlow) {
  for (const bool stop : {true, false}) {
    test::Machine machine;
    const auto rail = carriage(machine);
    if (stop) {
      rail->travel.upper = 0.25;
    } else {
      rail->travel.drive = CoordinateDrive::position;
      rail->travel.drive_times = {0.0, 0.25};
      rail->travel.drive_values = {0.0, 0.25};
    }
    // At 0.75 s and 0.75 m the drive would have it at 0.25 m.
    Simulation s = test::start(machine);
    ASSERT_THAT(s.world.release_joint(0), IsEmpty());
    advance(s, 75);
    const std::uint64_t before = hash(s.world.state());
    const Errors errors = s.world.lock_joint(0);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_THAT(errors[0].path, "/joints/0");
    EXPECT_THAT(errors[0].message,
                HasSubstr(stop ? "joint \"rail\" cannot be locked in this pose: its travel is 0.5"
                               : "m off the target of its drive"));
    EXPECT_EQ(hash(s.world.state()), before);
  }
  // A drive that can do no more than its limit pulls it back gently.
  test::Machine machine;
  const auto rail = carriage(machine);
  rail->travel.drive = CoordinateDrive::position;
  rail->travel.drive_times = {0.0, 0.25};
  rail->travel.drive_values = {0.0, 0.25};
  rail->travel.drive_limit = 4.0;
  Simulation s = test::start(machine);
  ASSERT_THAT(s.world.release_joint(0), IsEmpty());
  advance(s, 75);
  ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
  advance(s, 10);
  EXPECT_NEAR(s.world.velocity({0}).x(), 1.0 - 0.1 * 4.0 / 2.0, 1e-9);
}

TEST(JointLock, KnowsItsJoints) {
  test::Machine machine;
  carriage(machine);
  Simulation s = test::start(machine);
  const std::uint64_t before = hash(s.world.state());
  // One that holds goes on to hold.
  EXPECT_THAT(s.world.lock_joint(0), IsEmpty());
  EXPECT_EQ(hash(s.world.state()), before);
  for (const int joint : {-1, 1}) {
    for (const Errors& errors : {s.world.lock_joint(joint), s.world.release_joint(joint)}) {
      ASSERT_EQ(errors.size(), 1U);
      EXPECT_THAT(errors[0].message,
                  HasSubstr("there is no joint number " + std::to_string(joint)));
    }
  }
  EXPECT_EQ(hash(s.world.state()), before);
}

// What has broken may be locked again, and breaks again.
TEST(JointLock, BreaksAgain) {
  test::Machine machine;
  machine.model.gravity = test::down;
  const auto rail = carriage(machine);
  rail->breaking_force = 10.0;  // 2 g N are more
  Simulation s = test::start(machine);
  advance(s, 1);
  const std::optional<double> first = joint_reports(s.world)[0].broken_at;
  ASSERT_TRUE(first.has_value());
  advance(s, 20);
  ASSERT_THAT(s.world.lock_joint(0), IsEmpty());
  EXPECT_FALSE(joint_reports(s.world)[0].broken_at.has_value());
  advance(s, 1);
  ASSERT_TRUE(joint_reports(s.world)[0].broken_at.has_value());
  EXPECT_GT(*joint_reports(s.world)[0].broken_at, *first);
}

}  // namespace
}  // namespace sheave
