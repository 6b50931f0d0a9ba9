// Machines whose substeps keep a tolerance, against closed forms through events: the error is within
// the tolerance and falls with it, and the work grows with its root only.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cable/run_check.h"
#include "engine/body_set.h"
#include "measure/error_estimate.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

constexpr double g = 9.81;

/// A scene, and where one of its bodies is at a time [m].
struct KnownMotion {
  std::string name;
  std::string text;  ///< without "step"
  std::string body;
  int axis = 1;
  double duration = 1.0;
  std::function<double(double)> place;
};

/// A ball of 1 kg falls by 0.5 m onto a floor of this stiffness [N/m] without losses, and so on for ever.
KnownMotion bouncing(double stiffness = 1e4) {
  const auto place = [k = stiffness](double t) {
    const double fall = std::sqrt(1.0 / g);
    const double speed = g * fall;
    const double omega = std::sqrt(k);
    const double depth = g / k;  // at rest
    const double amplitude = std::hypot(depth, speed / omega);
    const double phase = std::atan2(depth, speed / omega);
    const double contact = (std::numbers::pi + 2.0 * phase) / omega;
    const double s = std::fmod(t + fall, contact + 2.0 * fall);
    if (s <= 2.0 * fall) return 0.05 + speed * s - 0.5 * g * s * s;
    return 0.05 - depth - amplitude * std::sin(omega * (s - 2.0 * fall) - phase);
  };
  const std::string text = fmt::format(
      R"("bodies": [
            {{"name": "floor", "mobility": "static", "shape": {{"type": "half-space"}}}},
            {{"name": "ball", "mass": 1, "position": [0, 0.55, 0],
             "shape": {{"type": "sphere", "radius": 0.05}}}}],
          "colliders": [{{"body": "floor"}}, {{"body": "ball", "compliance": {}, "restitution": 1}}])",
      1.0 / stiffness);
  return {"bouncing", text, "ball", 1, 1.9, place};
}

/// A load of 1 kg falls into a rope of 100 N/m, which breaks at 15 N.
KnownMotion breaking() {
  const auto place = [](double t) {
    constexpr double omega = 10.0;
    const double depth = g / 100.0;
    // 100 N/m x depth (1 - cos) = 15 N
    const double broken = std::acos(1.0 - 0.15 / depth) / omega;
    if (t < broken) return -1.0 - depth * (1.0 - std::cos(omega * t));
    const double since = t - broken;
    const double speed = depth * omega * std::sin(omega * broken);
    return -1.15 - speed * since - 0.5 * g * since * since;
  };
  return {"breaking",
          R"("bodies": [
            {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0, -1, 0]}],
          "cables": [{"name": "rope", "compliance": 0.01, "rest_lengths": [1], "breaking_tension": 15, "links": [
            {"type": "attachment", "body": "world", "point": [0, 0, 0]},
            {"type": "attachment", "body": "load"}]}])", "load", 1, 1.0, place};
}

/// A rope of 20 N/m, whose end moves at 0.5 m/s, pulls a box of 1 kg that holds by 0.3 of its weight.
KnownMotion sliding() {
  const auto place = [](double t) {
    const double since = t - 0.3 * g / (20.0 * 0.5);
    const double omega = std::sqrt(20.0);
    return since < 0.0 ? 0.0 : 0.5 * (since - std::sin(omega * since) / omega);
  };
  return {"sliding",
          R"("bodies": [
            {"name": "floor", "mobility": "static", "shape": {"type": "half-space"}},
            {"name": "box", "mass": 1, "position": [0, 0.1, 0], "shape": {"type": "box", "size": [0.4, 0.2, 0.3]}},
            {"name": "hand", "mobility": "kinematic", "position": [1, 0.1, 0], "velocity": [0.5, 0, 0]}],
          "colliders": [{"body": "floor", "friction": 0.3}, {"body": "box", "friction": 0.3}],
          "cables": [{"name": "rope", "compliance": 0.05, "rest_lengths": [1], "links": [
            {"type": "attachment", "body": "box"}, {"type": "attachment", "body": "hand"}]}])", "box", 0, 1.0, place};
}

