// Cable of a material that slides over posts and other bodies is stretched on their arcs, too.
//
// With the unstretched length M of all that is between the ends, spans l_i and arcs a_j, a smooth
// cable has one strain, 1 + e = (sum of l_i + sum of a_j) / M, so it is a spring of the rate EA / M.
// With friction the tension along an arc is T0 e^(m phi), and with q = e^(m theta)
//
//   M = l0 / (1 + e0) + a (1 - ln((1 + q e0) / (1 + e0)) / ln q) + l1 / (1 + q e0),
//
// because the integral of 1 / (1 + e0 e^(m phi)) over phi is phi - ln(1 + e0 e^(m phi)) / m.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/shapes/cylinder.h"
#include "scenes/observables.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"
#include "tests/support/shapes.h"

namespace sheave::wrapped_strain {
namespace {

using test::attach;
using test::cable;
using test::eyelet;
using test::g;
using test::left;
using test::post;
using test::right;
using test::wrapped;

constexpr double radius = 0.5;
constexpr double stiffness = 1e5;  // EA [N]

/// A rope from (-r, -1) over a post at the origin to (r, -2), with these rest lengths of its spans.
test::Machine strung(const StepSettings& step, double friction, std::vector<double> rest_lengths) {
  test::Machine m;
  m.model.step = step;
  m.model.add(post("post", {0, 0, 0}, radius));
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-radius, -1, 0}), wrapped({0}, right, friction),
                     attach(BodyId::world(), {radius, -2, 0})}));
  m.cables[0].axial_stiffness = stiffness;
  m.cables[0].rest_lengths = std::move(rest_lengths);
  return m;
}

/// A rope over what `wrap` adds, unstretched, of which one end is drawn along -y at 0.4 m/s.
test::Machine drawn(const StepSettings& step, const BodyDef& wrap, double friction,
                    const Vector3& held, const Vector3& pulled, bool from_behind) {
  test::Machine m;
  m.model.step = step;
  m.model.add(wrap);
  BodyDef puller = test::weight("puller", pulled, 1.0);
  puller.mobility = Mobility::kinematic;
  puller.axis = Vector3::UnitZ();
  puller.velocity = {0, -0.4, 0};
  m.model.add(puller);
  const auto still = attach(BodyId::world(), held);
  m.cables.push_back(from_behind
                         ? cable("rope", {still, wrapped({0}, right, friction), attach({1})})
                         : cable("rope", {attach({1}), wrapped({0}, left, friction), still}));
  m.cables[0].axial_stiffness = stiffness;
  return m;
}

/// The same rope without a post's friction, and a weight at its end.
test::Machine hung(const StepSettings& step, double mass) {
  test::Machine m;
  m.model.step = step;
  m.model.gravity = test::down;
  m.model.add(post("post", {0, 0, 0}, radius));
  m.model.add(test::weight("weight", {radius, -2, 0}, mass));
  m.cables.push_back(cable(
      "rope", {attach(BodyId::world(), {-radius, -1, 0}), wrapped({0}, right, 0.0), attach({1})}));
  m.cables[0].axial_stiffness = stiffness;
  return m;
}

