// Controllers and triggers of scenes: against the recursions and closed forms that they are made
// of.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A rotor of 0.5 kg m2 that a torque drives. `rest`: the other keys of the scene.
std::string rotor_scene(const std::string& rest, const std::string& of_rotor = "",
                        const std::string& step = R"({"dt": 0.005, "substeps": 1})") {
  return R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 10, "step": )" + step +
         R"(, "bodies": [{"name": "rotor", "mobility": "rotor", "mass": 1, "spin_inertia": 0.5,
              "drive": "torque", "drive_values": [0])" +
         of_rotor + "}], " + rest + "}";
}

Simulation start_scene(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> texts;
  for (const SceneError& error : load_scene_text(text, "s.json").errors) {
    texts.push_back(to_string(error));
  }
  return texts;
}

void run_scene(Simulation& simulation, double time) {
  const double dt = simulation.world.model().step.dt;
  while (simulation.world.state().time < time - 0.5 * dt) {
    if (!simulation.step().ok()) throw std::runtime_error("it diverges");
  }
}

/// The controller of the documentation, over again.
struct Pid {
  double p = 0.0, i = 0.0, d = 0.0, filter = 0.0, limit = 0.0;
  double sum = 0.0, before = 0.0, slope = 0.0;
  bool first = true;
  double operator()(double error, double interval) {
    slope = first ? 0.0 : (filter * slope + d * (error - before)) / (filter + interval);
    first = false;
    before = error;
    const double wanted = p * error + sum + slope;
    const double given = std::min(std::max(wanted, -limit), limit);
    const double growth = i * error * interval;
    if (!((wanted - given) * growth > 0.0)) sum += growth;
    return given;
  }
};

// A torque that holds from sample to sample moves a rotor by parabolas, which `rattle` follows
// exactly: so the loop is the recursion of its samples, at the limits, too.
TEST(Pid, IsTheRecursionOfItsSamples) {
  for (const double limit : {1e9, 3.0}) {
    Simulation simulation = start_scene(rotor_scene(fmt::format(
        R"("controllers": [{{"type": "pid", "name": "servo", "measures": "rotor.angle",
             "control": "rotor.drive", "setpoint": 1, "proportional": 8, "integral": 4,
             "derivative": 2, "derivative_filter": 0.03, "sample_time": 0.02,
             "lower": -{0}, "upper": {0}}}])",
        limit)));
    Pid pid{8.0, 4.0, 2.0, 0.03, limit};
    double angle = 0.0;
    double speed = 0.0;
    for (int k = 0; k < 100; ++k) {
      const double torque = pid(1.0 - angle, 0.02);
      angle += 0.02 * speed + 0.5 * 0.02 * 0.02 * torque / 0.5;
      speed += 0.02 * torque / 0.5;
      run_scene(simulation, 0.02 * (k + 1));
      ASSERT_NEAR(simulation.world.state().bodies[0].angle, angle, 1e-10) << k << ", " << limit;
    }
  }
}

// J x'' = P (1 - x) - D x' has the poles -1 +- 4.8990 i for J = 0.5, P = 12.5, D = 1: a step
// response with known peaks.
TEST(Pid, HasThePolesOfItsLinearLoop) {
  Simulation simulation = start_scene(rotor_scene(
      R"("controllers": [{"type": "pid", "name": "servo", "measures": "rotor.angle",
           "control": "rotor.drive", "setpoint": 1, "proportional": 12.5, "derivative": 1}])",
      "", R"({"dt": 0.0005, "substeps": 1})"));
  const double w = std::sqrt(24.0);
  std::vector<double> peaks;
  std::vector<double> times;
  double before = 0.0;
  double last = 0.0;
  while (simulation.world.state().time < 2.5) {
    ASSERT_TRUE(simulation.step().ok());
    const double angle = simulation.world.state().bodies[0].angle;
    if ((last - before) * (angle - last) < 0.0) {
      peaks.push_back(last - 1.0);
      times.push_back(simulation.world.state().time - 0.0005);
    }
    before = last;
    last = angle;
  }
  ASSERT_GE(peaks.size(), 3U);
  // From peak to trough half a period, and the decay e^(-pi / w). Samples hold for 0.5 ms: what is
  // 0.1 % of the pole's time.
  EXPECT_NEAR(times[1] - times[0], pi / w, 0.01 * pi / w);
  EXPECT_NEAR(std::log(std::abs(peaks[0] / peaks[1])) / (times[1] - times[0]), 1.0, 0.01);
  EXPECT_NEAR(peaks[0], std::exp(-pi / w), 0.01);
}

