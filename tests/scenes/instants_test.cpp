// What acts at a time or at a condition acts at its own instant, wherever in a substep that is
// (engine/instants.h): against closed forms of the motion before and after.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/support/combinations.h"

namespace sheave::test {
namespace {

using testing::IsEmpty;

constexpr std::array<double, 3> step_lengths{1.0 / 60.0, 0.01, 0.005};
constexpr std::array<int, 6> substep_counts{1, 2, 3, 4, 8, 64};

struct InstantSteps {
  double dt = 0.01;
  int substeps = 1;
  Combination method{};
  [[nodiscard]] double h() const { return dt / substeps; }
  [[nodiscard]] std::string text() const {
    return fmt::format(R"({{"dt": {}, "substeps": {}, "solver": "{}", "integrator": "{}"}})", dt,
                       substeps, method.solver == SolverKind::direct ? "direct" : "gauss-seidel",
                       method.rattle() ? "rattle" : "xpbd");
  }
};

template <class Check>
void for_all_instant_steps(const Check& check) {
  for (const double dt : step_lengths) {
    for (const int substeps : substep_counts) {
      for (const Combination& method : combinations) {
        const InstantSteps steps{dt, substeps, method};
        SCOPED_TRACE(steps.text());
        check(steps);
      }
    }
  }
}

Simulation start_instants(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

void run_instants(Simulation& simulation, double time) {
  const double dt = simulation.world.model().step.dt;
  while (simulation.world.state().time < time - 0.5 * dt) {
    if (!simulation.step().ok()) throw std::runtime_error("it diverges");
  }
}

double acted(const Simulation& simulation, std::size_t trigger) {
  const auto* supervisor = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
  return supervisor->acted_at(simulation.world.state()).at(trigger).value_or(-1.0);
}

/// A weight of 2 kg that hangs 1 m below a ring, `of_rope` and what is told beside.
std::string hung_scene(const InstantSteps& steps, const std::string& of_rope,
                       const std::string& rest) {
  return R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1, "step": )" +
         steps.text() + R"(, "bodies": [{"name": "weight", "mobility": "slider", "axis": [0, 1, 0],
           "mass": 2, "position": [0, -1, 0]}],
         "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "world"},
           {"type": "attachment", "body": "weight"}])" +
         of_rope + "}]" + rest + "}";
}

/// A weight that moves along y from 0 at `speed` under `gravity`.
std::string thrown_scene(const InstantSteps& steps, double speed, double gravity,
                         const std::string& triggers) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, {}, 0], "duration": 1, "step": {},
           "bodies": [{{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
             "velocity": [0, {}, 0]}}], "triggers": [{}]}})",
      gravity, steps.text(), speed, triggers);
}

/// Rounding of speeds: in each substep of a second that of a position below 4 m, 2.2e-16 m, over
/// its length.
double speed_rounding(const InstantSteps& steps) {
  return 1e-10 + 2.3e-16 / (steps.h() * steps.h());
}

/// How well an instant of a condition is known: the search ends within 1e-9 of a substep, speeds
/// are rounded as above at 10 m/s2, positions less than 1e-11 s at some metres a second, and near
/// the ends of a substep there is no room for a part.
double instant_tolerance(const InstantSteps& steps, double expected) {
  StepSettings settings;
  settings.dt = steps.dt;
  settings.substeps = steps.substeps;
  settings.solver = steps.method.solver;
  const double slop = instant_slop(settings);
  const double after = expected - std::floor(expected / steps.h()) * steps.h();
  const bool at_end = after < slop || steps.h() - after < slop;
  return (at_end ? slop : 1e-9 * steps.h()) + 0.1 * speed_rounding(steps) + 1e-11;
}

