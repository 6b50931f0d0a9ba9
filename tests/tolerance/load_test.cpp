// Loads that change with time, with a tolerance: they act over the substeps of the tolerance, and
// end substeps at their corners where that matters. References are closed forms.
//
// The tolerance is the error that one second may add, and all runs take one second. So each error must
// stay below the tolerance.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/time_table.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

Simulation start_loaded(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

std::string loaded_scene(double tolerance, const std::string& bodies, const std::string& more) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {{"tolerance": {}}},
           "bodies": [{}], {}}})",
      tolerance, bodies, more);
}

/// Runs a second; calls `look` after each step. Returns the number of substeps that missed the
/// tolerance.
std::int64_t run_second(Simulation& simulation, const std::function<void(double)>& look) {
  std::int64_t missed = 0;
  for (int i = 0; i < 60; ++i) {
    const StepReport report = simulation.step();
    if (!report.ok()) throw std::runtime_error("it diverges");
    missed += report.statistics.missed_tolerance;
    look(simulation.world.state().time);
  }
  return missed;
}

const BodyState& body_of(const Simulation& simulation, const std::string& name) {
  int body = 0;
  while (simulation.world.bodies().name(body) != name) ++body;
  return simulation.world.state().bodies[static_cast<std::size_t>(body)];
}

constexpr const char* weight_on_a_rail =
    R"({"name": "frame", "mobility": "static", "position": [1, 0, 0], "shape": {"type": "sphere", "radius": 0.1}},
       {"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0, 0, 0]})";

/// The way of 1 kg from rest under a force that is linear between points; f = a + b s within a piece
/// adds v s + a s^2 / 2 + b s^3 / 6 to the way and a s + b s^2 / 2 to the speed.
double way_under(const std::vector<double>& times, const std::vector<double>& forces, double time) {
  double way = 0.0;
  double speed = 0.0;
  for (std::size_t i = 1; i < times.size() && times[i - 1] < time; ++i) {
    const double slope = (forces[i] - forces[i - 1]) / (times[i] - times[i - 1]);
    const double s = std::min(time, times[i]) - times[i - 1];
    way += speed * s + 0.5 * forces[i - 1] * s * s + slope * s * s * s / 6.0;
    speed += forces[i - 1] * s + 0.5 * slope * s * s;
  }
  return way;
}

/// Points of a sine of this amplitude [N] and frequency [Hz], forty per period.
struct SampledSine {
  SampledSine(double amplitude, double frequency) {
    for (int i = 0; times.empty() || times.back() < 1.1; ++i) {
      times.push_back(i / (40.0 * frequency));
      values.push_back(amplitude * std::sin(2.0 * std::numbers::pi * i / 40.0));
    }
  }
  std::vector<double> times, values;
};

void expect_within(const std::vector<double>& times, const std::vector<double>& forces) {
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 2e-6}) {
    std::vector<std::string> vectors;
    for (const double force : forces) vectors.push_back(fmt::format("[0, {}, 0]", force));
    const std::string load = fmt::format(
        R"("loads": [{{"type": "force", "name": "push", "body": "weight", "times": [{}], "forces": [{}]}}])",
        fmt::join(times, ", "), fmt::join(vectors, ", "));
    Simulation simulation = start_loaded(loaded_scene(tolerance, weight_on_a_rail, load));
    double worst = 0.0;
    const std::int64_t missed = run_second(simulation, [&](double time) {
      const double off =
          body_of(simulation, "weight").position.y() - way_under(times, forces, time);
      worst = std::max(worst, std::abs(off));
    });
    EXPECT_LE(worst, tolerance) << times.size() << " points, " << tolerance;
    EXPECT_EQ(missed, 0) << times.size() << " points, " << tolerance;
  }
}

TEST(TolerantLoads, RampIsWithinTheTolerance) {
  // With its mean over a quarter of a step the error would be 40 N/s h^2 / 12 = 5.8e-5 m.
  expect_within({0.0, 2.0}, {0.0, 80.0});
}

TEST(TolerantLoads, CornersAreWithinTheTolerance) {
  expect_within({0.0, 0.123, 0.2, 0.31, 0.7, 2.0}, {0.0, 50.0, -20.0, 80.0, 0.0, 0.0});
}

TEST(TolerantLoads, SineIsWithinTheTolerance) {
  const SampledSine sine(30.0, 1.7);
  expect_within(sine.times, sine.values);
}

TEST(TolerantLoads, SineWithThePeriodOfSubstepsIsSeen) {
  // The mean over each half of a step is 0, as if nothing acted. The weight drifts by F / (m w).
  const SampledSine sine(30.0, 120.0);
  expect_within(sine.times, sine.values);
}

