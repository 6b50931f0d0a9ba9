// Loads of a scene over time: forces, wind, motions.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/joint_report.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using testing::HasSubstr;

/// A scene with these bodies and other lists, steps of `dt` and no gravity.
std::string loads_scene(const std::string& lists, double dt = 0.01, double gravity = 0.0) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, {}, 0], "duration": 10,
           "step": {{"dt": {}, "substeps": 1}}, {}}})",
      -gravity, dt, lists);
}

Simulation loads_simulation(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "scene.json");
  EXPECT_TRUE(scene) << (scene ? "" : to_string(scene.errors.front()));
  Result<Simulation> made = create_simulation(*scene);
  EXPECT_TRUE(made.ok());
  return std::move(*made);
}

void run_loads(Simulation& simulation, double time) {
  while (simulation.world.state().time < time - 1e-9) ASSERT_TRUE(simulation.step().ok());
}

const BodyState& loads_body(const Simulation& simulation, std::size_t index = 0) {
  return simulation.world.state().bodies[index];
}

const std::string loads_ball =
    R"({"name": "ball", "mass": 2, "shape": {"type": "sphere", "radius": 0.5}})";

/// Time at which a rigid rope or a joint parts that holds 10 kg below a hook [s]; the hook heaves by
/// 0.1 m (cos w t - 1), w = 2 pi / s, so the force is m (g - 0.1 m w^2 cos w t).
double parting_time(const std::string& hold, const std::string& integrator, double dt,
                    bool oscillates = false) {
  const std::string still =
      R"("mobility": "kinematic", "shape": {"type": "sphere", "radius": 0.1})";
  const std::string heave = R"(, "loads": [{"type": "motion", "name": "heave", "body": "hook",
    "frequencies": [1], "phases": [1.5707963267948966], "translations": [[0, 0.1, 0]]}])";
  const std::string oscillation = R"(, "oscillation": [0, 0.1, 0], "oscillation_frequency": 1,
    "oscillation_phase": 1.5707963267948966)";
  Simulation s = loads_simulation(fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
           "step": {{"dt": {}, "substeps": 1, "integrator": "{}", "solver": "direct"}},
           "bodies": [{{"name": "hook", {}}},
             {{"name": "load", "mass": 10, "position": [0, -1, 0], "shape": {{"type": "sphere", "radius": 0.1}}}}],
           {}{}}})",
      dt, integrator, still + (oscillates ? oscillation : ""), hold, oscillates ? "" : heave));
  while (s.world.state().time < 0.6) {
    EXPECT_TRUE(s.step().ok());
    if (s.cables && !s.cables->events().empty()) return s.cables->events()[0].time;
    const auto joints = joint_reports(s.world);
    if (!joints.empty() && joints[0].broken_at) return *joints[0].broken_at;
  }
  return 1e9;
}

// The force passes m (g + 2 m/s2) when cos w t = -2 m/s2 / (0.1 m w^2). The force of an instant is of
// second order, as the motion of the hook within a substep: below w h^2. Before, the hook speeds down,
// and the velocities of `xpbd`, which are older, must not make the rope slack.
TEST(SceneLoads, AMotionBreaksAtTheInstantOfTheBreakingForce) {
  const double w = 2.0 * pi;
  const double due = std::acos(-2.0 / (0.1 * w * w)) / w;
  for (const std::string hold :
       {R"("cables": [{"name": "rope", "breaking_tension": 118.1, "links": [
             {"type": "attachment", "body": "hook"}, {"type": "attachment", "body": "load"}]}])",
        R"("joints": [{"type": "fixed", "name": "bolt", "body_a": "hook", "body_b": "load",
             "anchor": [0, -1, 0], "breaking_force": 118.1}])"}) {
    for (const std::string integrator : {"rattle", "xpbd"}) {
      for (const double dt : {0.02, 0.01, 0.005}) {
        for (const bool oscillates : {false, true}) {
          SCOPED_TRACE(hold + integrator + std::to_string(dt));
          EXPECT_NEAR(parting_time(hold, integrator, dt, oscillates), due, w * dt * dt);
        }
      }
    }
  }
}

