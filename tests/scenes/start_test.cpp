// Where simulations of a scene start: in its pose, at rest, or in a state from elsewhere.

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/load_world.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

/// A winch with a position control lifts 100 kg by a trapezoidal speed, on a rope of 50 kN/m; 1 s
/// passes before it begins. `start` is a member of the scene.
std::string crane(const std::string& start) {
  return R"({"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 3, )" + start + R"(
    "step": {"dt": 0.01, "solver": "direct"},
    "bodies": [
      {"name": "drum", "mobility": "rotor", "position": [-0.2, 6, 0], "mass": 50,
       "shape": {"type": "cylinder", "radius": 0.2, "length": 0.4},
       "drive": "speed", "drive_values": [0]},
      {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 100}],
    "cables": [{"name": "rope", "compliance": 2e-5, "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 2},
      {"type": "attachment", "body": "load"}]}],
    "controllers": [{"type": "pid", "name": "height", "measures": "drum.angle",
      "control": "drum.drive", "setpoint_times": [1, 1.5, 2.5, 3],
      "setpoint_values": [0, 0.625, 3.125, 3.75], "setpoint_interpolation": "clamped",
      "proportional": 20, "rate_gain": 1, "sample_time": 0.01, "lower": -10, "upper": 10}]})";
}

Scene loaded(const std::string& text) {
  SceneResult scene = load_scene_text(text, "test");
  for (const SceneError& error : scene.errors) ADD_FAILURE() << to_string(error);
  return std::move(*scene.scene);
}

double tension(const Simulation& simulation) {
  return simulation.cable_reports()[0].spans[0].tension;
}

// Before the move the tension is m g to the residual of the search, 1e-11 of the weight, and it
// stays so: 1e-9 leaves a hundred times of that for the swing that the residual causes.
TEST(SceneStart, ACraneWithFeedbackAtRestHasTheWeightInItsRopeUntilItMoves) {
  Result<Simulation> simulation = create_simulation(loaded(crane(R"("start": "rest",)")));
  ASSERT_TRUE(simulation);
  const double start = simulation->world.position(BodyId{1}).y();
  EXPECT_NEAR(start, -981.0 * 2e-5, 1e-10) << "m g c below its place";
  double most = 0.0;
  while (simulation->world.state().time < 3.0) {
    ASSERT_TRUE(simulation->step().ok());
    const double force = tension(*simulation);
    if (simulation->world.state().time < 0.995) {
      EXPECT_NEAR(force, 981.0, 981.0 * 1e-9);
    }
    most = std::max(most, force);
  }
  // 0.5 s take the load to 0.5 m/s: a mean of 100 N, and the peak of a cubic ramp is 1.5 to 2 times
  // that. The load swings about the ramp with at most as much again.
  EXPECT_GT(most, 981.0 + 100.0);
  EXPECT_LT(most, 981.0 + 400.0);
  EXPECT_NEAR(simulation->world.position(BodyId{1}).y() - start, 0.2 * 3.75, 0.02);
}

TEST(SceneStart, InThePoseTheSameCraneBounces) {
  Result<Simulation> simulation = create_simulation(loaded(crane("")));
  ASSERT_TRUE(simulation);
  double most = 0.0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(simulation->step().ok());
    most = std::max(most, tension(*simulation));
  }
  EXPECT_GT(most, 1.8 * 981.0) << "twice the weight, but for the phase of the samples";
}

TEST(SceneStart, IsWrittenAsItIsRead) {
  EXPECT_EQ(loaded(crane("")).start, std::nullopt);
  EXPECT_EQ(write_scene(loaded(crane(""))).find("\"start\""), std::string::npos);
  for (const Start start : {Start::pose, Start::rest}) {
    const std::string name(start_names[static_cast<std::size_t>(start)]);
    const Scene scene = loaded(crane("\"start\": \"" + name + "\","));
    EXPECT_EQ(scene.start, start);
    EXPECT_EQ(loaded(write_scene(scene)).start, start) << write_scene(scene);
  }
  const SceneResult wrong = load_scene_text(crane(R"("start": "here",)"), "test");
  ASSERT_EQ(wrong.errors.size(), 1U);
  EXPECT_EQ(wrong.errors[0].pointer, "/start");
  EXPECT_EQ(wrong.errors[0].allowed, "\"pose\", \"rest\"");
}

TEST(SceneStart, ASceneThatHasNoRestLoadsAndTellsItWhenItIsBuilt) {
  const Scene scene = loaded(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "start": "rest", "bodies": [{"name": "stone", "mass": 1, "inertia": [1, 1, 1]}]})");
  const Result<Simulation> simulation = create_simulation(scene);
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.errors()[0].path, "/start");
  EXPECT_NE(simulation.errors()[0].message.find("\"stone\""), std::string::npos);
  EXPECT_TRUE(create_in_pose(scene));
}

TEST(SceneStart, AGivenStateReplacesThatOfTheScene) {
  Scene scene = loaded(crane(R"("start": "rest",)"));
  Result<Simulation> first = create_in_pose(scene);
  ASSERT_TRUE(first);
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(first->step().ok());
  scene.start_state = std::make_shared<const State>(first->world.state());
  const Result<Simulation> second = create_simulation(scene);
  ASSERT_TRUE(second);
  EXPECT_EQ(hash(second->world.state()), hash(first->world.state()));
}

}  // namespace
}  // namespace sheave::test