TEST(TolerantLoads, TorqueTurnsABodyWithinTheTolerance) {
  // A body of 0.1 kg m2 and of the size s = 0.1 m under 4 N m/s: the surface moves by s x 40 t^3 / 6.
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 2e-6}) {
    Simulation simulation = start_loaded(loaded_scene(
        tolerance,
        R"({"name": "frame", "mobility": "static", "position": [1, 0, 0], "shape": {"type": "sphere", "radius": 0.1}},
           {"name": "wheel", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [0.1, 0.1, 0.1],
            "shape": {"type": "sphere", "radius": 0.1}})",
        R"("loads": [{"type": "force", "name": "turn", "body": "wheel", "times": [0, 2], "torques": [[0, 0, 0], [0, 0, 8]]}])"));
    double worst = 0.0;
    const std::int64_t missed = run_second(simulation, [&](double time) {
      const double off = body_of(simulation, "wheel").angle - 40.0 * time * time * time / 6.0;
      worst = std::max(worst, 0.1 * std::abs(off));
    });
    EXPECT_LE(worst, tolerance);
    EXPECT_EQ(missed, 0);
  }
}

TEST(TolerantLoads, DragThroughAnImpactIsWithinTheTolerance) {
  // v' = -k v^2 / m gives the way m / k ln(1 + k v t / m), also beyond an elastic wall, which reflects
  // it. Drag by the velocities of before the impact would act in the wrong direction.
  constexpr double k = 0.5 * 1.225 * 2.0;
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    Simulation simulation = start_loaded(loaded_scene(
        tolerance,
        R"({"name": "wall", "mobility": "static", "position": [2, 0, 0], "shape": {"type": "box", "size": [1, 1, 1]}},
           {"name": "ball", "mass": 1, "position": [0, 0, 0], "velocity": [5, 0, 0],
            "shape": {"type": "sphere", "radius": 0.1}})",
        R"("colliders": [{"body": "wall", "restitution": 1}, {"body": "ball", "restitution": 1}],
           "loads": [{"type": "wind", "name": "air", "body": "ball", "drag_area": 2}])"));
    double worst = 0.0;
    const std::int64_t missed = run_second(simulation, [&](double time) {
      const double way = std::log(1.0 + k * 5.0 * time) / k;
      const double right = way < 1.4 ? way : 2.8 - way;
      worst = std::max(worst, std::abs(body_of(simulation, "ball").position.x() - right));
    });
    EXPECT_LE(worst, tolerance);
    EXPECT_EQ(missed, 0);
  }
}

/// A ship heaves by a (cos(W t) - 1) and yaws by the same angle. On it hang 1 kg by a spring along a
/// guide and a wheel by a torsion spring, both with w = 8 rad/s. From rest, each one follows
///   x'' = w^2 (a (cos(W t) - 1) - x):   x = -a + a (w^2 cos(W t) - W^2 cos(w t)) / (w^2 - W^2).
void expect_to_follow(double frequency, double tolerance) {
  constexpr double a = 0.01;
  constexpr double w = 8.0;
  const double fast = 2.0 * std::numbers::pi * frequency;
  Simulation simulation = start_loaded(loaded_scene(
      tolerance,
      R"({"name": "ship", "mobility": "kinematic", "shape": {"type": "box", "size": [1, 1, 1]}},
         {"name": "load", "mass": 1, "inertia": [0.1, 0.1, 0.1]},
         {"name": "wheel", "mass": 1, "inertia": [1, 1, 1], "shape": {"type": "sphere", "radius": 1}})",
      fmt::format(
          R"("joints": [{{"type": "slider", "name": "spring", "body_a": "ship", "body_b": "load", "anchor": [0, 0, 0],
               "axis": [0, 1, 0], "stiffness": 64}},
              {{"type": "hinge", "name": "torsion", "body_a": "ship", "body_b": "wheel", "anchor": [0, 0, 0],
               "axis": [0, 1, 0], "stiffness": 64}}],
             "loads": [{{"type": "motion", "name": "sea", "body": "ship", "frequencies": [{}],
               "phases": [{}], "translations": [[0, {}, 0]], "rotations": [[0, {}, 0]]}}])",
          frequency, 0.5 * std::numbers::pi, a, a)));
  double worst = 0.0;
  const std::int64_t missed = run_second(simulation, [&](double time) {
    const double right =
        -a + a * (w * w * std::cos(fast * time) - fast * fast * std::cos(w * time)) /
                 (w * w - fast * fast);
    worst = std::max(worst, std::abs(body_of(simulation, "load").position.y() - right));
    const Quaternion& q = body_of(simulation, "wheel").orientation;
    worst = std::max(worst, std::abs(2.0 * std::atan2(q.y(), q.w()) - right));
  });
  EXPECT_LE(worst, tolerance) << frequency << " Hz";
  EXPECT_EQ(missed, 0) << frequency << " Hz";
}

