// Similar scenes: Newton's equations are alike in both.

#include "measure/similarity.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scenes/scaling.h"

namespace sheave::measure {
namespace {

std::string similarity_scene_path(const std::string& name) {
  return std::string(SHEAVE_SOURCE_DIR) + "/scenes/" + name;
}

Scene short_scene(const std::string& name, const std::vector<Override>& more) {
  std::vector<Override> overrides{{"/duration", "0.2", ""}, {"/checks", "[]", ""}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  SceneResult scene = load_scene(similarity_scene_path(name), overrides);
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

TEST(Similarity, ScenesOfAllSizesAndMassesMoveTheSame) {
  // Factors that are powers of two change no digit, except where cable is counted in multiples of a
  // power of two that the size decides; 12 steps of some 40 roundings each stay far below 1e-9.
  for (const std::string name :
       {"analytic/atwood.json", "machines/crane.json", "paper/pulley.json"}) {
    std::ifstream file(similarity_scene_path(name));
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::vector<ScalableSetting> settings = scalable_settings(text);
    ASSERT_FALSE(settings.empty());
    const Scene original = short_scene(name, {});
    for (const auto& [length, mass] : {std::pair{1024.0, 1.0}, {1.0, 1.0 / 1024.0}}) {
      const Scene other = short_scene(name, similar_scene(settings, length, mass));
      const Result<double> error = similarity_error(other, original, length, mass);
      ASSERT_TRUE(error);
      EXPECT_LT(*error, 1e-9) << name << " " << length << " " << mass;
    }
    // What is not similar is told apart.
    const Scene heavier = short_scene(name, {{"/gravity", "[0, -30, 0]", ""}});
    EXPECT_GT(similarity_error(heavier, original, 1.0, 1.0).value(), 1e-3) << name;
  }
}

}  // namespace
}  // namespace sheave::measure
