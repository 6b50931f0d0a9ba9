#include "scenes/generators.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/shapes/capsule.h"
#include "scenes/check.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// Runs a scene to its end and returns the messages of the checks that fail.
std::string failed_checks(const Scene& scene) {
  Simulation simulation = start(Machine{scene.model, scene.cables});
  CheckRecorder recorder(scene, simulation);
  recorder.record(simulation);
  const auto steps = static_cast<int>(std::lround(scene.duration / scene.model.step.dt));
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.world.step();
    if (!report.ok()) return report.divergence->message;
    recorder.record(simulation);
  }
  std::string failures;
  for (const CheckResult& result : recorder.results()) {
    if (!result.passed) failures += result.message + "\n";
  }
  return failures;
}

TEST(WheelTrainGenerator, AcceleratesByItsClosedForm) {
  for (const int wheels : {1, 2, 3, 4, 7, 16, 33}) {
    SCOPED_TRACE(wheels);
    WheelTrainOptions options;
    options.wheels = wheels;
    const Result<Scene> scene = generate_wheel_train(options);
    ASSERT_TRUE(scene);
    EXPECT_EQ(text(validate_scene(*scene)), "");
    EXPECT_EQ(scene->cables[0].links.size(), static_cast<std::size_t>(wheels) + 2);
    EXPECT_EQ(scene->checks.size(), 4U);
    EXPECT_EQ(failed_checks(*scene), "");
  }
}

TEST(WheelTrainGenerator, GoesEitherWayAndStandsStillInBalance) {
  WheelTrainOptions options;
  options.wheels = 5;
  options.radius = 0.2;
  options.wheel_mass = 0.3;
  for (const double last : {0.5, 1.0, 3.0}) {
    options.last_mass = last;
    EXPECT_EQ(failed_checks(*generate_wheel_train(options)), "") << last;
  }
}

TEST(WheelTrainGenerator, LightWheelsGetEnoughIterations) {
  WheelTrainOptions options;
  options.wheels = 8;
  options.wheel_mass = 0.01;
  EXPECT_EQ(failed_checks(*generate_wheel_train(options)), "");
}

TEST(BlockAndTackleGenerator, StandsStillInBalance) {
  for (const int parts : {2, 3, 4, 5, 6, 7, 8}) {
    SCOPED_TRACE(parts);
    BlockAndTackleOptions options;
    options.parts = parts;
    const Result<Scene> scene = generate_block_and_tackle(options);
    ASSERT_TRUE(scene);
    EXPECT_EQ(text(validate_scene(*scene)), "");
    EXPECT_NEAR(options.effort_mass() * parts, options.load, 1e-12);
    EXPECT_EQ(failed_checks(*scene), "");
  }
}

TEST(BlockAndTackleGenerator, MovesByItsClosedForm) {
  for (const int parts : {2, 3, 5, 8}) {
    for (const double unbalance : {0.5, 2.0}) {
      SCOPED_TRACE(testing::Message() << parts << " parts, unbalance " << unbalance);
      BlockAndTackleOptions options;
      options.parts = parts;
      options.unbalance = unbalance;
      options.sheave_mass = 0.5;
      options.duration = 0.5;
      EXPECT_EQ(failed_checks(*generate_block_and_tackle(options)), "");
    }
  }
}

TEST(BlockAndTackleGenerator, PartsHangVertically) {
  for (const int parts : {2, 3, 16, 64}) {
    BlockAndTackleOptions options;
    options.parts = parts;
    options.load = 100.0;
    const Result<Scene> scene = generate_block_and_tackle(options);
    ASSERT_TRUE(scene);
    const Simulation simulation = start(Machine{scene->model, scene->cables});
    const CableReport rope = simulation.cable_reports()[0];
    ASSERT_EQ(rope.spans.size(), static_cast<std::size_t>(parts) + 1);
    for (std::size_t k = 0; k < rope.spans.size(); ++k) {
      EXPECT_NEAR(rope.spans[k].start.x(), options.diameter * static_cast<double>(k), 1e-9);
      EXPECT_NEAR(rope.spans[k].end.x(), options.diameter * static_cast<double>(k), 1e-9);
    }
  }
}

TEST(ChainGenerator, HangsTogetherAtAnyAngleAndKeepsItsEnergy) {
  for (const double angle : {0.0, 0.7, 1.4}) {
    ChainOptions options;
    options.links = 5;
    options.mass_ratio = 20.0;
    options.ball_radius = 0.5;
    options.angle = angle;
    options.duration = 2.0;
    const Result<Scene> scene = generate_chain(options);
    ASSERT_TRUE(scene);
    EXPECT_EQ(text(validate_scene(*scene)), "");
    EXPECT_EQ(scene->model.joints.size(), 6U);
    // Joints are where their links end, so nothing jumps: after a step the ball has fallen freely
    // at most, but for what the ball's weight adds to a link that turns.
    Simulation simulation = start(Machine{scene->model, scene->cables});
    ASSERT_TRUE(simulation.world.step().ok());
    EXPECT_LT(simulation.world.velocity({5}).norm(), 1.5 * options.gravity * scene->model.step.dt);
    EXPECT_EQ(failed_checks(*scene), "");
  }
}

