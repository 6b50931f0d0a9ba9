// A tendon with a spring and a damper over a smooth cylinder that it comes onto and leaves.
//
// The tension is that of the whole length L, on the cylinder or straight: T = k (L - L0) + c L',
// not below 0. The rope has axial_stiffness k L0 and axial_damping c L0, so that its spans and the arc
// together are this spring and this damper. The tendon turns a forearm about a hinge in the axis of
// the cylinder, I w' = -T dL / dangle, which the reference integrates with Runge-Kutta's formula.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::damped_tendon {
namespace {

constexpr double radius = 0.03;
constexpr double k = 100.0;
constexpr double c = 20.0;
constexpr double rest = 0.2;
constexpr double inertia = 0.008;
constexpr double duration = 0.3;
const std::array<double, 2> from{-0.2, 0.04};

struct Start {
  double angle;      // about y [rad]
  double rate;       // [rad/s]
  bool found;        // the cylinder is a wrappable body, and no link of the rope
  const char* name;  // of what happens
};

/// Length of the tendon above the cylinder.
double length_at(double angle) {
  const double x = 0.1 * std::cos(angle) + 0.02 * std::sin(angle);
  const double z = -0.1 * std::sin(angle) + 0.02 * std::cos(angle);
  const double straight = std::hypot(x - from[0], z - from[1]);
  // The height of the straight line over the axis.
  const double height = (from[1] * x - from[0] * z) / straight;
  if (height >= radius) return straight;
  const double a = std::hypot(from[0], from[1]);
  const double b = std::hypot(x, z);
  const double between = std::atan2(from[1], from[0]) - std::atan2(z, x);
  return std::sqrt(a * a - radius * radius) + std::sqrt(b * b - radius * radius) +
         radius * (between - std::acos(radius / a) - std::acos(radius / b));
}

std::array<double, 2> rates(const std::array<double, 2>& state) {
  constexpr double e = 1e-6;
  const double slope = (length_at(state[0] + e) - length_at(state[0] - e)) / (2.0 * e);
  const double tension = k * (length_at(state[0]) - rest) + c * slope * state[1];
  return {state[1], -std::max(tension, 0.0) * slope / inertia};
}

double reference(const Start& start) {
  // An event within a step costs some 1e-4 of the change of the forces there, of steps of 5e-5 s.
  constexpr int steps = 6000;
  constexpr double h = duration / steps;
  std::array<double, 2> state{start.angle, start.rate};
  const auto after = [&](const std::array<double, 2>& rate, double time) {
    return std::array{state[0] + time * rate[0], state[1] + time * rate[1]};
  };
  for (int i = 0; i < steps; ++i) {
    const auto k1 = rates(state);
    const auto k2 = rates(after(k1, 0.5 * h));
    const auto k3 = rates(after(k2, 0.5 * h));
    const auto k4 = rates(after(k3, h));
    for (std::size_t n = 0; n < 2; ++n) {
      state[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
    }
  }
  return state[0];
}

Simulation forearm(const Start& start, const char* integrator, int substeps) {
  const std::string surface =
      R"({"type": "surface", "body": "post", "shape": 0, "winding": "counter-clockwise",
          "normal": [0, 1, 0]}, )";
  const std::string text = fmt::format(
      R"({{"format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0],
      "step": {{"dt": 0.001, "substeps": {}, "integrator": "{}"}},
      "bodies": [
        {{"name": "post", "mobility": "static", "wrappable": {}, "shapes": [{{"type": "cylinder",
          "radius": {}, "length": 0.08,
          "orientation": [0.7071067811865476, -0.7071067811865475, 0, 0]}}]}},
        {{"name": "fore", "orientation": [{}, 0, {}, 0], "angular_velocity": [0, {}, 0],
          "mass": 0.5, "center_of_mass": [0.1, 0, 0], "inertia": [0.003, 0.003, 0.003]}}],
      "joints": [{{"type": "hinge", "name": "elbow", "body_a": "world", "body_b": "fore",
          "anchor": [0, 0, 0], "axis": [0, 1, 0]}}],
      "cables": [{{"name": "tendon", "axial_stiffness": {}, "axial_damping": {},
        "rest_lengths": [{}], "most_wraps": {}, "links": [
          {{"type": "attachment", "body": "world", "point": [-0.2, 0, 0.04]}},
          {}
          {{"type": "attachment", "body": "fore", "point": [0.1, 0, 0.02]}}]}}]}})",
      substeps, integrator, start.found, radius, std::cos(0.5 * start.angle),
      std::sin(0.5 * start.angle), start.rate, k * rest, c * rest,
      start.found ? "0.2" : "0.12658226493274424, 0.06115577304184794", start.found ? 1 : 0,
      start.found ? "" : surface);
  const SceneResult scene = load_scene_text(text, "forearm");
  for (const SceneError& error : scene.errors) ADD_FAILURE() << to_string(error);
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) ADD_FAILURE() << simulation.errors().front().message;
  return std::move(*simulation);
}