TEST(TolerantLoads, ShakenBodiesAreWithinTheTolerance) {
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) expect_to_follow(1.3, tolerance);
  expect_to_follow(20.0, 1e-3);
  expect_to_follow(20.0, 1e-4);
}

TEST(TolerantLoads, ShakingWithThePeriodOfSubstepsIsSeen) {
  // Half of a step is one period: the ship is where it was, and at rest, at the end of each half.
  expect_to_follow(120.0, 1e-3);
}

TEST(TolerantLoads, BodiesThatMoveAsTheyAreToldTakeTheLongestSubsteps) {
  // No body has an acceleration that could change, so no first half is done for comparison.
  Simulation simulation = start_loaded(loaded_scene(
      1e-4,
      R"({"name": "ship", "mobility": "kinematic", "shape": {"type": "box", "size": [1, 1, 1]}})",
      R"("loads": [{"type": "motion", "name": "sea", "body": "ship", "times": [0, 0.5, 1],
           "positions": [[0, 0, 0], [3, 0, 0], [0, 0, 0]]}])"));
  std::int64_t kept = 0;
  std::int64_t undone = 0;
  for (int i = 0; i < 60; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.ok());
    kept += report.statistics.kept_substeps;
    undone += report.statistics.undone_substeps;
  }
  EXPECT_LE(kept, 2 * 60);
  EXPECT_EQ(undone, 0);
}

TEST(TolerantLoads, StateInTheMiddleGoesOnWithTheSameBits) {
  const std::string text = loaded_scene(
      1e-4,
      R"({"name": "wall", "mobility": "static", "position": [2, 0, 0], "shape": {"type": "box", "size": [1, 9, 9]}},
         {"name": "ship", "mobility": "kinematic", "position": [-1, 0, 0], "shape": {"type": "box", "size": [1, 1, 1]}},
         {"name": "ball", "mass": 1, "velocity": [5, 0, 0], "shape": {"type": "sphere", "radius": 0.1}})",
      R"("colliders": [{"body": "wall", "restitution": 1}, {"body": "ball", "restitution": 1}],
         "loads": [{"type": "wind", "name": "air", "body": "ball", "drag_area": 2},
                   {"type": "force", "name": "push", "body": "ball", "times": [0, 0.111, 0.2], "forces": [[0, 0, 0], [0, 9, 0], [0, 0, 0]]},
                   {"type": "motion", "name": "sea", "body": "ship", "frequencies": [3], "translations": [[0, 1, 0]]}],
         "cables": [{"name": "rope", "compliance": 0.01, "links": [
           {"type": "attachment", "body": "ship"}, {"type": "attachment", "body": "ball"}]}])");
  Simulation whole = start_loaded(text);
  Simulation second = start_loaded(text);
  for (int i = 0; i < 60; ++i) {
    const Result<State> saved = state_from_bytes(to_bytes(whole.world.state()));
    ASSERT_TRUE(saved.ok());
    ASSERT_TRUE(second.world.restore(*saved).empty());
    ASSERT_TRUE(whole.step().ok());
    ASSERT_TRUE(second.step().ok());
    ASSERT_EQ(hash(whole.world.state()), hash(second.world.state())) << i;
  }
}

TEST(TolerantLoads, MomentOfATableIsThatOfItsPieces) {
  // f = 2 t up to 1 s, then 2. Over 0 ... 2 s about 1 s: integral of (1 - t) f = 1/3 - 1 = -2/3.
  const TimeTable ramp = TimeTable::of({0.0, 1.0}, {0.0, 2.0}, Interpolation::linear);
  EXPECT_NEAR(ramp.moment(0.0, 2.0), -2.0 / 3.0, 1e-15);
  EXPECT_EQ(ramp.moment(3.0, 4.0), 0.0);
  // A spline through a cubic is the cubic: t^3 over 0 ... 1 s about 0.5 s: 1/8 - 1/5.
  const TimeTable cubic = TimeTable::of({-1.0, 0.3, 0.6, 1.5, 2.0},
                                        {-1.0, 0.027, 0.216, 3.375, 8.0}, Interpolation::cubic);
  EXPECT_NEAR(cubic.moment(0.0, 1.0), 0.125 - 0.2, 1e-14);
  EXPECT_EQ(ramp.next_corner(-1.0), 0.0);
  EXPECT_EQ(ramp.next_corner(0.0), 1.0);
  EXPECT_EQ(ramp.next_corner(1.0), no_instant);
}

}  // namespace
}  // namespace sheave::test
