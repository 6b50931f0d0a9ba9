// The certificate finds nothing where numbers are right, to what solvers leave, and something where
// a solver has not converged. That it sees faults of the code itself is shown by
// bench/tables/mutation-table.

#include "cable/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave::test {
namespace {

using Kind = CertificateItem::Kind;

Certificate certify(Simulation& simulation, double time) {
  Certificate all;
  while (simulation.world.state().time < time - 1e-9) {
    EXPECT_TRUE(simulation.world.step().ok());
    const auto one = simulation.certificate();
    if (one) all.merge(*one);
  }
  return all;
}

StepSettings exact(IntegratorKind integrator) {
  StepSettings step = settings(1.0 / 60.0, 4, 20);
  step.solver = SolverKind::direct;
  step.integrator = integrator;
  return step;
}

std::string worst_of(const Certificate& certificate) {
  return certificate.worst() == nullptr ? "nothing checked" : certificate.worst()->sentence();
}

class CertificateOf : public testing::TestWithParam<IntegratorKind> {};

// The direct solver ends when no row is violated by 1e-10 of the scene, 5 m here: a force of m
// 5e-10 m / h^2 with h = 1/240 s is 3e-6 m g. Tensions are as exact.
TEST_P(CertificateOf, AtwoodIsTheResidualOfTheSolver) {
  Machine machine = Atwood{}.machine();
  machine.model.step = exact(GetParam());
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_EQ(all.substeps, 30);
  EXPECT_TRUE(all.clean(1e-5)) << worst_of(all);
  for (const Kind kind : {Kind::momentum, Kind::angular_momentum, Kind::span, Kind::energy,
                          Kind::length, Kind::complementarity}) {
    EXPECT_NE(all.find(kind), nullptr);
  }
  EXPECT_EQ(all.find(Kind::joint), nullptr);
}

TEST_P(CertificateOf, BlockAndTackle) {
  Tackle tackle;
  tackle.strands = 6;
  Machine machine = tackle.machine();
  machine.model.step = exact(GetParam());
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.4);
  EXPECT_TRUE(all.clean(1e-4)) << worst_of(all);
}

// A free body without forces: what is left of its balance is rounding.
TEST_P(CertificateOf, TumblingBody) {
  Machine machine;
  machine.model.step = exact(GetParam());
  BodyDef body = lump("lump", {1, 2, 3}, 2.0);
  body.angular_velocity = {1, 8, 2};
  body.velocity = {1, 0, 0};
  machine.model.add(body);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 1.0);
  EXPECT_TRUE(all.clean(1e-9)) << worst_of(all);
}

TEST_P(CertificateOf, DrivenHinge) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = exact(GetParam());
  const BodyId arm = machine.model.add(lump("arm", {0.3, 0, 0}, 2.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "axle";
  hinge->body_b = arm;
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_times = {0.0, 0.2};
  hinge->angle.drive_values = {0.0, 2.0};
  machine.model.joints.push_back(hinge);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_TRUE(all.clean(1e-5)) << worst_of(all);
  EXPECT_NE(all.find(Kind::drive), nullptr);
  EXPECT_NE(all.find(Kind::joint), nullptr);
}

// A damper is by b L / EA h = 100 stiffer here than its spring: what a substep feeds, 1e-4 of the
// rest length, is a percent of what it pulls with.
TEST_P(CertificateOf, DampedCableThatIsWoundUp) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = settings(0.007, 5, 50);
  machine.model.step.solver = SolverKind::direct;
  machine.model.step.integrator = GetParam();
  const BodyId load = machine.model.add(weight("load", {0.0, -2.0, 0.0}, 0.1));
  auto hole = std::make_shared<PinholeLink>();
  auto winch = attach(BodyId::world(), {2.0, 0.0, 0.0});
  winch->feed_speed = -0.2;
  machine.cables.push_back(cable("rope", {attach(load), hole, winch}));
  machine.cables[0].axial_stiffness = 120.0;
  machine.cables[0].damping = 8.0;
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_TRUE(all.clean(1e-5)) << worst_of(all);
}