// Feed-forward alone: what the setpoint and its rate say.
TEST(Pid, FeedsForward) {
  Simulation simulation = start_scene(rotor_scene(
      R"("controllers": [{"type": "pid", "name": "servo", "measures": "rotor.wz",
           "control": "rotor.drive", "setpoint_times": [0, 1, 2], "setpoint_values": [0, 1, 4],
           "setpoint_interpolation": "cubic", "feed_forward": 0.5, "setpoint_gain": 2,
           "rate_gain": 3}])"));
  // Through three points goes t^2, whose mean rate until the next sample is 2 t + dt: u = 0.5 + 2
  // t^2 + 3 (2 t + dt), held from sample to sample.
  run_scene(simulation, 1.0);
  const auto u = [](double t) { return 0.5 + 2.0 * t * t + 3.0 * (2.0 * t + 0.005); };
  double speed = 0.0;
  for (int k = 0; k < 200; ++k) speed += 0.005 * u(0.005 * k) / 0.5;
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), speed, 1e-10);
}

// A rotor in drag c is switched between the torques 0 and 1: it runs up towards 1 / c and down
// towards 0 between two speeds, in times J / c ln((1 / c - low) / (1 / c - high)) and J / c ln(high
// / low).
TEST(BangBang, RunsBetweenItsThresholds) {
  Simulation simulation = start_scene(rotor_scene(
      R"("controllers": [{"type": "bang-bang", "name": "relay", "measures": "rotor.wz",
           "control": "rotor.drive", "setpoint": 2.5, "low": 0, "high": 1, "hysteresis": 1}])",
      R"(, "angular_damping": 0.2)", R"({"dt": 0.001, "substeps": 1})"));
  std::vector<double> turns;
  double before = 0.0;
  double last = 0.0;
  while (simulation.world.state().time < 10.0) {
    ASSERT_TRUE(simulation.step().ok());
    const double speed = simulation.world.angular_velocity(BodyId{0}).z();
    if ((last - before) * (speed - last) < 0.0) turns.push_back(simulation.world.state().time);
    before = last;
    last = speed;
  }
  ASSERT_GE(turns.size(), 4U);
  const double up = 0.5 / 0.2 * std::log((5.0 - 2.0) / (5.0 - 3.0));
  const double down = 0.5 / 0.2 * std::log(3.0 / 2.0);
  // It is looked at every millisecond.
  EXPECT_NEAR(turns[1] - turns[0], down, 0.003);
  EXPECT_NEAR(turns[2] - turns[1], up, 0.003);
}

const char* const follower = R"("controllers": [
  {"type": "pid", "name": "servo", "measures": "rotor.angle", "control": "rotor.drive",
   "setpoint_quantity": "t", "proportional": 30, "integral": 5, "derivative": 3, "sample_time": 0.013},
  {"type": "bang-bang", "name": "relay", "measures": "rotor.angle", "control": "gravity.y",
   "setpoint": 1, "low": -1, "high": 1, "on": false}],
 "triggers": [
  {"name": "late", "quantity": "rotor.angle", "above": 0.8, "action": "on", "target": "relay"},
  {"name": "slower", "at": 1.5, "action": "off", "target": "servo"},
  {"name": "push", "at": 1.7, "action": "set", "target": "rotor.drive", "value": 0.25}])";

// What they remember is part of the state: a run that is saved and loaded is the same to the last
// bit.
TEST(Supervisor, ReplaysFromASavedState) {
  Simulation whole = start_scene(rotor_scene(follower));
  run_scene(whole, 0.9);
  const Result<State> saved = state_from_bytes(to_bytes(whole.world.state()));
  ASSERT_TRUE(saved);
  EXPECT_EQ(hash(*saved), hash(whole.world.state()));
  run_scene(whole, 2.0);
  Simulation rest = start_scene(rotor_scene(follower));
  EXPECT_NE(hash(rest.world.state()), hash(*saved));
  ASSERT_THAT(rest.world.restore(*saved), IsEmpty());
  run_scene(rest, 2.0);
  EXPECT_EQ(hash(rest.world.state()), hash(whole.world.state()));
  // The memory is hashed, and belongs to this scene.
  State other = *saved;
  other.memory.back() += 1.0;
  EXPECT_NE(hash(other), hash(*saved));
  other.memory.pop_back();
  EXPECT_FALSE(rest.world.restore(other).empty());
}

