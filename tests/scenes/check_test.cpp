#include "scenes/check.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::test {
namespace {

constexpr double speed = 3.0;  // [m/s] of the only body, along x
constexpr double dt = 0.125;

/// A body that moves steadily for 2 s: x = 3 t, and y = -y_amplitude ... for nothing else.
struct Checks : testing::Test {
  Checks() {
    BodyDef body = lump("body", Vector3::Zero(), 1.0);
    body.velocity = {speed, 0.0, 0.0};
    scene.model.add(body);
    scene.model.step = settings(dt, 1, 1);
    scene.duration = 2.0;
  }

  CheckDef& add(std::string quantity, Statistic statistic, double equals) {
    CheckDef& check = scene.checks.emplace_back();
    check.quantity = std::move(quantity);
    check.statistic = statistic;
    check.equals = equals;
    check.tolerance = 1e-9;
    return check;
  }
  std::vector<CheckResult> run_until(double time) {
    Simulation simulation = start(Machine{scene.model, scene.cables});
    CheckRecorder recorder(scene, simulation);
    recorder.record(simulation);
    while (simulation.world.state().time < time - 0.5 * dt) {
      EXPECT_TRUE(simulation.world.step().ok());
      recorder.record(simulation);
    }
    return recorder.results();
  }
  CheckResult only(double time = 2.0) { return run_until(time).at(0); }