// A rod that breaks at 1600 N holds 30 kg, and below them 100 kg on 15 m of rope of 1 GN, which a force
// draws with 500 N/s from 0.1 s on: 130 kg g + 500 N/s (t - 0.1 s). No substep resolves the vibration of
// the rope, 130 Hz; `xpbd` damps it. Its motion is of first order.
TEST(SceneLoads, AJointBesideAStiffRopeBreaksAtTheInstantOfTheBreakingForce) {
  const double due = 0.1 + (1600.0 - 130.0 * 9.81) / 500.0;
  for (const double dt : {1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0}) {
    Simulation s = loads_simulation(fmt::format(
        R"({{"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
             "step": {{"dt": {}, "substeps": 1, "integrator": "xpbd", "solver": "direct"}},
             "bodies": [{{"name": "block", "mobility": "slider", "axis": [0, 1, 0], "mass": 30}},
               {{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "position": [0, -15, 0],
                "mass": 100}}],
             "joints": [{{"type": "distance", "name": "rod", "body_a": "world", "body_b": "block",
               "anchor_a": [0, 5, 0], "anchor_b": [0, 0, 0], "breaking_force": 1600}}],
             "cables": [{{"name": "rope", "axial_stiffness": 1e9, "pretension": 981, "links": [
               {{"type": "attachment", "body": "block"}}, {{"type": "attachment", "body": "load"}}]}}],
             "loads": [{{"type": "force", "name": "pull", "body": "load", "times": [0.1, 2.1],
               "forces": [[0, 0, 0], [0, -1000, 0]]}}]}})",
        dt));
    while (!joint_reports(s.world)[0].broken_at && s.world.state().time < 1.0) {
      ASSERT_TRUE(s.step().ok());
    }
    ASSERT_TRUE(joint_reports(s.world)[0].broken_at);
    EXPECT_NEAR(*joint_reports(s.world)[0].broken_at, due, 2.0 * dt);
  }
}

// The mean over each substep gives the exact impulse: 10 N s of the triangle, and 2 kg.
TEST(SceneLoads, AForceOverTimeHasItsImpulse) {
  for (const double dt : {0.01, 0.07}) {
    Simulation s = loads_simulation(
        loads_scene(R"("bodies": [)" + loads_ball +
                        R"(], "loads": [{"type": "force", "name": "push", "body": "ball",
        "times": [0.5, 1.5, 2.5], "forces": [[0, 0, 0], [10, 0, 5], [0, 0, 0]]}])",
                    dt));
    run_loads(s, 2.9);
    EXPECT_NEAR(loads_body(s).velocity.x(), 5.0, 1e-12);
    EXPECT_NEAR(loads_body(s).velocity.z(), 2.5, 1e-12);
  }
}

// A torque of 3 N m on I = 2/5 m r^2 = 0.2 kg m2; and a force of 2 N at 0.3 m that turns with a
// rotor-like body: M / I t.
TEST(SceneLoads, TorquesAndForcesAtAPointTurnTheBody) {
  Simulation s = loads_simulation(
      loads_scene(R"("bodies": [)" + loads_ball +
                  R"(, {"name": "bar", "mobility": "planar", "mass": 6, "position": [5, 0, 0],
      "shape": {"type": "box", "size": [1, 1, 1]}}],
      "loads": [{"type": "force", "name": "twist", "body": "ball", "torques": [[0, 3, 0]]},
      {"type": "force", "name": "thrust", "body": "bar", "forces": [[0, 2, 0]], "point": [0.3, 0, 0],
       "frame": "body"}])"));
  run_loads(s, 2.0);
  EXPECT_NEAR(loads_body(s).angular_velocity.y(), 3.0 / 0.2 * 2.0, 1e-9);
  EXPECT_NEAR(loads_body(s, 1).angular_velocity.z(), 0.6 / 1.0 * 2.0, 1e-9);  // I = m a^2 / 6
}

TEST(SceneLoads, CentralForcesOfOneBodyAddUp) {
  Simulation s = loads_simulation(loads_scene(R"("bodies": [)" + loads_ball + R"(], "loads": [
      {"type": "force", "name": "a", "body": "ball", "forces": [[4, 0, 0]]},
      {"type": "force", "name": "b", "body": "ball", "forces": [[0, 2, 0]]}])"));
  run_loads(s, 1.0);
  EXPECT_NEAR(loads_body(s).velocity.x(), 2.0, 1e-12);
  EXPECT_NEAR(loads_body(s).velocity.y(), 1.0, 1e-12);
}