// Attachments that stay where they were at the start leave the rest length alone that acts. The
// wheel falls and pays out some 1e-3 of it in a substep, which is as much as it is strained.
TEST_P(CertificateOf, DampedMaterialWithFrozenTangents) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = settings(0.01, 1, 50);
  machine.model.step.solver = SolverKind::direct;
  machine.model.step.integrator = GetParam();
  BodyDef drum = lump("drum", {0.0, -2.0, 0.0}, 1.0);
  drum.velocity = {0.1, -0.4, 0.0};
  drum.angular_velocity = {0.0, 0.0, 3.0};
  drum.shapes = {{make<Cylinder>([](Cylinder& c) { c.radius = 0.1, c.length = 0.1; })}};
  drum.inertia.reset();
  const BodyId body = machine.model.add(drum);
  auto wound = roll(body, left);
  wound->stored_length = 1.0;
  machine.cables.push_back(cable("rope", {attach(BodyId::world()), wound}));
  machine.cables[0].axial_stiffness = 270.0;
  machine.cables[0].damping = 40.0;
  machine.cables[0].tangent_update = TangentUpdate::substep;
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.1);
  const CertificateItem* span = all.find(Kind::span);
  ASSERT_NE(span, nullptr);
  EXPECT_LT(span->relative, 1e-4) << span->sentence();
}

// One span leans to the plane of a massless wheel, where attachments cannot keep their places: both
// spans pull with one tension and with one arm.
TEST_P(CertificateOf, MasslessWheelUnderALeaningCable) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = exact(GetParam());
  BodyDef pulley = wheel("pulley", Vector3::Zero(), 0.2, 0.1);
  pulley.inertia.reset();
  pulley.spin_inertia = 0.0;
  const BodyId body = machine.model.add(pulley);
  const BodyId load = machine.model.add(lump("load", {0.3, -1.0, 0.4}, 1.0));
  machine.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-0.2, -1.0, 0.0}), roll(body, right), attach(load)}));
  machine.cables[0].tangent_update = TangentUpdate::substep;
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.1);
  EXPECT_TRUE(all.clean(1e-6)) << worst_of(all);
}

// A drive turns a body 0.3 rad into a stop that gives by 1e-3 rad/(N m): both push with 200 N m
// inside of the joint, which passes nothing on.
TEST_P(CertificateOf, DriveAgainstAnElasticStop) {
  Machine machine;
  machine.model.step = exact(GetParam());
  const BodyId arm = machine.model.add(lump("arm", {0.3, 0, 0}, 2.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "axle";
  hinge->body_b = arm;
  hinge->angle.upper = 0.1;
  hinge->angle.limit_compliance = 1e-3;
  hinge->angle.drive = CoordinateDrive::position;
  hinge->angle.drive_times = {0.0, 0.4};
  hinge->angle.drive_values = {0.0, 0.4};
  hinge->angle.drive_interpolation = Interpolation::clamped;
  machine.model.joints.push_back(hinge);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  // Rounds end at 1e-10 of the scene: 3e-5 of what flows as the stop is met.
  EXPECT_TRUE(all.clean(1e-4)) << worst_of(all);
}

// A hinge holds what slides, and a rope from there stops a slider that begins at 0.19 m/s within a
// substep. It passes m v^2 / 2 = 36 mJ on, though nothing moves in the end; beside that the 1e-12 m
// by which rounds leave the hinge open times its 4e5 N are nothing.
TEST_P(CertificateOf, HingeThatStopsAMovingBody) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = direct_settings(GetParam(), 0.00045947487275793393);
  machine.model.step.iterations = 100;
  BodyDef first = weight("first", {1.35, -0.08894041193691687, 0}, 2.062652838552336);
  first.axis = Vector3(0.9758619605985421, 0.218388264008782, 0);
  first.velocity = {0.1841701414316719, 0.041215457814182545, 0};
  first.orientation = Quaternion(0.25830696977486567, 0, 0, -0.9660628909991972);
  BodyDef second = weight("second", {2.7, 0.2595153797418538, 0}, 2.0582575334295363);
  second.axis = Vector3(-0.8256255938664657, 0.5642183786023331, 0);
  second.orientation = Quaternion(0.8520299097000907, 0, 0, -0.5234931069044321);
  const BodyId a = machine.model.add(first);
  const BodyId b = machine.model.add(second);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = b;
  hinge->anchor = {2.719405345236707, 0.03872600304368923, 0};
  hinge->axis = Vector3::UnitZ();
  machine.model.joints.push_back(hinge);
  auto hole = std::make_shared<PinholeLink>();
  hole->body = a;
  hole->point = {-0.07464042929879154, -0.026967035156679933, 0};
  const auto wall = attach(BodyId::world(), {0.04231123302422135, -0.3358414580517745, 0});
  const auto end = attach(b, {0.07790245178857985, 0.020206155863528412, 0});
  machine.cables.push_back(cable("rope", {wall, hole, end}));
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.0092);
  EXPECT_TRUE(all.clean(1e-3)) << worst_of(all);
}

