// Springs that act on one side only: ropes, strings, stops. With `rattle` no substep in which such a
// spring begins or ceases to act takes or makes energy (engine/solvers/row_system.h).

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "engine/joints/distance.h"
#include "engine/joints/slider.h"
#include "tests/support/builders.h"

namespace sheave::one_sided_spring {
namespace {

using test::attach;
using test::cable;
using test::g;

constexpr double mass = 2.0;
constexpr double fall = 0.2;          // [m]
constexpr double stiffness = 1.15e5;  // [N/m]: 240 rad/s

/// A load that begins at rest at the height `top` [m] and has no spring yet.
test::Machine falling(const StepSettings& step, double top = -1.0) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::weight("load", {0, top, 0}, mass));
  return m;
}

/// Steps for 1.5 s, in which the load falls by `fall` and bounces three times. Its energy never
/// changes by more than a share of the energy of the fall, and it comes back to its place.
void expect_bounces(const test::Machine& machine, double share) {
  const double top = machine.model.bodies[0].position.y();
  Simulation s = test::start(machine);
  const double before = s.world.energy().total();
  const double whole = mass * g * fall;
  double highest = top - fall;
  while (s.world.state().time < 1.5) {
    ASSERT_TRUE(s.world.step().ok());
    ASSERT_NEAR(s.world.energy().total(), before, share * whole) << s.world.state().time;
    if (s.world.state().time > 1.0) {
      highest = std::max(highest, s.world.position({0}).y());
    }
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate);
    ASSERT_TRUE(certificate->clean()) << certificate->worst()->sentence();
  }
  // Steps end within half of a step from the top.
  const double half = 0.5 * machine.model.step.dt;
  EXPECT_NEAR(highest, top, 0.5 * g * half * half + share * fall);
}

void for_steps(const std::function<void(const StepSettings&)>& test) {
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    for (const int substeps : {1, 3, 16, 64}) {
      SCOPED_TRACE(testing::Message() << (solver == SolverKind::direct ? "direct" : "sweeps")
                                      << ", substeps " << substeps);
      StepSettings step = test::settings(1.0 / 60.0, substeps, 50);
      step.solver = solver;
      step.integrator = IntegratorKind::rattle;
      test(step);
    }
  }
}

// Rounds end at residuals of 1e-10 m of stretches of 8 mm, at the force of 900 N: 1e-7 J in each of
// some ten substeps in which a spring begins or ceases to act, of 3.9 J.
constexpr double rounding = 1e-6;

TEST(OneSidedSpring, ARopeGivesBackTheEnergyOfAFall) {
  for_steps([](const StepSettings& step) {
    for (const bool material : {true, false}) {
      SCOPED_TRACE(material ? "axial stiffness" : "compliance");
      test::Machine m = falling(step);
      CableDef rope = cable("rope", {attach(BodyId::world()), attach({0})});
      rope.rest_lengths = {1.0 + fall};
      if (material) rope.axial_stiffness = stiffness * (1.0 + fall);
      if (!material) rope.compliance = 1.0 / stiffness;
      m.cables.push_back(rope);
      expect_bounces(m, rounding);
    }
  });
}

// A string above the load pulls, a strut below it pushes.
TEST(OneSidedSpring, AStringAndAStrutGiveBackTheEnergyOfAFall) {
  for_steps([](const StepSettings& step) {
    for (const DistanceLimit limit : {DistanceLimit::at_most, DistanceLimit::at_least}) {
      const bool pulls = limit == DistanceLimit::at_most;
      SCOPED_TRACE(pulls ? "string" : "strut");
      test::Machine m = falling(step, pulls ? -1.0 : 1.0);
      auto joint = std::make_shared<DistanceJoint>();
      joint->name = "joint";
      joint->body_a = BodyId::world();
      joint->body_b = {0};
      joint->anchor_b = {0, pulls ? -1.0 : 1.0, 0};
      joint->limit = limit;
      joint->length = pulls ? 1.0 + fall : 1.0 - fall;
      joint->compliance = 1.0 / stiffness;
      m.model.joints.push_back(joint);
      expect_bounces(m, rounding);
    }
  });
}

TEST(OneSidedSpring, StopsAtBothEndsGiveBackTheEnergyOfAFall) {
  for_steps([](const StepSettings& step) {
    for (const double way : {1.0, -1.0}) {  // of the rail's axis
      SCOPED_TRACE(way > 0.0 ? "lower stop" : "upper stop");
      test::Machine m = falling(step);
      BodyDef& load = m.model.bodies[0];
      load.mobility = Mobility::free;
      load.axis = BodyDef{}.axis;
      load.inertia = Vector3(0.1, 0.1, 0.1);
      auto rail = std::make_shared<SliderJoint>();
      rail->name = "rail";
      rail->body_a = BodyId::world();
      rail->body_b = {0};
      rail->axis = {0, way, 0};
      if (way > 0.0) rail->travel.lower = -fall;
      if (way < 0.0) rail->travel.upper = fall;
      rail->travel.limit_compliance = 1.0 / stiffness;
      m.model.joints.push_back(rail);
      expect_bounces(m, rounding);
    }
  });
}

/// A rope from the left over `links` to the load, with a last span that is slack by `fall`.
CableDef rope_over(std::vector<std::shared_ptr<const LinkDef>> links, bool material,
                   std::vector<double> lengths) {
  CableDef rope = cable("rope", {});
  rope.links = std::move(links);
  rope.links.push_back(attach({0}));
  const double whole = std::accumulate(lengths.begin(), lengths.end(), fall);
  if (material) rope.axial_stiffness = stiffness * whole;
  if (!material) rope.compliance = 1.0 / (stiffness * static_cast<double>(lengths.size()));
  lengths.back() += fall;
  rope.rest_lengths = std::move(lengths);
  return rope;
}