TEST(NaiveRopeGenerator, LiesOnItsWheelsAndHangsTogetherForAnyNumberOfSegments) {
  for (const int segments : {20, 31, 100, 257}) {
    SCOPED_TRACE(segments);
    NaiveRopeOptions options;
    options.segments = segments;
    const Result<Scene> scene = generate_naive_rope(options);
    ASSERT_TRUE(scene);
    EXPECT_EQ(text(validate_scene(*scene)), "");
    const auto count = static_cast<std::size_t>(segments);
    ASSERT_EQ(scene->model.bodies.size(), count + 4);
    ASSERT_EQ(scene->model.joints.size(), count + 1);
    ASSERT_EQ(scene->model.colliders.size(), count + 2);
    // Ends of neighbours coincide, and no segment is nearer to an axle than its radius beside the
    // wheel's; numbers of a scene have 12 digits.
    const auto end = [&](std::size_t k, double side) {
      const BodyDef& body = scene->model.bodies[k + 4];
      const auto& capsule = dynamic_cast<const Capsule&>(*body.shapes[0].shape);
      return Vector3(body.position +
                     body.orientation * Vector3(0.5 * side * capsule.length, 0.0, 0.0));
    };
    for (std::size_t k = 0; k < count; ++k) {
      if (k > 0) {
        EXPECT_LT((end(k, -1.0) - end(k - 1, 1.0)).norm(), 1e-10) << k;
      }
      for (std::size_t wheel = 0; wheel < 2; ++wheel) {
        const Vector3 center = scene->model.bodies[wheel].position;
        const Vector3 start = end(k, -1.0) - center;
        const Vector3 way = end(k, 1.0) - center - start;
        const double nearest = std::clamp(-start.dot(way) / way.squaredNorm(), 0.0, 1.0);
        EXPECT_GT((start + nearest * way).norm(), options.radius + options.rope_radius - 1e-10);
      }
    }
  }
}

TEST(NaiveRopeGenerator, WithOneCableInItsPlaceDoesNotStretch) {
  NaiveRopeOptions options;
  options.cable = true;
  options.duration = 1.0;
  const Result<Scene> scene = generate_naive_rope(options);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->model.colliders.size(), 0U);
  EXPECT_EQ(failed_checks(*scene), "");
}

TEST(Generators, RefuseOptionsOutOfRange) {
  WheelTrainOptions train;
  train.wheels = 0;
  train.radius = -1.0;
  const Result<Scene> scene = generate_wheel_train(train);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.errors()[0].path, "/wheels");
  EXPECT_EQ(scene.errors()[1].path, "/radius");
  BlockAndTackleOptions tackle;
  tackle.parts = 64;
  tackle.load = 3.0;  // 32 sheaves of 0.1 kg
  EXPECT_EQ(generate_block_and_tackle(tackle).errors()[0].path, "/load");
  tackle.load = 12.0;
  tackle.drop = 0.3;
  EXPECT_EQ(generate_block_and_tackle(tackle).errors()[0].path, "/drop");
}

TEST(Generators, AreChosenByNameWithOptionsAsText) {
  const SceneResult scene = generate_scene("wheel-train", {{"wheels", "3"}, {"radius", "0.25"}});
  ASSERT_TRUE(scene);
  WheelTrainOptions options;
  options.wheels = 3;
  options.radius = 0.25;
  EXPECT_EQ(write_scene(*scene), write_scene(*generate_wheel_train(options)));
}

TEST(Generators, ExplainWrongOptions) {
  using testing::HasSubstr;
  EXPECT_THAT(to_string(generate_scene("whee-train", {}).errors.at(0)),
              HasSubstr("did you mean \"wheel-train\"?"));
  EXPECT_THAT(to_string(generate_scene("wheel-train", {{"wheel", "3"}}).errors.at(0)),
              HasSubstr("/wheel: unknown key in a wheel-train, did you mean \"wheels\"?"));
  EXPECT_THAT(to_string(generate_scene("wheel-train", {{"wheels", "2.5"}}).errors.at(0)),
              HasSubstr("/wheels: value 2.5: must be an integer 1 ... 100000"));
  EXPECT_THAT(to_string(generate_scene("block-and-tackle", {{"parts", "65"}}).errors.at(0)),
              HasSubstr("/parts: value 65: must be 2 ... 64"));
  EXPECT_EQ(generate_scene("block-and-tackle", {{"parts", "1"}, {"load", "x"}}).errors.size(), 2U);
}

}  // namespace
}  // namespace sheave::test