/// The strain where the rope enters the arc, by bisection; `rise` is m theta.
double entering_strain(double unstretched, double before, double arc, double after, double rise) {
  const auto needed = [&](double e) {
    const double last = e * std::exp(rise);
    const double mean =
        rise == 0.0 ? 1.0 / (1.0 + e) : 1.0 - std::log((1.0 + last) / (1.0 + e)) / rise;
    return before / (1.0 + e) + arc * mean + after / (1.0 + last);
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (needed(middle) > unstretched ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void expect_clean(const Simulation& simulation) {
  const auto certificate = simulation.certificate();
  ASSERT_TRUE(certificate.has_value());
  EXPECT_TRUE(certificate->clean(1e-6)) << certificate->worst()->sentence();
}

class WrappedStrain : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, WrappedStrain, testing::ValuesIn(test::combinations),
                         test::combination_name);

// A tension is found where its row leaves 1e-15 of the lengths, 1e-15 x EA of force; a factor of
// 1000 for what sweeps leave.
constexpr double force_near = 1e-12 * stiffness;

TEST_P(WrappedStrain, RoundASmoothPostIsUniform) {
  Simulation s = test::start(strung(step_settings(0.01, 50), 0.0, {0.99, 2.0}));
  const double whole = s.cable_reports()[0].total_length;
  const double strain = (3.0 + pi * radius) / whole - 1.0;
  ASSERT_GT(strain, 1e-3);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    for (const SpanReport& span : report.spans) {
      EXPECT_NEAR(span.tension, stiffness * strain, force_near);
      EXPECT_NEAR(span.length / span.rest_length - 1.0, strain, 1e-13);
    }
    EXPECT_NEAR(report.links[1].stored_stretch / report.links[1].stored_length, strain, 1e-13);
    EXPECT_NEAR(report.total_length, whole, 1e-15 * whole);
    // All of it, stretched, EA e^2 / 2 per unstretched length.
    const double elastic = 0.5 * stiffness * strain * strain * whole;
    EXPECT_NEAR(s.world.energy().elastic, elastic, 1e-11 * elastic);
    expect_clean(s);
  }
}

/// Draws a rope for ten steps and asks for its tensions; `entering` is the strain of the held side
/// for a length of the pulled one, `rise` what friction makes of it.
template <class Entering>
void expect_strains(Simulation& s, bool from_behind, double rise, double length,
                    const Entering& entering) {
  const double whole = s.cable_reports()[0].total_length;
  for (int i = 1; i <= 10; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const double held = stiffness * entering(whole, length + 0.4 * 0.01 * i);
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.spans[from_behind ? 0 : 1].tension, held, force_near);
    EXPECT_NEAR(report.spans[from_behind ? 1 : 0].tension, held * std::exp(rise), force_near);
    EXPECT_NEAR(report.total_length, whole, 1e-15 * whole);
    EXPECT_GT(report.links[1].slip * (from_behind ? 1.0 : -1.0), 0.0);
    expect_clean(s);
  }
}

TEST_P(WrappedStrain, WithFrictionFollowsTheTensionAlongTheArc) {
  constexpr double arc = pi * radius;
  for (const double friction : {0.0, 0.01, 0.1, 0.5, 1.2}) {
    for (const bool from_behind : {true, false}) {
      SCOPED_TRACE(testing::Message() << friction << (from_behind ? " behind" : " before"));
      const double rise = friction * pi;
      Simulation s = test::start(drawn(step_settings(0.01, 50), post("post", {0, 0, 0}, radius),
                                       friction, {-radius, -1, 0}, {radius, -2, 0}, from_behind));
      expect_strains(s, from_behind, rise, 2.0, [&](double whole, double length) {
        return entering_strain(whole, 1.0, arc, length, rise);
      });
      const LinkReport lies = s.cable_reports()[0].links[1];
      EXPECT_NEAR(lies.stored_length + lies.stored_stretch, arc, 1e-13);
    }
  }
}

