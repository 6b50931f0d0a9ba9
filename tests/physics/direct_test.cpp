// The direct solver: closed forms where Gauss-Seidel is far from converged, and what is redundant.

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "engine/joints/distance.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

/// One substep of 1/60 s per step, at most `rounds` rounds.
void use_direct(test::Machine& m, int rounds = 10) {
  m.model.step = test::settings(1.0 / 60.0, 1, rounds);
  m.model.step.solver = SolverKind::direct;
}

/// Acceleration of a body along y over the first `steps` steps, from its velocity.
double acceleration(Simulation& s, BodyId body, int steps = 10) {
  const double start = s.world.velocity(body).y();
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(s.world.step().ok());
  return (s.world.velocity(body).y() - start) / (steps / 60.0);
}

TEST(Direct, WheelTrainsOfAnyLengthAreExactAtOneSubstep) {
  for (const int wheels : {15, 63, 255, 1023}) {
    const double inertia = 0.125;
    test::Machine m = test::wheel_train(wheels, 1.0, 2.0, 0.5, inertia);
    use_direct(m);
    Simulation s = test::start(m);
    // All rims run at one speed: (m2 - m1) g = (m1 + m2 + n J / r^2) a.
    const double expected = g / (3.0 + wheels * inertia / 0.25);
    const double a = -acceleration(s, {wheels + 1});
    EXPECT_NEAR(a, expected, 1e-6 * expected) << wheels;
    const StepReport report = s.world.step();
    EXPECT_LE(report.statistics.rounds, 2) << wheels;
    EXPECT_EQ(report.statistics.solver_fallbacks, 0);
  }
}

// Where the search for a solution begins decides how many rounds it takes: a pendulum that goes on
// as it moves is nearer to where it will be than one that falls.
TEST(Direct, ASlowSwingNeedsFewRounds) {
  test::Machine m = test::cable_pendulum(1.0, 1.0, 0.5);
  use_direct(m);
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    // The swing of at most sqrt(2 g L (1 - cos 0.5)) h = 0.026 rad per substep turns gradients by
    // as much, and every round leaves h^2 g / L = 3e-3 of the error: 1e-10 after 0.026^2, 2e-6,
    // 6e-9, 2e-11.
    ASSERT_LE(report.statistics.rounds, 4);
    ASSERT_LE(report.statistics.last_correction, 1e-9);
  }
}

// Rest lengths are multiples of a quantum, here 2^-39 m = 1.8e-12 m, and all spans of a train are
// rounded alike. Over n spans that is a jerk of n x 1e-12 m, against g h^2 = 2.5e-10 m that gravity
// moves the ends by: if rows did not count what is below the quantum, most spans would be slack
// after the first substep. What is left is the rounding of positions: a last digit of 1.8e-15 m at
// the weights, who move by a h^2 = 4.9e-13 m in the first substep.
/// Where implicit Euler puts a body of 1 kg that hangs by a point `hook` above its centre of mass
/// on a rope of `length` from the origin, all in a plane: x' = x + h v + h^2 (g - u T), a' = a + h
/// w + h^2 (r x u) T / I, |x' + r| = length, with u = (x' + r) / length the direction of the rope
/// and r the hook's arm at the end.
struct SwingByImplicitEuler {
  double inertia;
  double hook;
  double length;
  double h;
  Eigen::Vector4d next{0.0, 0.0, 0.0, 0.0};  // x, y, angle, tension
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};

  [[nodiscard]] Eigen::Vector4d residual(const Eigen::Vector4d& z,
                                         const Eigen::Vector3d& from) const {
    const Eigen::Vector2d arm(-hook * std::sin(z[2]), hook * std::cos(z[2]));
    const Eigen::Vector2d u = (z.head<2>() + arm) / length;
    const double lever = arm.x() * u.y() - arm.y() * u.x();
    const Eigen::Vector2d moved =
        from.head<2>() + h * velocity.head<2>() + h * h * (Eigen::Vector2d(0.0, -g) - u * z[3]);
    Eigen::Vector4d r;
    r << z.head<2>() - moved, z[2] - from[2] - h * velocity[2] + h * h * lever * z[3] / inertia,
        u.norm() - 1.0;
    return r;
  }
  void step() {
    const Eigen::Vector3d from = next.head<3>();
    for (int round = 0; round < 40; ++round) {
      Eigen::Matrix4d jacobian;
      for (int i = 0; i < 4; ++i) {
        const double e = 1e-6 * std::max(1.0, std::abs(next[i]));
        Eigen::Vector4d more = next;
        Eigen::Vector4d less = next;
        more[i] += e;
        less[i] -= e;
        jacobian.col(i) = (residual(more, from) - residual(less, from)) / (2.0 * e);
      }
      next -= jacobian.inverse() * residual(next, from);
    }
    velocity = (next.head<3>() - from) / h;
  }
};

