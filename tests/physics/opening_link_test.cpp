// Cables through openings of bodies, against closed forms, the conservation of energy and a second
// integration.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::cylinder_of;
using test::sphere_of;
using test::static_body;

std::shared_ptr<OpeningLink> pass(BodyId body) {
  auto link = std::make_shared<OpeningLink>();
  link->body = body;
  return link;
}

std::string refusal(const test::Machine& m) {
  const auto made = Simulation::create(m.model, m.cables);
  return made ? std::string() : test::text(made.errors());
}

constexpr double half_distance = 0.8;  // of the points from which the rope comes [m]

/// A free body that a rope passes between two points of the world at (+-half_distance, 0, 0).
test::Machine bead(const std::shared_ptr<const Shape>& shape, const Vector3& place,
                   bool back = false, const Quaternion& turn = Quaternion::Identity()) {
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  BodyDef body;
  body.name = "bead";
  body.mass = 2.0;
  body.inertia = Vector3(0.03, 0.02, 0.025);
  body.position = place;
  body.shapes = {{shape}};
  m.model.add(body);
  const double end = back ? -half_distance : half_distance;
  m.cables.push_back(
      test::cable("rope", {test::attach(BodyId::world(), turn * Vector3(-end, 0.0, 0.0)), pass({0}),
                           test::attach(BodyId::world(), turn * Vector3(end, 0.0, 0.0))}));
  return m;
}

// A ball of the radius r hangs in a rigid rope of the length 2 a: the place where the rope turns
// lies on the ellipsoid of revolution with the half axes a and b about the points of the wall, and
// the ball touches it from outside. So its centre moves on the parallel surface, whose radii of
// curvature at the lowest point are a^2 / b + r along the wall and b + r across it. The force of
// the rope passes through the centre. The swing of 1e-3 m lowers the frequency by less than (swing
// / radius)^2 / 16, 1e-7; rattle's error is (w h)^2 / 24, 7e-7 for h = 1/960.
TEST(OpeningLink, ABallHangsInARopeLikeAPendulumOnAParallelSurface) {
  const double r = 0.15;
  const double a = 1.0;
  const double b = std::sqrt(a * a - half_distance * half_distance);
  for (const bool back : {false, true}) {
    for (const bool along : {true, false}) {
      const double radius = (along ? a * a / b : b) + r;
      const double frequency = std::sqrt(test::g / radius);
      const double swing = 1e-3;
      test::Machine m = bead(sphere_of(r), {0.0, -b - r, 0.0}, back);
      m.model.step.substeps = 16;
      m.model.gravity = test::down;
      m.model.bodies[0].velocity =
          along ? Vector3(swing * frequency, 0.0, 0.0) : Vector3(0.0, 0.0, swing * frequency);
      Simulation s = test::start(m);
      const CableReport first = s.cable_reports()[0];
      EXPECT_NEAR(first.total_length, 2.0 * a, 1e-14);
      EXPECT_LT((first.links[1].entry - Vector3(0.0, -b, 0.0)).norm(), 1e-14);
      const double quarter = 0.5 * pi / frequency;
      double before = 0.0;
      double time = 0.0;
      // The time at which the ball comes back to the middle, after half a period.
      while (time < 3.0 * quarter) {
        ASSERT_TRUE(s.world.step().ok());
        time += 1.0 / 60.0;
        const Vector3 at = s.world.position({0});
        const double now = along ? at.x() : at.z();
        if (before > 0.0 && now <= 0.0) {
          const double crossing = time - (1.0 / 60.0) * now / (now - before);
          // Linear interpolation about the middle: (w h)^3 / 6 of a radian at most, 2e-5.
          EXPECT_NEAR(crossing, 2.0 * quarter, 3e-5 * quarter);
        }
        before = now;
      }
      EXPECT_LT(before, 0.0);
      const CableReport report = s.cable_reports()[0];
      EXPECT_EQ(report.spans[0].tension, report.spans[1].tension);
      EXPECT_EQ(report.length_error, 0.0);
      EXPECT_LT(s.world.angular_velocity({0}).norm(), 1e-9) << "the rope turns no ball";
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
  }
}

// Without weight a ball flies across a stretched rope: free as long as the rope passes it, |y| < r,
// and drawn back outside. The rope is l = 2 sqrt(c^2 + (|y| - r)^2) long. A second integration in
// the one coordinate, by Runge and Kutta's method with 2e5 steps, gives the motion.
TEST(OpeningLink, ABallFliesFreelyUntilTheRopeComesAgainstItsInside) {
  const double r = 0.1;
  const double stiffness = 400.0;
  const double rest = 1.5;
  const double speed = 0.8;
  const auto acceleration = [&](double y) {
    const double out = std::max(std::abs(y) - r, 0.0);
    const double length = 2.0 * std::hypot(half_distance, out);
    const double tension = stiffness * (length / rest - 1.0);
    return -std::copysign(2.0 * tension * out / (0.5 * length), y) / 2.0;
  };
  double y = 0.0;
  double v = speed;
  constexpr int steps = 200000;
  const double h = 2.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double a1 = acceleration(y);
    const double a2 = acceleration(y + 0.5 * h * v);
    const double a3 = acceleration(y + 0.5 * h * (v + 0.5 * h * a1));
    const double a4 = acceleration(y + h * (v + 0.5 * h * a2));
    y += h * (v + h * (a1 + a2 + a3) / 6.0);
    v += h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
  }
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    std::vector<double> errors;
    for (const int substeps : {4, 16, 64}) {
      test::Machine m = bead(sphere_of(r), Vector3::Zero());
      m.model.step = test::direct_settings(integrator, 1.0 / 50.0, substeps);
      m.model.bodies[0].velocity = {0.0, speed, 0.0};
      m.cables[0].axial_stiffness = stiffness;
      m.cables[0].rest_lengths = {0.5 * rest, 0.5 * rest};
      Simulation s = test::start(m);
      test::run(s.world, 2.0);
      errors.push_back(std::abs(s.world.position({0}).y() - y));
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
    const bool second = integrator == IntegratorKind::rattle;
    // Four times the substeps: a sixteenth, or a quarter, of the error.
    EXPECT_GT(errors[0] / errors[2], second ? 80.0 : 8.0) << errors[0] << " " << errors[2];
    EXPECT_LT(errors[2], second ? 1e-5 : 1e-2);
  }
}

