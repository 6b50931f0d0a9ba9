// scenes/README.md, which dev/gallery writes, shows every scene that is there and nothing else.

#include <regex>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

const std::filesystem::path& scene_folder() {
  static const std::filesystem::path folder = std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes";
  return folder;
}

std::string key_of(const std::filesystem::path& scene) {
  return scene.parent_path().filename().string() + "/" + scene.stem().string();
}

TEST(Gallery, NamesEverySceneWithClaimPictureAndCommand) {
  const std::string page = read_file(scene_folder() / "README.md");
  for (const std::filesystem::path& file : valid_scene_files()) {
    const std::string key = key_of(file);
    SCOPED_TRACE(key);
    const SceneResult scene = load_scene(file.string());
    ASSERT_TRUE(scene);
    EXPECT_NE(page.find("### " + scene->name + "\n"), std::string::npos);
    EXPECT_NE(page.find("\n" + scene->description + "\n"), std::string::npos);
    EXPECT_NE(page.find("[" + key + ".json](" + key + ".json)"), std::string::npos);
    EXPECT_NE(page.find("sheave run scenes/" + key + ".json --check"), std::string::npos);
  }
}

TEST(Gallery, PicturesExistAreSmallAndBelongToScenes) {
  const std::string page = read_file(scene_folder() / "README.md");
  const std::regex picture(R"(\]\((pictures/[^)]+)\))");
  std::uintmax_t total = 0;
  std::size_t count = 0;
  for (std::sregex_iterator match(page.begin(), page.end(), picture), end; match != end; ++match) {
    const std::filesystem::path file = scene_folder() / (*match)[1].str();
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    const std::uintmax_t bytes = std::filesystem::file_size(file);
    EXPECT_LE(bytes, 60'000U) << file;
    total += bytes;
    ++count;
  }
  EXPECT_EQ(count, valid_scene_files().size());
  EXPECT_LE(total, 3'000'000U);
}

TEST(Gallery, NoCheckHasFailed) {
  EXPECT_EQ(read_file(scene_folder() / "README.md").find("FAILED"), std::string::npos);
}

}  // namespace
}  // namespace sheave::test
