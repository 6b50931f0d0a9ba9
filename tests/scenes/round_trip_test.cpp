#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/links/rolling.h"
#include "scenes/generators.h"
#include "scenes/scene.h"
#include "tests/scenes/random_scene.h"
#include "tests/scenes/scene_compare.h"
#include "tests/scenes/scene_files.h"
#include "tests/support/effort.h"

namespace sheave::test {
namespace {

/// Writing and loading gives exactly the scene, and writing that gives exactly the text.
void expect_exact(const Scene& scene) {
  const std::string text = write_scene(scene);
  const SceneResult again = load_scene_text(text, "written");
  ASSERT_TRUE(again) << to_string(again.errors.front()) << "\n" << text;
  EXPECT_EQ(difference(scene, *again), "") << text;
  EXPECT_EQ(write_scene(*again), text);
}

class ShippedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScene, SurvivesWritingAndLoadingExactly) {
  const SceneResult scene = load_scene(GetParam());
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  expect_exact(*scene);
}

INSTANTIATE_TEST_SUITE_P(RoundTrip, ShippedScene, testing::ValuesIn(valid_scene_files()),
                         [](const auto& scene) { return test_name(scene.param); });

TEST(RoundTrip, RandomScenesSurviveExactly) {
  std::set<std::string_view> types;
  std::size_t entities = 0;
  std::size_t colliders = 0;
  std::size_t paints = 0;
  std::size_t texts = 0;
  std::size_t keyframes = 0;
  std::size_t triggers = 0;
  std::size_t parameters = 0;
  // Rolling links need a rotor of the right kind, and the order of random numbers is the compiler's.
  const auto goes_on = [&](unsigned seed) {
    return seed < 400 || (seed < 2000 && !types.contains(RollingLink::type_name));
  };
  for (unsigned seed = 0; goes_on(seed); ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(seed);
    if (!test::instrumented || seed % 5 == 0) expect_exact(scene);
    for (const BodyDef& body : scene.model.bodies) {
      for (const PlacedShape& placed : body.shapes) types.insert(placed.shape->type());
    }
    for (const auto& joint : scene.model.joints) types.insert(joint->type());
    for (const CableDef& cable : scene.cables) {
      for (const auto& link : cable.links) types.insert(link->type());
    }
    for (const auto& controller : scene.controllers) types.insert(controller->type());
    triggers += scene.triggers.size();
    parameters += scene.model.parameters.size();
    colliders += scene.model.colliders.size();
    paints += scene.paint.size();
    texts += scene.annotations.size();
    keyframes += scene.camera_path.size();
    entities += scene.model.bodies.size() + scene.model.joints.size() + scene.cables.size() +
                scene.checks.size() + (scene.camera ? 1 : 0) + (scene.model.ground ? 1 : 0);
  }
  // The random scenes are worth something: all types occur, and there is much of everything.
  const auto expect_types = [&](auto registry) {
    for (const auto& type : registry) EXPECT_TRUE(types.contains(type.name)) << type.name;
  };
  expect_types(shape_types());
  expect_types(joint_types());
  // Shipped scenes have surface links, sheaths and openings.
  expect_types(link_types().first(link_types().size() - 3));
  expect_types(controller_types());
  EXPECT_GT(triggers, 20U);
  EXPECT_GT(parameters, 50U);
  EXPECT_GT(entities, 600U);
  EXPECT_GT(colliders, 50U);
  EXPECT_GT(paints, 50U);
  EXPECT_GT(texts, 50U);
  EXPECT_GT(keyframes, 20U);
}

TEST(RoundTrip, GeneratedScenesSurviveExactly) {
  for (const GeneratorKind& kind : generator_kinds()) {
    const SceneResult scene = generate_scene(kind.name, {});
    ASSERT_TRUE(scene);
    expect_exact(*scene);
  }
}

TEST(RoundTrip, NegativeZeroAndExtremeNumbersSurvive) {
  Scene scene = random_scene(1);
  scene.model.gravity = {-0.0, 5e-324, -1e100};
  scene.model.bodies.clear();
  scene.model.joints.clear();
  scene.model.colliders.clear();
  scene.cables.clear();
  scene.paint.clear();
  scene.annotations.clear();
  scene.checks.clear();
  scene.duration = 1.0 / 3.0;
  expect_exact(scene);
}

TEST(WriteScene, LeavesDefaultsOut) {
  Scene scene;
  scene.duration = 1.0;
  scene.model.gravity = {0.0, -10.0, 0.0};
  EXPECT_EQ(
      write_scene(scene),
      "{\n  \"format\": \"sheave-scene/1\",\n  \"gravity\": [0, -10, 0],\n  \"duration\": 1\n}\n");
}

TEST(WriteScene, NamesThePresetAndItsDifferences) {
  Scene scene;
  scene.duration = 1.0;
  scene.step_preset.preset = StepPreset::paper;
  scene.model.step = StepSettings::paper();
  EXPECT_THAT(write_scene(scene), testing::HasSubstr(R"("step": {"preset": "paper"})"));
  scene.model.step.solver = SolverKind::direct;
  EXPECT_THAT(write_scene(scene),
              testing::HasSubstr(R"("step": {"preset": "paper", "solver": "direct"})"));
  expect_exact(scene);
}

TEST(WriteScene, NumbersThatAreNotFiniteDoNotLoad) {
  Scene scene;
  scene.duration = std::numeric_limits<double>::infinity();
  const SceneResult again = load_scene_text(write_scene(scene), "written");
  ASSERT_FALSE(again);
  EXPECT_EQ(again.errors.front().pointer, "/duration");
}

}  // namespace
}  // namespace sheave::test