// What no run leaves in the memory is refused, and changes nothing: flags are 0 or 1, counts are
// whole, nothing has been done in the future, and no number is infinite.
TEST(Supervisor, RefusesAMemoryThatIsNotItsOwn) {
  Simulation simulation = start_scene(rotor_scene(follower));
  run_scene(simulation, 0.9);
  const State good = simulation.world.state();
  const std::uint64_t before = hash(good);
  const auto fault = [&](std::size_t place, double value) {
    State bad = good;
    bad.memory[place] = value;
    const Errors errors = simulation.world.restore(bad);
    EXPECT_EQ(hash(simulation.world.state()), before);
    return errors.empty() ? std::string() : errors[0].message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // Stopped, refused; acted at and holds of three triggers; on, samples, sampled at and 3 numbers of
  // the first controller.
  for (const double value : {0.5, -1.0, 1e300, nan}) {
    for (const std::size_t flag : {0U, 3U, 5U, 7U, 8U}) EXPECT_NE(fault(flag, value), "") << flag;
    EXPECT_NE(fault(1, value), "");
  }
  for (const double time : {-2.0, 0.91, 1e300, nan}) {
    for (const std::size_t place : {2U, 4U, 6U, 10U}) EXPECT_NE(fault(place, time), "") << place;
  }
  EXPECT_NE(fault(9, -1.0), "");
  EXPECT_NE(fault(11, std::numeric_limits<double>::infinity()), "");
  EXPECT_THAT(fault(3, 2.0), testing::HasSubstr("trigger \"late\""));
  EXPECT_THAT(fault(8, 2.0), testing::HasSubstr("controller \"servo\""));
  EXPECT_THAT(simulation.world.restore(good), IsEmpty());
}

TEST(Supervisor, ActsAtEachSubstep) {
  // Twice the substeps at twice the step: the same samples, the same motion.
  const char* const servo = R"("controllers": [{"type": "pid", "name": "servo",
    "measures": "rotor.angle", "control": "rotor.drive", "setpoint": 1, "proportional": 8,
    "derivative": 1, "sample_time": 0.005}])";
  Simulation steps = start_scene(rotor_scene(servo));
  Simulation substeps = start_scene(rotor_scene(servo, "", R"({"dt": 0.01, "substeps": 2})"));
  run_scene(steps, 1.0);
  run_scene(substeps, 1.0);
  EXPECT_NEAR(steps.world.state().bodies[0].angle, substeps.world.state().bodies[0].angle, 1e-12);
}

/// A weight that hangs by a rope from a fixed ring, and one on a joint.
std::string hanging_scene(const std::string& triggers) {
  return R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 3,
    "step": {"dt": 0.01, "substeps": 1, "solver": "direct", "integrator": "rattle"},
    "bodies": [
      {"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]},
      {"name": "bar", "mass": 2, "inertia": [1, 1, 1], "position": [5, 0, 0]}],
    "joints": [{"type": "fixed", "name": "clamp", "body_b": "bar", "anchor": [5, 0, 0]}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "world"},
      {"type": "attachment", "body": "weight"}]}],
    "triggers": [)" +
         triggers + "]}";
}

TEST(Triggers, ReleaseAJoint) {
  Simulation simulation = start_scene(
      hanging_scene(R"({"name": "let go", "at": 0.5, "action": "release", "target": "clamp"})"));
  run_scene(simulation, 0.5);
  EXPECT_NEAR(simulation.world.position(BodyId{1}).y(), 0.0, 1e-12);
  run_scene(simulation, 1.0);
  EXPECT_NEAR(simulation.world.position(BodyId{1}).y(), -5.0 * 0.25, 1e-9) << "g t^2 / 2";
  EXPECT_NEAR(simulation.world.velocity(BodyId{1}).y(), -5.0, 1e-9);
  // Released it stays, in a world that starts from there, too.
  const State state = simulation.world.state();
  Simulation again = start_scene(
      hanging_scene(R"({"name": "let go", "at": 0.5, "action": "release", "target": "clamp"})"));
  ASSERT_THAT(again.world.restore(state), IsEmpty());
  run_scene(again, 1.5);
  EXPECT_NEAR(again.world.position(BodyId{1}).y(), -5.0, 1e-9);
}