// What rounds end with is implicit Euler's solution, also across the rope, where rows see nothing:
// a load that swings by a quarter of a radian per step. Each step may leave `across` (1e-9 of 1 m,
// and a tenth of that after bodies have been moved along the last gradients); measured are 2e-11 m
// after a second.
TEST(Direct, AQuickSwingAgreesWithImplicitEuler) {
  const double speed = 15.0;
  SwingByImplicitEuler expected{0.02, 0.1, 0.5, 1.0 / 60.0};
  expected.next << 0.0, -0.6, 0.0, 140.0;
  expected.velocity << 0.6 * speed, 0.0, speed;
  test::Machine m;
  m.model.gravity = test::down;
  use_direct(m, 50);
  BodyDef load = test::lump("load", {0.0, -0.6, 0.0}, 1.0);
  load.mobility = Mobility::planar;
  load.inertia = Vector3::Constant(0.02);
  load.velocity = {0.6 * speed, 0.0, 0.0};
  load.angular_velocity = {0.0, 0.0, speed};
  const BodyId body = m.model.add(load);
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), Vector3::Zero()), attach(body, {0.0, 0.1, 0.0})}));
  Simulation s = test::start(m);
  std::int64_t rounds = 0;
  for (int i = 0; i < 60; ++i) {
    expected.step();
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    rounds += report.statistics.rounds;
    EXPECT_NEAR(s.world.position(body).x(), expected.next[0], 1e-9);
    EXPECT_NEAR(s.world.position(body).y(), expected.next[1], 1e-9);
    EXPECT_NEAR(s.world.state().bodies[0].angle, expected.next[2], 1e-8);
  }
  EXPECT_LE(rounds, 3 * 60);
}

TEST(Direct, RoundedRestLengthsDoNotJerkLongCables) {
  const int wheels = 999;  // an odd number: the last one is above, and its weight hangs upright
  const double h = 5e-6;
  test::Machine m = test::wheel_train(wheels, 1.0, 2.0, 0.5, 0.125);
  use_direct(m);
  m.model.step.dt = h;
  Simulation s = test::start(m);
  for (int i = 0; i < 10; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.set_changes, 0) << i;
  }
  const double expected = g / (3.0 + wheels * 0.5);
  EXPECT_NEAR(-s.world.velocity({wheels + 1}).y() / (10 * h), expected, 0.01 * expected);
  EXPECT_NEAR(s.world.velocity({wheels}).y() / (10 * h), expected, 0.01 * expected);
}

TEST(Direct, LightWheelsAreAsExactAsHeavyOnes) {
  for (const double inertia : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e6}) {
    test::Tackle tackle{.strands = 4, .load = 8.0, .effort = 3.0};
    test::Machine m = tackle.machine();
    for (BodyDef& body : m.model.bodies) {
      if (body.mobility == Mobility::rotor) body.spin_inertia = inertia;
    }
    tackle.inertia = inertia;
    use_direct(m);
    Simulation s = test::start(m);
    const double expected = tackle.acceleration();
    const double a = acceleration(s, test::Tackle::block);
    // Heavy wheels leave little motion; what counts is the acceleration that the gravity of the
    // weights would give.
    const double scale = std::max(std::abs(expected), 1e-6 * g);
    EXPECT_NEAR(a, expected, 1e-5 * scale) << inertia;
  }
}

TEST(Direct, MassRatiosToABillion) {
  for (const double ratio : {1.0, 1e3, 1e6, 1e9}) {
    const test::Atwood atwood{.m1 = 1.0, .m2 = ratio, .inertia = 0.05, .hang = 10.0};
    test::Machine m = atwood.machine();
    use_direct(m);
    Simulation s = test::start(m);
    const double a = -acceleration(s, {2});
    EXPECT_NEAR(a, atwood.acceleration(), 1e-9 * g + 1e-6 * atwood.acceleration()) << ratio;
    const double tension = g + atwood.acceleration();
    EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, tension, 1e-5 * tension) << ratio;
  }
}

