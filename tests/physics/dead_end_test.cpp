// Machines that are led where no motion meets what they ask for, though their rows yield on the
// way: bodies stay at the place that is least off, and runs tell
// (engine/solvers/least_violation.h).

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/simulation.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

class DeadEnd : public test::ForEveryCombination {
 protected:
  static bool direct() { return GetParam().solver == SolverKind::direct; }
  static constexpr double h = 1.0 / 240.0;
};

BodyDef load_on_rail(const Vector3& position) {
  BodyDef load = test::lump("load", position, 1.0);
  load.mobility = Mobility::slider;
  load.axis = Vector3::UnitX();
  return load;
}

BodyDef led(const Vector3& position, const Vector3& velocity) {
  BodyDef body = test::lump("led", position, 1.0);
  body.mobility = Mobility::kinematic;
  body.velocity = velocity;
  return body;
}

// A rope draws a load along a rail, through an eyelet 0.4 m above it, with the speed u: from 0.5 m
// to 0.4 m its length beneath the eyelet gives the load's place, and after that no place does. The
// nearest one is beneath the eyelet, where the rope lacks u t - 0.1 m.
TEST_P(DeadEnd, ALoadStaysAtTheNearestPointOfItsRail) {
  if (!direct()) GTEST_SKIP() << "sweeps do not look for singular configurations";
  constexpr double speed = 0.51;
  constexpr double height = 0.4;
  Model model;
  model.step = step_settings(h, 50);
  const BodyId load = model.add(load_on_rail({0.3, 0.0, 0.0}));
  const BodyId end = model.add(led({0.0, 1.4, 0.0}, {0.0, speed, 0.0}));
  const auto eyelet = std::make_shared<PinholeLink>();
  eyelet->body = BodyId::world();
  eyelet->point = {0.0, height, 0.0};
  auto s = Simulation::create(
      model, {test::cable("rope", {test::attach(load), eyelet, test::attach(end)})});
  ASSERT_TRUE(s.ok());
  for (int i = 1; i <= 96; ++i) {
    const StepReport report = s->world.step();
    ASSERT_TRUE(report.ok());
    const double gap = speed * h * i - 0.1;
    const double x = s->world.position(load).x();
    if (gap < -1e-9) {
      EXPECT_EQ(report.statistics.dead_ends, 0) << i;
      EXPECT_NEAR(x, std::sqrt((height - gap) * (height - gap) - height * height), 1e-8) << i;
    } else if (gap > 1e-9) {
      EXPECT_EQ(report.statistics.dead_ends, 1) << i;
      EXPECT_NEAR(report.statistics.most_impossible, gap, 1e-6) << i;
      EXPECT_NEAR(x, 0.0, 1e-3) << i;
    }
  }
  EXPECT_LT(s->world.velocity(load).norm(), 0.1);
}

std::shared_ptr<PinholeLink> eyelet(BodyId body, const Vector3& point, double friction) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  if (friction > 0.0) link->friction = friction;
  return link;
}

// A rope from a load on a rail over two eyelets beside it and back to the load, which a hook
// between them draws up by z: beneath the middle of the eyelets, at x = 0, the load is nearest to
// both of them together, and beyond that the rope lacks what the hook takes. That is so whatever
// the friction: where an eyelet is rough the forces along the rope do not balance there, and that
// mends nothing.
TEST_P(DeadEnd, FrictionDoesNotHideADeadEnd) {
  if (!direct()) GTEST_SKIP() << "sweeps do not look for singular configurations";
  constexpr double speed = 0.5;
  constexpr double beside = 0.4;
  constexpr double hook = 0.5;
  const double start = 0.3;
  for (const double friction : {0.0, 0.2}) {
    Model model;
    model.step = step_settings(h, 50);
    const BodyId load = model.add(load_on_rail({start, 0.0, 0.0}));
    const BodyId drawn = model.add(led({0.0, hook, 0.0}, {0.0, speed, 0.0}));
    auto s = Simulation::create(
        model,
        {test::cable("rope",
                     {test::attach(load), eyelet(BodyId::world(), {-beside, beside, 0.0}, friction),
                      eyelet(drawn, {0.0, 0.0, 0.0}, 0.0),
                      eyelet(BodyId::world(), {beside, beside, 0.0}, 0.0), test::attach(load)})});
    ASSERT_TRUE(s.ok());
    const auto length = [&](double x, double z) {
      return std::hypot(beside + x, beside) + std::hypot(beside - x, beside) +
             2.0 * std::hypot(beside, beside - z);
    };
    for (int i = 1; i <= 96; ++i) {
      const StepReport report = s->world.step();
      ASSERT_TRUE(report.ok());
      const double gap = length(0.0, hook + speed * h * i) - length(start, hook);
      if (gap < -1e-9) {
        EXPECT_EQ(report.statistics.dead_ends, 0) << friction << ' ' << i;
      } else if (gap > 1e-9) {
        EXPECT_EQ(report.statistics.dead_ends, 1) << friction << ' ' << i;
        EXPECT_GT(report.statistics.most_impossible, 0.2 * gap) << friction << ' ' << i;
      }
    }
  }
}