// A drive of 30 N that has to bring 2 kg to 0.1 m/s: with `rattle` the first half of a substep has
// 15 N for the whole way, which is not enough; the second one brings the speed, with less than 30 N
// altogether. 30 N / 2 kg h = 0.0625 m/s after the first substep, 0.1 m/s after the second.
TEST_P(CertificateOf, DriveThatSpeedsUpWithAllItsForce) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.step.substeps = 1;
  machine.model.step.dt = 1.0 / 240.0;
  const BodyId car = machine.model.add(lump("car", Vector3::Zero(), 2.0));
  auto rail = std::make_shared<SliderJoint>();
  rail->name = "rail";
  rail->body_b = car;
  rail->axis = Vector3::UnitX();
  rail->travel.drive = CoordinateDrive::speed;
  rail->travel.drive_values = {0.1};
  rail->travel.drive_limit = 30.0;
  machine.model.joints.push_back(rail);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5 / 240.0);
  EXPECT_NEAR(simulation.world.velocity(car).x(), 0.0625, 1e-9);
  const Certificate later = certify(simulation, 0.1);
  EXPECT_NEAR(simulation.world.velocity(car).x(), 0.1, 1e-9);
  EXPECT_TRUE(all.clean(1e-5)) << worst_of(all);
  EXPECT_TRUE(later.clean(1e-5)) << worst_of(later);
}

// Between a wheel and the edge of a box, out of the plane of either: the wheel is held in its plane
// as by another wheel, and a sharp corner is a point. Without the pair of forces that says so the
// disk's torques are 2 % off.
TEST_P(CertificateOf, WheelAndBoxInSkewPlanes) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = exact(GetParam());
  BodyDef disk = wheel("disk", {0, -2.0, 0}, 0.2, 0.05);
  disk.mobility = Mobility::free;
  disk.orientation = rotation_by({0.1, 0.2, 0.0});
  disk.angular_velocity = {0.3, 0.2, 1.0};
  BodyDef box = lump("box", {0.4, 0.0, 0.5}, 50.0);
  box.mobility = Mobility::fixed;
  auto box_shape = std::make_shared<Box>();
  box_shape->size = {0.3, 0.3, 0.3};
  box.shapes.push_back({box_shape, Vector3::Zero(), Quaternion::Identity()});
  box.orientation = rotation_by({0.2, -0.1, 0.3});
  const BodyId first = machine.model.add(disk);
  const BodyId second = machine.model.add(box);
  const BodyId third = machine.model.add(lump("load", {1.0, -2.0, 0.8}, 1.0));
  auto drum = roll(first, left);
  drum->stored_length = 5.0;
  machine.cables.push_back(cable("rope", {drum, roll(second, right), attach(third)}));
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.2);
  EXPECT_TRUE(all.clean(1e-5)) << worst_of(all);
  EXPECT_GT(simulation.cable_reports()[0].spans[0].tension, 1.0);
}

