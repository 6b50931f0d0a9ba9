// A rigid rope breaks at the instant at which its tension passes the breaking tension.
//
// A rigid rope has no stretch that determines its tension, and multipliers are means of a substep.
// The closed forms of these machines show that the tension of the instant decides.
//
// Tolerances. The motion of `rattle`, its mean forces and their extrapolation to the instant have
// errors of h^2 times second derivatives (engine/instant_forces.cpp). The machines here move with
// frequencies of at most 5/s, and tensions have rates of the same order, so the error of a time is
// below 10/s h^2. Rounding: 1e-5 m/s2 over rates of 5 m/s3 and more, at most 2e-6 s.

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/step_warnings.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;

constexpr double frame_time = 1.0 / 60.0;
const Quaternion upright = Quaternion::Identity();
const Quaternion turned(Eigen::AngleAxisd(1.1, Vector3(1.0, -2.0, 0.5).normalized()));

/// The time of the first break of a machine's ropes [s]; -1: none breaks within 2 s.
double break_time(const test::Machine& machine) {
  Simulation s = test::start(machine);
  while (s.world.state().time < 2.0 && s.cables->events().empty()) {
    EXPECT_TRUE(s.world.step().ok());
  }
  return s.cables->events().empty() ? -1.0 : s.cables->events()[0].time;
}

/// Expects the break at `time` [s] with 1 to 64 substeps: with the error first x h + second x h^2.
void expect_break(const std::function<test::Machine(StepSettings)>& machine,
                  IntegratorKind integrator, double time, double first, double second) {
  for (const int substeps : {1, 4, 16, 64}) {
    SCOPED_TRACE(std::string(integrator_names[static_cast<std::size_t>(integrator)]) +
                 ", substeps " + std::to_string(substeps));
    const double h = frame_time / substeps;
    const double error =
        break_time(machine(test::direct_settings(integrator, frame_time, substeps))) - time;
    EXPECT_LT(std::abs(error), first * h + second * h * h + 2e-6);
  }
}

/// A bob of 1 kg on a rope of 1 m, in a frame turned by `frame`, with gravity along its -y.
test::Machine bob(StepSettings step, const Quaternion& frame, const Vector3& position,
                  const Vector3& velocity, double breaking) {
  test::Machine m;
  m.model.step = step;
  m.model.gravity = frame * test::down;
  BodyDef body;
  body.name = "bob";
  body.mass = 1.0;
  body.inertia = Vector3(0.01, 0.01, 0.01);
  body.position = frame * position;
  body.velocity = frame * velocity;
  m.cables.push_back(cable("rope", {attach(BodyId::world()), attach(m.model.add(body))}));
  m.cables[0].breaking_tension = breaking;
  return m;
}

/// When the tension of a spherical pendulum of 1 kg and 1 m is `tension` [s]. It starts at the angle
/// `start` from the vertical with the angular velocity `spin` about it. By energy and angular
/// momentum, T = g cos a + v^2 and a'' = spin^2 sin^4 start cos a / sin^3 a - g sin a. Steps of
/// Runge's and Kutta's method of 1e-4 s have errors below 1e-12 s.
double swing_time(double start, double spin, double tension) {
  const double momentum = spin * std::sin(start) * std::sin(start);
  const double square = spin * momentum;  // of the speed at the start
  const auto pull = [&](double a) {
    return square + g * (3.0 * std::cos(a) - 2.0 * std::cos(start));
  };
  const auto rate = [&](double a) {
    const double s = std::sin(a);
    const double turning = momentum == 0.0 ? 0.0 : momentum * momentum * std::cos(a) / (s * s * s);
    return turning - g * s;
  };
  constexpr double dt = 1e-4;
  double a = start;
  double w = 0.0;
  for (double time = 0.0; time < 2.0; time += dt) {
    const double a1 = rate(a);
    const double a2 = rate(a + 0.5 * dt * w);
    const double a3 = rate(a + 0.5 * dt * (w + 0.5 * dt * a1));
    const double a4 = rate(a + dt * (w + 0.5 * dt * a2));
    const double next = a + dt * w + dt * dt / 6.0 * (a1 + a2 + a3);
    if (pull(next) > tension) {
      return time + dt * (tension - pull(a)) / (pull(next) - pull(a));
    }
    w += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    a = next;
  }
  return -1.0;
}

