// Free motion: what moves without constraints, and what is never allowed to move.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"
#include "engine/math/turn_between.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;

/// Angular momentum of a body about its centre of mass, with the spins of its mounted rotors.
Vector3 angular_momentum(const World& world, int carrier) {
  const BodyProperties& body = world.bodies()[carrier];
  const BodyState& state = world.state().bodies[static_cast<std::size_t>(carrier)];
  const Matrix3 rotation = state.orientation.toRotationMatrix();
  Vector3 momentum = rotation * body.inertia * rotation.transpose() * state.angular_velocity;
  for (const int i : body.mounted_rotors) {
    const BodyProperties& rotor = world.bodies()[i];
    const Vector3 axis = state.orientation * rotor.axis;
    const Vector3& w = world.state().bodies[static_cast<std::size_t>(i)].angular_velocity;
    momentum += rotor.axis_inertia * axis.dot(w) * axis;
  }
  return momentum;
}

TEST(FreeMotion, FallFollowsTheDiscreteParabola) {
  // v_n = n h g and x_n = h^2 g n (n + 1) / 2, up to rounding of n additions.
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.01, 1, 1);
  model.add(test::lump("stone", {1.0, 2.0, 3.0}, 2.0));
  World world = test::start(model);
  test::run(world, 1.0);
  EXPECT_NEAR(world.velocity({0}).y(), -g, 1e-13 * g * 100);
  EXPECT_NEAR(world.position({0}).y(), 2.0 - g * 1e-4 * 100 * 101 / 2, 1e-13 * 100);
  EXPECT_EQ(world.position({0}).x(), 1.0);
  EXPECT_EQ(world.position({0}).z(), 3.0);
}

// Under a torque about a principal axis the angle follows the same parabola, whatever the other
// moments of inertia.
TEST(FreeMotion, TurningFollowsTheDiscreteParabola) {
  for (const Vector3& inertia :
       {Vector3(0.3, 0.3, 0.3), Vector3(0.1, 0.2, 0.3), Vector3(0.2, 0.2, 0.3)}) {
    Model model;
    model.step = test::settings(0.01, 1, 1);
    BodyDef def = test::lump("plate", Vector3::Zero(), 2.0);
    def.inertia = inertia;
    def.torque = {0.0, 0.0, 0.6};  // 2 rad/s2
    model.add(def);
    World world = test::start(model);
    test::run(world, 1.0);
    EXPECT_NEAR(world.angular_velocity({0}).z(), 2.0, 1e-13 * 2.0 * 100);
    const Quaternion& q = world.state().bodies[0].orientation;
    EXPECT_NEAR(2.0 * std::atan2(q.z(), q.w()), 2.0 * 1e-4 * 100 * 101 / 2, 1e-13 * 100);
  }
}

// A velocity is that of the displacement: of a body that a weld holds against a torque it is 0, and a
// rotor that is welded to its carrier turns as fast as the carrier.
TEST(FreeMotion, ABodyThatIsHeldAgainstATorqueHasNoVelocity) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const Vector3& inertia :
         {Vector3(0.3, 0.3, 0.3), Vector3(0.1, 0.2, 0.3), Vector3(0.2, 0.2, 0.3)}) {
      for (const Vector3& torque : {Vector3(0.0, 0.0, 1.0), Vector3(0.7, -0.4, 0.2)}) {
        Model model;
        model.step = test::settings(1.0 / 60.0, 4, 50);
        model.step.solver = SolverKind::direct;
        model.step.integrator = integrator;
        BodyDef def = test::lump("plate", Vector3::Zero(), 1.0);
        def.inertia = inertia;
        def.torque = torque;
        const BodyId plate = model.add(def);
        model.joints.push_back(test::make<FixedJoint>([&](FixedJoint& weld) {
          weld.name = "weld";
          weld.body_b = plate;
        }));
        World world = test::start(model);
        test::run(world, 0.5);
        // The prediction turns the body by h^2 a, and with it the response h a to the torque.
        const double h = 1.0 / 240.0;
        const double a = torque.norm() / inertia.minCoeff();
        const double left = integrator == IntegratorKind::xpbd ? h * a * h * h * a : 0.0;
        EXPECT_LT(world.angular_velocity(plate).norm(), left + 240.0 * 1e-11);
      }
    }
  }
}