TEST(Direct, ManyPinholesHaveOneTension) {
  for (const int holes : {1, 5, 50}) {
    test::Machine m;
    m.model.gravity = test::down;
    use_direct(m);
    const BodyId a = m.model.add(test::weight("a", {0.0, -3.0, 0.0}, 1.0));
    const BodyId b = m.model.add(test::weight("b", {0.1 * (holes - 1), -3.0, 0.0}, 2.0));
    CableDef rope = cable("rope", {attach(a)});
    for (int i = 0; i < holes; ++i) {
      auto hole = std::make_shared<PinholeLink>();
      hole->point = {0.1 * i, 0.05 * (i % 2), 0.0};
      rope.links.push_back(hole);
    }
    rope.links.push_back(attach(b));
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    EXPECT_NEAR(acceleration(s, a), g / 3.0, 1e-6 * g) << holes;
    const CableReport report = s.cable_reports()[0];
    for (const SpanReport& span : report.spans) {
      EXPECT_EQ(span.tension, report.spans[0].tension);
      EXPECT_GE(span.rest_length, 0.0);
    }
  }
}

TEST(Direct, SlackAndTautAreFoundInOneSubstep) {
  // Weights on a train of wheels, the second half of which is thrown up: its cable is slack at
  // once, the other's taut.
  test::Machine m = test::wheel_train(31, 1.0, 2.0, 0.5, 0.125);
  use_direct(m);
  m.model.bodies[32].velocity = {0.0, 5.0, 0.0};
  Simulation s = test::start(m);
  for (int i = 0; i < 120; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.solver_fallbacks, 0);
    const CableReport cable_report = s.cable_reports()[0];
    for (const SpanReport& span : cable_report.spans) {
      EXPECT_GE(span.tension, 0.0);
      EXPECT_LT(span.length - span.rest_length, 1e-7);
      // A span that pulls is taut. (Complementarity.)
      EXPECT_TRUE(span.tension == 0.0 || span.rest_length - span.length < 1e-7);
    }
  }
}

TEST(Direct, ABeltOverFourWheelsIsRedundantAndRuns) {
  test::Machine m;
  m.model.gravity = test::down;
  CableDef belt = cable("belt", {});
  for (int i = 0; i < 4; ++i) {
    const double x = i == 0 || i == 3 ? -1.0 : 1.0;
    const BodyId id = m.model.add(test::wheel("w" + std::to_string(i), {x, i < 2 ? -1.0 : 1.0, 0.0},
                                              0.1 * (i + 1), 0.01 * (i + 1)));
    belt.links.push_back(roll(id, left));
  }
  m.model.bodies[0].torque = {0.0, 0.0, 1.0};
  belt.closed = true;
  m.cables.push_back(belt);
  use_direct(m);
  Simulation s = test::start(m);
  StepReport report;
  for (int i = 0; i < 60; ++i) {
    report = s.world.step();
    ASSERT_TRUE(report.ok());
  }
  // Rims run together: M / r0 = sum(J / r^2) a.
  double inertia = 0.0;
  for (int i = 0; i < 4; ++i) inertia += 0.01 * (i + 1) / std::pow(0.1 * (i + 1), 2);
  const double a = 10.0 / inertia;
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(s.world.angular_velocity({i}).z() * 0.1 * (i + 1), a, 1e-6 * a);
  }
  EXPECT_LT(report.statistics.last_correction, 1e-9);
}

