// Drums with a helical groove: the place of the rope, torque and axial force, energy, momentum.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/drum_groove.h"
#include "cable/reactions.h"
#include "tests/support/combinations.h"
#include "tests/support/grooved_hoist.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::Machine;
using test::grooved::drift;
using test::grooved::drum;
using test::grooved::Hoist;
using test::grooved::link_of;
using test::grooved::Placed;
using test::grooved::radius;
using test::grooved::rattle;
using test::grooved::turn;

// The drum turns at one turn per second. Stored length, place and layer are those of the angle of
// the drum against the rope, which the rope's direction tells.
TEST(GroovedDrum, ADrivenDrumWindsALayerForthAndTheNextBack) {
  for (const bool reversed : {false, true}) {
    Machine m;
    m.model.gravity = test::down;
    m.model.step = rattle(0.01);
    BodyDef winch = test::wheel("drum", Vector3::Zero(), radius, 0.02);
    winch.drive = DriveKind::speed;
    winch.drive_values = {turn};
    const BodyId body = m.model.add(winch);
    const BodyId load = m.model.add(test::weight("load", {radius, -30.0, 0.0}, 10.0));
    const auto spool = drum(body, reversed ? test::left : test::right, 0.0, 0.04);
    m.cables.push_back(reversed ? cable("rope", {attach(load), spool})
                                : cable("rope", {spool, attach(load)}));
    Simulation s = test::start(m);
    const auto span = [&] { return s.cable_reports()[0].spans[0]; };
    const auto direction = [&] {
      const SpanReport now = span();
      const Vector3 down = reversed ? Vector3(now.start - now.end) : Vector3(now.end - now.start);
      return std::atan2(down.x(), -down.y());
    };
    const double first = direction();
    const double rope = span().rest_length;
    const DrumGroove law{radius, 0.04, -0.06, 3.0, 0.02, 0, 1.0};
    for (int second = 1; second <= 8; ++second) {
      test::run(s.world, second);
      const CableReport report = s.cable_reports()[0];
      const LinkReport& own = link_of(report);
      const double angle = s.world.state().bodies[0].angle - (direction() - first);
      // Lengths of 30 m are rounded to 4e-15 m in each of 100 substeps per second; the radius
      // turns that into angles.
      EXPECT_NEAR(own.wrap_angle, angle, 1e-10);
      EXPECT_NEAR(own.stored_length, law.length(angle), 1e-11);
      EXPECT_NEAR(own.groove->axial_position, law.at(angle).axial, 1e-11);
      EXPECT_EQ(own.groove->layer, law.at(angle).layer + 1);
      const double length = span().length;
      EXPECT_NEAR(own.groove->fleet_angle, std::asin(-law.at(angle).axial / length), 1e-12);
      EXPECT_NEAR(own.stored_length + length, rope, 1e-9 * rope);
      EXPECT_EQ(report.length_error, 0.0);
    }
    EXPECT_EQ(link_of(s.cable_reports()[0]).groove->layer, 3);
  }
}

// m + z' sin(fleet angle) = R: the torque of the drive is T m, and the axial force of the bearing
// T sin(fleet angle). The load hangs at rest 1.5 m to the side, on a rail.
TEST(GroovedDrum, ADrumBearsTheMomentOfTheHelixAndTheAxialForce) {
  for (const double aside : {-0.8, -0.1, 0.0, 0.3, 0.8}) {
    Machine m;
    m.model.gravity = test::down;
    m.model.step = rattle(1e-3);
    BodyDef winch = test::wheel("drum", Vector3::Zero(), radius, 0.02);
    winch.drive = DriveKind::speed;
    winch.drive_values = {0.0};
    const BodyId body = m.model.add(winch);
    const BodyId load = m.model.add(test::weight("load", {radius, -2.0, aside}, 10.0));
    auto spool = drum(body, test::right, 0.5 * turn * radius, 0.1);
    spool->groove_start = 0.0;
    m.cables.push_back(cable("rope", {spool, attach(load)}));
    Simulation s = test::start(m);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    const SpanReport& span = report.spans[0];
    const Vector3 u = (span.end - span.start) / span.length;
    const double along = 0.1 / turn;
    const double gain = std::hypot(radius, along);
    const double moment = gain - along * u.z();
    EXPECT_NEAR(std::sin(report.links[0].groove->fleet_angle), u.z(), 1e-12);
    EXPECT_NEAR(std::abs(span.start.cross(u).z()), moment, 1e-12);
    EXPECT_NEAR(span.start.z(), report.links[0].groove->axial_position, 1e-13);
    const double vertical = -u.y() * span.tension;
    EXPECT_NEAR(vertical, 10.0 * g, 1e-7 * 10.0 * g);
    const auto reactions = Reactions::of(s);
    ASSERT_TRUE(reactions);
    EXPECT_NEAR(std::abs(reactions->drive(0).torque), span.tension * moment, 1e-7 * 10.0);
    EXPECT_NEAR(reactions->bearing(0).force.z(), -span.tension * u.z(), 1e-7 * 100.0);
  }
}