TEST(MountedRotor, ThatIsWeldedToItsCarrierTurnsWithIt) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Model model;
    model.step = test::settings(1.0 / 60.0, 4, 50);
    model.step.solver = SolverKind::direct;
    model.step.integrator = integrator;
    BodyDef carrier = test::lump("carrier", Vector3::Zero(), 1.0);
    carrier.inertia = Vector3(0.1, 0.2, 0.3);
    carrier.torque = {0.0, 0.0, 1.0};
    const BodyId base = model.add(carrier);
    const BodyId rotor = model.add(test::sheave("rotor", base, Vector3::Zero(), 0.2, 1.0, 0.1));
    model.joints.push_back(test::make<FixedJoint>([&](FixedJoint& lock) {
      lock.name = "lock";
      lock.body_a = base;
      lock.body_b = rotor;
    }));
    World world = test::start(model);
    test::run(world, 0.5);
    // T t / (J + j), with the rotor's moment about its axle.
    EXPECT_NEAR(world.angular_velocity(base).z(), 0.5 / 0.4, 1e-9);
    EXPECT_NEAR(world.angular_velocity(rotor).z(), 0.5 / 0.4, 1e-9);
  }
}

struct Top {
  double energy_error = 0.0;
  double momentum_error = 0.0;
  Quaternion orientation;
};

Top spin_top(int substeps) {
  Model model;
  model.step = test::settings(0.01, substeps, 1);
  BodyDef def = test::lump("top", Vector3::Zero(), 2.0);
  def.angular_velocity = {0.3, 4.0, -0.5};  // near the middle axis: it tumbles
  model.add(def);
  World world = test::start(model);
  const Vector3 momentum = angular_momentum(world, 0);
  const double energy = world.energy().kinetic;
  Top top;
  for (int i = 0; i < 500; ++i) {
    EXPECT_TRUE(world.step().ok());
    top.energy_error = std::max(top.energy_error, std::abs(world.energy().kinetic / energy - 1.0));
    top.momentum_error = std::max(top.momentum_error,
                                  (angular_momentum(world, 0) - momentum).norm() / momentum.norm());
  }
  top.orientation = world.orientation({0});
  return top;
}

// The explicit midpoint rule conserves L by construction (rounding only) and has order 2: halving h
// quarters the errors, 3.4 ... 4.6 this close to the limit.
TEST(FreeMotion, TumblingBodyConservesMomentumExactlyAndConvergesInSecondOrder) {
  const Top coarse = spin_top(1);
  const Top fine = spin_top(2);
  const Top finer = spin_top(4);
  const Top reference = spin_top(32);
  for (const Top& top : {coarse, fine, finer}) EXPECT_LT(top.momentum_error, 1e-12);
  EXPECT_GT(fine.energy_error / finer.energy_error, 3.4);
  EXPECT_LT(finer.energy_error, 1e-3);
  const double ratio = reference.orientation.angularDistance(fine.orientation) /
                       reference.orientation.angularDistance(finer.orientation);
  EXPECT_GT(ratio, 3.4);
  EXPECT_LT(ratio, 4.8);
  RecordProperty("orientation_ratio", std::to_string(ratio));
  RecordProperty("energy_ratio", std::to_string(fine.energy_error / finer.energy_error));
}