// Oblique flight and rotation of a bar in space: energy within the second order of the step, with
// the same motion from either end and in a turned world.
TEST(OpeningLink, ABarInSpaceKeepsItsEnergy) {
  const Quaternion turn = rotation_by({0.4, -1.3, 0.7});
  std::vector<double> drifts;
  const auto made = [&](int substeps, bool back, const Quaternion& in) {
    test::Machine m = bead(cylinder_of(0.12, 3.0), in * Vector3(0.1, -0.5, 0.05), back, in);
    m.model.step.substeps = substeps;
    m.model.gravity = in * test::down;
    m.model.bodies[0].orientation = in * rotation_by({0.3, 0.2, -0.1});
    m.model.bodies[0].velocity = in * Vector3(0.4, 0.5, 0.3);
    m.model.bodies[0].angular_velocity = in * Vector3(0.5, 0.3, 1.0);
    m.cables[0].compliance = 1e-3;
    return m;
  };
  for (const int substeps : {16, 32, 64, 128}) {
    Simulation s = test::start(made(substeps, false, Quaternion::Identity()));
    const double energy = s.world.energy().total();
    double drift = 0.0;
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      drift = std::max(drift, std::abs(s.world.energy().total() - energy));
    }
    drifts.push_back(drift);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
    Simulation other = test::start(made(substeps, true, Quaternion::Identity()));
    Simulation turned = test::start(made(substeps, false, turn));
    for (Simulation* one : {&other, &turned}) test::run(one->world, 1.0);
    EXPECT_LT((other.world.position({0}) - s.world.position({0})).norm(), 1e-8);
    EXPECT_LT((turned.world.position({0}) - turn * s.world.position({0})).norm(), 1e-8);
  }
  EXPECT_GT(drifts[0] / drifts[3], 30.0) << "second order: 64";
  EXPECT_LT(drifts[3], 1e-3 * test::g);
}