/// 2 kg and 1 kg over a wheel without inertia. The heavy weight lands, the light one flies on, falls
/// back into the rope and lifts the heavy one, and so on: speeds become three times smaller.
KnownMotion landing() {
  const auto place = [](double t) {
    const double pull = g / 3.0;
    double at = std::sqrt(1.0 / pull);
    if (t <= at) return -2.0 + 0.5 * pull * t * t;
    double speed = pull * at;
    while (true) {
      const double flight = 2.0 * speed / g;
      if (t - at <= flight) return -1.5 + speed * (t - at) - 0.5 * g * (t - at) * (t - at);
      at += flight;
      speed /= 3.0;
      const double lift = 2.0 * speed / pull;
      if (t - at <= lift) return -1.5 - speed * (t - at) + 0.5 * pull * (t - at) * (t - at);
      at += lift;
    }
  };
  return {"landing",
          R"("bodies": [
            {"name": "floor", "mobility": "static", "position": [0, -2.6, 0], "shape": {"type": "half-space"}},
            {"name": "wheel", "mobility": "rotor", "mass": 0.1, "spin_inertia": 0,
             "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
            {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]},
            {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0],
             "shape": {"type": "sphere", "radius": 0.1}}],
          "colliders": [{"body": "floor"}, {"body": "heavy"}],
          "cables": [{"name": "rope", "links": [
            {"type": "attachment", "body": "light"},
            {"type": "rolling", "body": "wheel", "winding": "clockwise"},
            {"type": "attachment", "body": "heavy"}]}])", "light", 1, 1.5, place};
}

std::vector<KnownMotion> known_motions() { return {bouncing(), breaking(), sliding(), landing()}; }

std::string scene_text(const KnownMotion& motion, const std::string& step) {
  return fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": {}, "step": {{{}}}, {}}})",
      motion.duration, step, motion.text);
}

Simulation start_tolerant(const std::string& text) {
  const SceneResult scene = load_scene_text(text, "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  return std::move(*simulation);
}

struct Measured {
  double error = 0.0;  // the largest of all frames [m]
  std::int64_t work = 0;
  std::int64_t missed = 0;
};

Measured measure_run(const KnownMotion& motion, const std::string& step) {
  Simulation simulation = start_tolerant(scene_text(motion, step));
  World& world = simulation.world;
  int body = 0;
  while (world.bodies().name(body) != motion.body) ++body;
  Measured measured;
  while (world.state().time < motion.duration - 1e-6) {
    const StepReport report = simulation.step();
    if (!report.ok()) throw std::runtime_error("it diverges");
    const StepStatistics& done = report.statistics;
    measured.work += done.kept_substeps + done.undone_substeps;
    if (done.kept_substeps == 0) measured.work += world.model().step.substeps;
    measured.missed += done.missed_tolerance;
    const double off = world.position(BodyId{body})[motion.axis] - motion.place(world.state().time);
    measured.error = std::max(measured.error, std::abs(off));
  }
  return measured;
}

Measured measure_run(const KnownMotion& motion, double tolerance) {
  return measure_run(motion, fmt::format(R"("tolerance": {})", tolerance));
}

TEST(Tolerance, BoundsTheErrorThroughEvents) {
  for (const KnownMotion& motion : known_motions()) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const Measured measured = measure_run(motion, tolerance);
      EXPECT_LE(measured.error, tolerance * motion.duration) << motion.name << " " << tolerance;
      EXPECT_EQ(measured.missed, 0) << motion.name << " " << tolerance;
    }
  }
}

TEST(Tolerance, WorkGrowsAtMostWithItsRoot) {
  // h^2 is proportional to the tolerance, and lengths are rounded to powers of two: a factor of 100
  // takes at most 10 x 2 times the work.
  for (const KnownMotion& motion : known_motions()) {
    const Measured coarse = measure_run(motion, 1e-3);
    const Measured fine = measure_run(motion, 1e-5);
    EXPECT_LE(fine.work, 20 * coarse.work) << motion.name;
  }
}

TEST(Tolerance, TakesAFifthOfTheWorkOfFixedSubstepsAtEvents) {
  for (const KnownMotion& motion : {bouncing(), landing()}) {
    const Measured adaptive = measure_run(motion, 1e-4);
    const std::int64_t steps = std::lround(60.0 * motion.duration);
    const std::int64_t count = 5 * adaptive.work / steps;
    const Measured fixed = measure_run(motion, fmt::format(R"("substeps": {})", count));
    EXPECT_GT(fixed.error, adaptive.error) << motion.name << " with " << count;
  }
}

/// A weight of 1 kg swings on an elastic rope of 25 N/m, which stays taut: w = 5 rad/s.
KnownMotion swinging() {
  const auto place = [](double t) { return -1.0 - g / 25.0 * (1.0 - std::cos(5.0 * t)); };
  return {"swinging",
          R"("bodies": [
            {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0, -1, 0]}],
          "cables": [{"name": "rope", "compliance": 0.04, "rest_lengths": [1], "links": [
            {"type": "attachment", "body": "world", "point": [0, 0, 0]},
            {"type": "attachment", "body": "load"}]}])", "load", 1, 1.0, place};
}