// Cut off at 0.3137 s, v = -g (t - 0.3137), and y falls by g (t - 0.3137)^2 / 2; with `xpbd` by g
// h^2 / 2 more in each substep, none of which is longer than 1.5 h. Where cuts were made at the
// ends of substeps, the speed was wrong by up to 0.06 m/s.
TEST(Instants, ALoadFallsFromTheInstantOfTheCut) {
  constexpr double at = 0.3137;
  const std::string trigger = fmt::format(
      R"(, "triggers": [{{"name": "snip", "at": {}, "action": "cut", "target": "rope"}}])", at);
  for_all_instant_steps([&](const InstantSteps& steps) {
    for (const bool by_trigger : {true, false}) {
      Simulation simulation = start_instants(
          by_trigger ? hung_scene(steps, "", trigger)
                     : hung_scene(steps, fmt::format(R"(, "cut_time": {})", at), ""));
      run_instants(simulation, 1.0);
      const double fallen = simulation.world.state().time - at;
      EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -10.0 * fallen, speed_rounding(steps));
      const double more = -1.0 - 5.0 * fallen * fallen - simulation.world.position(BodyId{0}).y();
      EXPECT_GE(more, -speed_rounding(steps));
      EXPECT_LE(more,
                steps.method.rattle() ? speed_rounding(steps) : 5.0 * fallen * 1.5 * steps.h());
      ASSERT_EQ(simulation.cables->events().size(), 1U);
      EXPECT_EQ(simulation.cables->events()[0].time, at);
      EXPECT_EQ(by_trigger ? acted(simulation, 0) : at, at);
    }
  });
}

// From the first instant on, as one that is cut between two substeps.
TEST(Instants, ALoadMayBeCutOffAtTheStart) {
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation = start_instants(hung_scene(steps, R"(, "cut_time": 0)", ""));
    run_instants(simulation, 0.2);
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -10.0 * simulation.world.state().time,
                speed_rounding(steps));
  });
}

// v = -g t passes -3 m/s at 0.3 s, with both integrators. The search ends within 1e-9 of a substep
// behind that; no part is shorter than the slop.
TEST(Instants, ASpeedIsFoundAtItsInstant) {
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation = start_instants(
        thrown_scene(steps, 0.013, -10.0,
                     R"({"name": "fast", "quantity": "weight.vy", "below": -3, "action": "set",
            "target": "gravity.y", "value": 0})"));
    run_instants(simulation, 1.0);
    EXPECT_NEAR(acted(simulation, 0), 0.3013, instant_tolerance(steps, 0.3013));
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -10.0 * acted(simulation, 0) + 0.013,
                speed_rounding(steps));
  });
}

// Dropped, it is 0.5 m lower at sqrt(0.1) s with `rattle`. With `xpbd` it falls by g (t^2 + sum of
// h_k^2) / 2: after n substeps and a part s, (n h + s)^2 + n h^2 + s^2 = 0.1, or s^2 + n h s + (n
// (n + 1) h^2 - 0.1) / 2 = 0.
TEST(Instants, AHeightIsFoundAtItsInstant) {
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation = start_instants(
        thrown_scene(steps, 0.0, -10.0,
                     R"({"name": "low", "quantity": "weight.y", "below": -0.5, "action": "set",
            "target": "gravity.y", "value": 0})"));
    run_instants(simulation, 1.0);
    double expected = std::sqrt(0.1);
    if (!steps.method.rattle()) {
      const double h = steps.h();
      double n = 0.0;
      while ((n + 1.0) * (n + 2.0) * h * h < 0.1) ++n;
      const double c = 0.5 * (n * (n + 1.0) * h * h - 0.1);
      expected = n * h + 0.5 * (std::sqrt(n * n * h * h - 4.0 * c) - n * h);
    }
    EXPECT_NEAR(acted(simulation, 0), expected, instant_tolerance(steps, expected));
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -10.0 * acted(simulation, 0),
                speed_rounding(steps));
  });
}

// At 1 m/s it is sqrt(0.37^2 - 0.2^2) m below its start when its distance from a point 0.2 m beside
// the start is 0.37 m. The distance is taken in the unit of y, so that 0.2 is a length.
TEST(Instants, AnExpressionIsFoundAtItsInstant) {
  const double expected = std::sqrt(0.37 * 0.37 - 0.2 * 0.2);
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation = start_instants(
        thrown_scene(steps, -1.0, 0.0,
                     R"j({"name": "far", "quantity": "hypot(weight.y, 0.2)", "above": 0.37,
            "action": "set", "target": "weight.force_y", "value": 20})j"));
    run_instants(simulation, 0.5);
    EXPECT_NEAR(acted(simulation, 0), expected, 2.0 * instant_tolerance(steps, expected))
        << "the distance grows with 0.84 of the speed";
    // 20 N on 2 kg from that instant on.
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(),
                -1.0 + 10.0 * (0.5 - acted(simulation, 0)), speed_rounding(steps));
  });
}