TEST(RigidBreak, APendulumBreaksAtTheInstantOfItsBreakingTension) {
  const double start = pi / 3.0;
  for (const double share : {0.6, 1.4, 1.98}) {
    const double time = swing_time(start, 0.0, share * g);
    for (const double side : {1.0, -1.0}) {
      expect_break(
          [&](StepSettings step) {
            return bob(step, side > 0.0 ? upright : turned,
                       {side * std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(), share * g);
          },
          IntegratorKind::rattle, time, 0.0, 10.0);
    }
  }
}

TEST(RigidBreak, APendulumOfXpbdBreaksAtThePlaceOfItsBreakingTension) {
  // Bodies of `xpbd` are ahead by half a substep, and the bob loses speed: by 2 w^3 h per second on
  // a circle, at most 8 m/s h until here. So the tension, with the rate 3 g w sin a of 20 N/s and
  // more, is late by 2 v x 8 m/s h / 20 N/s, below 3 h.
  const double start = pi / 3.0;
  for (const double share : {0.6, 1.8}) {
    expect_break(
        [&](StepSettings step) {
          return bob(step, turned, {std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(),
                     share * g);
        },
        IntegratorKind::xpbd, swing_time(start, 0.0, share * g), 3.0, 0.0);
  }
}

TEST(RigidBreak, ASphericalPendulumBreaksAtTheInstantOfItsBreakingTension) {
  const double start = pi / 3.0;
  for (const double spin : {2.0, -1.0}) {
    expect_break(
        [&](StepSettings step) {
          return bob(step, spin > 0.0 ? upright : turned, {std::sin(start), -std::cos(start), 0.0},
                     {0.0, 0.0, spin * std::sin(start)}, 1.9 * g);
        },
        IntegratorKind::rattle, swing_time(start, spin, 1.9 * g), 0.0, 10.0);
  }
}

/// A drum of 0.5 m winds up a row of weights of 1 kg over a wheel with J / r^2 = 1 kg. Its speed
/// grows as 1/2 jerk t^2 [rad/s], so the weights have the acceleration 0.5 m x jerk x t.
test::Machine winch(StepSettings step, double jerk, double side, int row, double breaking) {
  test::Machine m;
  m.model.step = step;
  m.model.gravity = test::down;
  BodyDef drum = test::wheel("drum", {-3.0 * side, 0.0, 0.0}, 0.5, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_interpolation = Interpolation::cubic;
  for (const double time : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    drum.drive_times.push_back(time);
    drum.drive_values.push_back(side * 0.5 * jerk * time * time);
  }
  const BodyId drawing = m.model.add(drum);
  const BodyId over = m.model.add(test::wheel("wheel", Vector3::Zero(), 0.5, 0.25));
  const Winding winding = side > 0.0 ? test::right : test::left;
  auto stored = test::roll(drawing, winding);
  stored->stored_length = 1.0;
  for (int k = 0; k < row; ++k) {
    const std::string number = std::to_string(k);
    const BodyId load =
        m.model.add(test::weight("load " + number, {0.5 * side, -2.0 - k, 0.0}, 1.0));
    const BodyId above{load.index - 1};
    m.cables.push_back(k == 0 ? cable("rope", {stored, test::roll(over, winding), attach(load)})
                              : cable("rope " + number, {attach(above), attach(load)}));
  }
  for (CableDef& rope : m.cables) rope.breaking_tension = breaking;
  return m;
}

TEST(RigidBreak, ARopeOfAWinchThatSpeedsUpBreaksAtTheInstantOfItsBreakingTension) {
  // Between drum and wheel T = n g + (n + 1 kg) a. All other ropes pull less. Drives prescribe the
  // motion, so `xpbd` is of second order, too.
  constexpr double jerk = 10.0;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int row : {1, 3}) {
      for (const double side : {1.0, -1.0}) {
        const double breaking = row * g + (row + 1) * 2.345;
        expect_break([&](StepSettings step) { return winch(step, jerk, side, row, breaking); },
                     integrator, 2.345 / (0.5 * jerk), 0.0, 1.0);
      }
    }
  }
}

TEST(RigidBreak, ARopeOverAWheelWithInertiaBreaksAtTheInstantOfItsBreakingTension) {
  // An Atwood machine of 1 kg and 2 kg over J / r^2 = 1 kg, whose lighter weight draws at a spring k:
  // x'' = a cos wt with a = g / 4 and w^2 = k / 4 kg. The heavier side has T = 2 kg (g - x''), which
  // is more than the other side while cos wt > 0.
  constexpr double stiffness = 100.0;
  const double rate = std::sqrt(stiffness / 4.0);
  const double breaking = 2.0 * (g - 0.25 * g * std::cos(1.2));
  const auto machine = [&](StepSettings step) {
    test::Machine m = test::Atwood{1.0, 2.0, 0.25, 0.0625, 3.0}.machine();
    m.model.step = step;
    m.cables[0].breaking_tension = breaking;
    m.cables.push_back(
        cable("spring", {attach(BodyId::world(), {-0.25, -5.0, 0.0}), attach(BodyId{1})}));
    m.cables[1].compliance = 1.0 / stiffness;
    return m;
  };
  expect_break(machine, IntegratorKind::rattle, 1.2 / rate, 0.0, 10.0);
  // The weights of `xpbd` are ahead by half a substep, and implicit Euler damps as much.
  expect_break(machine, IntegratorKind::xpbd, 1.2 / rate, 1.0, 0.0);
}

TEST(RigidBreak, ARopeBreaksAtTheInstantAtWhichAnotherOneIsCut) {
  // Two ropes hold a weight. The first one is cut within a substep, and the second one has the whole
  // weight at once: one that bears 0.75 of the weight breaks at this instant.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double cut : {0.1, 0.1 + 0.3 * frame_time, 0.1 + 1e-5}) {
      for (const double share : {0.75, 1.25}) {
        test::Machine m;
        m.model.gravity = test::down;
        m.model.step = test::direct_settings(integrator, frame_time, 2);
        const BodyId load = m.model.add(test::weight("load", {0.0, -1.0, 0.0}, 1.0));
        for (const char* name : {"first", "second"}) {
          m.cables.push_back(cable(name, {attach(BodyId::world()), attach(load)}));
        }
        m.cables[0].cut_time = cut;
        m.cables[1].breaking_tension = share * g;
        Simulation s = test::start(m);
        for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
        const std::vector<CableEvent>& events = s.cables->events();
        ASSERT_EQ(events.size(), share < 1.0 ? 2U : 1U);
        // No part of a substep is shorter than 1e-4 of it.
        if (share < 1.0) {
          EXPECT_NEAR(events[1].time, cut, 2e-4 * frame_time);
        }
      }
    }
  }
}

