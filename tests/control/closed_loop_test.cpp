// Loops that are closed while a world runs, against linear theory.
//
// A load m on a drum of radius r and inertia J, with the drum's drive torque u r + r m g, is pulled
// by u besides its weight. With M_d = J / r^2 and the law u = -(kp e + ki (integral of e) + kd e')
// of the error e of its height the poles are the zeros of
//   rigid cable:    (m + M_d) s^3 + kd s^2 + kp s + ki,
//   spring k with damping b between drum and load:
//     m M_d s^5 + (m + M_d) (b s^4 + k s^3) + (k + b s) (kd s^2 + kp s + ki).
// Poles are found in the response by Prony's method: samples of a sum of n exponentials e^(p_i t)
// satisfy a recurrence of n steps, whose characteristic roots are e^(p_i T).

#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "cable/live_world.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::right;
using test::roll;

using Poles = std::vector<std::complex<double>>;

/// Zeros of c[0] s^n + ... + c[n].
Poles zeros(const std::vector<double>& c) {
  const auto n = static_cast<Eigen::Index>(c.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(0, i) = -c[static_cast<std::size_t>(i + 1)] / c[0];
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  const Eigen::VectorXcd values = companion.eigenvalues();
  return {values.data(), values.data() + n};
}

/// The poles of samples at intervals of `interval` [s].
Poles poles_of(const std::vector<double>& samples, int order, double interval) {
  const auto n = static_cast<Eigen::Index>(order);
  const auto rows = static_cast<Eigen::Index>(samples.size()) - n;
  Eigen::MatrixXd past(rows, n);
  Eigen::VectorXd next(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    next[i] = samples[static_cast<std::size_t>(i + n)];
    for (Eigen::Index k = 0; k < n; ++k) {
      past(i, k) = samples[static_cast<std::size_t>(i + n - 1 - k)];
    }
  }
  const Eigen::VectorXd law = past.colPivHouseholderQr().solve(next);
  std::vector<double> polynomial{1.0};
  for (Eigen::Index k = 0; k < n; ++k) polynomial.push_back(-law[k]);
  Poles poles;
  for (const std::complex<double>& z : zeros(polynomial)) poles.push_back(std::log(z) / interval);
  return poles;
}

/// Largest distance of a pole to the nearest of `others`, relative to that one.
double worst_of(const Poles& expected, const Poles& found) {
  double worst = 0.0;
  for (const auto& pole : expected) {
    double nearest = 1e9;
    for (const auto& other : found) nearest = std::min(nearest, std::abs(other - pole));
    worst = std::max(worst, nearest / std::abs(pole));
  }
  return worst;
}

constexpr double mass = 2.0;
constexpr double radius = 0.2;
constexpr double inertia = 0.04;
constexpr double drum_mass = inertia / (radius * radius);

LiveWorld hoist(std::optional<double> stiffness, double damping, double dt) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = dt;
  machine.model.step.substeps = 1;
  BodyDef drum = test::wheel("drum", {0.0, 4.0, 0.0}, radius, inertia);
  drum.drive = DriveKind::torque;
  drum.drive_values = {radius * mass * g};
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {radius, 0.0, 0.0}, mass));
  auto spool = roll(on, right);
  spool->stored_length = 3.0;
  CableDef rope = cable("rope", {spool, attach(load)});
  if (stiffness) {
    rope.compliance = 1.0 / *stiffness;
    rope.damping = damping;
    // It begins at rest.
    rope.rest_lengths = {4.0 - mass * g / *stiffness};
  }
  machine.cables.push_back(rope);
  Result<LiveWorld> world = LiveWorld::create(machine.model, machine.cables);
  EXPECT_TRUE(world.ok()) << test::text(world.errors());
  return std::move(*world);
}

struct Gains {
  double p, i, d;
};

/// Heights of the load at intervals of `interval`, less the height that it is to be held at.
std::vector<double> response(LiveWorld& world, const Gains& gains, double goal, double interval,
                             int count) {
  const BodyHandle drum = *world.body("drum");
  const BodyHandle load = *world.body("load");
  const double h = world.simulation().world.model().step.dt;
  const int steps = static_cast<int>(std::lround(interval / h));
  std::vector<double> errors;
  double sum = 0.0;
  for (int n = 0; n < count * steps; ++n) {
    const BodyPose pose = *world.pose(load);
    const double error = pose.position.y() - goal;
    if (n % steps == 0) errors.push_back(error);
    const double pull = -(gains.p * error + gains.i * sum + gains.d * pose.velocity.y());
    sum += h * error;
    EXPECT_TRUE(world.set_torque(drum, radius * (pull + mass * g)).empty());
    EXPECT_TRUE(world.step().ok());
  }
  return errors;
}