// On a spring of c = 1e-3 m/N, y = -1 - m g c (1 - cos w t) with w = 1 / sqrt(m c) is half way down
// at t = pi / (3 w). The midpoint rule of `rattle` is of second order: four times nearer with half
// of the substep, within a tenth.
TEST(Instants, ConvergeWithTheOrderOfTheMotion) {
  constexpr double mass = 2.0;
  constexpr double compliance = 1e-3;
  const double expected = pi / 3.0 * std::sqrt(mass * compliance);
  double before = 0.0;
  for (const int substeps : {2, 4, 8, 16}) {
    Simulation simulation = start_instants(hung_scene(
        {0.01, substeps, {SolverKind::direct, IntegratorKind::rattle}}, R"(, "compliance": 1e-3)",
        R"(, "triggers": [{"name": "half", "quantity": "weight.y", "below": -1.01, "action": "set",
             "target": "gravity.y", "value": 0}])"));
    run_instants(simulation, 0.1);
    const double error = std::abs(acted(simulation, 0) - expected);
    EXPECT_LT(error, 1e-2 * expected);
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 4.0, 0.4) << substeps;
    }
    before = error;
  }
}

// At 1 m/s without gravity it passes -0.3037 m at 0.3037 s, where gravity of 10 m/s2 sets in; then
// -0.3111 m after u with u + 5 u^2 = 0.0074 (`xpbd`, if in one substep: u + 10 u^2), where it turns
// round; and at 0.317 s it ceases. All that is within a substep of 20 ms, and in others elsewhere.
TEST(Instants, SeveralAreFoundInOneSubstep) {
  for (const int substeps : {1, 2, 4, 64}) {
    for (const Combination& method : combinations) {
      const InstantSteps steps{0.02, substeps, method};
      SCOPED_TRACE(steps.text());
      Simulation simulation = start_instants(
          thrown_scene(steps, -1.0, 0.0,
                       R"({"name": "third", "at": 0.317, "action": "clear", "target": "gravity.y"},
             {"name": "second", "quantity": "weight.y", "below": -0.3111, "action": "set",
              "target": "gravity.y", "value": 5},
             {"name": "first", "quantity": "weight.y", "below": -0.3037, "action": "set",
              "target": "gravity.y", "value": -10})"));
      run_instants(simulation, 0.4);
      const double first = acted(simulation, 2);
      const double second = acted(simulation, 1);
      EXPECT_NEAR(first, 0.3037, instant_tolerance(steps, 0.3037));
      if (method.rattle() || substeps == 1) {
        const double half = method.rattle() ? 5.0 : 10.0;
        const double u = (std::sqrt(1.0 + 4.0 * half * 0.0074) - 1.0) / (2.0 * half);
        EXPECT_NEAR(second - first, u, 2e-9 * steps.h() + 1e-12);
      }
      EXPECT_EQ(acted(simulation, 0), 0.317);
      EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(),
                  -1.0 - 10.0 * (second - first) + 5.0 * (0.317 - second), speed_rounding(steps));
    }
  }
}

// The rope's tension is 0 as soon as it is cut, and what waits for that acts at the same instant.
TEST(Instants, OneTriggerFiresAnother) {
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation = start_instants(hung_scene(steps, "", R"(, "triggers": [
          {"name": "slack", "quantity": "rope.0.tension", "below": 5, "action": "set",
           "target": "weight.force_y", "value": 20},
          {"name": "snip", "at": 0.3137, "action": "cut", "target": "rope"}])"));
    run_instants(simulation, 0.5);
    EXPECT_EQ(acted(simulation, 1), 0.3137);
    EXPECT_EQ(acted(simulation, 0), 0.3137);
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), 0.0, speed_rounding(steps));
  });
}