// A body with two equal moments J and the third K, without torque: the axis goes round L at the
// rate |L| / J, and the spin about the axis stays w . u. That is followed exactly by any step, here
// of 3.7 turns per step; only rounding adds up, some 1e-16 of each step's angle in 200 steps.
TEST(FreeMotion, SymmetricBodiesPrecessExactlyInStepsOfAnyLength) {
  for (const double length : {0.05, 2.0}) {  // flat and long
    SCOPED_TRACE(length);
    Model model;
    model.step = test::settings(0.1, 1, 1);
    BodyDef def = test::lump("top", Vector3::Zero(), 2.0);
    const double mass = 3.0;
    const double radius = 0.4;
    def.mass = mass;
    const double k = 0.5 * mass * radius * radius;
    const double j = mass * (3.0 * radius * radius + length * length) / 12.0;
    def.inertia = Vector3(j, k, j);  // its axis is y
    def.orientation = rotation_by({0.4, -0.3, 0.9});
    const Vector3 own_axis = Vector3::UnitY();
    const Vector3 axis = def.orientation * own_axis;
    def.angular_velocity = 230.0 * axis + 35.0 * any_perpendicular(axis);
    const Vector3 across = def.angular_velocity - axis * axis.dot(def.angular_velocity);
    const Vector3 momentum = k * 230.0 * axis + j * across;
    model.add(def);
    World world = test::start(model);
    const double energy = world.energy().kinetic;
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(world.step().ok());
    const Vector3 rate = momentum / j;
    const double angle = rate.norm() * steps * model.step.dt;
    const Quaternion round(Eigen::AngleAxisd(angle, rate.normalized()));
    const double rounding = 1e-15 * steps * (1.0 + angle);
    EXPECT_LT((world.orientation({0}) * own_axis - round * axis).norm(), rounding);
    const Vector3 velocity =
        momentum / j + (1.0 / k - 1.0 / j) * momentum.dot(axis) * (round * axis);
    EXPECT_LT((world.state().bodies[0].angular_velocity - velocity).norm(), 265.0 * rounding);
    EXPECT_NEAR(world.energy().kinetic / energy, 1.0, 10.0 * rounding);
  }
}

/// A free carrier with a fast rotor on a general axle off its centre, thrown and turning.
Model gyrostat(double dt) {
  Model model;
  model.step = test::settings(dt, 1, 1);
  BodyDef carrier = test::lump("carrier", {0.2, 0.1, 0.0}, 2.0);
  carrier.velocity = {0.3, -0.1, 0.2};
  carrier.angular_velocity = {0.5, 1.0, -0.7};
  carrier.orientation = rotation_by({0.3, 0.2, -0.1});
  model.add(carrier);
  BodyDef rotor = test::sheave("rotor", {0}, {0.5, 0.3, 0.2}, 0.2, 0.8, 0.05);
  rotor.axis = Vector3(1.0, 0.5, 2.0);
  rotor.orientation = turn_between(Vector3::UnitZ(), rotor.axis->normalized());
  rotor.angular_velocity = 30.0 * rotor.axis->normalized();
  model.add(rotor);
  return model;
}

TEST(MountedRotor, IsolatedGyrostatConservesMomentaAndSpin) {
  World world = test::start(gyrostat(1e-3));
  const BodyProperties& carrier = world.bodies()[0];
  const Vector3 velocity = world.state().bodies[0].velocity;
  const Vector3 momentum = angular_momentum(world, 0);
  EXPECT_DOUBLE_EQ(carrier.mass, 2.8);
  double energy_error = 0.0;
  const double energy = world.energy().kinetic;
  for (int i = 0; i < 5000; ++i) {
    ASSERT_TRUE(world.step().ok());
    energy_error = std::max(energy_error, std::abs(world.energy().kinetic / energy - 1.0));
  }
  // 5000 steps of rounding.
  EXPECT_LT((angular_momentum(world, 0) - momentum).norm(), 1e-11 * momentum.norm());
  EXPECT_LT((world.state().bodies[0].velocity - velocity).norm(), 1e-11 * velocity.norm());
  const Vector3 axis = world.state().bodies[0].orientation * world.bodies()[1].axis;
  EXPECT_NEAR(axis.dot(world.state().bodies[1].angular_velocity), 30.0, 1e-10);
  EXPECT_LT(energy_error, 1e-4);  // order 2: (w h)^2 with w = L/I of about 10
}