// Released at 0.5 s, locked again 0.3 s later, 0.45 m lower, and once more; there it stays each
// time.
TEST(Triggers, LockAJointAgain) {
  const std::string scene = hanging_scene(
      R"({"name": "let go", "at": 0.5, "action": "release", "target": "clamp"},
         {"name": "catch", "at": 0.8, "action": "lock", "target": "clamp"},
         {"name": "again", "at": 1.1, "action": "release", "target": "clamp"},
         {"name": "deep", "quantity": "bar.y", "below": -0.9, "action": "lock", "target": "clamp"})");
  Simulation simulation = start_scene(scene);
  run_scene(simulation, 0.7);
  const Result<State> flying = state_from_bytes(to_bytes(simulation.world.state()));
  run_scene(simulation, 1.0);
  EXPECT_NEAR(simulation.world.position(BodyId{1}).y(), -0.45, 1e-9);
  EXPECT_NEAR(simulation.world.velocity(BodyId{1}).y(), 0.0, 1e-9);
  const Result<State> caught = state_from_bytes(to_bytes(simulation.world.state()));
  run_scene(simulation, 2.0);
  // From -0.45 to -0.9 m it takes 0.3 s, at 3 m/s; no part is shorter than 1e-4 of 10 ms.
  const double depth = simulation.world.position(BodyId{1}).y();
  EXPECT_NEAR(depth, -0.9, 3.0 * 1e-6 + 1e-9);
  EXPECT_NEAR(simulation.world.velocity(BodyId{1}).y(), 0.0, 1e-9);
  const auto* supervisor = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
  ASSERT_NE(supervisor, nullptr);
  EXPECT_EQ(supervisor->refusals(simulation.world.state()), 0);
  // To the last bit from any state on the way.
  for (const Result<State>& state : {flying, caught}) {
    Simulation rest = start_scene(scene);
    ASSERT_TRUE(state);
    ASSERT_THAT(rest.world.restore(*state), IsEmpty());
    run_scene(rest, 2.0);
    EXPECT_EQ(hash(rest.world.state()), hash(simulation.world.state()));
  }
}

// A brake is a drive to the speed 0 whose limit is set: 0 where it is open.
TEST(Triggers, ApplyABrake) {
  // J = 2 kg m2 at 3 rad/s against 4 N m for a second: 2 rad/s less.
  Simulation simulation =
      start_scene(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 3,
    "step": {"dt": 0.01, "substeps": 1, "solver": "direct", "integrator": "rattle"},
    "bodies": [{"name": "drum", "mass": 1, "inertia": [2, 2, 2], "angular_velocity": [0, 0, 3]}],
    "joints": [{"type": "hinge", "name": "brake", "body_b": "drum", "anchor": [0, 0, 0],
      "axis": [0, 0, 1], "drive": "speed", "drive_values": [0], "drive_limit": 0}],
    "triggers": [
      {"name": "apply", "at": 1, "action": "set", "target": "brake.drive_limit", "value": 4},
      {"name": "open", "at": 2, "action": "set", "target": "brake.drive_limit", "value": 0}]})");
  run_scene(simulation, 1.0);
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), 3.0, 1e-12);
  run_scene(simulation, 2.0);
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), 3.0 - 4.0 / 2.0, 1e-9);
  run_scene(simulation, 3.0);
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), 1.0, 1e-9);
}

TEST(Triggers, CutACable) {
  Simulation simulation =
      start_scene(hanging_scene(R"({"name": "snip", "at": 1, "action": "cut", "target": "rope"})"));
  run_scene(simulation, 1.0);
  EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), 0.0, 1e-12);
  run_scene(simulation, 2.0);
  EXPECT_TRUE(simulation.cable_reports()[0].cut);
  // It parts before the substep that begins then, and is told at that time.
  EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -10.0 * 1.0, 1e-9);
  ASSERT_EQ(simulation.cables->events().size(), 1U);
  EXPECT_EQ(simulation.cables->events()[0].kind, CableEvent::Kind::cut);
  EXPECT_NEAR(simulation.cables->events()[0].time, 1.0, 1e-12);
}

/// A weight that is let down with 1 m/s, and cut off once it is `way` lower.
std::string lowered_scene(double way) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 3,
    "step": {{"dt": 0.02, "substeps": 1, "solver": "direct", "integrator": "rattle"}},
    "bodies": [{{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
      "position": [0, -1, 0], "velocity": [0, -1, 0]}}],
    "cables": [{{"name": "rope", "links": [{{"type": "attachment", "body": "world", "feed_speed": 1}},
      {{"type": "attachment", "body": "weight"}}]}}],
    "triggers": [{{"name": "snip", "quantity": "weight.y", "below": {}, "action": "cut", "target": "rope"}}]}})",
      -1.0 - way);
}

