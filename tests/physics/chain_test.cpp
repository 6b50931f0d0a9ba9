// A heavy ball on a chain of light links: what mass ratios do to solvers.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

constexpr double length = 1.0;  // of a link [m]
constexpr double radius = 8.0;  // of the ball [m]

BodyDef chain_body(std::string name, double x, double mass) {
  BodyDef body;
  body.name = std::move(name);
  body.position = {x, 0.0, 0.0};
  body.mass = mass;
  return body;
}

/// `links` slender rods of 1 kg in a row along x and a ball of `ratio` kg, joined, the first to the
/// world.
Model ball_on_chain(int links, double ratio) {
  Model model;
  model.gravity = test::down;
  const auto join = [&](BodyId a, BodyId b, double x) {
    auto joint = std::make_shared<BallJoint>();
    joint->name = "joint " + std::to_string(b.index);
    joint->body_a = a;
    joint->body_b = b;
    joint->anchor = {x, 0.0, 0.0};
    model.joints.push_back(joint);
  };
  BodyId last;
  for (int k = 0; k < links; ++k) {
    BodyDef link = chain_body("link " + std::to_string(k), (k + 0.5) * length, 1.0);
    link.inertia = Vector3(0.01, 1.0, 1.0) * (length * length / 12.0);
    const BodyId id = model.add(link);
    join(last, id, k * length);
    last = id;
  }
  BodyDef ball = chain_body("ball", links * length + radius, ratio);
  ball.inertia = Vector3::Constant(0.4 * ratio * radius * radius);
  join(last, model.add(ball), links * length);
  return model;
}

/// The largest gap of a joint [m].
double largest_gap(const World& world, int links) {
  double worst = 0.0;
  Vector3 end = Vector3::Zero();
  for (int k = 0; k <= links; ++k) {
    const Vector3 half = world.orientation({k}) * Vector3(k < links ? 0.5 * length : radius, 0, 0);
    worst = std::max(worst, (world.position({k}) - half - end).norm());
    end = world.position({k}) + half;
  }
  return worst;
}

// The chain is let go from the horizontal. Under up to 3 M g a link swings across the chain with 2
// sqrt(3 M g / m L), by 1.2 rad in a substep of 1/240 s, so the gradients turn by as much as the
// corrections are large.
TEST(Chain, WithAHeavyBallKeepsItsLengthWithTheDirectSolver) {
  constexpr int links = 40;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Model model = ball_on_chain(links, 672.0);
    model.step = test::settings(1.0 / 60.0, 4, 20);
    model.step.solver = SolverKind::direct;
    model.step.integrator = integrator;
    World world = test::start(model);
    double worst = 0.0;
    for (int frame = 0; frame < 480; ++frame) {
      const StepReport report = world.step();
      ASSERT_TRUE(report.ok()) << report.divergence->message;
      worst = std::max(worst, largest_gap(world, links));
    }
    // Each of a joint's three rows is solved to 1e-10 of the scene's size. Where links swing far,
    // Newton's method takes more than ten rounds now and then; twelve have been enough.
    const double rows = std::sqrt(3.0) * 1e-10 * world.bodies().scale();
    EXPECT_LT(worst, rows);
    // It has swung to the other side.
    EXPECT_LT(world.position({links}).x(), 0.0);
  }
}

// With heavy links nothing is stiff, and the two ways of going on must agree: the energy of rattle
// at the same settings.
TEST(Chain, SwingsWithItsEnergy) {
  constexpr int links = 10;
  Model model = ball_on_chain(links, 5.0);
  model.step = test::settings(1.0 / 60.0, 16, 10);
  model.step.solver = SolverKind::direct;
  model.step.integrator = IntegratorKind::rattle;
  World world = test::start(model);
  const double start = world.energy().total();
  double drift = 0.0;
  for (int frame = 0; frame < 120; ++frame) {
    ASSERT_TRUE(world.step().ok());
    drift = std::max(drift, std::abs(world.energy().total() - start));
  }
  // Second order: the fastest swing turns links by some 0.1 rad in a substep, of which the square
  // and a tenth, by the usual coefficient of the midpoint rule, is seen in the energy m g L of a
  // link that swings.
  EXPECT_LT(drift, 1e-3 * 15.0 * g * length);
}

}  // namespace
}  // namespace sheave
