// Every shipped scene loads without a fault and shows what its checks promise, and the scenes that
// come from a generator are what the generator makes today.

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/generators.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

/// At most so many steps, if the environment says so: builds with sanitizers take ten times as long.
int most_steps(int steps) {
  const char* most = std::getenv("SHEAVE_SHIPPED_STEPS");
  return most == nullptr ? steps : std::min(steps, std::atoi(most));
}

class Shipped : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Shipped, PassesItsChecks) {
  const SceneResult scene = load_scene(GetParam());
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  EXPECT_FALSE(scene->name.empty());
  EXPECT_FALSE(scene->description.empty());
  EXPECT_FALSE(scene->checks.empty());
  auto simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  CheckRecorder recorder(*scene, *simulation);
  recorder.record(*simulation);
  const auto steps = static_cast<int>(std::lround(scene->duration / scene->model.step.dt));
  const int most = most_steps(steps);
  for (int i = 0; i < most; ++i) {
    const StepReport report = simulation->step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
    recorder.record(*simulation);
  }
  // Checks are claims about a whole run.
  if (most < steps) return;
  for (const CheckResult& result : recorder.results()) EXPECT_TRUE(result.passed) << result.message;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Shipped, testing::ValuesIn(valid_scene_files()),
                         [](const auto& scene) { return test_name(scene.param); });

struct Generated {
  std::string file;
  std::string kind;
  std::vector<GeneratorSetting> settings;
};

TEST(ShippedScenes, GeneratedScenesAreUpToDate) {
  const std::vector<Generated> all{
      {"analytic/block-and-tackle-2", "block-and-tackle", {{"parts", "2"}}},
      {"analytic/block-and-tackle-4", "block-and-tackle", {{"parts", "4"}}},
      {"analytic/block-and-tackle-6", "block-and-tackle", {{"parts", "6"}}},
      {"analytic/block-and-tackle-8", "block-and-tackle", {{"parts", "8"}}},
      {"paper/hilbert2-stretched", "hilbert", {{"order", "2"}}},
      {"paper/hilbert2-loose", "hilbert", {{"order", "2"}, {"slack", "0.05"}}},
      {"paper/hilbert3", "hilbert", {{"order", "3"}}},
      {"paper/naive-rope", "naive-rope", {{"segments", "100"}}},
      {"paper/naive-rope-cable", "naive-rope", {{"segments", "100"}, {"cable", "true"}}},
      {"stress/chain-and-ball", "chain", {{"links", "40"}, {"mass_ratio", "672"}}},
  };
  const auto scenes = std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes";
  for (const Generated& g : all) {
    const SceneResult scene = generate_scene(g.kind, g.settings);
    ASSERT_TRUE(scene);
    const std::string text = generator_comment(g.kind, g.settings) + write_scene(*scene);
    // Not the whole difference: a scene can have a megabyte.
    EXPECT_TRUE(read_file(scenes / (g.file + ".json")) == text)
        << g.file << ".json is not what this command writes:\n"
        << generator_comment(g.kind, g.settings);
  }
}

}  // namespace
}  // namespace sheave::test