TEST(Triggers, CutACableWhenTheirConditionHolds) {
  // What is let down with 1 m/s and cut off after s begins to fall then. No part is shorter than 1e-4
  // of h = 0.02 s.
  for (const double s : {0.3, 0.305, 0.31, 0.3199}) {
    Simulation simulation = start_scene(lowered_scene(s));
    double parted = 0.0;
    for (int i = 0; i < 100 && parted == 0.0; ++i) {
      ASSERT_TRUE(simulation.step().ok());
      if (simulation.cable_reports()[0].cut) parted = simulation.cables->events()[0].time;
    }
    EXPECT_GE(parted, s - 1e-9) << s;
    EXPECT_LE(parted, s + 1e-4 * 0.02 + 1e-9) << s;
    run_scene(simulation, 1.0);
    // v = -1 - g t from then on.
    EXPECT_NEAR(simulation.world.velocity(BodyId{0}).y(), -1.0 - 10.0 * (1.0 - parted), 1e-6) << s;
  }
}

TEST(Triggers, StopARunOnce) {
  Simulation simulation = start_scene(hanging_scene(
      R"({"name": "let go", "at": 0.2, "action": "release", "target": "clamp"},
         {"name": "enough", "quantity": "bar.y", "below": -1.25, "action": "stop"})"));
  const auto* supervisor = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
  ASSERT_NE(supervisor, nullptr);
  int steps = 0;
  while (!simulation.supervisor->has_stopped(simulation.world.state()) && steps < 1000) {
    ASSERT_TRUE(simulation.step().ok());
    ++steps;
  }
  // 1.25 m take 0.5 s, which rounding may have end just in the next step; the run ends with that.
  EXPECT_NEAR(simulation.world.state().time, 0.2 + 0.5 + 0.01, 1e-9);
  const auto times = supervisor->acted_at(simulation.world.state());
  EXPECT_EQ(times.at(0), 0.2);
  EXPECT_NEAR(times.at(1).value(), 0.7, 1e-6 + 1e-9);
  EXPECT_EQ(supervisor->refusals(simulation.world.state()), 0);
}

// A force that is set as often as the weight of a spring has come down: edges count, not levels.
TEST(Triggers, ActOnceOrEachTimeTheirConditionHolds) {
  for (const bool repeats : {false, true}) {
    Simulation simulation = start_scene(rotor_scene(fmt::format(
        R"("controllers": [{{"type": "pid", "name": "swing", "measures": "rotor.angle",
              "control": "rotor.drive", "setpoint": 1, "proportional": 20}}],
           "triggers": [{{"name": "past", "quantity": "rotor.angle", "above": 1, "action": "set",
              "target": "gravity.x", "value": 1, "repeats": {}}}])",
        repeats ? "true" : "false")));
    const auto* supervisor = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
    double acted = -1.0;
    int count = 0;
    while (simulation.world.state().time < 5.0) {
      ASSERT_TRUE(simulation.step().ok());
      const auto time = supervisor->acted_at(simulation.world.state())[0];
      if (time && *time != acted) ++count;
      acted = time.value_or(acted);
    }
    // x'' = 40 (1 - x): a period of 0.9935 s, so it comes past 1 five times.
    EXPECT_EQ(count, repeats ? 5 : 1);
  }
}