TEST(RigidBreak, AnInstantWithinASubstepBreaksNoRopeThatTurnsAVelocity) {
  // The bob has at most 2 m g. Another rope is cut beside it, at many places of a substep.
  const double start = pi / 3.0;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double cut : {0.3 + 1e-5, 0.3 + 0.1 * frame_time, 0.3 + 0.4 * frame_time}) {
      test::Machine m = bob(test::direct_settings(integrator, frame_time, 1), upright,
                            {std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(), 2.02 * g);
      const BodyId beside = m.model.add(test::weight("beside", {3.0, -1.0, 0.0}, 1.0));
      m.cables.push_back(
          cable("beside", {attach(BodyId::world(), {3.0, 0.0, 0.0}), attach(beside)}));
      m.cables[1].cut_time = cut;
      Simulation s = test::start(m);
      for (int i = 0; i < 120; ++i) ASSERT_TRUE(s.world.step().ok());
      EXPECT_EQ(s.cables->events().size(), 1U) << cut;
    }
  }
}

/// Draws a body with c t, in each substep with the mean, as loads of scenes do.
class RampingForce final : public StepActor {
 public:
  RampingForce(World& world, double slope) : world_(world), slope_(slope) {}
  void act(bool /*begins*/) override {
    const StepSettings& step = world_.model().step;
    set(world_.state().time + 0.5 * step.dt / step.substeps, force_);
    EXPECT_TRUE(world_.set_force({0}, force_).empty());
  }
  void set_loads_now(Controls& controls) override {
    ForceControl now = *controls.forces.find(0);
    PointForce force;
    set(world_.state().time, force);
    now.force = force.force;
    controls.forces.put(0, 1, now);
  }

