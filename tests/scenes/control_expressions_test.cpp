// Controllers and triggers on expressions of quantities: against their recursions and closed forms.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;

/// A rotor of 0.5 kg m2 that a torque drives. `rest`: the other keys of the scene.
std::string driven_scene(const std::string& rest) {
  return R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 10,
             "step": {"dt": 0.005, "substeps": 1},
             "bodies": [{"name": "rotor", "mobility": "rotor", "mass": 1, "spin_inertia": 0.5,
               "drive": "torque", "drive_values": [0]}], )" +
         rest + "}";
}

Simulation start_driven(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

std::vector<std::string> faults_of(const std::string& text) {
  std::vector<std::string> texts;
  for (const SceneError& error : load_scene_text(text, "s.json").errors) {
    texts.push_back(to_string(error));
  }
  return texts;
}

void run_driven(Simulation& simulation, double time) {
  const double dt = simulation.world.model().step.dt;
  while (simulation.world.state().time < time - 0.5 * dt) {
    if (!simulation.step().ok()) throw std::runtime_error("it diverges");
  }
}

// Each sample of 5 ms: w grows by h p (r - w / 2) / J with the setpoint r = 0.3 sin(2 t) + 0.2 t.
TEST(ControlExpressions, AreMeasuredAndFollowed) {
  Simulation simulation = start_driven(driven_scene(
      R"("controllers": [{"type": "pid", "name": "servo", "measures": "rotor.wz / 2",
           "control": "rotor.drive", "proportional": 3,
           "setpoint_quantity": "0.3[rad/s] * sin(2[rad/s] * t) + 0.2[rad/s2] * t"}])"));
  run_driven(simulation, 1.0);
  double speed = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double t = 0.005 * k;
    speed += 0.005 * 3.0 * (0.3 * std::sin(2.0 * t) + 0.2 * t - 0.5 * speed) / 0.5;
  }
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), speed, 1e-10);
}

// The same with the profile 0.4 t in a table, whose rate goes ahead, and a feedback of the angle:
// torque = 3 (0.4 t - 0.5 angle - w) + 2 x 0.4.
TEST(ControlExpressions, AreAddedToProfiles) {
  Simulation simulation = start_driven(driven_scene(
      R"("controllers": [{"type": "pid", "name": "servo", "measures": "rotor.wz",
           "control": "rotor.drive", "proportional": 3, "rate_gain": 2, "setpoint_times": [0, 10],
           "setpoint_values": [0, 4], "setpoint_quantity": "-0.5[1/s] * rotor.angle"}])"));
  double speed = 0.0;
  double angle = 0.0;
  for (int k = 0; k < 200; ++k) {
    run_driven(simulation, 0.005 * (k + 1));
    const double before = speed;
    speed += 0.005 * (3.0 * (0.4 * 0.005 * k - 0.5 * angle - speed) + 0.8) / 0.5;
    // A torque holds during a substep, so the angle is exact with the mean speed.
    angle += 0.005 * 0.5 * (before + speed);
  }
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), speed, 1e-9);
}

// The rotor of 0.5 kg m2 under 1 N m turns at 2 t, through t^2: the product passes 0.25 at
// (0.25 / 2)^(1/3) s.
TEST(ControlExpressions, AreAwaitedByTriggers) {
  Simulation simulation = start_driven(driven_scene(
      R"("triggers": [{"name": "go", "at": 0, "action": "set", "target": "rotor.drive", "value": 1},
           {"name": "half", "quantity": "rotor.wz * rotor.angle", "above": 0.25, "action": "set",
            "target": "rotor.drive", "value": 0}])"));
  run_driven(simulation, 1.0);
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), 2.0 * std::cbrt(0.125), 1e-8);
}

// 1 N m until the angle t^2 has been 0.25 at most; then -1 N m: the speed falls from 1 rad/s at
// 0.5 s. Setpoint and threshold are settings: J = 0.5 kg m2, and half of it.
TEST(ControlExpressions, WaitForStatisticsAndSettings) {
  Simulation simulation = start_driven(driven_scene(
      R"("triggers": [{"name": "go", "at": 0, "action": "set", "target": "rotor.drive", "value": 1},
           {"name": "far", "quantity": "max(rotor.angle) - /bodies/rotor/spin_inertia / 2[kg m2]",
            "above": 0, "action": "set", "target": "rotor.drive", "value": -1},
           {"name": "slow", "quantity": "max(rotor.wz) - rotor.wz", "above": 0.5, "action": "set",
            "target": "rotor.drive", "value": 0}])"));
  run_driven(simulation, 2.0);
  // 1 - 2 (t - 0.5) = 0.5 at 0.75 s.
  EXPECT_NEAR(simulation.world.angular_velocity(BodyId{0}).z(), 0.5, 1e-8);
  const auto acted = dynamic_cast<const SceneSupervisor&>(*simulation.supervisor)
                         .acted_at(simulation.world.state());
  EXPECT_NEAR(acted[1].value_or(-1.0), 0.5, 1e-8);
  EXPECT_NEAR(acted[2].value_or(-1.0), 0.75, 1e-8);
}

// The statistics are part of the state: a run that is saved between the largest speed and the
// condition on it goes on to the bit.
TEST(ControlExpressions, StatisticsAreSavedWithTheState) {
  const std::string text = driven_scene(
      R"("triggers": [{"name": "go", "at": 0, "action": "set", "target": "rotor.drive", "value": 1},
           {"name": "back", "at": 0.5, "action": "set", "target": "rotor.drive", "value": -1},
           {"name": "slow", "quantity": "max(rotor.wz) - rotor.wz", "above": 0.5, "action": "set",
            "target": "rotor.drive", "value": 0}])");
  Simulation whole = start_driven(text);
  run_driven(whole, 0.6);
  const State saved = whole.world.state();
  run_driven(whole, 2.0);
  Simulation later = start_driven(text);
  ASSERT_TRUE(later.world.restore(saved).empty());
  run_driven(later, 2.0);
  EXPECT_EQ(later.world.state().memory, whole.world.state().memory);
  EXPECT_EQ(later.world.angular_velocity(BodyId{0}).z(),
            whole.world.angular_velocity(BodyId{0}).z());
  State wrong = saved;
  wrong.memory.back() = 0.5;
  EXPECT_FALSE(later.world.restore(wrong).empty());
}

TEST(ControlExpressions, HaveFaultsWithTheirPlace) {
  const auto fault = [](const std::string& quantity) {
    const std::vector<std::string> errors =
        faults_of(driven_scene(R"("triggers": [{"name": "go", "quantity": ")" + quantity +
                               R"(", "above": 1, "action": "stop"}])"));
    return errors.empty() ? std::string("none") : errors.front();
  };
  EXPECT_EQ(fault("rotor.wz / rotor.angle"), "none");
  EXPECT_THAT(fault("rotor.wz + rotor.angle"),
              HasSubstr("expression \"rotor.wz + rotor.angle\", column 10: + "
                        "needs one unit"));
  EXPECT_THAT(fault("2 * rotor.drive_power"), HasSubstr("known only for the last substep"));
  EXPECT_THAT(fault("rotor.wz *"), HasSubstr("found the end"));
}

}  // namespace
}  // namespace sheave::test