void expect_right_estimate(const KnownMotion& motion, double tolerance) {
  const std::string text = scene_text(motion, fmt::format(R"("tolerance": {})", tolerance));
  const SceneResult scene = load_scene_text(text, "s.json");
  ASSERT_TRUE(scene);
  Simulation run = start_tolerant(text);
  auto estimator = measure::ErrorEstimator::create(*scene, run.world.state());
  ASSERT_TRUE(estimator);
  while (run.world.state().time < motion.duration - 1e-6) {
    ASSERT_TRUE(run.step().ok());
    estimator->observe(run);
  }
  const measure::ErrorEstimate estimate = estimator->estimate();
  const auto body = std::ranges::find(estimate.bodies, motion.body, &measure::BodyDifference::name);
  ASSERT_NE(body, estimate.bodies.end());
  const double right = measure_run(motion, tolerance).error;
  EXPECT_GT(body->position.error(), 0.5 * right) << motion.name << " " << tolerance;
  EXPECT_LT(body->position.error(), 3.0 * right) << motion.name << " " << tolerance;
}

TEST(Tolerance, EstimateIsBetweenHalfAndThreeTimesTheError) {
  for (const KnownMotion& motion : known_motions()) expect_right_estimate(motion, 1e-4);
}

TEST(Tolerance, EstimateIsRightWhereTheStepLimitsTheLength) {
  // A substep of 1/60 s has an error far below 1 m, as have those of a quarter and of a 16th of it.
  expect_right_estimate(swinging(), 1.0);
}

TEST(Tolerance, KeepsTheEnergyOfAPendulum) {
  // Of 150 periods the last ones have no larger error of energy than the first ones.
  Simulation simulation = start_tolerant(
      R"({"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 300,
          "step": {"tolerance": 1e-3},
          "bodies": [{"name": "rod", "mass": 1, "position": [0.4, 0.2, 0], "inertia": [0.1, 0.1, 0.08]}],
          "joints": [{"type": "hinge", "name": "hinge", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1]}]})");
  const double start = simulation.world.energy().total();
  std::array<double, 10> off{};
  for (double& part : off) {
    for (int i = 0; i < 30 * 60; ++i) {
      ASSERT_TRUE(simulation.step().ok());
      part = std::max(part, std::abs(simulation.world.energy().total() - start));
    }
  }
  EXPECT_LE(off.back(), 1.2 * off.front());
}

TEST(Tolerance, LooksAheadOnlyWhereSomethingMayBeDecidedLate) {
  // In a pendulum nothing is decided. Its substeps are undone only where they become shorter: in
  // the first swing, at most twice for each of some ten levels.
  Simulation simulation = start_tolerant(
      R"({"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 10,
          "step": {"tolerance": 1e-3},
          "bodies": [{"name": "rod", "mass": 1, "position": [0.4, 0.2, 0], "inertia": [0.1, 0.1, 0.08]}],
          "joints": [{"type": "hinge", "name": "hinge", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1]}]})");
  std::int64_t kept = 0;
  std::int64_t undone = 0;
  for (int i = 0; i < 600; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.ok());
    kept += report.statistics.kept_substeps;
    undone += report.statistics.undone_substeps;
  }
  EXPECT_GE(kept, 600);
  EXPECT_LE(undone, 20);
}

TEST(Tolerance, StateInTheMiddleGoesOnWithTheSameBits) {
  for (const KnownMotion& motion : known_motions()) {
    const std::string text = scene_text(motion, R"("tolerance": 1e-4)");
    Simulation whole = start_tolerant(text);
    Simulation second = start_tolerant(text);
    for (int i = 0; i < 25; ++i) ASSERT_TRUE(whole.step().ok());
    const Result<State> saved = state_from_bytes(to_bytes(whole.world.state()));
    ASSERT_TRUE(saved.ok());
    ASSERT_TRUE(second.world.restore(*saved).empty());
    for (int i = 0; i < 25; ++i) {
      ASSERT_TRUE(whole.step().ok());
      ASSERT_TRUE(second.step().ok());
      ASSERT_EQ(hash(whole.world.state()), hash(second.world.state())) << motion.name << " " << i;
    }
  }
}

TEST(Tolerance, StoppedStepChangesNothing) {
  Simulation simulation = start_tolerant(scene_text(breaking(), R"("tolerance": 1e-4)"));
  Simulation other = start_tolerant(scene_text(breaking(), R"("tolerance": 1e-4)"));
  for (int i = 0; i < 15; ++i) {
    for (const int allowed : {0, 1, 7, 40}) {
      int asked = 0;
      const std::uint64_t before = hash(simulation.world.state());
      const StepReport report = simulation.step([&] { return asked++ >= allowed; });
      if (!report.stopped) break;
      ASSERT_EQ(hash(simulation.world.state()), before);
    }
    while (simulation.world.state().steps <= i) ASSERT_TRUE(simulation.step().ok());
    while (other.world.state().steps <= i) ASSERT_TRUE(other.step().ok());
    ASSERT_EQ(hash(simulation.world.state()), hash(other.world.state()));
  }
}