constexpr double falling_gravity = 10.0;
constexpr double drag_area = 0.4;  // [m2]
/// sqrt(2 m g / (density drag_area)) of the ball of 2 kg in air of 1.25 kg/m3 [m/s].
const double terminal_speed = std::sqrt(2.0 * 2.0 * falling_gravity / (1.25 * drag_area));

Simulation falling_loads_ball(double dt) {
  return loads_simulation(loads_scene(R"("bodies": [)" + loads_ball + R"(], "loads": [
      {"type": "wind", "name": "air", "body": "ball", "drag_area": 0.4, "density": 1.25}])",
                                      dt, falling_gravity));
}

TEST(SceneLoads, AFallingBodyHasItsTerminalVelocity) {
  Simulation s = falling_loads_ball(0.01);
  run_loads(s, 20.0);
  EXPECT_NEAR(loads_body(s).velocity.y(), -terminal_speed, 1e-9 * terminal_speed);
}

// v = v_t tanh(g t / v_t); the error is of second order, so half the step leaves a quarter of it.
TEST(SceneLoads, DragIsOfSecondOrder) {
  std::vector<double> errors;
  for (const double dt : {0.04, 0.02, 0.01}) {
    Simulation s = falling_loads_ball(dt);
    run_loads(s, 1.0);
    const double exact =
        -terminal_speed * std::tanh(falling_gravity * s.world.state().time / terminal_speed);
    errors.push_back(std::abs(loads_body(s).velocity.y() - exact));
  }
  EXPECT_LT(errors[2], 1e-3);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_GT(errors[i] / errors[i + 1], 3.5);
    EXPECT_LT(errors[i] / errors[i + 1], 4.5);
  }
}

// Without other forces m u' = -k u^2 for the speed u relative to the wind: u = U / (1 + k U t / m).
TEST(SceneLoads, AWindTakesABodyAlong) {
  Simulation s = loads_simulation(loads_scene(R"("bodies": [)" + loads_ball + R"(], "loads": [
      {"type": "wind", "name": "gale", "body": "ball", "drag_area": 0.4, "density": 1.25,
       "velocities": [[20, 0, 0]]}])"));
  run_loads(s, 5.0);
  const double k = 0.5 * 1.25 * 0.4;
  EXPECT_NEAR(20.0 - loads_body(s).velocity.x(), 20.0 / (1.0 + k * 20.0 * 5.0 / 2.0), 1e-4);
}

