#include "measure/paper_table.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace sheave::measure {
namespace {

TEST(PaperTable, ShippedScenesHaveThePapersJoints) {
  int found = 0;
  for (const PaperRow& row : paper_table()) {
    const std::string path =
        std::string(SHEAVE_SOURCE_DIR "/scenes/paper/") + std::string(row.file);
    if (!std::filesystem::exists(path) || row.joints == 0) continue;
    SceneResult scene = load_scene(path);
    ASSERT_TRUE(scene) << path;
    if (scene->cables.empty()) continue;
    scene.scene->model.step = direct_settings(row, IntegratorKind::xpbd);
    const Result<Trajectory> run = record(*scene);
    ASSERT_TRUE(run && run->complete()) << path;
    EXPECT_EQ(joint_count(*scene, *run), row.joints) << row.scene;
    ++found;
  }
  EXPECT_GE(found, 6);
}

TEST(PaperTable, SettingsAreThePapers) {
  const PaperRow& first = paper_table().front();
  EXPECT_EQ(first.scene, "Simple");
  const StepSettings step = paper_settings(first);
  EXPECT_EQ(step.dt, 1.0 / 60.0);
  EXPECT_EQ(step.iterations, 1);
  EXPECT_EQ(step.solver, SolverKind::gauss_seidel);
  EXPECT_EQ(settings_text(step), "gauss-seidel 1 x 1");
  EXPECT_EQ(settings_text(direct_settings(first, IntegratorKind::xpbd)), "direct 1");
  EXPECT_EQ(settings_text(direct_settings(first, IntegratorKind::rattle)), "direct 1, rattle");
}

TEST(PaperTable, NamesOfRowsAreUnique) {
  // Baselines find their rows by scene and setting.
  std::vector<std::string> names;
  for (const PaperRow& row : paper_table()) {
    names.push_back(std::string(row.scene) + " " + settings_text(paper_settings(row)));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace sheave::measure
