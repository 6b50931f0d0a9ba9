// What is measured of cables at the end of a substep from lengths that it has found is what their
// reports tell, also where a cable has just left or touched a wheel, was cut, or the state was
// restored.

#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "engine/body_set.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

void expect_like_reports(const Simulation& simulation, double size) {
  std::vector<CableGauge> gauges;
  simulation.gauge_cables(gauges);
  const std::vector<CableReport> reports = simulation.cable_reports();
  ASSERT_EQ(gauges.size(), reports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const CableGauge expected = reports[i].gauge();
    // Sums of lengths, in another order, and the same length from another formula.
    const double rounding = 1e-13 * (size + expected.total_length);
    EXPECT_NEAR(gauges[i].total_length, expected.total_length, rounding) << reports[i].name;
    EXPECT_NEAR(gauges[i].length_error, expected.length_error, 1e-13) << reports[i].name;
    EXPECT_NEAR(gauges[i].excess, std::max(expected.excess, 0.0), 100.0 * rounding)
        << reports[i].name;
    EXPECT_NEAR(gauges[i].max_stretch, expected.max_stretch, 1e-6) << reports[i].name;
    EXPECT_NEAR(gauges[i].max_strain, expected.max_strain, 1e-6) << reports[i].name;
  }
}

class GaugedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(GaugedScene, AgreesWithItsReports) {
  const SceneResult scene = load_scene(GetParam());
  ASSERT_TRUE(scene);
  auto simulation = Simulation::create(scene->model, scene->cables);
  ASSERT_TRUE(simulation);
  const double size = simulation->world.bodies().scale();
  expect_like_reports(*simulation, size);
  const State start = simulation->world.state();
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(simulation->world.step().ok());
    expect_like_reports(*simulation, size);
  }
  ASSERT_TRUE(simulation->world.restore(start).empty());
  expect_like_reports(*simulation, size);
}

std::vector<std::filesystem::path> scenes_with_cables() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"paper", "machines"}) {
    for (const auto& file : scene_files(folder)) {
      // Its hundred rigid segments take long.
      if (file.stem() != "naive-rope") files.push_back(file);
    }
  }
  return files;
}

INSTANTIATE_TEST_SUITE_P(Scenes, GaugedScene, testing::ValuesIn(scenes_with_cables()),
                         [](const auto& scene) { return test_name(scene.param); });

}  // namespace
}  // namespace sheave::test
