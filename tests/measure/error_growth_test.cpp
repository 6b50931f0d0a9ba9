#include "measure/error_growth.h"

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "measure/reference_run.h"
#include "scenes/scene.h"

namespace sheave::measure {
namespace {

std::vector<double> course(int frames, double dt, const std::function<double(double)>& error) {
  std::vector<double> errors;
  for (int f = 0; f <= frames; ++f) errors.push_back(error(dt * f));
  return errors;
}

TEST(ErrorGrowth, DistinguishesAnExponentialFromAPower) {
  const auto chaotic = error_growth(
      course(200, 0.05, [](double t) { return 1e-9 * std::exp(1.5 * t); }), 0.05, 1e-4);
  ASSERT_TRUE(chaotic.rate);
  EXPECT_NEAR(*chaotic.rate, 1.5, 1e-9);  // what the course was made with, but for rounding
  // 1e-4 is reached at ln(1e5) / 1.5 = 7.675 s: frame 153 is the last one before.
  EXPECT_EQ(chaotic.trusted_frames, 154U);
  const auto regular =
      error_growth(course(200, 0.05, [](double t) { return 1e-6 * t * t; }), 0.05, 1e-4);
  EXPECT_FALSE(regular.rate);
  EXPECT_EQ(regular.trusted_frames, 201U);  // 1e-4 at the very end is not above the level
}

TEST(ErrorGrowth, HasNoRateForFewOrConstantErrors) {
  const std::vector<double> few{0.0, 1e-6, 1e-4, 1e-2};
  EXPECT_FALSE(error_growth(few, 0.1, 1.0).rate);
  const std::vector<double> constant(100, 1e-6);
  EXPECT_FALSE(error_growth(constant, 0.1, 1.0).rate);
  EXPECT_EQ(error_growth(std::vector<double>{1.0, 1.0}, 0.1, 1e-4).trusted_frames, 1U);
}

TEST(ErrorGrowth, AJumpIsNoGrowth) {
  // An impact at a slightly different time: quiet before and after, and no law. Over 200 frames
  // with the leap in the middle a line explains 3/4 of the variance of such a step.
  const auto leap =
      error_growth(course(200, 0.01, [](double t) { return t < 1.0 ? 1e-7 : 1e-3; }), 0.01, 1e-4);
  EXPECT_FALSE(leap.rate);
  EXPECT_NEAR(static_cast<double>(leap.trusted_frames), 100.0, 1.0);  // t is rounded
}

Reference reference_of(const std::string& name, double duration) {
  SceneResult scene = load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/" + name);
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  scene.scene->duration = duration;
  ReferenceOptions options;
  options.first_substeps = 4;
  options.most_substeps = 16;
  options.most_seconds = std::numeric_limits<double>::infinity();
  Result<Reference> reference = reference_run(*scene, options);
  if (!reference) throw std::runtime_error(reference.errors().front().message);
  return std::move(reference).value();
}

TEST(ErrorGrowth, APendulumIsNotChaotic) {
  const Reference reference = reference_of("analytic/pendulum.json", 5.0);
  ASSERT_EQ(reference.differences.size(), reference.trajectory.frames.size());
  EXPECT_FALSE(error_growth(reference.differences, 0.0225, 1e-4).rate);
}

TEST(FirstFrames, EqualThoseOfTheRun) {
  const Reference reference = reference_of("analytic/pendulum.json", 1.0);
  const Trajectory& run = reference.trajectory;
  EXPECT_EQ(first_frames(run, 10).frames.size(), 10U);
  EXPECT_EQ(first_frames(run, 0).frames.size(), 1U);
  EXPECT_EQ(first_frames(run, 10'000).frames.size(), run.frames.size());
}

}  // namespace
}  // namespace sheave::measure