// The place in the opening depends on the positions alone: a state that was kept goes on as it was.
TEST(OpeningLink, HasNoMemory) {
  test::Machine m = bead(sphere_of(0.1), {0.2, -0.4, 0.1});
  m.model.gravity = test::down;
  m.cables[0].axial_stiffness = 500.0;
  Simulation s = test::start(m);
  test::run(s.world, 0.4);
  const State kept = s.world.state();
  const double energy = s.world.energy().total();
  test::run(s.world, 0.6);
  const std::uint64_t then = hash(s.world.state());
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(kept).empty());
  EXPECT_EQ(other.world.energy().total(), energy);
  test::run(other.world, 0.6);
  EXPECT_EQ(hash(other.world.state()), then);
}

// Sweeps row by row apply each correction along the gradient of its time, the direct solver all
// along that of the end. The difference is of the order of the step.
TEST(OpeningLink, MovesAlikeWithBothSolvers) {
  std::vector<double> differences;
  for (const int substeps : {8, 64}) {
    test::Machine m = bead(sphere_of(0.1), {0.2, -0.4, 0.1});
    m.model.step = test::direct_settings(IntegratorKind::xpbd, 1.0 / 60.0, substeps);
    m.model.gravity = test::down;
    m.cables[0].axial_stiffness = 500.0;
    Simulation direct = test::start(m);
    test::run(direct.world, 1.0);
    m.model.step.solver = SolverKind::gauss_seidel;
    m.model.step.iterations = 40;
    Simulation swept = test::start(m);
    test::run(swept.world, 1.0);
    differences.push_back((swept.world.position({0}) - direct.world.position({0})).norm());
  }
  EXPECT_LT(differences[0], 1e-4);
  EXPECT_LT(differences[1], 0.2 * differences[0]);
}

TEST(OpeningLink, WarnsBeyondTheEndsOfACylinder) {
  for (const double aside : {0.05, 0.3}) {
    test::Machine m;
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 1);
    m.model.add(static_body("bar", cylinder_of(0.1, 0.2), {0.0, -0.5, aside}));
    m.model.add(test::weight("load", {0.0, 0.0, 0.0}, 1.0));
    m.cables.push_back(test::cable(
        "rope", {test::attach(BodyId::world(), {-1.0, 0.0, 0.0}), pass({0}), test::attach({1})}));
    m.cables[0].compliance = 1e-3;
    Simulation s = test::start(m);
    test::run(s.world, 0.1);
    const auto warnings = s.cables->misplaced_warnings();
    ASSERT_EQ(warnings.size(), aside > 0.1 ? 1U : 0U);
    for (const auto& warning : warnings) EXPECT_GT(warning.beyond, 0.1);
  }
}

TEST(OpeningLink, RefusesImpossibleSettings) {
  const test::Machine good = bead(sphere_of(0.1), {0.2, -0.4, 0.1});
  EXPECT_EQ(refusal(good), "");
  const auto expect = [&](const test::Machine& m, const std::string& message) {
    EXPECT_NE(refusal(m).find(message), std::string::npos) << refusal(m);
  };
  test::Machine m = good;
  auto box = std::make_shared<Box>();
  box->size = {0.2, 0.2, 1.0};
  m.model.bodies[0].shapes[0].shape = box;
  expect(m, "an opening needs a sphere or a cylinder; \"bead\" has another shape there");
  m = good;
  m.model.bodies[0].shapes.clear();
  expect(m, "\"bead\" has no shape");
  m = good;
  auto second = pass({0});
  second->shape = 1;
  m.cables[0].links[1] = second;
  expect(m, "has 1 shape; the first one has the number 0");
  m = good;
  m.cables[0].links.insert(m.cables[0].links.begin() + 1, pass({0}));
  expect(m, "the links beside it must be points; put a \"pinhole\" between it and link 2");
  m = good;
  m.cables[0].links.pop_back();
  expect(m, "a cable cannot end in an opening; attach it");
  m = good;
  m.model.add(static_body("post", sphere_of(0.1), {3.0, 0.0, 0.0}));
  m.model.bodies[1].wrappable = true;
  expect(m, "does not come to touch wrappable bodies; set most_wraps to 0");
  m.cables[0].most_wraps = 0;
  EXPECT_EQ(refusal(m), "");
  m = good;
  m.cables[0].axial_stiffness = 1e4;
  m.cables[0].linear_density = 0.1;
  expect(m, "this link is of type \"opening\"");
}

}  // namespace
}  // namespace sheave