/// A pinhole of the world at a point [m].
std::shared_ptr<const LinkDef> hole(const Vector3& point, double friction = 0.0) {
  auto link = std::make_shared<PinholeLink>();
  link->body = BodyId::world();
  link->point = point;
  link->friction = friction;
  return link;
}

// A rope shares one tension among its spans, and is one spring.
TEST(OneSidedSpring, ARopeOverPinholesGivesBackTheEnergyOfAFall) {
  for_steps([](const StepSettings& step) {
    for (const bool material : {true, false}) {
      SCOPED_TRACE(material ? "axial stiffness" : "compliance");
      test::Machine m = falling(step);
      m.cables.push_back(rope_over({attach(BodyId::world(), {-0.8, 0.6, 0}), hole({-0.8, 0, 0}),
                                    hole({-0.3, 0, 0}), hole({0, 0, 0})},
                                   material, {0.6, 0.5, 0.3, 1.0}));
      expect_bounces(m, rounding);
    }
  });
}

TEST(OneSidedSpring, ARopeOverAMasslessWheelGivesBackTheEnergyOfAFall) {
  for_steps([](const StepSettings& step) {
    test::Machine m = falling(step);
    BodyDef wheel = test::wheel("wheel", {-0.1, 0, 0}, 0.1, 1.0);
    wheel.spin_inertia = 0.0;
    m.model.add(wheel);
    m.cables.push_back(
        rope_over({attach(BodyId::world(), {-0.6, 0.1, 0}), test::roll({1}, test::right)}, false,
                  {0.5, 1.0}));
    expect_bounces(m, rounding);
  });
}

/// Largest change of the energy [J] in 0.6 s of a free load that is thrown sideways and falls into a
/// slack rope over a pinhole; the rope is listed from one end or the other.
double change_in_space(int substeps, bool reversed) {
  test::Machine m = falling(test::direct_settings(IntegratorKind::rattle, 1.0 / 240.0, substeps));
  BodyDef& load = m.model.bodies[0];
  load.mobility = Mobility::free;
  load.axis = BodyDef{}.axis;
  load.inertia = Vector3(0.02, 0.02, 0.02);
  load.velocity = {0.5, 0.0, 0.8};
  CableDef rope =
      rope_over({attach(BodyId::world(), {-1, 0, 0}), hole({0, 0, 0})}, true, {1.0, 1.0});
  if (reversed) {
    std::reverse(rope.links.begin(), rope.links.end());
    std::reverse(rope.rest_lengths.begin(), rope.rest_lengths.end());
  }
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  const double before = s.world.energy().total();
  double change = 0.0;
  while (s.world.state().time < 0.6) {
    EXPECT_TRUE(s.world.step().ok());
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    change = std::max(change, std::abs(s.world.energy().total() - before));
  }
  EXPECT_GT(s.world.position({0}).z(), 0.2) << "it swings";
  return change;
}

// The rope turns with the load, so `rattle` keeps the energy to second order only. Transitions that
// lost energy would add an error of first order or lower.
TEST(OneSidedSpring, ALoadThrownIntoSpaceKeepsItsEnergyToSecondOrder) {
  for (const bool reversed : {false, true}) {
    SCOPED_TRACE(reversed ? "listed from the load" : "listed from the world");
    double last = change_in_space(1, reversed);
    EXPECT_LT(last, 1e-3 * mass * g * fall);
    for (const int substeps : {4, 16, 64}) {
      SCOPED_TRACE(testing::Message() << "substeps " << substeps);
      const double change = change_in_space(substeps, reversed);
      EXPECT_LT(change, last / 10.0);  // 16 in the limit
      last = change;
    }
  }
}

// Friction alone takes energy, about as much in few long substeps as in many short ones.
TEST(OneSidedSpring, FrictionAloneTakesTheEnergyOfAFall) {
  double last = 0.0;
  for (const int substeps : {64, 16, 4, 1}) {
    SCOPED_TRACE(testing::Message() << "substeps " << substeps);
    test::Machine m = falling(test::direct_settings(IntegratorKind::rattle, 1.0 / 240.0, substeps));
    m.cables.push_back(
        rope_over({attach(BodyId::world(), {-1, 0, 0}), hole({0, 0, 0}, 0.1)}, true, {1.0, 1.0}));
    Simulation s = test::start(m);
    double before = s.world.energy().total();
    const double first = before;
    while (s.world.state().time < 0.6) {
      ASSERT_TRUE(s.world.step().ok());
      const double now = s.world.energy().total();
      ASSERT_LT(now, before + rounding * mass * g * fall);
      before = now;
    }
    const double lost = (first - before) / (mass * g * fall);
    if (substeps == 64) last = lost;
    EXPECT_GT(lost, 0.05);
    EXPECT_NEAR(lost, last, 0.02);
  }
}

TEST(OneSidedSpring, ADamperTakesEnergyOnly) {
  for_steps([](const StepSettings& step) {
    test::Machine m = falling(step);
    CableDef rope = cable("rope", {attach(BodyId::world()), attach({0})});
    rope.rest_lengths = {1.0 + fall};
    rope.axial_stiffness = stiffness * (1.0 + fall);
    rope.damping = 50.0;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    double before = s.world.energy().total();
    const double first = before;
    while (s.world.state().time < 1.5) {
      ASSERT_TRUE(s.world.step().ok());
      const double now = s.world.energy().total();
      ASSERT_LT(now, before + rounding * mass * g * fall);
      before = now;
    }
    EXPECT_LT(before, first - 0.1 * mass * g * fall);
  });
}

}  // namespace
}  // namespace sheave::one_sided_spring