TEST_P(WrappedStrain, OnAPrismChangesAtTheCornersOnly) {
  // A rope over the upper edge of a square: it is bent by a1 and a2 at its ends, and lies along it
  // with the strain e0 e^(m a1). The puller moves by 2 % of its span, so its corner's angle is that
  // of the step.
  constexpr double friction = 0.4;
  BodyDef block = post("block", {0, 0, 0}, radius);
  block.shapes[0].shape =
      test::polygon({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}}, 0.4);
  Simulation s =
      test::start(drawn(step_settings(0.01, 50), block, friction, {-1, -1, 0}, {1.5, -2, 0}, true));
  const double whole = s.cable_reports()[0].total_length;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(s.world.step().ok());
  const double depth = 2.5 + 0.4 * 0.1;
  const double l0 = std::hypot(0.5, 1.5);
  const double l1 = std::hypot(1.0, depth);
  const double first = std::atan2(1.5, 0.5);
  const double both = first + std::atan2(depth, 1.0);
  const auto needed = [&](double e) {
    return l0 / (1.0 + e) + 1.0 / (1.0 + e * std::exp(friction * first)) +
           l1 / (1.0 + e * std::exp(friction * both));
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (needed(middle) > whole ? low : high) = middle;
  }
  const CableReport report = s.cable_reports()[0];
  const LinkReport& lies = report.links[1];
  // Angles of `rattle` are those of the middle of a step, in which they change by 5e-4.
  const double near = GetParam().rattle() ? 1e-3 : 1e-9;
  EXPECT_NEAR(report.spans[0].length / report.spans[0].rest_length - 1.0, low, near * low);
  const double along = low * std::exp(friction * first);
  EXPECT_NEAR(lies.stored_stretch / lies.stored_length, along, near * along);
  const double pulled = low * std::exp(friction * both);
  EXPECT_NEAR(report.spans[1].length / report.spans[1].rest_length - 1.0, pulled, near * pulled);
  expect_clean(s);
}

TEST_P(WrappedStrain, SeveralSmoothPostsAndHolesAreOneSpring) {
  test::Machine m;
  m.model.step = step_settings(0.01, 50);
  m.model.add(post("first", {0, 0, 0}, radius));
  m.model.add(post("second", {3, 0, 0}, 0.25));
  const auto hole = eyelet(BodyId::world(), {6, 0, 0}, 0.0);
  const auto begin = attach(BodyId::world(), {-radius, -1, 0});
  const auto end = attach(BodyId::world(), {6, -2, 0});
  for (const bool backwards : {false, true}) {
    m.cables.clear();
    m.cables.push_back(
        backwards
            ? cable("rope", {end, hole, wrapped({1}, right, 0.0), wrapped({0}, left, 0.0), begin})
            : cable("rope", {begin, wrapped({0}, right, 0.0), wrapped({1}, left, 0.0), hole, end}));
    m.cables[0].axial_stiffness = stiffness;
    const Simulation unstretched = test::start(m);
    const CableReport slack = unstretched.cable_reports()[0];
    for (const SpanReport& span : slack.spans) {
      m.cables[0].rest_lengths.push_back(span.length);
    }
    m.cables[0].rest_lengths[1] *= 0.97;
    Simulation s = test::start(m);
    const double whole = s.cable_reports()[0].total_length;
    const double strain = unstretched.cable_reports()[0].total_length / whole - 1.0;
    test::run(s.world, 0.02);
    const CableReport report = s.cable_reports()[0];
    for (const SpanReport& span : report.spans) {
      EXPECT_NEAR(span.tension, stiffness * strain, force_near);
    }
    expect_clean(s);
  }
}

TEST_P(WrappedStrain, AConstantComplianceBelongsToSpansAlone) {
  test::Machine m = strung(step_settings(0.01, 50), 0.0, {0.99, 2.0});
  m.cables[0].axial_stiffness.reset();
  m.cables[0].compliance = 1e-5;
  Simulation s = test::start(m);
  test::run(s.world, 0.02);
  const CableReport report = s.cable_reports()[0];
  for (const SpanReport& span : report.spans) {
    EXPECT_NEAR(span.tension, 0.01 / 2e-5, 1e-9);
  }
  expect_clean(s);
}