const char* const all_kinds = R"(, "triggers": [
    {"name": "snip", "at": 0.3137, "action": "cut", "target": "rope"},
    {"name": "low", "quantity": "weight.y", "below": -1.05, "action": "set",
     "target": "gravity.y", "value": 20, "repeats": true},
    {"name": "high", "quantity": "weight.y", "above": -0.99, "action": "set",
     "target": "gravity.y", "value": -15, "repeats": true}],
  "controllers": [{"type": "pid", "name": "servo", "measures": "weight.vy",
    "control": "weight.force_y", "setpoint": 0, "proportional": 1, "sample_time": 0.0137}])";

// To the last bit from any state on the way, and after steps that were stopped and made again.
TEST(Instants, AreTheSameFromASavedState) {
  for (const Combination& method : combinations) {
    const InstantSteps steps{0.01, 3, method};
    SCOPED_TRACE(steps.text());
    const std::string scene = hung_scene(steps, "", all_kinds);
    Simulation whole = start_instants(scene);
    run_instants(whole, 1.0);
    EXPECT_GT(acted(whole, 1), 0.4);
    EXPECT_GT(acted(whole, 2), 0.4);
    for (const double time : {0.3, 0.31, 0.32, 0.41, 0.5}) {
      Simulation first = start_instants(scene);
      run_instants(first, time);
      const Result<State> saved = state_from_bytes(to_bytes(first.world.state()));
      ASSERT_TRUE(saved);
      Simulation rest = start_instants(scene);
      ASSERT_THAT(rest.world.restore(*saved), IsEmpty());
      int asked = 0;
      while (rest.world.state().time < 1.0 - 0.005) {
        ++asked;
        // Every other step is stopped somewhere, and is none.
        int left = asked % 2 == 0 ? -1 : asked % 23;
        (void)rest.step([&] { return left-- == 0; });
      }
      EXPECT_EQ(hash(rest.world.state()), hash(whole.world.state())) << time;
    }
  }
}

std::string switching_scene(const std::string& damping) {
  const InstantSteps steps{0.01, 4, {SolverKind::direct, IntegratorKind::rattle}};
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {},
           "bodies": [{{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 2{}}}],
           "triggers": [
             {{"name": "low", "quantity": "weight.y", "below": -0.1, "repeats": true,
               "action": "set", "target": "gravity.y", "value": 100}},
             {{"name": "high", "quantity": "weight.y", "above": -0.1, "repeats": true,
               "action": "set", "target": "gravity.y", "value": -100}}]}})",
      steps.text(), damping);
}

// Two triggers pull it back to -0.1 m with 100 m/s2: v^2 / 2 + 100 |y + 0.1| stays what it was, 10
// m2/s2. Each switch is 1e-9 of a substep late at 4.5 m/s, or where there is no room 1e-4 of one.
TEST(Instants, SwitchedForcesKeepTheEnergy) {
  Simulation simulation = start_instants(switching_scene(""));
  run_instants(simulation, 1.0);
  const double v = simulation.world.velocity(BodyId{0}).y();
  const double y = simulation.world.position(BodyId{0}).y();
  EXPECT_NEAR(0.5 * v * v + 100.0 * std::abs(y + 0.1), 10.0, 20.0 * 200.0 * 4.5 * 1e-4 * 0.0025);
}

// With drag of 10/s the switches come ever faster. Four in a substep are located, so there is an
// end to it; what it overshoots then is of the size of 100 m/s2 h^2.
TEST(Instants, RepeatedSwitchesInASubstepAreBounded) {
  Simulation simulation = start_instants(switching_scene(R"(, "damping": 20)"));
  run_instants(simulation, 1.5);
  EXPECT_NEAR(simulation.world.position(BodyId{0}).y(), -0.1, 5.0 * 100.0 * 0.0025 * 0.0025);
}

