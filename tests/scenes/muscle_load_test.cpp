// Muscles along cables: closed forms of activation and force, balances, controls, saved states.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/state.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using testing::HasSubstr;

/// Two balls on a line, the heavy one of mass `heavy`, 0.3 m apart, and a cable between them.
std::string muscle_scene(const std::string& loads, double heavy = 2.0, double dt = 1e-3,
                         const std::string& more = "") {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 10,
           "step": {{"dt": {}, "substeps": 1, "integrator": "rattle"}},
           "bodies": [{{"name": "left", "mass": 1, "shape": {{"type": "sphere", "radius": 0.1}}}},
                      {{"name": "right", "mass": {}, "position": [0.3, 0, 0],
                        "shape": {{"type": "sphere", "radius": 0.1}}}}, {{"name": "wall", "mobility": "static"}}],
           "cables": [{{"name": "path", "compliance": 1e12, "most_wraps": 0,
                        "links": [{{"type": "attachment", "body": "left"}},
                                  {{"type": "attachment", "body": "right"}}]}},
                      {{"name": "loop", "closed": true, "compliance": 1e12, "most_wraps": 0,
                        "links": [{{"type": "pinhole", "body": "left"}}, {{"type": "pinhole", "body": "right"}}]}},
                      {{"name": "rubbing", "compliance": 1e12, "most_wraps": 0,
                        "links": [{{"type": "attachment", "body": "left", "point": [0, 0.1, 0]}},
                                  {{"type": "pinhole", "body": "right", "friction": 0.1}},
                                  {{"type": "attachment", "body": "wall", "point": [0.3, 1, 0]}}]}}],
           "loads": [{}]{}}})",
      dt, heavy, loads, more);
}

std::string one_muscle(const std::string& more) {
  return R"({"type": "muscle", "name": "m", "cable": "path", "force": 50, "optimal_length": 0.2,
             "tendon_length": 0.1)" +
         more + "}";
}

Simulation muscle_simulation(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "scene.json");
  EXPECT_TRUE(scene) << (scene ? "" : to_string(scene.errors.front()));
  Result<Simulation> made = create_simulation(*scene);
  EXPECT_TRUE(made.ok());
  return std::move(*made);
}

std::vector<MuscleState> muscles_of(const Simulation& simulation) {
  return dynamic_cast<const SceneSupervisor&>(*simulation.supervisor)
      .muscles(simulation.world.state());
}

void run_muscles(Simulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(simulation.step().ok());
}

// With u = 1 from a = 0, a' = (1 - a) / (T (1/2 + 3/2 a)) has the integral
// -2 ln(1 - a) - 3/2 a = t / T. With u = 0 from a = 1, a' = -a (1/2 + 3/2 a) / T has
// 2 (ln((1/2 + 3/2 a) / a) - ln 2) = t / T. The error is of second order: a quarter at half a step,
// up to the third order, which is some h / tau of it: 1e-2 with h = 6e-5 s and tau = 5e-3 s.
TEST(MuscleLoads, ActivationFollowsTheClosedForms) {
  for (const bool rises : {true, false}) {
    const std::string law = rises ? R"(, "excitations": [1])" : R"(, "activation": 1)";
    std::array<double, 2> errors{};
    for (const int k : {0, 1}) {
      const int steps = k == 0 ? 320 : 640;
      Simulation s = muscle_simulation(muscle_scene(one_muscle(law), 1e9, 0.02 / steps));
      run_muscles(s, steps);
      const double a = muscles_of(s)[0].activation;
      const double time = rises ? 0.01 * (-2.0 * std::log(1.0 - a) - 1.5 * a)
                                : 0.04 * 2.0 * (std::log((0.5 + 1.5 * a) / a) - std::log(2.0));
      errors[static_cast<std::size_t>(k)] = time - 0.02;
    }
    EXPECT_LT(std::abs(errors[0]), 1e-6);
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.1);
  }
}