TEST_P(WrappedStrain, AWeightSwingsOnTheWholeRope) {
  if (!GetParam().rattle()) GTEST_SKIP();  // implicit Euler takes energy from what swings
  // T = EA (P / M - 1) is linear in the length P of the way, and the trapezoidal rule makes of
  // x'' = g - w^2 x the exact x = g / w^2 (1 - cos n b), tan(b / 2) = w h / 2.
  constexpr double mass = 100.0;
  constexpr double h = 0.01;
  Simulation s = test::start(hung(step_settings(h, 200), mass));
  const double whole = 3.0 + pi * radius;
  const double square = stiffness / (whole * mass);
  const double angle = 2.0 * std::atan(0.5 * h * std::sqrt(square));
  const double energy = s.world.energy().total();
  for (int n = 1; n <= 100; ++n) {
    ASSERT_TRUE(s.world.step().ok());
    const double fallen = -2.0 - s.world.state().bodies[1].position.y();
    EXPECT_NEAR(fallen, g / square * (1.0 - std::cos(n * angle)), 1e-9 * g / square) << n;
    EXPECT_NEAR(s.world.energy().total(), energy, 1e-9 * mass * g * g / square);
    expect_clean(s);
  }
}

TEST(WrappedStrainAtRest, StaticsAndModesHaveTheSameSpring) {
  test::Machine m = hung(test::direct_settings(IntegratorKind::xpbd, 0.01), 100.0);
  Simulation s = test::start(m);
  const double whole = 3.0 + pi * radius;
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const double fallen = -2.0 - s.world.state().bodies[1].position.y();
  EXPECT_NEAR(fallen, 100.0 * g / stiffness * whole, 1e-9);
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 1U);
  const double square = stiffness / (whole * 100.0);
  EXPECT_NEAR(modes.modes[0].eigenvalue, square, 1e-6 * square);
}

TEST_P(WrappedStrain, SlackRopeComesTautOverItsWholeLength) {
  if (GetParam().rattle()) GTEST_SKIP();
  // A weight that falls onto its rope, and comes to rest as implicit Euler damps it: M g = EA e.
  for (const double h : {1.0 / 60.0, 1.0 / 960.0}) {
    test::Machine m = hung(step_settings(h, 60), 100.0);
    m.cables[0].rest_lengths = {1.05, 2.05};
    m.model.bodies[1].damping = 2000.0;
    Simulation s = test::start(m);
    test::run(s.world, 2.0);
    const double strain = 100.0 * g / stiffness;
    const double fallen = -2.0 - s.world.state().bodies[1].position.y();
    EXPECT_NEAR(fallen, (3.1 + pi * radius) * (1.0 + strain) - 3.0 - pi * radius, 1e-7);
    expect_clean(s);
  }
}

TEST_P(WrappedStrain, RopeThatSticksKeepsItsStrain) {
  // The weight's pull stays within what the post holds, so its rope is a spring of its span alone,
  // and not a bit of the arc changes.
  test::Machine m = hung(step_settings(0.005, 200), 10.0);
  m.cables[0] = cable(
      "rope", {attach(BodyId::world(), {-radius, -1, 0}), wrapped({0}, right, 0.6), attach({1})});
  m.cables[0].axial_stiffness = stiffness;
  const double at_rest = 10.0 * g / stiffness;
  m.cables[0].rest_lengths = {1.0 / (1.0 + at_rest), 2.0 / (1.0 + 0.7 * at_rest)};
  Simulation s = test::start(m);
  const LinkReport lay = s.cable_reports()[0].links[1];
  const double rest = m.cables[0].rest_lengths[1];
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    EXPECT_EQ(report.links[1].stored_stretch, lay.stored_stretch);
    EXPECT_EQ(report.links[1].slip, 0.0);
    EXPECT_NEAR(report.spans[1].rest_length, rest, 1e-14);
    EXPECT_NEAR(report.spans[0].tension, stiffness * at_rest, force_near);
    expect_clean(s);
  }
}