 private:
  void set(double time, PointForce& force) const { force.force = {0.0, -slope_ * time, 0.0}; }

  World& world_;
  double slope_;
  PointForce force_;
};

TEST(RigidBreak, ALoadOverTimeBreaksARopeAtTheInstantOfItsBreakingTension) {
  // A weight of 1 kg hangs on a rope: T = g + 10 N/s t.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 4, 16}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::direct_settings(integrator, frame_time, substeps);
      const BodyId load = m.model.add(test::weight("load", {0.0, -1.0, 0.0}, 1.0));
      m.cables.push_back(cable("rope", {attach(BodyId::world()), attach(load)}));
      m.cables[0].breaking_tension = g + 4.69;
      Simulation s = test::start(m);
      RampingForce force(s.world, 10.0);
      for (int i = 0; i < 40; ++i) ASSERT_TRUE(s.world.step({}, &force).ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      EXPECT_NEAR(s.cables->events()[0].time, 0.469, 2e-6);
    }
  }
}

TEST(RigidBreak, AHitAcrossARopeBreaksItByTheMotionAfterIt) {
  // A shot of `mass` meets a bob of 1 kg that hangs at rest and stays with it: the bob goes on with u
  // = v mass / (1 kg + mass), and its rope of 1 m has the tension g + u^2 / 1 m and less. One that
  // bears 4 % more holds, however the impact lies in the substep; one that bears 4 % less breaks.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {2, 4, 16, 64}) {
      for (const auto& [away, mass] : {std::pair(0.62, 1.0), {0.5, 0.3}, {0.77, 4.0}}) {
        constexpr double speed = 6.0;
        const double after = speed * mass / (1.0 + mass);
        for (const double share : {0.96, 1.04}) {
          test::Machine m = bob(test::direct_settings(integrator, frame_time, substeps), upright,
                                {0.0, -1.0, 0.0}, Vector3::Zero(), share * (g + after * after));
          BodyDef shot = test::lump("shot", {-away, -1.0, 0.0}, mass);
          shot.velocity = {speed, 0.0, 0.0};
          shot.force = {0.0, mass * g, 0.0};
          const BodyId flying = m.model.add(shot);
          for (const BodyId body : {BodyId{0}, flying}) {
            m.model.bodies[static_cast<std::size_t>(body.index)].shapes.assign(
                1, {test::sphere_of(0.05)});
            m.model.colliders.emplace_back().body = body;
          }
          Simulation s = test::start(m);
          for (int i = 0; i < 30; ++i) ASSERT_TRUE(s.world.step().ok());
          EXPECT_EQ(s.cables->events().size(), share < 1.0 ? 1U : 0U)
              << substeps << ' ' << mass << ' ' << share;
        }
      }
    }
  }
}

TEST(RigidBreak, AJerkBreaksARope) {
  // A weight falls 0.5 m into its rope: 3.1 N s, of which `xpbd` gives the rope at least half in one
  // substep of 1/60 s, as 94 N, and no integrator more than 188 N and the weight.
  const double fall = std::sqrt(2.0 * 0.5 / g);
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double breaking : {90.0, 250.0}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::direct_settings(integrator, frame_time, 1);
      const BodyId load = m.model.add(test::weight("load", {0.0, -1.0, 0.0}, 1.0));
      m.cables.push_back(cable("rope", {attach(BodyId::world()), attach(load)}));
      m.cables[0].rest_lengths = {1.5};
      m.cables[0].breaking_tension = breaking;
      Simulation s = test::start(m);
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      const bool breaks = breaking < 94.0;
      ASSERT_EQ(s.cables->events().size(), breaks ? 1U : 0U);
      if (breaks) {
        EXPECT_NEAR(s.cables->events()[0].time, fall, 1.5 * frame_time);
      }
    }
  }
}