// A force F sin(w t) at the resonance w of a spring: x = F / (2 m w^2) (sin w t - w t cos w t). The
// table has 200 points per period, between which a cubic spline has an error of 1e-8 of F.
TEST(SceneLoads, AnOscillatorGrowsLinearlyAtResonance) {
  std::string times = "0";
  std::string forces = "[0, 0, 0]";
  for (int k = 1; k <= 1000; ++k) {
    const double t = k * pi / 200.0;
    times += fmt::format(", {}", t);
    forces += fmt::format(", [{}, 0, 0]", 3.0 * std::sin(2.0 * t));
  }
  Simulation s = loads_simulation(loads_scene(
      R"("bodies": [{"name": "cart", "mobility": "slider", "axis": [1, 0, 0], "mass": 5}],
      "joints": [{"type": "slider", "name": "spring", "body_b": "cart", "anchor": [0, 0, 0],
                  "axis": [1, 0, 0], "stiffness": 20}],
      "loads": [{"type": "force", "name": "shaker", "body": "cart", "times": [)" +
          times + R"(], "forces": [)" + forces + R"(], "interpolation": "cubic"}])",
      0.002));
  run_loads(s, 9.0);
  const double t = s.world.state().time;
  const double exact = 3.0 / (2.0 * 5.0 * 4.0) * (std::sin(2.0 * t) - 2.0 * t * std::cos(2.0 * t));
  // The frequency of a step h is wrong by (w h)^2 / 24 = 7e-7, a phase of 1e-5 after 18 rad.
  EXPECT_NEAR(loads_body(s).position.x(), exact, 1e-4 * std::abs(exact));
}

// A load of m on a rope of the stiffness k under a hook that heaves by Z sin(w t), from rest in the
// equilibrium: x = Z / (1 - r^2) (sin(w t) - r sin(w0 t)), w0^2 = k / m, r = w / w0.
TEST(SceneLoads, ALoadHangsFromAHookThatHeaves) {
  const double sag = 40.0 * 10.0 / 4000.0;
  Simulation s = loads_simulation(loads_scene(
      fmt::format(
          R"("bodies": [{{"name": "hook", "mobility": "kinematic", "position": [0, 5, 0]}},
          {{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 40, "position": [0, {}, 0]}}],
          "cables": [{{"name": "rope", "compliance": 2.5e-4, "rest_lengths": [2], "links": [
            {{"type": "attachment", "body": "hook"}}, {{"type": "attachment", "body": "load"}}]}}],
          "loads": [{{"type": "motion", "name": "sea", "body": "hook", "frequencies": [0.5],
                      "translations": [[0, 0.05, 0]]}}])",
          3.0 - sag),
      0.001, 10.0));
  run_loads(s, 3.0);
  const double t = s.world.state().time;
  const double w = 2.0 * pi * 0.5;
  const double w0 = std::sqrt(4000.0 / 40.0);
  const double r = w / w0;
  const double exact = 0.05 / (1.0 - r * r) * (std::sin(w * t) - r * std::sin(w0 * t));
  // The phase of the step is wrong by w0 t (w0 h)^2 / 24 = 1e-4 rad; the first substep starts the
  // hook from rest, as an impulse of Z w h / 2 = 8e-5 m.
  EXPECT_NEAR(loads_body(s, 1).position.y() - (3.0 - sag), exact, 2e-4);
}