/// Error of the angle at the end [rad].
double error(const Start& start, const char* integrator, int substeps) {
  Simulation s = forearm(start, integrator, substeps);
  for (int i = 0; i < 300; ++i) EXPECT_TRUE(s.world.step().ok());
  const auto certificate = s.certificate();
  EXPECT_TRUE(certificate && certificate->clean(1e-6));
  // The forearm turns by less than half a turn from angle 0, as the reference does.
  const Quaternion& turned = s.world.state().bodies[1].orientation;
  return std::abs(2.0 * std::atan2(turned.y(), turned.w()) - reference(start));
}

constexpr std::array starts{Start{0.6, -8.0, false, "lifts off a surface link"},
                            Start{-0.3, 10.0, true, "comes onto a wrappable body"}};

// Lifting off and coming on have errors of the order of the time step: the damper's force begins to
// act along another line within a substep. With 1e-3 s they are some 1e-4 rad.
TEST(DampedTendon, HasOneSpringAndOneDamperOnTheBodyAndBesideIt) {
  for (const Start& start : starts) {
    SCOPED_TRACE(start.name);
    EXPECT_LT(error(start, "rattle", 1), 2e-4);
    EXPECT_LT(error(start, "rattle", 4), 2e-5);
    EXPECT_LT(error(start, "rattle", 16), 2e-6);
  }
}

// Implicit Euler damps by an error of first order.
TEST(DampedTendon, ConvergesWithXpbd) {
  for (const Start& start : starts) {
    SCOPED_TRACE(start.name);
    const double coarse = error(start, "xpbd", 4);
    EXPECT_LT(coarse, 1e-2);
    EXPECT_NEAR(error(start, "xpbd", 16) / coarse, 0.25, 0.05);
  }
}

// With friction the tensions along an arc differ, and so would those of the dampers.
TEST(DampedTendon, SlidesWithoutFrictionOnly) {
  for (const bool found : {false, true}) {
    const std::string text = fmt::format(
        R"({{"format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0],
        "bodies": [{{"name": "post", "mobility": "static", "wrappable": {0}, "position": [0, 1, 0],
          "shape": {{"type": "cylinder", "radius": 0.1, "length": 1}}}}],
        "cables": [{{"name": "rope", "axial_stiffness": 1e4, "axial_damping": 10, {1} "links": [
          {{"type": "attachment", "body": "world", "point": [-1, 0, 0]}},
          {2}
          {{"type": "attachment", "body": "world", "point": [1, 0, 0]}}]}}]}})",
        found, found ? R"("wrap_friction": 0.1,)" : "",
        found ? ""
              : R"({"type": "rolling", "body": "post", "winding": "clockwise", "friction": 0.1},)");
    const SceneResult scene = load_scene_text(text, "post");
    ASSERT_FALSE(scene.errors.empty());
    EXPECT_THAT(scene.errors.front().message,
                ::testing::HasSubstr(found ? "axial_damping and wrap_friction"
                                           : "slides over an arc without friction only"));
  }
}

}  // namespace
}  // namespace sheave::damped_tendon