// A symmetric gyrostat (transverse inertia A, axle along the axis of symmetry) precesses about L at
// |L| / A. Second order: h and h/2 differ by a factor of 4 in the error.
TEST(MountedRotor, SymmetricGyrostatPrecessesAtTheClosedFormRate) {
  const auto error = [](double dt) {
    Model model;
    model.step = test::settings(dt, 1, 1);
    BodyDef carrier = test::lump("carrier", Vector3::Zero(), 2.0);
    carrier.inertia = Vector3(0.2, 0.2, 0.1);
    carrier.angular_velocity = {1.0, 0.0, 0.4};
    model.add(carrier);
    BodyDef rotor = test::sheave("rotor", {0}, Vector3::Zero(), 0.2, 0.5, 0.05);
    rotor.angular_velocity = {0.0, 0.0, 20.0};
    model.add(rotor);
    World world = test::start(model);
    const Vector3 momentum = angular_momentum(world, 0);
    // Lumped: A = 0.2 + 0.6 x 0.05.
    EXPECT_NEAR(momentum.norm(), std::hypot(0.23 * 1.0, 0.1 * 0.4 + 0.05 * 20.0), 1e-12);
    test::run(world, 2.0);
    const Vector3 turn = world.state().time / 0.23 * momentum;
    const Vector3 expected = rotation_by(turn) * Vector3::UnitZ();
    return (world.orientation({0}) * Vector3::UnitZ() - expected).norm();
  };
  const double coarse = error(2e-3);
  const double fine = error(1e-3);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(coarse / fine, 3.5);
  EXPECT_LT(coarse / fine, 4.5);
}

// The same machine with the wheel as a full free body on a hinge joint. Its error is of first order
// in h, so the difference halves with h and vanishes.
TEST(MountedRotor, AgreesWithAFullWheelOnAHinge) {
  const auto difference = [](double dt) {
    Model mounted = gyrostat(dt);
    mounted.gravity = test::down;
    // Hung up off-centre, so that the rotor's gyroscopic torque steers a pendulum.
    auto joint = std::make_shared<BallJoint>();
    joint->name = "hook";
    joint->body_b = {0};
    joint->anchor = {0.2, 0.6, 0.0};
    mounted.joints.push_back(joint);
    mounted.bodies[0].velocity.setZero();
    mounted.bodies[0].angular_velocity.setZero();
    mounted.step.iterations = 60;
    Model full = mounted;
    BodyDef& wheel = full.bodies[1];
    wheel.mobility = Mobility::free;
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "axle";
    hinge->body_a = {0};
    hinge->body_b = {1};
    hinge->anchor = wheel.position;
    hinge->axis = *wheel.axis;
    full.joints.push_back(hinge);
    wheel.mount.reset();
    wheel.axis.reset();
    World a = test::start(mounted);
    World b = test::start(full);
    test::run(a, 0.5);
    test::run(b, 0.5);
    return (a.position({0}) - b.position({0})).norm() +
           a.orientation({0}).angularDistance(b.orientation({0}));
  };
  const double coarse = difference(2e-3);
  const double fine = difference(1e-3);
  const double finer = difference(5e-4);
  EXPECT_LT(finer, 2e-2);
  EXPECT_GT(coarse / fine, 1.7);
  EXPECT_GT(fine / finer, 1.7);
  RecordProperty("difference", std::to_string(finer));
}

// Constant loads on a mounted rotor: a force at its centre and a torque across its axle must reach
// the carrier, exactly as gravity on its mass does.
TEST(MountedRotor, PassesForcesAndTransverseTorquesToItsCarrier) {
  Model model;
  model.step = test::settings(1e-3, 1, 1);
  BodyDef carrier = test::lump("carrier", Vector3::Zero(), 2.0);
  carrier.inertia = Vector3(0.2, 0.2, 0.2);
  model.add(carrier);
  BodyDef rotor = test::sheave("rotor", {0}, Vector3::Zero(), 0.2, 0.5, 0.05);
  rotor.force = {3.0, 0.0, 0.0};
  rotor.torque = {0.1, 0.0, 0.2};
  model.add(rotor);
  World world = test::start(model);
  ASSERT_TRUE(world.step().ok());
  EXPECT_NEAR(world.velocity({0}).x(), 1e-3 * 3.0 / 2.5, 1e-9);
  EXPECT_NEAR(world.angular_velocity({0}).x(), 1e-3 * 0.1 / 0.23, 1e-9);
  EXPECT_NEAR(world.angular_velocity({1}).z(), 1e-3 * 0.2 / 0.05, 1e-9);
}