// At the ends of substeps the pose is that of the formula but for rounding.
TEST(SceneLoads, AMotionInSixDegreesOfFreedomHasThePoseOfItsSines) {
  Simulation s = loads_simulation(loads_scene(
      R"("bodies": [{"name": "deck", "mobility": "kinematic", "position": [1, 2, 3]}],
      "loads": [{"type": "motion", "name": "sea", "body": "deck", "frequencies": [0.1, 0.23],
        "phases": [0.4, -1], "translations": [[0.5, 1, 0.2], [0.1, -0.3, 0]],
        "rotations": [[0.1, 0.02, 0.05], [0, 0.03, -0.02]], "times": [0, 2, 4, 6],
        "positions": [[1, 0, 0], [2, 0, 0], [4, 0, 0], [7, 0, 0]]}])"));
  run_loads(s, 4.0);
  const auto wave = [](double t, int k) {
    const double f = k == 0 ? 0.1 : 0.23;
    const double p = k == 0 ? 0.4 : -1.0;
    return std::sin(2.0 * pi * f * t + p) - std::sin(p);
  };
  const double t = s.world.state().time;
  const Vector3 way = wave(t, 0) * Vector3(0.5, 1.0, 0.2) + wave(t, 1) * Vector3(0.1, -0.3, 0.0);
  const Vector3 place = Vector3(1.0, 2.0, 3.0) + way + Vector3(3.0, 0.0, 0.0);
  EXPECT_NEAR((loads_body(s).position - place).norm(), 0.0, 1e-12);
  const Quaternion turned =
      rotation_by(wave(t, 0) * Vector3(0.1, 0.02, 0.05) + wave(t, 1) * Vector3(0.0, 0.03, -0.02));
  EXPECT_NEAR(loads_body(s).orientation.angularDistance(turned), 0.0, 1e-7);
  // The angular velocity is the rate of the orientation: central differences of second order.
  const Quaternion before = loads_body(s).orientation;
  const Vector3 spin = loads_body(s).angular_velocity;
  ASSERT_TRUE(s.step().ok());
  const Quaternion after = loads_body(s).orientation;
  const Vector3 mean = 2.0 * (after * before.conjugate()).vec() / 0.01;
  EXPECT_NEAR((0.5 * (spin + loads_body(s).angular_velocity) - mean).norm(), 0.0, 1e-5);
}

TEST(SceneLoads, ARunFromASavedStateHasTheSameBits) {
  Simulation whole = falling_loads_ball(0.01);
  run_loads(whole, 0.5);
  const State saved = whole.world.state();
  run_loads(whole, 1.0);
  Simulation later = falling_loads_ball(0.01);
  ASSERT_TRUE(later.world.restore(saved).empty());
  run_loads(later, 1.0);
  EXPECT_EQ(loads_body(later).velocity, loads_body(whole).velocity);
  EXPECT_EQ(later.world.state().memory, whole.world.state().memory);
}

TEST(SceneLoads, AreWrittenAndReadAgain) {
  const std::string text = loads_scene(R"("bodies": [)" + loads_ball + R"(], "loads": [
      {"type": "wind", "name": "air", "body": "ball", "drag_area": 0.4, "times": [0, 1],
       "velocities": [[0, 0, 0], [9, 0, 0]]}])");
  const SceneResult scene = load_scene_text(text, "scene.json");
  ASSERT_TRUE(scene);
  const std::string written = write_scene(*scene);
  const SceneResult again = load_scene_text(written, "scene.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(write_scene(*again), written);
  EXPECT_THAT(written, HasSubstr("\"drag_area\""));
}

void expect_load_fault(const std::string& lists, const std::string& pointer,
                       const std::string& word) {
  const SceneResult scene = load_scene_text(loads_scene(lists), "scene.json");
  ASSERT_FALSE(scene) << word;
  std::string all;
  bool found = false;
  for (const SceneError& error : scene.errors) {
    all += to_string(error) + "\n";
    found = found || (error.pointer == pointer && error.message.find(word) != std::string::npos);
  }
  EXPECT_TRUE(found) << pointer << ": " << word << "\n" << all;
}

TEST(SceneLoads, FaultsNameTheRemedy) {
  const std::string bodies =
      R"("bodies": [)" + loads_ball + R"(, {"name": "deck", "mobility": "kinematic"},
      {"name": "wall", "mobility": "static"}], "loads": [)";
  const auto force = [&](const std::string& rest) {
    return bodies + R"({"type": "force", "name": "f", )" + rest + "}]";
  };
  expect_load_fault(force(R"("body": "wall", "forces": [[1, 0, 0]])"), "/loads/0/body",
                    "no force moves");
  expect_load_fault(force(R"("body": "world", "forces": [[1, 0, 0]])"), "/loads/0/body",
                    "name a body");
  expect_load_fault(force(R"("body": "ball")"), "/loads/0", "needs forces or torques");
  expect_load_fault(force(R"("body": "ball", "times": [0, 1], "forces": [[1, 0, 0]])"),
                    "/loads/0/forces", "one value per time");
  expect_load_fault(force(R"("body": "ball", "times": [1, 1], "forces": [[1, 0, 0], [2, 0, 0]])"),
                    "/loads/0/times/1", "must increase");
  expect_load_fault(bodies + R"({"type": "wind", "name": "w", "body": "ball", "drag_area": 0}])",
                    "/loads/0/drag_area", "must be");
  expect_load_fault(bodies + R"({"type": "motion", "name": "m", "body": "ball", "frequencies": [1],
                          "translations": [[1, 0, 0]]}])",
                    "/loads/0/body", "kinematic");
  expect_load_fault(bodies + R"({"type": "motion", "name": "m", "body": "deck"}])", "/loads/0",
                    "needs translations or rotations");
  expect_load_fault(
      bodies + R"({"type": "motion", "name": "m", "body": "deck", "frequencies": [1, 2],
                          "translations": [[1, 0, 0]]}])",
      "/loads/0/translations", "one value per frequency");
  expect_load_fault(
      bodies + R"({"type": "force", "name": "a", "body": "ball", "forces": [[1, 0, 0]]},
                          {"type": "force", "name": "b", "body": "ball", "forces": [[1, 0, 0]],
                           "point": [1, 0, 0]}])",
      "/loads/1/body", "add up");
  expect_load_fault(force(R"("body": "ball", "forces": [[1, 0, 0]])") +
                        R"(, "triggers": [{"name": "t", "at": 1, "action": "set",
                      "target": "ball.force_x", "value": 1}])",
                    "/loads/0/body", "a trigger or a controller");
}

}  // namespace
}  // namespace sheave
