// Impacts with a tolerance: each one ends a substep, with free bodies, too, and without restitution.
// A free fall is exact with `rattle`, and the instant of an impact is known to 1e-9 of a substep of
// 1/240 s. So an impact at v adds some 1e-9 v / 240 s to the place, below 1e-10 m here. An instant
// within 1e-4 of that length of an end of its substep is moved there: that adds (1 + e) v 4.2e-7 s.

#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/math/turn_between.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

constexpr double fall = 9.81;  // [m/s2]

Simulation start_impact(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

/// Height of the lowest point of a ball that falls from `height` onto a floor [m].
double height_of_bounces(double height, double restitution, double time) {
  double speed = std::sqrt(2.0 * fall * height);
  double since = time - speed / fall;
  if (since < 0.0) return height - 0.5 * fall * time * time;
  while (true) {
    speed *= restitution;
    const double flight = 2.0 * speed / fall;
    if (!(flight > 1e-12)) return 0.0;
    if (since < flight) return speed * since - 0.5 * fall * since * since;
    since -= flight;
  }
}

/// A ball over a floor whose normal is `up`.
std::string bouncing_ball(double tolerance, double height, double restitution, const Vector3& up,
                          const std::string& mobility = "free") {
  const Quaternion turn = turn_between(Vector3::UnitY(), up);
  const Vector3 at = (height + 0.1) * up;
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [{}, {}, {}], "duration": 2, "step": {{"tolerance": {}}},
           "bodies": [
             {{"name": "floor", "mobility": "static", "orientation": [{}, {}, {}, {}], "shape": {{"type": "half-space"}}}},
             {{"name": "ball", "mass": 2, "mobility": "{}", {} "position": [{}, {}, {}],
              "shape": {{"type": "sphere", "radius": 0.1}}}}],
           "colliders": [{{"body": "floor", "restitution": {}}}, {{"body": "ball", "restitution": {}}}]}})",
      -fall * up.x(), -fall * up.y(), -fall * up.z(), tolerance, turn.w(), turn.x(), turn.y(),
      turn.z(), mobility,
      mobility == "slider" ? fmt::format("\"axis\": [{}, {}, {}],", up.x(), up.y(), up.z()) : "",
      at.x(), at.y(), at.z(), restitution, restitution);
}

void expect_bounces(double tolerance, double height, double restitution, const Vector3& up,
                    double allowed, const std::string& mobility = "free") {
  Simulation simulation = start_impact(bouncing_ball(tolerance, height, restitution, up, mobility));
  double worst = 0.0;
  std::int64_t missed = 0;
  for (int i = 0; i < 120; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.ok());
    missed += report.statistics.missed_tolerance;
    const double now = simulation.world.state().bodies[1].position.dot(up) - 0.1;
    const double right = height_of_bounces(height, restitution, simulation.world.state().time);
    worst = std::max(worst, std::abs(now - right));
  }
  const std::string which = fmt::format("from {} m, {}, within {}", height, restitution, tolerance);
  EXPECT_LE(worst, allowed) << which;
  EXPECT_EQ(missed, 0) << which;
}

TEST(TolerantImpacts, FastImpactIsNoMiss) {
  // A jump by 7.5 m/s moves a body by 3.8e-6 m in the shortest substep, 1/60 s / 2^15: more than a
  // quarter of the tolerance.
  for (const double tolerance : {1e-4, 1e-5, 3e-6}) {
    expect_bounces(tolerance, 1.0, 0.7, Vector3::UnitY(), 1e-9);
    expect_bounces(tolerance, 1.0, 1.0, Vector3(0.6, 0.0, -0.8), 1e-9);
    expect_bounces(tolerance, 1.0, 1.0, Vector3(-0.36, -0.48, 0.8), 1e-9, "slider");
  }
}

TEST(TolerantImpacts, BallThatDoesNotReboundStays) {
  for (const double tolerance : {1e-4, 1e-5, 3e-6}) {
    expect_bounces(tolerance, 1.0, 0.0, Vector3::UnitY(), 1e-9);
    expect_bounces(tolerance, 0.3, 0.0, Vector3(0.6, 0.0, -0.8), 1e-9, "slider");
  }
}

TEST(TolerantImpacts, BouncesWithoutEndAreWithinTheTolerance) {
  // Bounces that follow each other faster than four per quarter of a step are no longer located.
  // The tolerance is that of one second.
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    expect_bounces(tolerance, 0.7, 0.3, Vector3::UnitY(), 2.0 * tolerance);
    expect_bounces(tolerance, 1.0, 0.5, Vector3::UnitY(), 2.0 * tolerance);
  }
}

TEST(TolerantImpacts, BesideTheBoundaryOfTwoStepsIsNoMiss) {
  // The search for an impact may begin in one step and end in the next one.
  for (const double beside : {-5e-6, -4e-7, -1e-9, 0.0, 1e-9, 4e-7, 5e-6}) {
    for (const double restitution : {0.0, 1.0}) {
      const double time = 20.0 / 60.0 + beside;
      const double speed = fall * time;
      const int impacts = restitution > 0.0 ? 3 : 1;
      const double moved = impacts * (1.0 + restitution) * speed * 1e-4 / 240.0;
      expect_bounces(1e-4, 0.5 * speed * time, restitution, Vector3::UnitY(), 1e-9 + moved);
    }
  }
}

TEST(TolerantImpacts, PassThroughARowOfBalls) {
  // The first of four balls of 1 kg comes at 1.1 m/s; each one takes the speed on over 0.11 m, 0.1 s,
  // which is six steps. The last one rebounds from the wall.
  std::string balls;
  std::string colliders;
  for (int i = 0; i < 4; ++i) {
    balls += fmt::format(
        R"(, {{"name": "b{}", "mobility": "slider", "axis": [1, 0, 0], "mass": 1, "position": [{}, 0, 0],
            "velocity": [{}, 0, 0], "shape": {{"type": "sphere", "radius": 0.05}}}})",
        i, 0.21 * i, i == 0 ? 1.1 : 0.0);
    colliders += fmt::format(R"(, {{"body": "b{}", "restitution": 1}})", i);
  }
  Simulation simulation = start_impact(fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {{"tolerance": 1e-4}},
           "bodies": [{{"name": "wall", "mobility": "static", "position": [0.84, 0, 0],
             "shape": {{"type": "box", "size": [0.1, 1, 1]}}}}{}],
           "colliders": [{{"body": "wall", "restitution": 1}}{}]}})",
      balls, colliders));
  std::int64_t missed = 0;
  for (int i = 0; i < 60; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.ok());
    missed += report.statistics.missed_tolerance;
    const double time = simulation.world.state().time;
    // Between the first ball's start and the wall the speed travels 4 x 0.11 m there and back.
    const double way = 1.1 * time;
    const double there = std::min(way, 0.88 - way);
    for (int b = 0; b < 4 && way <= 0.88; ++b) {
      const double right = 0.21 * b + std::clamp(there - 0.11 * b, 0.0, 0.11);
      EXPECT_NEAR(simulation.world.state().bodies[static_cast<std::size_t>(b + 1)].position.x(),
                  right, 1e-9)
          << time;
    }
  }
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace sheave::test