TEST(RigidBreak, ATrialLeavesNoTraceInTheState) {
  // A rope that could break but does not moves as one that cannot, bit for bit, and a run that is
  // saved and restored breaks at the same time.
  const double start = pi / 3.0;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const auto machine = [&](double breaking) {
      return bob(test::direct_settings(integrator, frame_time, 2), turned,
                 {std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(), breaking);
    };
    test::Machine unbreakable = machine(1.0);
    unbreakable.cables[0].breaking_tension.reset();
    Simulation one = test::start(machine(1e3));
    Simulation other = test::start(unbreakable);
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(one.world.step().ok() && other.world.step().ok());
      ASSERT_EQ(hash(one.world.state()), hash(other.world.state()));
    }
    Simulation whole = test::start(machine(1.7 * g));
    Simulation again = test::start(machine(1.7 * g));
    for (int i = 0; i < 40; ++i) {
      ASSERT_TRUE(again.world.restore(whole.world.state()).empty());
      ASSERT_TRUE(whole.world.step().ok() && again.world.step().ok());
      ASSERT_EQ(hash(whole.world.state()), hash(again.world.state()));
    }
    EXPECT_EQ(whole.cables->events().size(), 1U);
  }
}

TEST(RigidBreak, ARopeBesideARopeWithInertiaBreaksAtTheInstantOfItsBreakingTension) {
  const double start = pi / 3.0;
  const auto machine = [&](StepSettings step) {
    test::Machine m =
        bob(step, upright, {std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(), 1.8 * g);
    const BodyId ballast = m.model.add(test::weight("ballast", {3.0, -2.0, 0.0}, 10.0));
    CableDef heavy = cable("heavy", {attach(BodyId::world(), {3.0, 0.0, 0.0}), attach(ballast)});
    heavy.linear_density = 1.0;
    heavy.axial_stiffness = 1e6;
    heavy.axial_inertia = true;
    heavy.pretension = 11.0 * g;
    m.cables.push_back(heavy);
    return m;
  };
  const double time = swing_time(start, 0.0, 1.8 * g);
  expect_break(machine, IntegratorKind::rattle, time, 0.0, 10.0);
  expect_break(machine, IntegratorKind::xpbd, time, 3.0, 0.0);
}

TEST(RigidBreak, AnInstantWithoutItsForcesIsTold) {
  // A hand draws the rope of a load on a rail further than the rope reaches: no motion is possible, and
  // no trial.
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::xpbd, frame_time, 2);
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {0.0, 1.0, 0.0};
  hand.velocity = {0.0, 1.0, 0.0};
  BodyDef load = test::weight("load", {1.5, 0.0, 0.0}, 1.0);
  load.axis = Vector3::UnitX();
  const BodyId drawing = m.model.add(hand);
  m.cables.push_back(cable("rope", {attach(drawing), attach(m.model.add(load))}));
  m.cables[0].breaking_tension = 1e12;
  Simulation s = test::start(m);
  std::int64_t before = 0;
  StepStatistics beyond;
  while (s.world.state().time < 1.2) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    if (s.world.state().time < 0.7) before += report.statistics.unknown_forces;
    beyond.unknown_forces += report.statistics.unknown_forces;
  }
  EXPECT_EQ(before, 0);
  EXPECT_GT(beyond.unknown_forces, 0);
  std::vector<Warning> warnings;
  append_solver_warnings(beyond, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "unknown_forces");
}

TEST(RigidBreak, ARunWithAToleranceBreaksAtTheInstantOfTheBreakingTension) {
  const double start = pi / 3.0;
  test::Machine m = bob(test::direct_settings(IntegratorKind::rattle, frame_time), turned,
                        {std::sin(start), -std::cos(start), 0.0}, Vector3::Zero(), 1.8 * g);
  m.model.step.tolerance = 1e-5;
  // A place that is off by the tolerance, at 2.8 m/s, and its error in the speed.
  EXPECT_NEAR(break_time(m), swing_time(start, 0.0, 1.8 * g), 5e-5);
}

}  // namespace
}  // namespace sheave