// Bodies of 1e12 kg do not move in 1 s under 50 N: the tension is force (a FL + FP) of their length.
TEST(MuscleLoads, ForceOfAMuscleThatIsHeldIsThatOfItsLength) {
  const auto tension = [](double optimal, double tendon, double excitation) {
    const std::string load = fmt::format(
        R"({{"type": "muscle", "name": "m", "cable": "path", "force": 50, "optimal_length": {},
             "tendon_length": {}, "activation": {}, "excitations": [{}]}})",
        optimal, tendon, excitation, excitation);
    std::string text = muscle_scene(load, 1e12);
    text.replace(text.find("\"mass\": 1,"), 10, "\"mass\": 1e12,");
    Simulation s = muscle_simulation(text);
    run_muscles(s, 3);
    return muscles_of(s)[0].tension;
  };
  EXPECT_NEAR(tension(0.2, 0.1, 1.0), 50.0, 1e-9);  // L = 1
  EXPECT_NEAR(tension(0.2, 0.1, 0.4), 20.0, 1e-9);
  EXPECT_NEAR(tension(0.3, 0.3, 1.0), 0.0, 1e-9);  // L = 0
  // L = 0.75 = (0.5 + 1) / 2, where two parabolas meet at a half.
  EXPECT_NEAR(tension(0.2, 0.15, 1.0), 25.0, 1e-9);
  // L = 1.3 = (1 + 1.6) / 2: half of the active force, and half of passive_force = 1.3.
  EXPECT_NEAR(tension(0.2, 0.04, 1.0), 50.0 * (0.5 + 0.65), 1e-9);
  // L = 1.9 = 1.3 + 0.6: the tangent of slope 1 / 0.3 adds 2 to a half.
  EXPECT_NEAR(tension(0.1, 0.11, 1.0), 50.0 * 1.3 * 2.5, 1e-9);
}

// The muscle pulls both ends with one force, so the sum of momenta stays 0 to rounding.
TEST(MuscleLoads, AMuscleMovesNoCentreOfMass) {
  Simulation s = muscle_simulation(muscle_scene(one_muscle(R"(, "excitations": [0.3])")));
  run_muscles(s, 100);
  const auto& bodies = s.world.state().bodies;
  EXPECT_GT(bodies[0].velocity.x(), 0.01);
  EXPECT_NEAR(bodies[0].velocity.x() + 2.0 * bodies[1].velocity.x(), 0.0, 1e-12);
}

/// The light scene: a ball of `mass` on the left, which cannot move the heavy one on the right.
std::string light_muscle_scene(double mass, int muscles, double dt) {
  std::string loads;
  for (int i = 0; i < muscles; ++i) {
    std::string one = one_muscle(R"(, "activation": 1, "excitations": [1])");
    one.replace(one.find("\"m\""), 3, fmt::format("\"m{}\"", i));
    loads += (i > 0 ? ", " : "") + one;
  }
  std::string text = muscle_scene(loads, 1e12, dt);
  text.replace(text.find("\"mass\": 1,"), 10, fmt::format("\"mass\": {},", mass));
  return text;
}

// A muscle that shortens at `optimal_length` x `max_speed` = 0.3 m/s has no force. Over a substep the
// force is that of the speed in its middle, so this speed is at most 0.3 m/s, and the speed at the
// end at most 0.6 m/s. A force by the speed at the start, or by a speed that is only foretold, has
// thrown such balls away: 50 N over a substep of 1/60 s accelerate 0.01 kg to 83 m/s.
TEST(MuscleLoads, ALightBodyIsNotThrownInAnySubstep) {
  for (const double mass : {1e-6, 0.01, 1.0}) {
    for (const int muscles : {1, 4}) {
      for (const double dt : {1.0 / 60.0, 1.0 / 240.0, 1e-3}) {
        SCOPED_TRACE(fmt::format("{} kg, {} muscles, {} s", mass, muscles, dt));
        Simulation s = muscle_simulation(light_muscle_scene(mass, muscles, dt));
        for (double time = 0.0; time < 0.2; time += dt) {
          ASSERT_TRUE(s.step().ok());
          // Before the muscle is shorter than half of its optimal length it has no force either.
          ASSERT_LT(std::abs(s.world.state().bodies[0].velocity.x()), 0.6 + 1e-9) << time;
        }
      }
    }
  }
}

// 1 kg that comes nearer, rests or goes away at first. A quarter of the error at half the substep; the
// corners of the curves, which a substep contains, and the third order leave the factor within 1.
TEST(MuscleLoads, MotionIsOfSecondOrder) {
  for (const double speed : {0.2, 0.0, -0.2}) {
    std::array<double, 3> places{};
    for (std::size_t k = 0; k < places.size(); ++k) {
      const int steps = 200 << k;
      std::string text = light_muscle_scene(1.0, 1, 0.05 / steps);
      text.replace(text.find("\"mass\": 1,"), 10,
                   fmt::format("\"mass\": 1, \"velocity\": [{}, 0, 0],", speed));
      Simulation s = muscle_simulation(text);
      run_muscles(s, steps);
      places[k] = s.world.state().bodies[0].position.x();
    }
    EXPECT_NEAR((places[0] - places[1]) / (places[1] - places[2]), 4.0, 1.0) << speed;
    EXPECT_LT(std::abs(places[1] - places[2]), 1e-6) << speed;
  }
}

