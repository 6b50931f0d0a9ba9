// No step takes many times as long as others, however long a machine runs: counted in rounds and
// factorisations, not by a clock. Where a machine locks up, its substeps are bounded and tell of
// it.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "engine/substep_driver.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

/// Of a substep: what the driver allows all parts and two attempts at the whole, with the rounds of
/// the settings for each.
std::int64_t most_factorisations_of(const Simulation& simulation) {
  std::int64_t rows = 0;
  for (const auto& feature : simulation.world.features()) rows += feature->row_count();
  const std::int64_t share = std::clamp<std::int64_t>(rows / SubstepDriver::rows_of_factorisation,
                                                      1, SubstepDriver::fewest_share);
  return (SubstepDriver::most_factorisations + 2 * SubstepDriver::last_factorisations) / share +
         3 * simulation.world.model().step.iterations;
}

class BoundedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BoundedScene, StepsTakeAboutAsLongAsOthers) {
  // A rope of 100 links in contact with wheels, most of whose substeps are hard to solve.
  if (GetParam().filename() == "naive-rope.json") GTEST_SKIP();
  const SceneResult loaded = load_scene(GetParam());
  ASSERT_TRUE(loaded);
  auto simulation = create_simulation(*loaded.scene);
  ASSERT_TRUE(simulation);
  const bool contacts = !loaded.scene->model.colliders.empty();
  const std::int64_t bound = most_factorisations_of(*simulation);
  const int substeps = loaded.scene->model.step.substeps;
  // In ten times its own duration, or so many steps.
  constexpr std::int64_t most_steps = 1000;
  // A machine that has locked up stays so: enough has been seen of it.
  constexpr int most_told = 10;
  int told_steps = 0;
  const auto steps = std::min<std::int64_t>(
      std::llround(10.0 * loaded.scene->duration / loaded.scene->model.step.dt), most_steps);
  std::vector<std::int64_t> work;
  std::int64_t worst = 0;
  double worst_time = 0.0;
  for (std::int64_t i = 0; i < steps && told_steps < most_told; ++i) {
    const StepReport report = simulation->step();
    if (!report.ok()) break;
    const StepStatistics& did = report.statistics;
    // Of contacts the rows come and go.
    if (!contacts) {
      EXPECT_LE(did.factorisations, substeps * bound) << "at " << simulation->world.state().time;
    }
    work.push_back(did.rounds + did.factorisations);
    const bool told = did.cut_substeps + did.dead_ends + did.impossible + did.exhausted +
                          did.unconverged + did.compromises + did.solver_fallbacks >
                      0;
    told_steps += told ? 1 : 0;
    if (told || work.back() <= worst) continue;
    worst = work.back();
    worst_time = simulation->world.state().time;
  }
  ASSERT_FALSE(work.empty());
  std::nth_element(work.begin(), work.begin() + static_cast<std::ptrdiff_t>(work.size() / 2),
                   work.end());
  const std::int64_t median = std::max<std::int64_t>(work[work.size() / 2], 1);
  EXPECT_LE(worst, 20 * median) << "at " << worst_time << " s";
}

INSTANTIATE_TEST_SUITE_P(Scenes, BoundedScene, testing::ValuesIn(valid_scene_files()),
                         [](const auto& scene) { return test_name(scene.param); });

}  // namespace
}  // namespace sheave::test
