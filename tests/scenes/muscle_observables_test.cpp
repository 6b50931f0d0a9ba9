// Quantities of muscles: closed forms, in checks, triggers and expressions.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/observables.h"
#include "scenes/quantity_list.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using testing::HasSubstr;

// A muscle at its optimal length between two balls of 1e9 kg, of which one leaves with `speed`.
// With u = 1 from a = 0 its activation a has -2 ln(1 - a) - 3/2 a = t / 0.01 s, so a = 1/2 after
// 6.3629 ms.
constexpr double half_active = 0.01 * (2.0 * 0.69314718055994531 - 0.75);

std::string observed_muscle(const std::string& more = "", double speed = 0.0) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 0.02,
           "step": {{"dt": 1e-3, "substeps": 10, "integrator": "rattle"}},
           "bodies": [{{"name": "left", "mass": 1e9, "shape": {{"type": "sphere", "radius": 0.1}}}},
                      {{"name": "right", "mass": 1e9, "position": [0.3, 0, 0], "velocity": [{}, 0, 0],
                        "shape": {{"type": "sphere", "radius": 0.1}}}}],
           "cables": [{{"name": "path", "compliance": 1e12, "most_wraps": 0, "rest_lengths": [0.25],
                        "links": [{{"type": "attachment", "body": "left"}},
                                  {{"type": "attachment", "body": "right"}}]}}],
           "loads": [{{"type": "force", "name": "push", "body": "left", "forces": [[1, 0, 0]]}},
                     {{"type": "muscle", "name": "m", "cable": "path", "force": 50, "optimal_length": 0.2,
                       "tendon_length": 0.1, "excitations": [1]}}]{}}})",
      speed, more);
}

Simulation observed_simulation(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "scene.json");
  EXPECT_TRUE(scene) << (scene ? "" : to_string(scene.errors.front()));
  Result<Simulation> made = create_simulation(*scene);
  EXPECT_TRUE(made.ok());
  return std::move(*made);
}

double observed(const Simulation& simulation, const std::string& text) {
  QuantityList list(QuantityIndex::of(simulation, std::span(&text, 1)));
  EXPECT_TRUE(list.add(text).empty()) << text;
  double value = 0.0;
  list.observe(simulation, std::span(&value, 1));
  return value;
}

TEST(MuscleObservables, AreColumnsOfScenesAndOfSimulations) {
  const SceneResult scene = load_scene_text(observed_muscle(), "scene.json");
  ASSERT_TRUE(scene);
  const ObservableSet of_scene(scene->model, scene->cables, scene->loads);
  const ObservableSet of_run(observed_simulation(observed_muscle()));
  EXPECT_EQ(of_scene.names(), of_run.names());
  for (const char* name : {"m.activation", "m.tension", "m.fibre_length", "m.fibre_velocity"}) {
    const Result<int> index = of_run.index_of(name);
    ASSERT_TRUE(index) << name;
    const bool column = static_cast<std::size_t>(*index) < of_run.default_count();
    EXPECT_EQ(column, !std::string(name).starts_with("m.fibre")) << name;
    EXPECT_EQ(of_run.unit(*index), std::string(name) == "m.tension" ? "N" : "") << name;
    EXPECT_TRUE(of_run.follows_from_state(*index)) << name;
  }
  EXPECT_FALSE(of_run.index_of("push.tension")) << "a force is no muscle";
}

// Substeps of 0.1 ms have an error of second order: (h / tau)^2 = 1e-4 of some 1e-1.
TEST(MuscleObservables, ActivationIsThatOfTheClosedForm) {
  Simulation s = observed_simulation(observed_muscle());
  EXPECT_EQ(observed(s, "m.activation"), 0.0);
  EXPECT_TRUE(std::isnan(observed(s, "m.tension"))) << "no force before the first substep";
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.step().ok());
  const double a = observed(s, "m.activation");
  EXPECT_NEAR(-2.0 * std::log(1.0 - a) - 1.5 * a, 2.0, 1e-4);
  // The tension is that of the middle of the last substep, 0.05 ms ago; a' < 1 / (0.01 s x 2) = 50 / s.
  EXPECT_NEAR(observed(s, "m.tension") / 50.0, a, 50 * 5e-5);
  EXPECT_LT(observed(s, "m.tension") / 50.0, a);
}

// L = (0.3 m + v t - 0.1 m) / 0.2 m and V = v / (0.2 m x 1.5 / s), but for the motion of 1e9 kg under 50 N.
TEST(MuscleObservables, FibresHaveTheLengthAndVelocityOfThePath) {
  Simulation s = observed_simulation(observed_muscle("", 0.6));
  EXPECT_NEAR(observed(s, "m.fibre_length"), 1.0, 1e-12);
  EXPECT_NEAR(observed(s, "m.fibre_velocity"), 2.0, 1e-12);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(s.step().ok());
  EXPECT_NEAR(observed(s, "m.fibre_length"), 1.0 + 0.6 * 0.01 / 0.2, 1e-9);
  EXPECT_NEAR(observed(s, "m.fibre_velocity"), 2.0, 1e-8);
}

TEST(MuscleObservables, ATriggerActsWhenTheActivationCrosses) {
  Simulation s = observed_simulation(observed_muscle(
      R"(, "triggers": [{"name": "end", "quantity": "m.activation", "above": 0.5, "action": "stop"}])"));
  while (!s.supervisor->has_stopped(s.world.state())) {
    ASSERT_LT(s.world.state().time, 0.02);
    ASSERT_TRUE(s.step().ok());
  }
  const auto& own = dynamic_cast<const SceneSupervisor&>(*s.supervisor);
  ASSERT_TRUE(own.acted_at(s.world.state())[0]);
  // At the crossing or at the next substep of 0.1 ms; the error of the activation is 1e-4 of it.
  EXPECT_GE(*own.acted_at(s.world.state())[0], half_active - 1e-6);
  EXPECT_LE(*own.acted_at(s.world.state())[0], half_active + 1.01e-4);
}

TEST(MuscleObservables, ChecksMayUseThem) {
  const auto faults = [](const std::string& quantity) {
    const SceneResult scene =
        load_scene_text(observed_muscle(fmt::format(R"(, "checks": [{{"quantity": "{}", "equals": 1,
                                                      "tolerance": 0.5}}])",
                                                    quantity)),
                        "scene.json");
    return scene ? std::string() : to_string(scene.errors.front());
  };
  EXPECT_EQ(faults("m.activation"), "");
  EXPECT_EQ(faults("m.fibre_length + m.tension / 1[N]"), "");
  EXPECT_THAT(faults("m.activatoin"), HasSubstr("m.activation"));
  EXPECT_THAT(faults("m.activation + m.tension"), HasSubstr("N")) << "units differ";
}

// The cable pulls by 0.05 m / 1e12 m/N, and so parts at the trigger.
TEST(MuscleObservables, ACutPathHasNoFibresAndNoTension) {
  Simulation s = observed_simulation(observed_muscle(
      R"(, "triggers": [{"name": "knife", "at": 0.005, "action": "cut", "target": "path"}])"));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(s.step().ok());
  EXPECT_TRUE(std::isnan(observed(s, "m.fibre_length")));
  EXPECT_TRUE(std::isnan(observed(s, "m.fibre_velocity")));
  EXPECT_EQ(observed(s, "m.tension"), 0.0);
}

}  // namespace
}  // namespace sheave
