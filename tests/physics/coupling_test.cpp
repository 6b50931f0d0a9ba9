// Couplings of joints in closed form: flywheels, springs, curves, chains in space.

#include "engine/joints/coupling.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/simulation.h"
#include "engine/joint_report.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/state.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/gradient_check.h"

namespace sheave {
namespace {

using testing::HasSubstr;

/// Adds a joint of this type between two bodies.
template <class Joint>
std::shared_ptr<Joint> join(Model& model, const char* name, BodyId a, BodyId b) {
  auto joint = std::make_shared<Joint>();
  joint->name = name;
  joint->body_a = a;
  joint->body_b = b;
  model.joints.push_back(joint);
  return joint;
}

/// Two flywheels on hinges "first" and "second" about z, and a coupling of them, not yet added.
struct Pair {
  Model model;
  BodyId a, b;
  std::shared_ptr<CouplingJoint> coupling = std::make_shared<CouplingJoint>();

  Pair() {
    a = model.add(test::wheel("a", Vector3::Zero(), 0.1, first));
    b = model.add(test::wheel("b", {0.6, 0.0, 0.0}, 0.2, second));
    join<HingeJoint>(model, "first", BodyId::world(), a)->axis = Vector3::UnitZ();
    auto hinge = join<HingeJoint>(model, "second", BodyId::world(), b);
    hinge->axis = Vector3::UnitZ();
    hinge->anchor = {0.6, 0.0, 0.0};
    coupling->name = "coupling";
    coupling->body_b = b;
    coupling->joints = {"first", "second"};
    coupling->factors = {2.0, -0.5};
  }
  static constexpr double first = 0.02;  // moments of inertia [kg m2]
  static constexpr double second = 0.5;
};

class Coupling : public test::ForEveryCombination {
 protected:
  static StepSettings settings() {
    return step_settings(1.0 / 240.0, GetParam().solver == SolverKind::direct ? 30 : 300);
  }
};

// 2 p - 0.5 q = 0, so q = 4 p and the first flywheel has the inertia I1 + 16 I2. The forces are
// constant, so both integrators have exact velocities.
TEST_P(Coupling, SharesTorqueByTheSquareOfTheRatio) {
  Pair pair;
  pair.model.step = settings();
  pair.model.bodies[0].torque = {0.0, 0.0, 3.0};
  pair.model.joints.push_back(pair.coupling);
  World world = test::start(pair.model);
  test::run(world, 1.0);
  const double acceleration = 3.0 / (Pair::first + 16.0 * Pair::second);
  EXPECT_NEAR(world.angular_velocity(pair.a).z(), acceleration, 1e-8);
  EXPECT_NEAR(world.angular_velocity(pair.b).z(), 4.0 * acceleration, 4e-8);
  const JointReport report = joint_reports(world)[2];
  EXPECT_NEAR(report.coordinates[0].value, 0.0, 1e-9);
  // The force on b is its moment of inertia times its acceleration.
  EXPECT_NEAR(report.torque.z(), Pair::second * 4.0 * acceleration, 1e-8);
}

// A spring of stiffness k along s = 2 p - 0.5 q: w^2 = k (4 / I1 + 0.25 / I2). Without other forces
// s = s0 cos(w t), of which `rattle` has the frequency to (w h)^2 / 24 of itself: at w h = 0.02
// a phase of 2e-5 after w t = 1; `xpbd` damps by w h / 2 of the phase.
TEST_P(Coupling, ASpringAlongTheTravelHasItsFrequency) {
  Pair pair;
  pair.model.step = settings();
  pair.coupling->held = false;
  pair.coupling->travel.stiffness = 0.115;
  pair.coupling->travel.rest = 0.1;
  pair.model.joints.push_back(pair.coupling);
  const double w = std::sqrt(0.115 * (4.0 / Pair::first + 0.25 / Pair::second));
  World world = test::start(pair.model);
  for (int i = 1; i <= 240; ++i) {
    ASSERT_TRUE(world.step().ok());
    const double t = i / 240.0;
    const double s = joint_reports(world)[2].coordinates[0].value;
    EXPECT_NEAR(s, 0.1 * (1.0 - std::cos(w * t)), GetParam().rattle() ? 5e-5 : 5e-3) << t;
  }
}

// A wheel winds x = 0.3 p^2 of a rope that a slider of mass m hangs on: with u = dx/dp = 0.6 p the
// energy is (I + m u^2) p'^2 / 2. `rattle` keeps it to the second order of the step.
TEST(CouplingCurve, KeepsTheEnergyOfACam) {
  double last = 0.0;
  for (const double step : {1.0 / 120.0, 1.0 / 240.0}) {
    Model model;
    model.step.dt = step;
    model.step.substeps = 1;
    const BodyId wheel = model.add(test::wheel("wheel", Vector3::Zero(), 0.1, 0.4));
    const BodyId load = model.add(test::weight("load", {1.0, 0.0, 0.0}, 2.0));
    model.bodies[0].angular_velocity = {0.0, 0.0, 2.0};
    auto slider = join<SliderJoint>(model, "rail", BodyId::world(), load);
    slider->axis = Vector3::UnitY();
    slider->anchor = {1.0, 0.0, 0.0};
    join<HingeJoint>(model, "axle", BodyId::world(), wheel)->axis = Vector3::UnitZ();
    auto cam = join<CouplingJoint>(model, "cam", BodyId::world(), wheel);
    cam->joints = {"rail", "axle"};
    cam->factors = {1.0, 0.0};
    cam->curve = {-0.3};
    World world = test::start(model);
    double worst = 0.0;
    for (int i = 0; i < static_cast<int>(std::lround(1.0 / step)); ++i) {
      ASSERT_TRUE(world.step().ok());
      const auto reports = joint_reports(world);
      const double p = reports[1].coordinates[0].value;
      EXPECT_NEAR(reports[0].coordinates[0].value, 0.3 * p * p, 1e-9);
      worst = std::max(worst, std::abs(world.energy().kinetic - 0.8));
      EXPECT_NEAR(world.energy().kinetic,
                  0.5 * (0.4 + 2.0 * 0.36 * p * p) * std::pow(world.angular_velocity(wheel).z(), 2),
                  1e-8);
    }
    EXPECT_GT(joint_reports(world)[1].coordinates[0].value, 1.2);
    if (last > 0.0) {
      EXPECT_NEAR(last / worst, 4.0, 0.5);
    }
    last = worst;
    EXPECT_LT(worst, 2e-4);
  }
}

/// A chain in space with joints of several types, all coupled, with a curve on the last.
Model chain() {
  Model model;
  const BodyId a = model.add(test::lump("a", {0.3, 0.0, 0.1}, 1.0));
  const BodyId b = model.add(test::lump("b", {0.7, 0.2, 0.0}, 2.0));
  const BodyId c = model.add(test::lump("c", {1.1, 0.1, 0.3}, 0.7));
  auto gimbal = join<UniversalJoint>(model, "gimbal", BodyId::world(), a);
  gimbal->axis_a = Vector3::UnitX();
  gimbal->axis_b = Vector3::UnitY();
  auto screw = join<CylindricalJoint>(model, "screw", a, b);
  screw->axis = {0.3, 1.0, -0.2};
  screw->anchor = {0.5, 0.1, 0.0};
  auto hinge = join<HingeJoint>(model, "hinge", b, c);
  hinge->axis = {0.1, -0.4, 1.0};
  hinge->anchor = {0.9, 0.1, 0.1};
  auto coupling = join<CouplingJoint>(model, "tendon", b, c);
  coupling->joints = {"gimbal", "screw", "screw", "hinge"};
  coupling->joint_coordinates = {"angle_b", "travel", "angle", "angle"};
  coupling->factors = {0.7, -1.5, 0.4, 1.2};
  coupling->curve = {0.3, -0.2};
  coupling->radius = 0.3;
  coupling->held = false;
  coupling->travel.stiffness = 60.0;
  coupling->travel.rest = 0.08;
  coupling->travel.damping = 0.5;
  coupling->travel.friction = 0.2;
  return model;
}

// Tolerance: tests/engine/joint_gradient_test.cpp.
TEST(CouplingGradient, IsExactInAChain) {
  World world = test::start(chain());
  Substep substep(world.bodies(), world.state(), 0.01, 1);
  std::size_t feature = 0;
  while (world.features()[feature]->name() != "couplings") ++feature;
  ConstraintBatch& batch = *world.features()[feature];
  batch.begin(substep, world.feature_state(feature));
  test::displace(substep, 0.1, 0.2);
  const test::GradientCheck result = test::check_gradients(substep, batch);
  EXPECT_GE(result.compared, 3 * 18);
  EXPECT_GT(result.largest, 0.2);
  EXPECT_LT(result.error, 1e-9) << result.worst;
}

// The certificate has its own account of the travel, its forces and their laws.
TEST_P(Coupling, PassesTheCertificateInAChain) {
  for (const bool held : {false, true}) {
    for (const double compliance : {0.0, 1e-4}) {
      if (!held && compliance > 0.0) continue;
      Model model = chain();
      model.gravity = test::down;
      model.step = settings();
      auto coupling =
          std::make_shared<CouplingJoint>(static_cast<const CouplingJoint&>(*model.joints.back()));
      coupling->held = held;
      coupling->compliance = compliance;
      if (held) coupling->travel = {};
      model.joints.back() = coupling;
      Simulation simulation = test::start(test::Machine{model, {}});
      Certificate all;
      for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(simulation.world.step().ok());
        all.merge(*simulation.certificate());
      }
      ASSERT_NE(all.worst(), nullptr);
      const bool direct = GetParam().solver == SolverKind::direct;
      EXPECT_TRUE(all.clean(direct ? 1e-4 : 0.1)) << all.worst()->sentence();
      EXPECT_GT(std::abs(joint_reports(simulation.world)[2].coordinates[0].value), 0.1);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Combinations, Coupling, testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST(CouplingState, IsSavedReleasedAndLocked) {
  Pair pair;
  pair.model.bodies[0].torque = {0.0, 0.0, 3.0};
  pair.model.joints.push_back(pair.coupling);
  World world = test::start(pair.model);
  test::run(world, 0.1);
  const State saved = world.state();
  test::run(world, 0.2);
  const std::uint64_t after = hash(world.state());
  ASSERT_TRUE(world.restore(saved).empty());
  test::run(world, 0.2);
  EXPECT_EQ(hash(world.state()), after);
  ASSERT_TRUE(world.release_joint(2).empty());
  test::run(world, 0.3);
  const double apart = joint_reports(world)[2].coordinates[0].value;
  EXPECT_GT(apart, 0.1);
  ASSERT_TRUE(world.lock_joint(2).empty());
  test::run(world, 0.4);
  // Locked where it was: the travel stays, and the flywheels share their momentum.
  EXPECT_NEAR(joint_reports(world)[2].coordinates[0].value, apart, 1e-9);
  EXPECT_NEAR(world.angular_velocity(pair.b).z(), 4.0 * world.angular_velocity(pair.a).z(), 1e-8);
}

/// The message of the first error of a coupling that `change` spoils.
template <class Change>
std::string fault(const Change& change) {
  Pair pair;
  change(*pair.coupling);
  pair.model.joints.push_back(pair.coupling);
  const Result<World> world = World::create(pair.model);
  if (world) return "none";
  return world.errors().front().path + ": " + world.errors().front().message;
}

TEST(CouplingErrors, NameTheSettingAndTheRemedy) {
  EXPECT_EQ(fault([](CouplingJoint&) {}), "none");
  EXPECT_THAT(fault([](CouplingJoint& c) { c.joints[1] = "third"; }),
              HasSubstr("/joints/2/joints/1: joint \"coupling\": there is no joint \"third\""));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.joints = {}; }), HasSubstr("1 to 4 joints"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.factors = {1.0}; }), HasSubstr("there are 1 and 2"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.factors[0] = 0.0; }), HasSubstr("must not be 0"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.factors[1] = 0.0; }), HasSubstr("must not be 0"));
  EXPECT_EQ(fault([](CouplingJoint& c) { c.factors[1] = 0.0, c.curve = {1.0}; }), "none");
  EXPECT_THAT(fault([](CouplingJoint& c) { c.joints[0] = "second"; }), HasSubstr("coupled twice"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.joints[0] = "coupling"; }),
              HasSubstr("of the type coupling; hinge, slider"));
  EXPECT_THAT(fault([](CouplingJoint& c) {
                c.joint_coordinates = {"angle", "travel"};
              }),
              HasSubstr("\"second\" has the coordinates angle; name one"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.joint_coordinates = {"angle"}; }),
              HasSubstr("as many names as joints"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.body_b = {0}; }),
              HasSubstr("must be those of the last joint, \"second\""));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.travel.stiffness = 1.0; }),
              HasSubstr("set held to false"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.held = false, c.compliance = 1.0; }),
              HasSubstr("give a stiffness"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.curve.assign(9, 1.0); }), HasSubstr("at most 8"));
  EXPECT_THAT(fault([](CouplingJoint& c) { c.radius = 0.0; }), HasSubstr("radius"));
}

}  // namespace
}  // namespace sheave