// A rope that leaves along its helix touches the bottom of the groove: it leaves at r.
TEST(GroovedDrum, ARopeAlongItsHelixLeavesAtTheRadiusOfTheDrum) {
  Machine m;
  m.model.step = rattle(1e-3);
  const BodyId body = m.model.add(test::wheel("drum", Vector3::Zero(), radius, 0.02));
  auto spool = drum(body, test::right, 0.0, 0.1);
  spool->groove_start = 0.0;
  const double slope = 0.1 / (turn * radius);
  m.cables.push_back(
      cable("rope", {spool, attach(BodyId::world(), {radius, -2.0, -2.0 * -slope})}));
  const Simulation s = test::start(m);
  const SpanReport span = s.cable_reports()[0].spans[0];
  EXPECT_NEAR(std::atan(slope), s.cable_reports()[0].links[0].groove->fleet_angle, 1e-14);
  EXPECT_NEAR(std::hypot(span.start.x(), span.start.y()), radius, 1e-14);
}

// J w^2 / 2 + m v^2 / 2 + m g y stays, to the second order of the step. Where layers change, the
// curvature of the length jumps; each such place, of which the motion has two, adds an error of the
// second order with a factor that depends on its place within a substep.
TEST(GroovedDrum, KeepsTheEnergyToSecondOrderAtFleetAngles) {
  const double scale = 5.0 * g * 2.0;
  for (const bool layers : {false, true}) {
    Hoist hoist;
    hoist.layers = layers;
    double angle = 0.0;
    const double coarse = drift(hoist.machine(rattle(8e-3)), 1.2, &angle);
    const double fine = drift(hoist.machine(rattle(4e-3)), 1.2);
    const double finest = drift(hoist.machine(rattle(2e-3)), 1.2);
    EXPECT_LT(finest, 3e-5 * scale) << layers;
    EXPECT_GT(std::log2(coarse / finest), layers ? 3.0 : 3.8) << coarse << ' ' << fine << layers;
    EXPECT_LT(angle, 3.0 * turn - 0.5 * pi) << "the change of layers has not been passed";
  }
}

// A wrong factor of the axial way would create energy: with the opposite sign of z' sin(fleet angle)
// the error would be T 2 z' sin(fleet angle) per radian, some 0.3 x 30 N x 0.048 m per radian.
TEST(GroovedDrum, ALargeLeadCreatesNoEnergy) {
  for (const double lead : {-0.3, 0.3}) {
    Hoist hoist;
    hoist.lead = lead;
    hoist.layers = false;
    hoist.throws = {0.2, 0.0, 1.0};
    double wound = 0.0;
    EXPECT_LT(drift(hoist.machine(rattle(1e-3)), 0.8, &wound), 1e-5 * 5.0 * g * 2.0) << lead;
    EXPECT_LT(std::abs(wound - hoist.stored / 0.11), 15.0) << lead;
    EXPECT_GT(std::abs(wound - hoist.stored / 0.11), 5.0) << lead;
  }
}

// The motion does not depend on how the machine lies in space, on the end from which the cable is
// counted, or on units. The runs differ by rounding, which the swing of a second multiplies by less
// than 1e3.
TEST(GroovedDrum, MovesTheSameHoweverItIsPlaced) {
  const auto last = [](const Placed& placed) {
    Hoist hoist;
    hoist.placed = placed;
    Simulation s = test::start(hoist.machine(rattle(4e-3)));
    for (int i = 0; i < 250; ++i) EXPECT_TRUE(s.world.step().ok());
    return hoist.load(s);
  };
  const Vector3 expected = last({});
  EXPECT_GT((expected - Vector3(radius, -2.0, 0.05)).norm(), 0.5);
  const Quaternion turned = rotation_by({0.4, -1.1, 0.7});
  for (const Placed& placed :
       {Placed{.turned = turned}, Placed{.mirror = -1.0}, Placed{.reversed = true},
        Placed{.unit = 1000.0}, Placed{.turned = turned, .mirror = -1.0, .reversed = true}}) {
    EXPECT_LT((last(placed) - expected).norm(), 1e-9)
        << placed.mirror << placed.reversed << placed.unit;
  }
}

