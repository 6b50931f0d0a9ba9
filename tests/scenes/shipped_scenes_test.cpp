// Every shipped scene loads without a fault and shows what its checks promise, and the scenes that
// come from a generator are what the generator makes today.

#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/generators.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

class Shipped : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Shipped, shows_what_it_promises) {
  const SceneResult scene = load_scene(GetParam());
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  EXPECT_FALSE(scene->name.empty());
  EXPECT_FALSE(scene->description.empty());
  EXPECT_FALSE(scene->checks.empty());
  auto simulation = Simulation::create(scene->model, scene->cables);
  ASSERT_TRUE(simulation);
  CheckRecorder recorder(*scene, *simulation);
  recorder.record(*simulation);
  const auto steps = static_cast<int>(std::lround(scene->duration / scene->model.step.dt));
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation->world.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
    recorder.record(*simulation);
  }
  for (const CheckResult& result : recorder.results()) EXPECT_TRUE(result.passed) << result.message;
}

INSTANTIATE_TEST_SUITE_P(scenes, Shipped, testing::ValuesIn(valid_scene_files()),
                         [](const auto& scene) { return test_name(scene.param); });

TEST(shipped_scenes, generated_ones_are_up_to_date) {
  for (const int parts : {2, 4, 6, 8}) {
    BlockAndTackleOptions options;
    options.parts = parts;
    const std::string file = "block-and-tackle-" + std::to_string(parts) + ".json";
    const auto path = std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes" / "analytic" / file;
    EXPECT_EQ(read_file(path), write_scene(*generate_block_and_tackle(options))) << file;
  }
}

}  // namespace
}  // namespace sheave::test