TEST(ClosedLoop, PidHoldsALoadOnARigidCableWithThePolesOfTheory) {
  // -4, -2 +- 3i: (s + 4)(s^2 + 4 s + 13).
  const double all = mass + drum_mass;
  const Gains gains{29.0 * all, 52.0 * all, 8.0 * all};
  LiveWorld world = hoist(std::nullopt, 0.0, 1.0 / 4000.0);
  const std::vector<double> errors = response(world, gains, 0.05, 0.05, 40);
  const Poles expected = zeros({all, gains.d, gains.p, gains.i});
  EXPECT_LT(worst_of(expected, poles_of(errors, 3, 0.05)), 0.01);
  EXPECT_NEAR(errors.back(), 0.0, 0.05 * 0.05);
}

TEST(ClosedLoop, PidHoldsALoadOnAnElasticCableWithThePolesOfTheory) {
  const double k = 600.0;
  const double b = 4.0;
  const double all = mass + drum_mass;
  const Gains gains{20.0, 20.0, 15.0};
  LiveWorld world = hoist(k, b, 1.0 / 4000.0);
  const double interval = 0.03;
  const std::vector<double> errors = response(world, gains, 0.05, interval, 60);
  const Poles expected = zeros({mass * drum_mass, b * all, k * all + b * gains.d,
                                k * gains.d + b * gains.p, k * gains.p + b * gains.i, k * gains.i});
  for (const auto& pole : expected) EXPECT_LT(pole.real(), 0.0);
  const Poles found = poles_of(errors, 5, interval);
  EXPECT_LT(worst_of(expected, found), 0.01);
  for (const auto& pole : expected) {
    // None of them is beyond what the samples can tell apart.
    EXPECT_LT(std::abs(pole.imag()), pi / interval);
  }
}

// A winch holds the tension of a rope while what pulls at its end gets stronger: from 100 N,
// balanced, to 180 N in 2 s. The drive's speed is a PI law of the tension's error, v = kp e + ki
// (integral of e). With the spring k of the rope T' = k (v_end - v), and the end's acceleration is
// a = (F - T) / m: after what e'' + k kp e' + k ki e = k a makes of the start it is e = a / ki,
// 0.64 N at most, with the two roots' frequency sqrt(k ki) = 224 / s.
TEST(ClosedLoop, AWinchKeepsItsTensionThroughARampOfTheLoad) {
  const double k = 2e4;
  const double wanted = 100.0;
  const double end_mass = 50.0;
  test::Machine machine;
  machine.model.step.dt = 1.0 / 2000.0;
  machine.model.step.substeps = 1;
  BodyDef drum = test::wheel("drum", {0.0, 0.0, 0.0}, radius, inertia);
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  const BodyId on = machine.model.add(drum);
  const BodyId end = machine.model.add(test::weight("end", {radius, -4.0, 0.0}, end_mass));
  auto spool = roll(on, right);
  spool->stored_length = 30.0;
  CableDef rope = cable("rope", {spool, attach(end)});
  rope.compliance = 1.0 / k;
  rope.damping = 10.0;
  rope.rest_lengths = {4.0 - wanted / k};
  machine.cables.push_back(rope);
  Result<LiveWorld> made = LiveWorld::create(machine.model, machine.cables);
  ASSERT_TRUE(made.ok()) << test::text(made.errors());
  LiveWorld& world = *made;
  const BodyHandle winch = *world.body("drum");
  const BodyHandle load = *world.body("end");
  const CableHandle line = *world.cable("rope");
  ASSERT_TRUE(world.set_force(load, {.force = {0.0, -wanted, 0.0}}).empty());
  ASSERT_TRUE(world.step().ok());
  double sum = 0.0;
  double worst = 0.0;
  for (int n = 0; n < 6000; ++n) {
    const double t = world.time();
    const double pull = wanted + 40.0 * std::clamp(t - 0.5, 0.0, 2.0);
    ASSERT_TRUE(world.set_force(load, {.force = {0.0, -pull, 0.0}}).empty());
    const double error = *world.tension(line, 0) - wanted;
    worst = std::max(worst, std::abs(error));
    sum += machine.model.step.dt * error;
    // Paying out turns the drum clockwise.
    ASSERT_TRUE(world.set_speed(winch, -(0.025 * error + 2.5 * sum) / radius).empty());
    ASSERT_TRUE(world.step().ok());
  }
  EXPECT_LT(worst, 0.01 * wanted);
  // It has not stood still meanwhile: the end has been let go by far.
  EXPECT_LT(world.pose(load)->position.y(), -5.0);
}

}  // namespace
}  // namespace sheave