// A drum that falls and unwinds: its radius at the end of a substep is that of what it holds then.
// That of the start puts the span's length off by 41 % of its stretch of 1.5e-5 m. What the solver
// leaves, 1e-10 of the scene's 2 m, is 1.3e-5 of that.
TEST_P(CertificateOf, DrumThatUnwindsLayers) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.gravity = down;
  BodyDef reel = wheel("reel", {0.1, 0, 0}, 0.1, 0.02);
  reel.mobility = Mobility::planar;
  reel.mass = 6.0;
  const BodyId body = machine.model.add(reel);
  auto drum = std::make_shared<SpoolLink>();
  drum->body = body;
  drum->winding = left;
  drum->stored_length = 0.9;
  drum->layer_pitch = 0.005;
  CableDef rope = cable("rope", {attach({}, {0, 1.0, 0}), drum});
  rope.compliance = 1e-6;
  machine.cables.push_back(rope);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_LT(simulation.cable_reports()[0].links[1].stored_length, 0.5);
  ASSERT_NE(all.find(Kind::span), nullptr);
  EXPECT_LT(all.find(Kind::span)->relative, 2e-5) << all.find(Kind::span)->sentence();
  EXPECT_LT(all.find(Kind::length)->relative, 1e-9) << all.find(Kind::length)->sentence();
  EXPECT_TRUE(all.clean(1e-4)) << worst_of(all);
}

INSTANTIATE_TEST_SUITE_P(Integrators, CertificateOf,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle),
                         [](const auto& info) {
                           return std::string(
                               integrator_names[static_cast<std::size_t>(info.param)]);
                         });

// 31 wheels are more than one sweep can carry a tension over: 1 + 2 kg move, the middle knows
// nothing of it.
TEST(Certificate, FindsASolverThatHasNotConverged) {
  Machine machine = wheel_train(31, 1.0, 2.0, 0.25, 0.05);
  machine.model.step = settings(1.0 / 60.0, 1, 1);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.2);
  EXPECT_FALSE(all.clean());
  ASSERT_NE(all.worst(), nullptr);
  EXPECT_THAT(all.worst()->advice, testing::HasSubstr("direct"));
  machine.model.step = exact(IntegratorKind::xpbd);
  simulation = start(machine);
  const Certificate good = certify(simulation, 0.2);
  EXPECT_TRUE(good.clean()) << worst_of(good);
  EXPECT_THAT(good.worst()->advice, testing::Not(testing::HasSubstr("\"direct\"")));
}

TEST(Certificate, NeedsAStep) {
  Simulation simulation = start(Atwood{}.machine());
  EXPECT_FALSE(simulation.certificate().has_value());
  const State state = simulation.world.state();
  ASSERT_TRUE(simulation.world.step().ok());
  EXPECT_TRUE(simulation.certificate().has_value());
  ASSERT_TRUE(simulation.world.restore(state).empty());
  EXPECT_FALSE(simulation.certificate().has_value());
  ASSERT_TRUE(simulation.world.step().ok());
  EXPECT_TRUE(simulation.certificate().has_value());
}

// Asking changes nothing.
TEST(Certificate, LeavesTheStateAlone) {
  Simulation asked = start(Atwood{}.machine());
  Simulation silent = start(Atwood{}.machine());
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(asked.world.step().ok());
    ASSERT_TRUE(silent.world.step().ok());
    ASSERT_TRUE(asked.certificate().has_value());
  }
  EXPECT_EQ(hash(asked.world.state()), hash(silent.world.state()));
}

TEST(Certificate, MergeKeepsTheWorstOfEachKind) {
  const auto item = [](Kind kind, double relative) {
    CertificateItem result;
    result.kind = kind;
    result.relative = relative;
    return result;
  };
  Certificate all{{item(Kind::span, 0.1)}, 1};
  all.merge({{item(Kind::momentum, 0.2), item(Kind::span, 0.05)}, 1});
  all.merge({{item(Kind::span, 0.3), item(Kind::length, 0.0)}, 2});
  ASSERT_EQ(all.items.size(), 3U);
  EXPECT_EQ(all.substeps, 4);
  EXPECT_EQ(all.items[0].kind, Kind::momentum);
  EXPECT_EQ(all.items[1].relative, 0.3);
  EXPECT_EQ(all.worst()->kind, Kind::span);
  EXPECT_TRUE(all.clean(0.3));
  EXPECT_FALSE(all.clean(0.29));
}