TEST(MuscleLoads, TwoMusclesOnOneCablePullTogether) {
  const auto speed = [](const std::string& loads) {
    Simulation s = muscle_simulation(muscle_scene(loads));
    run_muscles(s, 50);
    return s.world.state().bodies[0].velocity.x();
  };
  const std::string law =
      R"(, "cable": "path", "optimal_length": 0.2, "tendon_length": 0.1, "excitations": [0.5])";
  const std::string one = R"({"type": "muscle", "name": "a", "force": 50)" + law + "}";
  const std::string half = R"({"type": "muscle", "name": "a", "force": 20)" + law + "}, " +
                           R"({"type": "muscle", "name": "b", "force": 30)" + law + "}";
  EXPECT_NEAR(speed(one), speed(half), 1e-12);
}

TEST(MuscleLoads, AStateContinuesWithTheSameBits) {
  const std::string text = muscle_scene(
      one_muscle(R"(, "times": [0, 0.1], "excitations": [0, 0.8])"), 2.0, 1e-3,
      R"(, "triggers": [{"name": "t", "at": 0.05, "action": "set", "target": "m.excitation", "value": 0.2}])");
  Simulation whole = muscle_simulation(text);
  run_muscles(whole, 60);
  const State saved = whole.world.state();
  run_muscles(whole, 40);
  Simulation rest = muscle_simulation(text);
  ASSERT_TRUE(rest.world.restore(saved).empty());
  run_muscles(rest, 40);
  EXPECT_EQ(hash(rest.world.state()), hash(whole.world.state()));
}

TEST(MuscleLoads, ControlsReplaceTheExcitation) {
  const auto scene = [](const std::string& more) {
    return muscle_scene(one_muscle(R"(, "excitations": [0.2])"), 1e9, 1e-3, more);
  };
  Simulation s = muscle_simulation(scene(
      R"(, "triggers": [{"name": "on", "at": 0.1, "action": "set", "target": "m.excitation", "value": 0.9},
                        {"name": "off", "at": 0.9, "action": "clear", "target": "m.excitation"}])"));
  // Time constants are below 0.08 s, so after ten of them 1e-4 of a change is left.
  run_muscles(s, 90);
  EXPECT_FALSE(muscles_of(s)[0].excitation);
  run_muscles(s, 800);
  EXPECT_NEAR(muscles_of(s)[0].activation, 0.9, 1e-6);
  EXPECT_EQ(muscles_of(s)[0].excitation, 0.9);
  run_muscles(s, 900);
  EXPECT_NEAR(muscles_of(s)[0].activation, 0.2, 1e-3);
  const Result<ControlPoint> point = find_control("m.excitation", s);
  ASSERT_TRUE(point.ok());
  EXPECT_THAT(point->set(s, 1.5, 0.001).front().message, HasSubstr("between 0 and 1"));
  EXPECT_TRUE(point->set(s, 1.0, 0.001).empty());
  EXPECT_EQ(muscles_of(s)[0].excitation, 1.0);
  EXPECT_FALSE(find_control("n.excitation", s).ok());
}

TEST(MuscleLoads, FaultsNameTheRemedy) {
  const auto expect = [](const std::string& load, const std::string& pointer,
                         const std::string& word, const std::string& more = "") {
    const SceneResult scene = load_scene_text(muscle_scene(load, 2.0, 1e-3, more), "scene.json");
    std::string all;
    bool found = false;
    for (const SceneError& error : scene.errors) {
      all += to_string(error) + "\n";
      found = found || (error.pointer == pointer && error.message.find(word) != std::string::npos);
    }
    EXPECT_TRUE(found) << pointer << ": " << word << "\n" << all;
  };
  const auto on = [](const std::string& cable, const std::string& more = "") {
    return R"({"type": "muscle", "name": "m", "force": 5, "optimal_length": 0.2, "cable": ")" +
           cable + "\"" + more + "}";
  };
  expect(on("pat"), "/loads/0/cable", "near it are \"path\"");
  expect(on("loop"), "/loads/0/cable", "a muscle has ends");
  expect(on("rubbing"), "/loads/0/cable", "has friction");
  expect(on("path", R"(, "body": "left")"), "/loads/0/body", "leave body out");
  expect(on("path", R"(, "shortest": 1)"), "/loads/0/shortest", "below 1");
  expect(on("path", R"(, "excitations": [2])"), "/loads/0/excitations/0", "must be");
  expect(on("path", R"(, "excitations": [0, 1])"), "/loads/0/excitations", "one value per time");
  expect(on("path") + R"(, {"type": "force", "name": "f", "body": "left", "point": [1, 0, 0],
                            "forces": [[1, 0, 0]]})",
         "/loads/1/body", "add up");
  expect(
      on("path"), "/loads/0/cable", "a trigger or a controller",
      R"(, "triggers": [{"name": "t", "at": 1, "action": "set", "target": "left.force_x", "value": 1}])");
  expect(
      on("path"), "/triggers/0/value", "between 0 and 1",
      R"(, "triggers": [{"name": "t", "at": 1, "action": "set", "target": "m.excitation", "value": 2}])");
}

}  // namespace
}  // namespace sheave
