// Numbers near the limits of double are told; those up to the stated range stay finite.

#include "scenes/magnitude.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/simulation.h"

namespace sheave {
namespace {

/// Two weights on a cable over a wheel, and a free box, in units of a mass, a length and a time.
std::string scaled_scene(double mass, double length, double time) {
  const auto number = [](double value) { return fmt::format("{}", value); };
  const std::string g = number(-10.0 * length / (time * time));
  const std::string l = number(length);
  const std::string w = number(0.5 * length);
  const std::string m = number(mass);
  return R"({"format": "sheave-scene/1", "gravity": [0, )" + g + R"(, 0], "duration": )" +
         number(time) + R"(, "step": {"dt": )" + number(0.01 * time) + R"(}, "bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": )" +
         m + R"(, "shape": {"type": "cylinder", "radius": )" + w + R"(, "length": )" + w + R"(}},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "position": [-)" +
         w + ", -" + l + R"(, 0], "mass": )" + m + R"(},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "position": [)" +
         w + ", -" + l + R"(, 0], "mass": )" + number(2.0 * mass) + R"(},
    {"name": "box", "position": [)" +
         l + ", 0, 0], \"angular_velocity\": [" + number(1.0 / time) + ", " + number(2.0 / time) +
         R"(, 0], "mass": )" + m + R"(, "shape": {"type": "box", "size": [)" + l + ", " + w + ", " +
         number(0.2 * length) +
         R"(]}}],
   "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "light"},
    {"type": "rolling", "body": "wheel", "winding": "clockwise"},
    {"type": "attachment", "body": "heavy"}]}]})";
}

TEST(Magnitude, WithinTheStatedRangeAMachineMovesTheSameInOtherUnits) {
  // Each unit to where the first number of the scene comes to the range's end: the acceleration of
  // gravity is the largest.
  struct Units {
    double mass, length, time;
  };
  for (const Units& units :
       {Units{1.0, 1.0, 1.0}, Units{1e29, 1.0, 1.0}, Units{1e-29, 1.0, 1.0}, Units{1.0, 1e28, 1.0},
        Units{1.0, 1e-28, 1.0}, Units{1.0, 1.0, 1e-14}, Units{1.0, 1.0, 1e14},
        Units{1e29, 1e28, 1.0}, Units{1e-29, 1e-28, 1.0}, Units{1e29, 1e-28, 1.0},
        Units{1e29, 1.0, 1e-14}, Units{1e-29, 1e28, 1e14}}) {
    SCOPED_TRACE(fmt::format("{} kg, {} m, {} s", units.mass, units.length, units.time));
    const std::string text = scaled_scene(units.mass, units.length, units.time);
    const SceneResult scene = load_scene_text(text, "scaled");
    ASSERT_TRUE(scene) << to_string(scene.errors.front());
    const auto warnings = check_magnitudes(*scene, 10);
    EXPECT_TRUE(warnings.empty()) << warnings.front().message;
    for (const SolverKind solver : {SolverKind::gauss_seidel, SolverKind::direct}) {
      for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
        Model model = scene->model;
        model.step.solver = solver;
        model.step.integrator = integrator;
        auto simulation = Simulation::create(model, scene->cables);
        ASSERT_TRUE(simulation);
        for (int k = 0; k < 20; ++k) {
          const StepReport report = simulation->world.step();
          ASSERT_TRUE(report.ok()) << report.divergence->message;
        }
        EXPECT_TRUE(std::isfinite(simulation->world.energy().total()));
        // (m2 - m1) g / (m1 + m2 + I / r^2) with I = m r^2 / 2, after 0.2 units of time.
        const double expected = 10.0 / 3.5 * 0.2 * units.length / units.time;
        EXPECT_NEAR(simulation->world.velocity(BodyId{1}).y() / expected, 1.0, 0.01);
        EXPECT_TRUE(std::isfinite(simulation->cable_reports()[0].spans[0].tension));
      }
    }
  }
}

TEST(Magnitude, NumbersBeyondTheRangeAreReported) {
  const auto pointers = [](const std::string& text) {
    const SceneResult scene = load_scene_text(text, "scene");
    EXPECT_TRUE(scene) << to_string(scene.errors.front());
    std::vector<std::string> found;
    if (!scene) return found;
    for (const MagnitudeWarning& warning : check_magnitudes(*scene, 10)) {
      found.push_back(warning.pointer);
      EXPECT_THAT(warning.message, testing::HasSubstr("from 1e-30 to 1e+30"));
    }
    return found;
  };
  using testing::ElementsAre;
  EXPECT_THAT(pointers(R"({"format": "sheave-scene/1", "gravity": [0, -1e31, 0], "duration": 1,
    "step": {"dt": 1e-31},
    "bodies": [{"name": "a", "mass": 1e99, "shape": {"type": "sphere", "radius": 1e-31}},
               {"name": "b", "mass": 1, "velocity": [0, 0, 5e-324],
                "shape": {"type": "box", "size": [1, 1e40, 1]}}]})"),
              ElementsAre("/gravity/1", "/step/dt", "/bodies/0/mass", "/bodies/0/shape/radius",
                          "/bodies/1/velocity/2", "/bodies/1/shape/size/1"));
  // Both numbers are within the range, the mass that follows from them is not.
  EXPECT_THAT(pointers(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [{"name": "a", "density": 1e10, "shape": {"type": "sphere", "radius": 1e10}}]})"),
              ElementsAre("/bodies/0/density"));
  EXPECT_THAT(
      pointers(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [{"name": "a", "density": 1e3, "shape": {"type": "sphere", "radius": 1}}],
    "joints": [{"type": "distance", "name": "d", "body_b": "a", "anchor_a": [3, 0, 0],
                "anchor_b": [0, 0, 0], "compliance": 1e-99}],
    "cables": [{"name": "c", "compliance": 1e99, "links": [
      {"type": "attachment", "body": "a"},
      {"type": "attachment", "body": "world", "point": [1e-40, 2, 0]}]}]})"),
      ElementsAre("/joints/0/compliance", "/cables/0/compliance", "/cables/0/links/1/point/0"));
}

}  // namespace
}  // namespace sheave
