// Random machines in which nothing turns, whose cables fall slack and taut and whose weights land,
// step by step against the stages of engine/step.cpp, which any machine takes that has a free body
// besides (as in affine_motion_test.cpp).
//
// Both start each step from the same state and solve the same equations, so what differs is what
// rounding makes of one step. Positions are sums of some ten numbers of the scene's size, each off
// by 1e-16 of it, and the equations of a substep magnify that by what the matrix is conditioned by
// in rows of light and heavy wheels, of masses from 0.01 to 100 kg: 1e-12 of the scene leaves room
// for a factor of 1e3. Velocities are that over the substep, and forces those that move the
// heaviest body so far.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "engine/body_set.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::affine_slack {
namespace {

using test::attach;
using test::Random;
using test::right;
using test::roll;

constexpr double share = 1e-12;
constexpr double heaviest = 100.0;  // [kg]
constexpr double smallest = 0.15;   // radius [m]

/// From 10^low to 10^high.
double decades(Random& random, double low, double high) {
  return std::pow(10.0, random.between(low, high));
}

BodyDef random_weight(Random& random, const std::string& name, double x) {
  // One draw per statement: compilers differ in the order of arguments.
  const double mass = decades(random, -2, 2);
  BodyDef body = test::weight(name, {x, random.between(-3.0, -1.5), 0.0}, mass);
  auto shape = std::make_shared<Box>();
  shape->size = Vector3(0.1, 0.2, 0.1);
  body.shapes.push_back({shape});
  if (random.chance(0.3)) body.damping = *body.mass * random.between(0.0, 3.0);
  if (random.chance(0.4)) body.velocity = Vector3(0.0, random.between(-2.0, 2.0), 0.0);
  return body;
}

BodyDef random_wheel(Random& random, int i, double* radius) {
  *radius = random.between(smallest, 0.35);
  const double inertia = decades(random, -2, 2) * *radius * *radius;
  BodyDef body = test::wheel("wheel" + std::to_string(i), {2.0 * i, random.between(-0.4, 0.4), 0.0},
                             *radius, inertia);
  if (random.chance(0.3)) body.angular_damping = inertia * random.between(0.0, 3.0);
  if (random.chance(0.3)) body.angular_velocity = Vector3(0.0, 0.0, random.between(-5.0, 5.0));
  return body;
}

void drive(Random& random, BodyDef& drum) {
  if (random.chance(0.3)) return;
  drum.drive = random.chance(0.5) ? DriveKind::speed : DriveKind::torque;
  drum.drive_times = {0.0, 0.1, 0.3};
  for (int i = 0; i < 3; ++i) drum.drive_values.push_back(random.between(-3.0, 3.0));
}

/// Gives wheels that the cable would not reach a turn of it.
void reach_all(test::Machine& m) {
  const auto made = Simulation::create(m.model, m.cables);
  if (made.ok()) return;
  for (const Error& error : made.errors()) {
    const std::size_t link = std::stoul(error.path.substr(error.path.rfind('/') + 1));
    auto over = roll(dynamic_cast<const RollingLink&>(*m.cables[0].links[link]).body, right);
    over->turns = 1;
    m.cables[0].links[link] = over;
  }
}

/// A cable over wheels in a row, with a weight, a wall or a drum at either end.
test::Machine random_machine(Random& random, IntegratorKind integrator) {
  test::Machine m;
  m.model.gravity = test::down;
  const int substeps = 1 + random.below(3);
  m.model.step = test::settings(decades(random, -2.5, -1.5), substeps, 50);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  const int count = 1 + random.below(6);
  double first_radius = 0.0;
  double radius = 0.0;
  CableDef cable;
  cable.name = "cable";
  for (int i = 0; i < count; ++i) {
    m.model.bodies.push_back(random_wheel(random, i, &radius));
    if (i == 0) first_radius = radius;
    cable.links.push_back(roll(BodyId{i}, right));
  }
  const auto end = [&](bool front) {
    const double x = front ? -first_radius : 2.0 * (count - 1) + radius;
    const int kind = random.below(5);
    std::shared_ptr<const LinkDef> link;
    if (kind == 0) {
      link = attach(BodyId{}, {x, -2.0, 0.0});
    } else if (kind == 1) {
      double own = 0.0;
      BodyDef drum = random_wheel(random, front ? -2 : count + 1, &own);
      drive(random, drum);
      auto spool = std::make_shared<SpoolLink>();
      spool->body = m.model.add(drum);
      spool->winding = right;
      spool->stored_length = 5.0;
      link = spool;
    } else {
      link = attach(m.model.add(random_weight(random, front ? "first" : "last", x)));
    }
    cable.links.insert(front ? cable.links.begin() : cable.links.end(), link);
  };
  end(true);
  end(false);
  if (random.chance(0.4)) {
    cable.compliance = decades(random, -6, -3);
    if (random.chance(0.5)) cable.damping = decades(random, -1, 2);
  }
  m.cables.push_back(cable);
  reach_all(m);
  const CableReport drawn = test::start(m).cable_reports()[0];
  for (const SpanReport& span : drawn.spans) {
    const bool slack = random.chance(0.4);
    m.cables[0].rest_lengths.push_back(span.length + (slack ? decades(random, -6, -1) : 0.0));
  }
  if (random.chance(0.5)) {
    m.model.ground = GroundDef{{0.0, random.between(-4.0, -3.11), 0.0}, Vector3::UnitY()};
  }
  return m;
}

/// The state of the machine with a body besides.
State with_another(const State& state, const State& other) {
  State whole = state;
  whole.bodies.push_back(other.bodies.back());
  whole.layout = other.layout;
  whole.history = {};
  return whole;
}

void expect_same(const Simulation& own, const Simulation& their, double scale, double h,
                 double radius) {
  const State& mine = own.world.state();
  const double off = share * scale;
  for (std::size_t b = 0; b < mine.bodies.size(); ++b) {
    const BodyState& x = mine.bodies[b];
    const BodyState& y = their.world.state().bodies[b];
    ASSERT_LE((x.position - y.position).norm(), off) << b;
    ASSERT_LE((x.velocity - y.velocity).norm(), off / h) << b;
    ASSERT_LE(std::abs(x.angle - y.angle), off / radius) << b;
    ASSERT_LE((x.angular_velocity - y.angular_velocity).norm(), off / (radius * h)) << b;
    ASSERT_LE((x.orientation.coeffs() - y.orientation.coeffs()).norm(), off / radius) << b;
  }
  const std::vector<CableReport> reports = own.cable_reports();
  const std::vector<CableReport> others = their.cable_reports();
  for (std::size_t k = 0; k < reports[0].spans.size(); ++k) {
    ASSERT_NEAR(reports[0].spans[k].rest_length, others[0].spans[k].rest_length, off) << k;
    ASSERT_NEAR(reports[0].spans[k].tension, others[0].spans[k].tension, heaviest * off / (h * h))
        << k;
  }
}

struct Tally {
  int steps = 0;
  int whole = 0;    ///< all of whose substeps were affine
  int changes = 0;  ///< of rows that act
};

/// Steps of both from the same states; another world takes over in the middle.
void compare(const test::Machine& m, int steps, Tally& tally) {
  Simulation affine = test::start(m);
  test::Machine besides = m;
  besides.model.bodies.push_back(test::lump("besides", {1.0, -1.0, 0.0}, 1.0));
  besides.model.bodies.back().shapes.clear();
  Simulation stages = test::start(besides);
  Simulation second = test::start(m);
  const double scale = affine.world.bodies().scale();
  const double h = m.model.step.dt / m.model.step.substeps;
  for (int i = 0; i < steps; ++i) {
    const State start = with_another(affine.world.state(), stages.world.state());
    ASSERT_TRUE(stages.world.restore(start).empty());
    int polls = 0;
    const StepReport report = affine.world.step([&] { return ++polls < 0; });
    const StepReport theirs = stages.world.step();
    ASSERT_EQ(report.ok(), theirs.ok());
    if (!report.ok()) {
      // A weight has reached a wheel.
      EXPECT_EQ(report.divergence->message, theirs.divergence->message);
      return;
    }
    ++tally.steps;
    // Stages ask before each factorisation.
    if (polls == 1) ++tally.whole;
    if (polls == 1) tally.changes += static_cast<int>(report.statistics.set_changes);
    // What the stages have done in both worlds is not the matter here.
    if (polls == 1) expect_same(affine, stages, scale, h, smallest);
    if (testing::Test::HasFatalFailure()) {
      FAIL() << "step " << i << ", time " << affine.world.state().time << ", polls " << polls;
    }
    if (i == steps / 2) {
      ASSERT_TRUE(second.world.restore(affine.world.state()).empty());
    } else if (i > steps / 2) {
      ASSERT_TRUE(second.world.step().ok());
      ASSERT_EQ(hash(second.world.state()), hash(affine.world.state())) << i;
    }
  }
}

class AffineSlack : public testing::TestWithParam<IntegratorKind> {};

TEST_P(AffineSlack, RandomMachinesMoveAsByTheStages) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    const test::Machine m = random_machine(random, GetParam());
    compare(m, 60, tally);
    if (HasFatalFailure()) FAIL() << "seed " << seed;
  }
  // Of drums some run out, and of light wheels between heavy ones more than rounding is left. With
  // `rattle` the stages do the substeps in which a spring begins or ceases to press, a fifth here.
  const bool rattle = GetParam() == IntegratorKind::rattle;
  EXPECT_GE(tally.whole, tally.steps * (rattle ? 7 : 9) / 10);
  EXPECT_GE(tally.changes, tally.steps / (rattle ? 25 : 20));
}

INSTANTIATE_TEST_SUITE_P(Integrators, AffineSlack,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle));

}  // namespace
}  // namespace sheave::affine_slack