  Scene scene;
};

TEST_F(Checks, StatisticsAgreeWithTheirNames) {
  add("body.x", Statistic::at, speed * 1.0).at = 1.0;
  add("body.x", Statistic::at, speed * 2.0);  // the end by default
  add("body.x", Statistic::mean, speed * 1.0);
  CheckDef& mean = add("body.x", Statistic::mean, speed * 0.75);
  mean.from = 0.5;
  mean.to = 1.0;
  add("body.x", Statistic::rate, speed);
  add("body.x", Statistic::minimum, 0.0);
  add("body.x", Statistic::maximum, speed * 2.0);
  add("body.x", Statistic::range, speed * 2.0);
  add("body.x", Statistic::drift, speed * 2.0);
  add("body.x", Statistic::integral, speed * 2.0);  // x = v t, for 2 s
  CheckDef& drift = add("body.x", Statistic::drift, speed * 0.5);
  drift.from = 1.0;
  drift.to = 1.5;
  for (const CheckResult& result : run_until(2.0)) {
    EXPECT_TRUE(result.passed) << result.message;
    EXPECT_NEAR(result.error, 0.0, 1e-12);
    EXPECT_EQ(result.error, result.measured - result.check.equals);
  }
}

TEST_F(Checks, QuantitiesMayBeExpressions) {
  add("body.x - body.vx * t", Statistic::range, 0.0);
  add("hypot(body.vx, body.vy)", Statistic::mean, speed);
  add("body.x ^ 2", Statistic::maximum, speed * 2.0 * speed * 2.0);
  add("if(body.x > 3, body.x, 0)", Statistic::minimum, 0.0);
  add("body.momentum_x / body.vx", Statistic::at, 1.0);  // on request: its mass
  for (const CheckResult& result : run_until(2.0)) EXPECT_TRUE(result.passed) << result.message;
  EXPECT_THAT(run_until(2.0)[1].message, testing::StartsWith("hypot(body.vx, body.vy), mean"));
}

TEST_F(Checks, DriftHasASignAndRangeHasNone) {
  scene.model.bodies[0].velocity = {-speed, 0.0, 0.0};
  add("body.x", Statistic::drift, -speed * 2.0);
  add("body.x", Statistic::range, speed * 2.0);
  add("body.x", Statistic::rate, -speed);
  for (const CheckResult& result : run_until(2.0)) EXPECT_TRUE(result.passed) << result.message;
}

TEST_F(Checks, AtTakesTheNearestStep) {
  add("body.x", Statistic::at, speed * 0.25).at = 0.25 + 0.4 * dt;
  add("body.x", Statistic::at, speed * (0.25 + dt)).at = 0.25 + 0.6 * dt;
  add("body.x", Statistic::at, speed * 0.25).at = 0.25 + 0.5 * dt;  // a tie: the first
  for (const CheckResult& result : run_until(2.0)) EXPECT_TRUE(result.passed) << result.message;
}

TEST_F(Checks, AWrongValueFailsWithAMessage) {
  add("body.x", Statistic::rate, 2.0);
  const CheckResult result = only();
  EXPECT_FALSE(result.passed);
  EXPECT_NEAR(result.error, 1.0, 1e-12);
  EXPECT_THAT(result.message, testing::HasSubstr("body.x, rate from 0 to 2 s: 3, wanted 2"));
}

TEST_F(Checks, TheLargerToleranceCounts) {
  CheckDef& check = add("body.x", Statistic::rate, 2.0);
  check.relative_tolerance = 0.6;
  EXPECT_EQ(check.allowed_error(), 1.2);
  EXPECT_TRUE(only().passed);
  scene.checks[0].relative_tolerance = 0.4;
  EXPECT_FALSE(only().passed);
  scene.checks[0].tolerance = 1.1;
  EXPECT_TRUE(only().passed);
}

TEST_F(Checks, WithoutToleranceNothingPasses) {
  add("body.x", Statistic::rate, speed).tolerance.reset();
  EXPECT_FALSE(only().passed);
}

TEST_F(Checks, ARunThatEndedEarlyFails) {
  add("body.x", Statistic::rate, speed);
  add("body.x", Statistic::at, speed);
  add("body.x", Statistic::rate, speed).to = 0.5;  // its window is complete
  const auto results = run_until(1.0);
  EXPECT_FALSE(results[0].passed);
  EXPECT_THAT(results[0].message, testing::HasSubstr("the run ended early, at 1 s"));
  EXPECT_FALSE(results[1].passed);
  EXPECT_TRUE(results[2].passed);
}

TEST_F(Checks, AWindowBetweenTwoStepsHoldsNothing) {
  CheckDef& check = add("body.x", Statistic::mean, speed);
  check.from = 0.25 + 0.2 * dt;
  check.to = 0.25 + 0.8 * dt;
  EXPECT_FALSE(only().passed);
  EXPECT_THAT(only().message, testing::HasSubstr("no step falls into this time"));
  EXPECT_TRUE(std::isnan(only().measured));
}

TEST_F(Checks, ARateNeedsTwoSamples) {
  CheckDef& check = add("body.x", Statistic::rate, speed);
  check.from = 0.25 - 0.2 * dt;
  check.to = 0.25 + 0.2 * dt;
  EXPECT_THAT(only().message, testing::HasSubstr("no step but one"));
}

TEST_F(Checks, NothingRecordedFails) {
  add("body.x", Statistic::at, 0.0).at = 0.0;
  const Simulation simulation = start(Machine{scene.model, {}});
  const CheckResult result = CheckRecorder(scene, simulation).results().at(0);
  EXPECT_FALSE(result.passed);
  EXPECT_THAT(result.message, testing::HasSubstr("nothing was simulated"));
}

TEST_F(Checks, UnknownQuantitiesFail) {
  add("nobody.x", Statistic::rate, speed);
  EXPECT_THAT(only().message, testing::HasSubstr("there is no quantity \"nobody.x\""));
  EXPECT_FALSE(only().passed);
}

// A velocity is finite, and its square is not.
TEST_F(Checks, InfiniteValuesFailEveryStatistic) {
  for (int s = 0; s < static_cast<int>(statistic_names.size()); ++s) {
    add("energy.kinetic", static_cast<Statistic>(s), 0.0).tolerance = 1e300;
  }
  Simulation simulation = start(Machine{scene.model, {}});
  CheckRecorder recorder(scene, simulation);
  recorder.record(simulation);
  while (simulation.world.state().time < 1.8) {
    ASSERT_TRUE(simulation.world.step().ok());
    recorder.record(simulation);
  }
  State state = simulation.world.state();
  state.bodies[0].velocity.x() = 1e200;
  state.time = 2.0;
  ASSERT_TRUE(simulation.world.restore(state).empty());
  recorder.record(simulation);
  for (const CheckResult& result : recorder.results()) {
    EXPECT_FALSE(result.passed) << result.message;
    EXPECT_THAT(result.message, testing::HasSubstr("not finite"));
  }
}

TEST_F(Checks, TensionsBeforeTheFirstStepDoNotCount) {
  scene.model.gravity = down;
  scene.model.bodies[0].velocity.setZero();
  scene.cables.push_back(
      cable("rope", {attach(BodyId::world(), {0.0, 5.0, 0.0}), attach(BodyId{0})}));
  add("rope.0.tension", Statistic::minimum, g).tolerance = 0.01 * g;
  EXPECT_TRUE(only().passed) << only().message;
}

}  // namespace
}  // namespace sheave::test