TEST(Controllers, FaultsAreLocated) {
  const auto with = [](const std::string& controller) {
    return errors_of(
        rotor_scene(R"("controllers": [{"type": "pid", "name": "servo", )" + controller + "}]"));
  };
  EXPECT_THAT(with(R"("measures": "rotor.angel", "control": "rotor.drive", "setpoint": 1)"),
              ElementsAre(AllOf(HasSubstr("/controllers/0/measures"),
                                HasSubstr("did you mean \"rotor.angle\"?"))));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drve", "setpoint": 1)"),
              ElementsAre(AllOf(HasSubstr("/controllers/0/control"),
                                HasSubstr("near it are \"rotor.drive\""))));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "what", "setpoint": 1)"),
              ElementsAre(HasSubstr("allowed are")));
  EXPECT_THAT(with(R"("measures": "rotor.drive_power", "control": "rotor.drive", "setpoint": 1)"),
              ElementsAre(HasSubstr("known only for the last substep")));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drive")"),
              ElementsAre(HasSubstr("needs one of setpoint")));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drive", "setpoint": "high")"),
              ElementsAre(AllOf(HasSubstr("/controllers/0/setpoint"), HasSubstr("a number"))));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drive", "setpoint": 1,
                      "sample_time": 0)"),
              ElementsAre(AllOf(HasSubstr("/controllers/0/sample_time"), HasSubstr("> 0"))));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drive", "setpoint": 1,
                      "lower": 2, "upper": 1)"),
              ElementsAre(HasSubstr("must be below the greatest")));
  EXPECT_THAT(with(R"("measures": "rotor.angle", "control": "rotor.drive", "setpoint_times": [0, 1],
                      "setpoint_values": [1])"),
              ElementsAre(HasSubstr("there are 1 and 2")));
  EXPECT_THAT(errors_of(rotor_scene(R"("controllers": [{"type": "fuzzy", "name": "x"}])")),
              ElementsAre(HasSubstr("/controllers/0/type")));
}

TEST(Triggers, FaultsAreLocated) {
  const auto with = [](const std::string& trigger) {
    return errors_of(hanging_scene(R"({"name": "t", )" + trigger + "}"));
  };
  EXPECT_THAT(
      with(R"("at": 1, "action": "release", "target": "clmp")"),
      ElementsAre(AllOf(HasSubstr("/triggers/0/target"), HasSubstr("near it are \"clamp\""))));
  EXPECT_THAT(with(R"("at": 1, "action": "lock", "target": "rope")"),
              ElementsAre(AllOf(HasSubstr("/triggers/0/target"), HasSubstr("no joint \"rope\""))));
  EXPECT_THAT(with(R"("at": 1, "action": "lock")"), ElementsAre(HasSubstr("it needs a target")));
  EXPECT_THAT(with(R"("at": 1, "action": "explode")"),
              ElementsAre(HasSubstr("/triggers/0/action")));
  EXPECT_THAT(with(R"("action": "stop")"), ElementsAre(HasSubstr("either at or a quantity")));
  EXPECT_THAT(with(R"("quantity": "bar.y", "action": "stop")"),
              ElementsAre(HasSubstr("either above or below")));
  EXPECT_THAT(with(R"("at": 1, "action": "set", "target": "weight.force_y")"),
              ElementsAre(HasSubstr("set needs a value")));
  EXPECT_THAT(with(R"("at": 1, "action": "set", "target": "rope.breaking_tension", "value": -3)"),
              ElementsAre(AllOf(HasSubstr("/triggers/0/value"), HasSubstr("-3"))));
  EXPECT_THAT(with(R"("at": 1, "action": "set", "target": "rope.breaking_tension", "value": 3,
                      "over": 0.5)"),
              ElementsAre(AllOf(HasSubstr("/triggers/0/over"), HasSubstr("is set at once"))));
  // The joint would hold already when the trigger acts.
  EXPECT_THAT(with(R"("at": 1, "action": "lock", "target": "clamp")"),
              ElementsAre(AllOf(HasSubstr("/triggers/0/target"), HasSubstr("never released"),
                                HasSubstr("clamp.drive_limit"))));
  EXPECT_THAT(with(R"("at": 1, "action": "cut")"), ElementsAre(HasSubstr("it needs a target")));
  EXPECT_THAT(with(R"("at": -1, "action": "stop")"), ElementsAre(HasSubstr("/triggers/0/at")));
}

TEST(Controllers, AreWrittenAsTheyWereRead) {
  const SceneResult scene = load_scene_text(rotor_scene(follower), "s.json");
  ASSERT_TRUE(scene);
  const std::string text = write_scene(*scene);
  const SceneResult again = load_scene_text(text, "again.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(write_scene(*again), text);
  ASSERT_EQ(again->controllers.size(), 2U);
  ASSERT_EQ(again->triggers.size(), 3U);
  EXPECT_EQ(again->triggers[2].value, 0.25);
  EXPECT_EQ(again->controllers[0]->sample_time, 0.013);
  Simulation a = start_scene(rotor_scene(follower));
  Simulation b = start_scene(text);
  run_scene(a, 2.0);
  run_scene(b, 2.0);
  EXPECT_EQ(hash(a.world.state()), hash(b.world.state()));
}

}  // namespace
}  // namespace sheave::test
