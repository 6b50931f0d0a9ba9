#include "measure/trajectory.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::measure {
namespace {

Scene scene_of(const test::Machine& machine, double duration) {
  Scene scene;
  scene.model = machine.model;
  scene.cables = machine.cables;
  scene.duration = duration;
  scene.model.step.dt = 1.0 / 60.0;
  return scene;
}

TEST(Trajectory, HasAFrameForEachStepAndTimeZero) {
  const Scene scene = scene_of(test::Atwood().machine(), 0.5);
  std::int64_t seen = 0;
  const Result<Trajectory> run = record(scene, [&](std::int64_t done, std::int64_t of) {
    EXPECT_EQ(done, ++seen);
    EXPECT_EQ(of, 30);
    return true;
  });
  ASSERT_TRUE(run);
  EXPECT_EQ(frame_count(scene), 30);
  EXPECT_EQ(seen, 30);
  EXPECT_EQ(run->frames.size(), 31U);
  EXPECT_EQ(run->frames.back().tensions.size(), 2U);
  EXPECT_TRUE(run->complete());
}

TEST(Trajectory, TheObserverCanEndTheRun) {
  const Scene scene = scene_of(test::Atwood().machine(), 0.5);
  const Result<Trajectory> run =
      record(scene, [](std::int64_t done, std::int64_t) { return done < 3; });
  ASSERT_FALSE(run);
  EXPECT_EQ(run.errors().front().message, "interrupted");
}

TEST(Trajectory, FollowsOnlyBodiesWithoutPrescribedMotion) {
  test::Machine machine = test::Atwood().machine();
  BodyDef frame = test::weight("frame", {5.0, 0.0, 0.0}, 1.0);
  frame.mobility = Mobility::fixed;
  frame.axis.reset();
  machine.model.add(frame);
  BodyDef drum = test::wheel("drum", {7.0, 0.0, 0.0}, 0.3, 0.1);
  drum.drive = DriveKind::speed;
  drum.drive_values = {1.0};
  machine.model.add(drum);
  const Result<Trajectory> run = record(scene_of(machine, 0.1));
  ASSERT_TRUE(run) << test::text(run.errors());
  ASSERT_EQ(run->bodies.size(), 3U);
  EXPECT_EQ(run->bodies[0].id.index, 0);
  EXPECT_TRUE(run->bodies[0].turns_by_angle);
  EXPECT_FALSE(run->bodies[1].turns_by_angle);
}

TEST(Trajectory, StretchIsTheSumOverTheCable) {
  // One sweep leaves spans too long; what is told must be the largest sum of their excesses, by the
  // cable's length.
  Scene scene = scene_of(test::wheel_train(5, 1.0, 2.0, 0.2, 0.01), 0.5);
  scene.model.step.iterations = 1;
  const Result<Trajectory> run = record(scene);
  ASSERT_TRUE(run);
  Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  ASSERT_TRUE(simulation);
  double largest = 0.0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(simulation->world.step().ok());
    const CableReport cable = simulation->cable_reports().front();
    double excess = 0.0;
    for (const SpanReport& span : cable.spans) {
      excess += std::max(0.0, span.length - span.rest_length);
    }
    largest = std::max(largest, excess / cable.total_length);
  }
  EXPECT_EQ(run->stretch, largest);
  EXPECT_GT(run->stretch, 1e-6);
  EXPECT_EQ(run->row_solves, 30 * 6);
}

TEST(Trajectory, StretchOfAnElasticCableIsNoViolation) {
  test::Machine machine = test::Atwood().machine();
  machine.cables[0].compliance = 1e-3;
  const Result<Trajectory> run = record(scene_of(machine, 0.5));
  ASSERT_TRUE(run);
  EXPECT_EQ(run->stretch, 0.0);
}

TEST(Trajectory, FindsTheBodiesThatTwoModelsShare) {
  const test::Machine machine = test::Atwood().machine();
  test::Machine more = machine;
  more.model.add(test::lump("stone", {9.0, 0.0, 0.0}, 1.0));
  more.model.bodies[0].name = "pulley";
  const Result<Trajectory> one = record(scene_of(machine, 0.1));
  const Result<Trajectory> two = record(scene_of(more, 0.1));
  ASSERT_TRUE(one && two);
  const auto [a, b] = with_common_bodies(*two, *one);
  ASSERT_EQ(a.bodies.size(), 2U);  // neither the wheel, which has two names, nor the stone
  ASSERT_EQ(b.bodies.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a.bodies[i].name, b.bodies[i].name);
  EXPECT_EQ(a.frames.size(), 7U);
  EXPECT_EQ(a.frames[6].poses[1].position, b.frames[6].poses[1].position);
  EXPECT_TRUE(a.frames[6].tensions.empty());
}

TEST(Trajectory, OfASceneThatDoesNotBuildIsAnError) {
  Scene scene = scene_of(test::Atwood().machine(), 0.5);
  scene.model.bodies[0].mass = -1.0;
  EXPECT_FALSE(record(scene));
}

}  // namespace
}  // namespace sheave::measure