TEST(Direct, AFrameWithMoreRodsThanItNeedsHangs) {
  // Four balls that turn freely have 12 degrees of freedom; there are 6 rods between them and 8 to
  // the ceiling.
  test::Machine m;
  m.model.gravity = test::down;
  std::vector<BodyId> balls;
  const std::vector<Vector3> places{
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.3, -1.0, 0.3}};
  for (const Vector3& place : places) {
    balls.push_back(m.model.add(test::lump("ball" + std::to_string(balls.size()), place, 1.0)));
  }
  const auto rod = [&](BodyId a, const Vector3& from, BodyId b, const Vector3& to) {
    auto joint = std::make_shared<DistanceJoint>();
    joint->name = "rod" + std::to_string(m.model.joints.size());
    joint->body_a = a;
    joint->body_b = b;
    joint->anchor_a = from;
    joint->anchor_b = to;
    m.model.joints.push_back(joint);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) rod(balls[i], places[i], balls[j], places[j]);
    const double turn = 1.3 * static_cast<double>(i);
    const Vector3 aside(0.5 * std::cos(turn), 2.0, 0.5 * std::sin(turn));
    rod(BodyId::world(), places[i] + aside, balls[i], places[i]);
    rod(BodyId::world(), places[i] + Vector3(-aside.z(), 1.5, aside.x()), balls[i], places[i]);
  }
  use_direct(m);
  Simulation s = test::start(m);
  for (int i = 0; i < 120; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_GT(report.statistics.redundant_rows, 0);
    EXPECT_LT(report.statistics.last_correction, 1e-6);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR((s.world.position(balls[i]) - places[i]).norm(), 0.0, 1e-6);
  }
}

TEST(Direct, AgreesWithConvergedGaussSeidel) {
  // A tackle whose free block sways: mounted rotors, an elastic cable with damping.
  const test::Tackle tackle{.strands = 4, .effort = 3.0, .block_mobility = Mobility::free};
  test::Machine m = tackle.machine();
  m.model.step = test::settings(1.0 / 60.0, 1, 4000);
  m.cables[0].axial_stiffness = 1e4;
  m.cables[0].damping = 30.0;
  m.model.bodies[0].angular_velocity = {0.05, 0.1, 0.2};
  Simulation slow = test::start(m);
  m.model.step.iterations = 10;
  m.model.step.solver = SolverKind::direct;
  Simulation fast = test::start(m);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(slow.world.step().ok());
    ASSERT_TRUE(fast.world.step().ok());
  }
  // Both solve the same equations but for the gradients at which the multipliers of earlier rounds
  // have acted.
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR((fast.world.position({i}) - slow.world.position({i})).norm(), 0.0, 1e-6);
  }
  for (int k = 0; k < 5; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double tension = slow.cable_reports()[0].spans[at].tension;
    EXPECT_NEAR(fast.cable_reports()[0].spans[at].tension, tension, 1e-4 * tension);
  }
}

TEST(Direct, AStateWithItsActiveSetCanBeRestored) {
  test::Machine m = test::wheel_train(15, 1.0, 2.0, 0.5, 0.125);
  use_direct(m);
  m.model.bodies[16].velocity = {0.0, 3.0, 0.0};
  Simulation s = test::start(m);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
  const State saved = s.world.state();
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(s.world.step().ok());
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(saved).empty());
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(hash(other.world.state()), hash(s.world.state()));
}

// A box stands on its four lower corners, whose rows and the cable's all move it along one axis. A
// winch pulls at v from the start; the cable was loose by s, so the box leaves the floor at t = s /
// v and has then risen by v t - s.
TEST(Direct, AWinchLiftsABoxOffTheFloor) {
  const double v = 0.3;
  const double s = 0.12;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const Mobility mobility : {Mobility::slider, Mobility::free}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::settings(1.0 / 60.0, 1, 10);
      m.model.step.solver = SolverKind::direct;
      m.model.step.integrator = integrator;
      m.model.ground = GroundDef{};
      BodyDef box = test::lump("box", {0.0, 0.15, 0.0}, 3.0);
      box.mobility = mobility;
      if (mobility == Mobility::slider) box.axis = Vector3::UnitY();
      auto shape = std::make_shared<Box>();
      shape->size = Vector3::Constant(0.3);
      box.shapes = {{shape}};
      m.model.add(box);
      auto winch = test::attach(BodyId{}, {0.0, 2.0, 0.0});
      winch->feed_speed = -v;
      m.cables = {test::cable("rope", {winch, test::attach({0}, {0.0, 0.15, 0.0})})};
      m.cables[0].rest_lengths = {1.7 + s};
      Simulation simulation = test::start(m);
      test::run(simulation.world, 1.0);
      // Rows are solved to 1e-10 of the scene's size, here some metres.
      EXPECT_NEAR(simulation.world.position({0}).y(), 0.15 + v * 1.0 - s, 1e-9);
      EXPECT_NEAR(simulation.cable_reports()[0].spans[0].tension, 3.0 * g, 1e-6 * 3.0 * g);
    }
  }
}

}  // namespace
}  // namespace sheave