// A motion of `rattle` runs back on its way, also through a change of layers.
TEST(GroovedDrum, RunsBackOnItsWay) {
  Simulation s = test::start(Hoist{}.machine(rattle(4e-3)));
  const Vector3 start = s.world.state().bodies[1].position;
  for (int i = 0; i < 250; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_EQ(link_of(s.cable_reports()[0]).groove->layer, 1);
  State back = s.world.state();
  for (BodyState& body : back.bodies) {
    body.velocity *= -1.0;
    body.angular_velocity *= -1.0;
  }
  ASSERT_TRUE(s.world.restore(back).empty());
  for (int i = 0; i < 250; ++i) ASSERT_TRUE(s.world.step().ok());
  // The solver leaves 1e-10 of the scene, 2 m, per substep.
  EXPECT_LT((s.world.state().bodies[1].position - start).norm(), 500 * 1e-10 * 2.0);
  EXPECT_EQ(link_of(s.cable_reports()[0]).groove->layer, 2);
}

class GroovedDrumMethods : public testing::TestWithParam<test::Combination> {};

// All solvers and integrators tend to one motion, with 1 to 64 substeps: of first order for `xpbd`.
TEST_P(GroovedDrumMethods, TendToOneMotion) {
  const auto last = [](const StepSettings& step) {
    Hoist hoist;
    Simulation s = test::start(hoist.machine(step));
    test::run(s.world, 0.8);
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
    return hoist.load(s);
  };
  StepSettings step = rattle(0.01);
  step.substeps = 64;
  const Vector3 expected = last(step);
  step.solver = GetParam().solver;
  step.integrator = GetParam().integrator;
  step.iterations = 60;
  std::vector<double> errors;
  for (const int substeps : {1, 4, 16, 64}) {
    step.substeps = substeps;
    errors.push_back((last(step) - expected).norm());
  }
  // The way is 1 m; a step of 0.01 s is a hundredth of the time.
  EXPECT_LT(errors[0], GetParam().rattle() ? 2e-3 : 0.1);
  EXPECT_LT(errors[3], GetParam().rattle() ? 1e-5 : 2e-3);
  EXPECT_LT(errors[2], errors[0] / (GetParam().rattle() ? 60.0 : 10.0));
}

INSTANTIATE_TEST_SUITE_P(All, GroovedDrumMethods, testing::ValuesIn(test::combinations),
                         test::combination_name);

// A drum that floats keeps momenta to the solver's residual, 1e-10 of the scene, and the energy to
// the second order of the step: the force of the rope is that of one line, at both of its ends.
TEST(GroovedDrum, AFloatingDrumKeepsItsMomenta) {
  std::vector<double> drifts;
  for (const double h : {4e-3, 2e-3, 1e-3}) {
    Machine m;
    m.model.gravity.setZero();
    m.model.step = rattle(h);
    BodyDef reel = test::wheel("reel", Vector3::Zero(), radius, 0.02);
    reel.mobility = Mobility::free;
    reel.axis.reset();
    reel.mass = 4.0;
    reel.inertia = Vector3(0.015, 0.015, 0.02);
    reel.angular_velocity = {0.3, -0.2, 2.0};
    const BodyId body = m.model.add(reel);
    BodyDef load = test::lump("load", {radius, -1.0, 0.2}, 3.0);
    load.velocity = {0.1, -1.5, 0.4};
    const BodyId weight = m.model.add(load);
    m.cables.push_back(cable("rope", {drum(body, test::right, 2.2, 0.1), attach(weight)}));
    test::grooved::keep_taut(m);
    Simulation s = test::start(m);
    const Momentum before = momentum(s.world);
    drifts.push_back(drift(m, 0.5));
    for (int i = 0; i < static_cast<int>(0.5 / h); ++i) ASSERT_TRUE(s.world.step().ok());
    const Momentum after = momentum(s.world);
    EXPECT_GT(s.cable_reports()[0].spans[0].tension, 0.1);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-9) << h;
    EXPECT_LT((after.angular - before.angular).norm(), 1e-7) << h;
  }
  EXPECT_GT(drifts[0] / drifts[2], 10.0);
}

}  // namespace
}  // namespace sheave