// A torque that holds from sample to sample turns a rotor by parabolas, so at common multiples of
// step and sample time `rattle` is where the recursion of the samples is, though most of them lie
// within substeps.
TEST(Instants, ControllersActAtTheirSampleTimes) {
  for (const int substeps : {1, 2, 4}) {
    const InstantSteps steps{0.02, substeps, {SolverKind::direct, IntegratorKind::rattle}};
    SCOPED_TRACE(steps.text());
    constexpr double interval = 0.023;
    Simulation simulation = start_instants(fmt::format(
        R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {},
             "bodies": [{{"name": "rotor", "mobility": "rotor", "mass": 1, "spin_inertia": 0.5,
               "drive": "torque", "drive_values": [0]}}],
             "controllers": [{{"type": "pid", "name": "servo", "measures": "rotor.angle",
               "control": "rotor.drive", "setpoint": 1, "proportional": 2, "sample_time": {}}}]}})",
        steps.text(), interval));
    double angle = 0.0;
    double speed = 0.0;
    for (int k = 1; k <= 20; ++k) {
      const double acceleration = 2.0 * (1.0 - angle) / 0.5;
      angle += interval * speed + 0.5 * interval * interval * acceleration;
      speed += interval * acceleration;
    }
    run_instants(simulation, 20 * interval);
    EXPECT_NEAR(simulation.world.state().bodies[0].angle, angle, 1e-11);
  }
}

// A speed v that a trigger sets is there at its instant t0, so that the driven part has moved by v (t - t0).
// (A ramp over a substep was short of v h / 2.) The drive of a joint, of a drum and of a feed; the
// load of the feed is drawn up, so its rope is taut.
TEST(Instants, ASpeedIsSetAtItsInstant) {
  constexpr double at = 0.3137;
  for_all_instant_steps([&](const InstantSteps& steps) {
    const std::string drives = fmt::format(
        R"({{"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1, "step": {},
             "bodies": [
               {{"name": "drum", "mobility": "rotor", "mass": 1, "drive": "speed",
                 "drive_values": [0], "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}},
               {{"name": "hung", "mobility": "slider", "axis": [0, 1, 0], "mass": 1,
                 "position": [-0.2, -2, 0]}},
               {{"name": "fed", "mobility": "slider", "axis": [0, 1, 0], "mass": 1,
                 "position": [1, -2, 0]}}],
             "cables": [
               {{"name": "hoist", "links": [{{"type": "spool", "body": "drum",
                 "winding": "counter-clockwise", "stored_length": 1}},
                 {{"type": "attachment", "body": "hung"}}]}},
               {{"name": "line", "links": [{{"type": "attachment", "body": "world",
                 "point": [1, 0, 0], "feed_speed": 0}}, {{"type": "attachment", "body": "fed"}}]}}],
             "triggers": [
               {{"name": "turn", "at": {}, "action": "set", "target": "drum.drive", "value": -3}},
               {{"name": "haul", "at": {}, "action": "set", "target": "line.link0.feed_speed",
                 "value": -0.5}}]}})",
        steps.text(), at, at);
    Simulation simulation = start_instants(drives);
    run_instants(simulation, 1.0);
    const double since = simulation.world.state().time - at;
    // Rows are left at 1e-10 of the scene.
    EXPECT_NEAR(simulation.world.state().bodies[0].angle, -3.0 * since, 1e-12);
    EXPECT_NEAR(simulation.world.position(BodyId{1}).y(), -2.0 + 0.6 * since, 1e-8);
    EXPECT_NEAR(simulation.world.position(BodyId{2}).y(), -2.0 + 0.5 * since, 1e-8);
  });
}

// It ends with the step in which it happens, and knows when that was.
TEST(Instants, AStopEndsItsStep) {
  for_all_instant_steps([&](const InstantSteps& steps) {
    Simulation simulation =
        start_instants(thrown_scene(steps, -1.0, 0.0,
                                    R"({"name": "there", "quantity": "weight.y", "below": -0.3137,
                         "action": "stop"})"));
    while (!simulation.supervisor->has_stopped(simulation.world.state())) {
      ASSERT_TRUE(simulation.step().ok());
    }
    EXPECT_NEAR(acted(simulation, 0), 0.3137, instant_tolerance(steps, 0.3137));
    EXPECT_LE(simulation.world.state().time, 0.3137 + steps.dt);
  });
}

}  // namespace
}  // namespace sheave::test