TEST_P(WrappedStrain, ALoadThatSwingsUnderASmoothPostKeepsItsEnergy) {
  if (!GetParam().rattle() || GetParam().solver != SolverKind::direct) GTEST_SKIP();
  // The rope winds on and off the post while it stretches. Errors of second order: half the step, a
  // quarter of what is off.
  const auto worst = [&](double h) {
    test::Machine m = hung(step_settings(h, 100), 20.0);
    m.model.bodies[1].mobility = Mobility::planar;
    m.model.bodies[1].axis = Vector3::UnitZ();
    m.model.bodies[1].inertia = Vector3::Ones();
    m.model.bodies[1].position = {1.8, -1.2, 0};
    m.cables[0].axial_stiffness = 2e3;
    // Strained by a tenth, so that it does not go slack.
    const Simulation unstretched = test::start(m);
    const CableReport slack = unstretched.cable_reports()[0];
    for (const SpanReport& span : slack.spans) {
      m.cables[0].rest_lengths.push_back(span.length / 1.1);
    }
    Simulation s = test::start(m);
    const double energy = s.world.energy().total();
    double off = 0.0;
    for (int i = 0; i < static_cast<int>(std::lround(1.0 / h)); ++i) {
      EXPECT_TRUE(s.world.step().ok());
      off = std::max(off, std::abs(s.world.energy().total() - energy));
    }
    expect_clean(s);
    return off;
  };
  const double coarse = worst(0.004);
  const double fine = worst(0.002);
  EXPECT_LT(coarse, 0.2);  // of 200 J that go to and fro
  EXPECT_GT(coarse / fine, 3.0);
  EXPECT_LT(coarse / fine, 5.0);
}

TEST_P(WrappedStrain, OnAWrappableBodyIsTheSame) {
  // A weight swings its rope against a bar, which nothing lists: from the touch on the whole way is
  // one spring.
  test::Machine m;
  m.model.step = step_settings(0.002, 60);
  m.model.gravity = test::down;
  BodyDef bar = post("bar", {0.1, -1.0, 0}, 0.1);
  bar.shapes[0].shape = test::make<Cylinder>([](Cylinder& c) { c.radius = 0.1, c.length = 0.4; });
  bar.wrappable = true;
  m.model.add(bar);
  BodyDef bob = test::weight("bob", {-1.0, -1.8, 0}, 5.0);
  bob.mobility = Mobility::planar;
  bob.axis = Vector3::UnitZ();
  bob.inertia = Vector3::Ones();
  m.model.add(bob);
  m.cables.push_back(cable("rope", {attach(BodyId::world()), attach({1})}));
  m.cables[0].axial_stiffness = 2e4;
  m.cables[0].most_wraps = 2;
  Simulation s = test::start(m);
  const double whole = s.cable_reports()[0].total_length;
  const ObservableSet observables(s);
  const Result<int> wrapped_length = observables.index_of("rope.wrapped_length");
  ASSERT_TRUE(wrapped_length);
  std::vector<double> values;
  int wrapped_steps = 0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.total_length, whole, 1e-14 * whole);
    if (report.wraps.size() != 1) continue;
    const LinkReport& lies = report.wraps[0].link;
    const double before = report.spans[0].length / report.spans[0].rest_length - 1.0;
    const double behind = report.wraps[0].span.length / report.wraps[0].span.rest_length - 1.0;
    // In the substep of a touch it is divided as it lay.
    if (++wrapped_steps < 3 || !(lies.stored_length > 1e-6) || !(before > 1e-6)) continue;
    EXPECT_NEAR(behind, before, 1e-11);
    // What is told of the length on bodies is the arc.
    const Vector3 entry = lies.entry - lies.center;
    const Vector3 exit = lies.exit - lies.center;
    const double angle = std::atan2(entry.cross(exit).norm(), entry.dot(exit));
    observables.sample(s, values);
    EXPECT_NEAR(values.at(static_cast<std::size_t>(*wrapped_length)), 0.1 * angle, 1e-12);
    EXPECT_NEAR(lies.stored_stretch / lies.stored_length, before, 1e-6 * before);
  }
  EXPECT_GT(wrapped_steps, 50);
}

}  // namespace
}  // namespace sheave::wrapped_strain