// A rope turns a crank to its dead centre against a damper, whose part in a substep is no measure of
// what rope and hinge may lack: beyond the dead centre nothing meets what the rope asks for.
TEST_P(DeadEnd, ADamperDoesNotHideADeadEnd) {
  if (!direct()) GTEST_SKIP() << "sweeps do not look for singular configurations";
  constexpr double radius = 0.3;
  constexpr double distance = 0.8;
  constexpr double angle = 0.5;
  for (const double speed : {0.02, 0.05, 0.1, 0.2, 0.4}) {
    Model model;
    model.step = step_settings(h, 50);
    const Vector3 tip = radius * Vector3(std::cos(angle), std::sin(angle), 0.0);
    const BodyId crank = model.add(test::lump("crank", 0.5 * tip, 1.0));
    const BodyId end = model.add(led({distance, 1.0, 0.0}, {0.0, speed, 0.0}));
    auto axle = std::make_shared<HingeJoint>();
    axle->name = "axle";
    axle->body_b = crank;
    axle->axis = Vector3::UnitZ();
    axle->angle.damping = 2.5;
    axle->angle.stiffness = 1.0;
    model.joints = {axle};
    auto s = Simulation::create(
        model, {test::cable("rope", {test::attach(crank, 0.5 * tip),
                                     eyelet(BodyId::world(), {distance, 0.0, 0.0}, 0.0),
                                     test::attach(end)})});
    ASSERT_TRUE(s.ok());
    const double slack = std::hypot(distance - tip.x(), tip.y()) - (distance - radius);
    for (int i = 1; i <= 1.2 * slack / (speed * h); ++i) {
      const StepReport report = s->world.step();
      ASSERT_TRUE(report.ok());
      const double gap = speed * h * i - slack;
      if (std::abs(gap) < 1e-8) continue;
      EXPECT_EQ(report.statistics.dead_ends, gap > 0.0 ? 1 : 0) << speed << ' ' << i << ' ' << gap;
    }
  }
}

// A rod of 0.4 m is pushed down on a load just beside its foot: where it stands upright is the
// worst place, and the load gets out of its way.
TEST_P(DeadEnd, ALoadThatCanYieldIsAtNoDeadEnd) {
  if (!direct()) GTEST_SKIP() << "sweeps do not look for singular configurations";
  constexpr double speed = 0.05;
  constexpr double height = 0.4;
  Model model;
  model.step = step_settings(h, 50);
  const BodyId load = model.add(load_on_rail({1e-3, 0.0, 0.0}));
  const BodyId end = model.add(led({0.0, height, 0.0}, {0.0, -speed, 0.0}));
  auto rod = std::make_shared<DistanceJoint>();
  rod->name = "rod";
  rod->body_a = load;
  rod->body_b = end;
  rod->anchor_a = {1e-3, 0.0, 0.0};
  rod->anchor_b = {0.0, height, 0.0};
  model.joints = {rod};
  World world = test::start(model);
  for (int i = 1; i <= 60; ++i) {
    const StepReport report = world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.dead_ends, 0) << i;
    const double left = height - speed * h * i;
    EXPECT_NEAR(std::abs(world.position(load).x()), std::sqrt(1e-6 + height * height - left * left),
                1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(All, DeadEnd, testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