TEST(Tolerance, ControllersActAsWithFixedSubsteps) {
  // A regulator without a sample time acts `substeps` times per step, however short substeps are.
  const auto text = [](const char* step) {
    return fmt::format(
        R"({{"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1, "step": {{{}}},
            "bodies": [{{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2}}],
            "triggers": [{{"name": "push", "at": 0.1234, "action": "set", "target": "load.force_y", "value": 30}}]}})",
        step);
  };
  Simulation simulation = start_tolerant(text(R"("tolerance": 1e-6)"));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(simulation.step().ok());
  // Free fall, and from 0.1234 s on 30 N more, at the instant itself: no length is too long.
  const double since = 1.0 - 0.1234;
  const double right = -0.5 * g + 0.5 * 15.0 * since * since;
  EXPECT_NEAR(simulation.world.position(BodyId{0}).y(), right, 1e-6);
}

TEST(Tolerance, ThatCannotBeKeptMakesTheRunDoubtful) {
  // A floor of 1e8 N/m returns the ball within 0.3 ms; the tolerance would need substeps of 0.1 us.
  Simulation simulation = start_tolerant(scene_text(bouncing(1e8), R"("tolerance": 1e-6)"));
  RunCheck check(simulation);
  std::int64_t missed = 0;
  // The ball meets the floor at 0.319 s.
  for (int i = 0; i < 21; ++i) {
    const StepReport report = simulation.step({}, check.within(simulation), {});
    ASSERT_TRUE(report.ok());
    missed += report.statistics.missed_tolerance;
    check.observe(simulation, report.statistics, i == 20);
  }
  EXPECT_GT(missed, 0);
  const Certificate certificate = check.certificate();
  const CertificateItem* item = certificate.find(CertificateItem::Kind::tolerance);
  ASSERT_NE(item, nullptr);
  EXPECT_FALSE(certificate.clean());
  EXPECT_EQ(item->name, "body \"ball\"");
  EXPECT_GE(item->time, 0.319);
  EXPECT_NE(item->sentence().find("larger tolerance"), std::string::npos);
}

TEST(Tolerance, NeedsTheDirectSolverAndRattle) {
  const SceneResult sweeps = load_scene_text(
      scene_text(breaking(), R"("tolerance": 1e-4, "solver": "gauss-seidel")"), "s.json");
  ASSERT_EQ(sweeps.errors.size(), 1U);
  EXPECT_EQ(sweeps.errors[0].pointer, "/step/solver");
  const SceneResult first_order = load_scene_text(
      scene_text(breaking(), R"("tolerance": 1e-4, "integrator": "xpbd")"), "s.json");
  ASSERT_EQ(first_order.errors.size(), 1U);
  EXPECT_EQ(first_order.errors[0].pointer, "/step/integrator");
}

TEST(Tolerance, IsNotBelowAMillionthOfTheMachine) {
  const SceneResult scene =
      load_scene_text(scene_text(breaking(), R"("tolerance": 1e-8)"), "s.json");
  ASSERT_EQ(scene.errors.size(), 1U);
  EXPECT_EQ(scene.errors[0].pointer, "/step/tolerance");
}

TEST(Tolerance, IsNotSetBesideSubsteps) {
  const std::string both = scene_text(breaking(), R"("tolerance": 1e-4, "substeps": 4)");
  const SceneResult refused = load_scene_text(both, "s.json");
  ASSERT_EQ(refused.errors.size(), 1U);
  EXPECT_EQ(refused.errors[0].pointer, "/step/substeps");
  EXPECT_FALSE(load_scene_text(scene_text(breaking(), R"("tolerance": -1)"), "s.json"));
  // An override takes the place of the other setting in the text.
  const std::string fixed = scene_text(breaking(), R"("substeps": 8)");
  const SceneResult tolerant =
      load_scene_text(fixed, "s.json", {{"/step/tolerance", "1e-4", "--tolerance"}});
  ASSERT_TRUE(tolerant);
  EXPECT_EQ(tolerant->model.step.tolerance, 1e-4);
  const std::string adaptive = scene_text(breaking(), R"("tolerance": 1e-4)");
  const SceneResult counted =
      load_scene_text(adaptive, "s.json", {{"/step/substeps", "8", "--substeps"}});
  ASSERT_TRUE(counted);
  EXPECT_EQ(counted->model.step.tolerance, 0.0);
  EXPECT_EQ(counted->model.step.substeps, 8);
  // Both as overrides are refused.
  EXPECT_FALSE(load_scene_text(
      fixed, "s.json",
      {{"/step/tolerance", "1e-4", "--tolerance"}, {"/step/substeps", "8", "--substeps"}}));
  const SceneResult again = load_scene_text(write_scene(*tolerant), "again.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->model.step.tolerance, 1e-4);
}

}  // namespace
}  // namespace sheave::test