// A dashpot locks nothing: any distance is permitted.
TEST_P(CertificateOf, DashpotLocksNothing) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.gravity = down;
  machine.model.add(lump("load", {0, -1.0, 0}, 2.0));
  auto dashpot = std::make_shared<DistanceJoint>();
  dashpot->name = "dashpot";
  dashpot->body_b = {0};
  dashpot->anchor_b = {0, -1.0, 0};
  dashpot->limit = DistanceLimit::none;
  dashpot->damping = 3.0;
  machine.model.joints.push_back(dashpot);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_TRUE(all.clean(1e-6)) << worst_of(all);
  // It has sunk: m v' = m g - c v.
  EXPECT_LT(simulation.world.position({0}).y(), -1.8);
}

// A wheel without inertia lands on the ground with what carries it: what rounding leaves of its
// torque is measured by the forces that act on it.
TEST_P(CertificateOf, MasslessWheelThatLands) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.step.dt = 0.013672361515376399;
  machine.model.step.substeps = 5;
  machine.model.gravity = down;
  BodyDef block = lump("block", {0, 0, 0}, 0.7500398738144769);
  block.orientation = Quaternion(0.9326195836130391, 0, 0, 0.3608610705817983);
  block.shapes.push_back({make<Box>([](Box& box) { box.size = {0.3, 0.3, 0.3}; })});
  machine.model.add(std::move(block));
  BodyDef idle;
  idle.name = "wheel";
  idle.mobility = Mobility::rotor;
  idle.mount = BodyId{0};
  idle.mass = 1.910010207206312;
  idle.spin_inertia = 0.0;
  idle.shapes.push_back({make<Cylinder>([](Cylinder& c) {
    c.radius = 0.2683074085914011;
    c.length = 0.1;
  })});
  machine.model.add(std::move(idle));
  machine.model.ground.emplace().point = {0, -0.7339483590912778, 0};
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 1.5);
  EXPECT_TRUE(all.clean(1e-6)) << worst_of(all);
}

// All of a cable may have been fed.
TEST_P(CertificateOf, CableThatBeginsWithNothing) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.gravity = down;
  machine.model.add(lump("a", {0, 0, 0}, 1.0));
  machine.model.add(lump("b", {0, 0, 0}, 2.0));
  auto mouth = attach({1});
  mouth->feed_speed = 0.2;
  machine.cables.push_back(cable("rope", {attach({0}), mouth}));
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_TRUE(all.clean(1e-6)) << worst_of(all);
  EXPECT_NEAR(simulation.cable_reports()[0].total_length, 0.1, 1e-12);
  EXPECT_EQ(simulation.cable_reports()[0].length_error, 0.0);
}

// What falls together with its cable pulls at nothing: what rounding leaves of tensions has no
// ratio, and what it leaves of damped rates is no force.
TEST_P(CertificateOf, RoundingIsNoFriction) {
  Machine machine;
  machine.model.step = exact(GetParam());
  machine.model.gravity = down;
  machine.model.add(lump("a", {0.1, 0.2, 0}, 1.0));
  machine.model.add(lump("b", {1.3, 0.7, 0.4}, 2.3));
  machine.model.add(lump("c", {2.9, 0.1, 0}, 0.7));
  auto hole = std::make_shared<PinholeLink>();
  hole->body = {1};
  hole->friction = 0.01;
  machine.cables.push_back(cable("rope", {attach({0}), hole, attach({2})}));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_a = {0};
  hinge->body_b = {1};
  hinge->anchor = {0.7, 0.5, 0.2};
  hinge->angle.damping = 2.0;
  machine.model.joints.push_back(hinge);
  Simulation simulation = start(machine);
  const Certificate all = certify(simulation, 0.5);
  EXPECT_TRUE(all.clean(1e-4)) << worst_of(all);
}

}  // namespace
}  // namespace sheave::test