// A pull in a general direction moves nothing along a forbidden direction. Along coordinate axes
// nothing at all may leak; along others what v - n (n.v) leaves, eps/2 per step, adds up.
TEST(Mobility, RestrictionsAreExact) {
  for (const Vector3& axis :
       {Vector3(Vector3::UnitY()), Vector3(Vector3(0.3, 1.0, -0.6).normalized())}) {
    test::Machine machine;
    machine.model.gravity = {1.0, -9.0, 2.0};
    machine.model.step = test::settings(0.01, 1, 10);
    BodyDef slider = test::weight("slider", {0.5, 0.0, 0.0}, 1.0);
    slider.axis = axis;
    machine.model.add(slider);
    BodyDef plate = test::lump("plate", {-0.5, 0.0, 0.0}, 1.0);
    plate.mobility = Mobility::planar;
    plate.axis = axis;
    machine.model.add(plate);
    BodyDef rotor = test::wheel("rotor", {0.0, -0.5, 0.0}, 0.1, 0.01);
    rotor.axis = axis;
    rotor.orientation = turn_between(Vector3::UnitZ(), axis);
    machine.model.add(rotor);
    machine.cables.push_back(cable("a", {attach(BodyId::world(), {1.5, 0.3, 0.4}), attach({0})}));
    machine.cables.push_back(
        cable("b", {attach(BodyId::world(), {-1.5, 1.3, 0.4}), attach({1}, {0.1, 0.2, 0.1})}));
    machine.cables.push_back(
        cable("c", {attach(BodyId::world(), {0.5, -1.5, 0.4}), attach({2}, {0.1, 0.05, 0.02})}));
    Simulation s = test::start(machine);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(s.world.step().ok());
    const Vector3 slid = s.world.position({0}) - Vector3(0.5, 0.0, 0.0);
    const Vector3 moved = s.world.position({1}) - Vector3(-0.5, 0.0, 0.0);
    const bool aligned = axis == Vector3(Vector3::UnitY());
    const double leak = aligned ? 0.0 : 1e-13;
    EXPECT_LE((slid - axis.dot(slid) * axis).norm(), leak);
    EXPECT_LE(std::abs(axis.dot(moved)), leak);
    EXPECT_GT(moved.norm() + slid.norm(), 0.05);
    EXPECT_EQ(s.world.position({2}), Vector3(0.0, -0.5, 0.0));
    EXPECT_LE(s.world.angular_velocity({1}).cross(axis).norm(),
              aligned ? 0.0 : 1e-12 * (1.0 + s.world.angular_velocity({1}).norm()));
    const Quaternion relative =
        s.world.orientation({2}) * machine.model.bodies[2].orientation.conjugate();
    EXPECT_LE(relative.vec().cross(axis).norm(), 1e-15);
    // Sliders do not turn.
    EXPECT_EQ(s.world.orientation({0}).coeffs(), Quaternion::Identity().coeffs());
  }
}

TEST(Mobility, KinematicBodiesFollowTheirFunctionsOfTime) {
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.01, 3, 1);
  BodyDef drive;
  drive.name = "drive";
  drive.mobility = Mobility::kinematic;
  drive.position = {1.0, 2.0, 3.0};
  drive.velocity = {0.1, 0.2, 0.3};
  drive.angular_velocity = {2.0, -5.0, 1.0};
  drive.oscillation = {0.0, 0.5, 0.1};
  drive.oscillation_frequency = 1.7;
  drive.oscillation_phase = 0.4;
  drive.orientation = rotation_by({0.1, 0.2, 0.3});
  drive.shapes.push_back({std::make_shared<Box>()});
  model.add(drive);
  World world = test::start(model);
  for (int i = 1; i <= 1000; ++i) {
    ASSERT_TRUE(world.step().ok());
    const double t = i * 0.01;
    const double phase = 2.0 * pi * 1.7 * t + 0.4;
    const Vector3 position =
        drive.position + t * drive.velocity + (std::sin(phase) - std::sin(0.4)) * drive.oscillation;
    const Vector3 velocity = drive.velocity + 2.0 * pi * 1.7 * std::cos(phase) * drive.oscillation;
    // eps of the phase, 100 rad, and of the position.
    ASSERT_LT((world.position({0}) - position).norm(), 1e-13);
    ASSERT_LT((world.velocity({0}) - velocity).norm(), 1e-12);
    ASSERT_LT(world.orientation({0}).angularDistance(rotation_by(t * drive.angular_velocity) *
                                                     drive.orientation),
              1e-12);
  }
}

}  // namespace
}  // namespace sheave
