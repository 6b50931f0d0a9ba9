// Stability maps: what the verdicts mean, that the closed forms of the standard machines are right,
// and that the command of a cell is the cell.

#include "measure/stress_map.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "measure/stress_judge.h"
#include "measure/stress_scenes.h"

namespace sheave::measure {
namespace {

using testing::HasSubstr;

/// Runs a scene to its end or to a divergence.
StressVerdict judged(const Scene& scene) {
  Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  StressJudge judge(scene, *simulation);
  judge.observe(*simulation);
  std::optional<Divergence> divergence;
  const auto steps = std::llround(scene.duration / scene.model.step.dt);
  for (long i = 0; i < steps && !divergence; ++i) {
    divergence = simulation->world.step().divergence;
    if (!divergence) judge.observe(*simulation);
  }
  return judge.verdict(*simulation, divergence);
}

Scene train(const std::vector<GeneratorSetting>& settings = {}) {
  SceneResult scene = generate_scene("wheel-train", settings);
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

TEST(StressJudge, ErrorIsRelativeToTheClosedForm) {
  // A gravity that is 20 % too large makes all accelerations and tensions 20 % too large, up to
  // Gauss-Seidel's error, below 0.1 %; checks of the generator have tolerances of 0.1 %.
  Scene scene = train();
  EXPECT_EQ(judged(scene).kind, StressKind::right);
  EXPECT_LT(judged(scene).error, 1e-3);
  scene.model.gravity *= 1.2;
  const StressVerdict verdict = judged(scene);
  EXPECT_EQ(verdict.kind, StressKind::wrong);
  EXPECT_NEAR(verdict.error, 0.2, 0.002);
  EXPECT_TRUE(verdict.failed());
  scene.model.gravity /= 1.11;
  EXPECT_EQ(judged(scene).kind, StressKind::right);
}

TEST(StressJudge, DistinguishesFaults) {
  Scene scene = train();
  scene.model.gravity = -scene.model.gravity;
  EXPECT_EQ(judged(scene).kind, StressKind::false_slack);  // the cable should pull and does not
  scene = train();
  scene.model.bodies.front().velocity.y() = 1e300;
  const StressVerdict diverged = judged(scene);
  EXPECT_EQ(diverged.kind, StressKind::diverged);
  EXPECT_THAT(diverged.detail, HasSubstr("first weight"));
  EXPECT_EQ(diverged.error, std::numeric_limits<double>::infinity());
}

TEST(StressJudge, FindsEnergyWithoutASource) {
  // The judge is told of a state that another run has reached: a weight moves although the machine
  // is in balance.
  const Scene scene = train({{"last_mass", "1"}});
  Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  ASSERT_TRUE(simulation);
  StressJudge judge(scene, *simulation);
  judge.observe(*simulation);
  State state = simulation->world.state();
  state.bodies.front().velocity.y() += 1.0;
  ASSERT_TRUE(simulation->world.restore(state).empty());
  judge.observe(*simulation);
  // The tensions, which no step has found, are slack as well; energy is judged where they are not
  // asked for.
  EXPECT_NE(judge.verdict(*simulation, {}).kind, StressKind::right);
  Scene unchecked = scene;
  unchecked.checks.clear();
  StressJudge other(unchecked, *simulation);
  state.bodies.front().velocity.y() = 0.0;
  ASSERT_TRUE(simulation->world.restore(state).empty());
  other.observe(*simulation);
  state.bodies.front().velocity.y() = 1.0;
  ASSERT_TRUE(simulation->world.restore(state).empty());
  other.observe(*simulation);
  EXPECT_EQ(other.verdict(*simulation, {}).kind, StressKind::energy_gain);
}

TEST(StressJudge, RecognisesDrivenScenes) {
  Scene scene = train();
  EXPECT_TRUE(is_conservative(scene));
  scene.model.bodies[1].drive = DriveKind::torque;
  EXPECT_FALSE(is_conservative(scene));
  EXPECT_TRUE(is_conservative(
      *load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/analytic/atwood.json")));
  EXPECT_FALSE(
      is_conservative(*load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/machines/crane.json")));
  EXPECT_FALSE(is_conservative(
      *load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/analytic/four-bar.json")));
}

/// The closed forms belong to the machine and not to a solver, so the most exact settings must meet
/// them: steps that resolve the motion, moderate numbers. 1e-2 leaves room for what vibrations of
/// the elastic machine lose to the step.
TEST(StressMaps, ModerateCellsMeetTheirClosedForms) {
  int judged_cells = 0;
  for (const StressMap& map : standard_stress_maps({})) {
    for (const StressCell& cell : map.cells) {
      const bool moderate = cell.x == 0.0 || (cell.x >= 1e-2 && cell.x <= 100.0);
      if (cell.y != 1e-3 || !moderate) continue;
      const SceneResult scene = cell.scene(SolverKind::direct, IntegratorKind::rattle);
      ASSERT_TRUE(scene) << cell.command(SolverKind::direct, IntegratorKind::rattle);
      const StressVerdict verdict = judged(*scene);
      EXPECT_LT(verdict.error, 1e-2) << map.name << " " << cell.x << ": " << verdict.detail;
      ++judged_cells;
    }
  }
  EXPECT_GT(judged_cells, 20);
}

TEST(StressMaps, EveryStandardCellIsAScene) {
  for (const StressMap& map : standard_stress_maps({.quick = true})) {
    EXPECT_EQ(map.cells.size(), map.x.values.size() * map.y.values.size());
    for (const StressCell& cell : map.cells) {
      const SceneResult scene = cell.scene(SolverKind::gauss_seidel, IntegratorKind::xpbd);
      EXPECT_TRUE(scene) << map.name << ": " << to_string(scene.errors.front());
    }
  }
}

TEST(StressCell, CommandQuotesForAShell) {
  StressCell cell;
  cell.path = "it's a scene.json";
  cell.replace("/gravity", "[0, -1, 0]");
  EXPECT_EQ(cell.command(SolverKind::direct, IntegratorKind::xpbd),
            "sheave run 'it'\\''s a scene.json' --solver direct --integrator xpbd "
            "--set '/gravity=[0, -1, 0]'");
  cell.kind = "wheel-train";
  cell.settings = {{"wheel_mass", "2"}};
  EXPECT_THAT(cell.command(SolverKind::direct, IntegratorKind::xpbd),
              HasSubstr("sheave generate wheel-train --wheel-mass 2 | sheave run - --check"));
}

TEST(StressMaps, ReadASceneFile) {
  const std::string path = std::string(SHEAVE_SOURCE_DIR) + "/scenes/analytic/atwood.json";
  const auto maps = scene_stress_maps(path, {.quick = true});
  ASSERT_TRUE(maps);
  ASSERT_EQ(maps->size(), 4U);
  int cells = 0;
  int arrivals = 0;
  for (const StressMap& map : *maps) {
    for (const StressCell& cell : map.cells) {
      const SceneResult scene = cell.scene(SolverKind::direct, IntegratorKind::xpbd);
      ASSERT_TRUE(scene) << map.name << ": " << to_string(scene.errors.front());
      const StressVerdict verdict = judged(*scene);
      // Strong gravity draws the light weight to the wheel, where the run ends by name.
      const bool arrives = verdict.detail.find("has reached the wheel") != std::string::npos;
      arrivals += arrives ? 1 : 0;
      EXPECT_TRUE(arrives || verdict.kind == StressKind::right)
          << map.name << " " << cell.x << " " << cell.y << ": " << verdict.detail;
      ++cells;
    }
  }
  EXPECT_LT(2 * arrivals, cells);
  EXPECT_FALSE(scene_stress_maps("nowhere.json", {}));
}

TEST(StressMaps, IncludeTheScenesInTheProgram) {
  const auto maps = built_in_stress_maps({});
  EXPECT_EQ(maps.size(), 4 * stress_scene_names.size());
  for (const StressMap& map : maps) {
    SCOPED_TRACE(map.name);
    const StressCell& cell = map.cells.front();
    EXPECT_TRUE(cell.scene(SolverKind::direct, IntegratorKind::xpbd));
    EXPECT_THAT(cell.command(SolverKind::direct, IntegratorKind::xpbd),
                HasSubstr("sheave stress --print " + cell.built_in + " | sheave run - --solver"));
  }
  for (const std::string_view name : stress_scene_names) {
    std::ifstream file(std::string(SHEAVE_SOURCE_DIR) + "/scenes/paper/" + std::string(name) +
                       ".json");
    EXPECT_EQ(*stress_scene(name), std::string(std::istreambuf_iterator<char>(file), {})) << name;
  }
  EXPECT_FALSE(stress_scene("foot"));
}

}  // namespace
}  // namespace sheave::measure
