#include "measure/reference_run.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::measure {
namespace {

Scene pendulum_scene() {
  const test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.5);
  Scene scene;
  scene.model = machine.model;
  scene.cables = machine.cables;
  scene.duration = 2.0;
  scene.model.step.dt = 1.0 / 60.0;
  return scene;
}

/// With all the time there is, unless a test has a clock of its own.
Reference made(ReferenceOptions options) {
  if (options.most_seconds == ReferenceOptions{}.most_seconds) {
    options.most_seconds = std::numeric_limits<double>::infinity();
  }
  Result<Reference> reference = reference_run(pendulum_scene(), options);
  if (!reference) throw std::runtime_error(reference.errors().front().message);
  return std::move(reference).value();
}

TEST(ReferenceRun, EstimatesItsOwnError) {
  ReferenceOptions options;
  options.first_substeps = 2;
  options.most_substeps = 8;
  const Reference reference = made(options);
  EXPECT_EQ(reference.substeps, 8);
  EXPECT_FALSE(reference.good);
  EXPECT_NEAR(reference.order, 2.0, 0.1);
  // 16 times finer, so a 256th of the error: as good as the truth here. An estimate of second order
  // is three times too large, 1 / (2^2 - 1); half and twice that leave room for what is of higher
  // order.
  ReferenceOptions finer = options;
  finer.first_substeps = 64;
  finer.most_substeps = 128;
  const double error = error_of(reference.trajectory, made(finer).trajectory).position;
  EXPECT_GT(reference.estimate.position, 1.5 * error);
  EXPECT_LT(reference.estimate.position, 6.0 * error);
}

TEST(ReferenceRun, KnowsTheOrderOfTheIntegrator) {
  ReferenceOptions options;
  options.integrator = IntegratorKind::xpbd;
  options.first_substeps = 16;
  options.most_substeps = 128;
  EXPECT_NEAR(made(options).order, 1.0, 0.1);
}

TEST(ReferenceRun, EndsWhenTheErrorIsSmallEnough) {
  ReferenceOptions options;
  options.first_substeps = 1;
  options.most_substeps = 1024;
  options.good_enough = [](const Reference& reference) {
    return reference.estimate.position < 1e-4;
  };
  const Reference reference = made(options);
  EXPECT_TRUE(reference.good);
  EXPECT_LT(reference.estimate.position, 1e-4);
  EXPECT_LT(reference.substeps, 1024);
}

TEST(ReferenceRun, BeginsNoRunThatWouldTakeTooLong) {
  ReferenceOptions options;
  options.first_substeps = 1;
  options.most_substeps = 1024;
  // A clock by which every run takes twice as long as the last one: it is read before the first and
  // after each, at 0, 1, 3, 7 s.
  double next = 0.0;
  options.clock.cpu = [&] { return std::exchange(next, 2.0 * next + 1.0); };
  options.most_seconds = 8.0;
  // Three runs take 7 s, a fourth would end at 15 s.
  EXPECT_EQ(made(options).substeps, 4);
  next = 0.0;
  options.most_seconds = 0.0;
  EXPECT_EQ(made(options).substeps, 2);  // two runs are needed for an estimate
}

TEST(ReferenceRun, TriesBothIntegratorsUntilOneIsGood) {
  ReferenceOptions options;
  options.most_substeps = 4;
  options.most_seconds = std::numeric_limits<double>::infinity();
  const Result<Reference> kept = best_reference(pendulum_scene(), options);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->integrator, IntegratorKind::rattle);  // of the higher order
  int asked = 0;
  options.good_enough = [&](const Reference& reference) {
    ++asked;
    return reference.integrator == IntegratorKind::xpbd;
  };
  // A good one is taken, but only if it is nearer than the other.
  const Result<Reference> better = best_reference(pendulum_scene(), options);
  ASSERT_TRUE(better);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(better->integrator, IntegratorKind::rattle);
}

TEST(ReferenceRun, OfASingleRunIsNotVerified) {
  ReferenceOptions options;
  options.first_substeps = 4;
  options.most_substeps = 4;
  const Reference reference = made(options);
  EXPECT_TRUE(std::isinf(reference.estimate.position));
  EXPECT_FALSE(reference.good);
}

}  // namespace
}  // namespace sheave::measure
