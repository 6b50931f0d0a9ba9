#include "measure/rope_history.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::measure {
namespace {

TEST(Rainflow, CountsTheExampleOfTheStandard) {
  // ASTM E1049-85, figure 6: of -2, 1, -3, 5, -1, 3, -4, 4, -2 the cycles are half ones of the ranges
  // 3, 4, 8, 9, 8, 6 and a whole one of 4.
  Rainflow rainflow;
  for (const double value : {-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0}) {
    rainflow.add(value);
  }
  std::vector<LoadCycle> cycles = rainflow.cycles();
  const auto count = [&](double range) {
    double sum = 0.0;
    for (const LoadCycle& cycle : cycles) {
      if (std::abs(cycle.range - range) < 1e-12) sum += cycle.count;
    }
    return sum;
  };
  EXPECT_EQ(count(3.0), 0.5);
  EXPECT_EQ(count(4.0), 1.5);
  EXPECT_EQ(count(6.0), 0.5);
  EXPECT_EQ(count(8.0), 1.0);
  EXPECT_EQ(count(9.0), 0.5);
}

TEST(Rainflow, SmallSwingsWithinALargeOneAreWholeCycles) {
  Rainflow rainflow;
  for (const double value : {0.0, 10.0, 6.0, 8.0, 0.0}) rainflow.add(value);
  double whole = 0.0;
  for (const LoadCycle& cycle : rainflow.cycles()) {
    if (cycle.count == 1.0) whole += cycle.range;
  }
  EXPECT_EQ(whole, 2.0);
}

TEST(RopeHistory, CountsWhatPassesOverAWheel) {
  // A winch takes up 1 m of rope that comes over a wheel: of the sections that begin between the
  // load and the wheel, those within 1 m of it come onto it once; what lay on it is not bent again.
  const char* text =
      R"({"format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0], "bodies": [
    {"name": "drum", "mobility": "rotor", "position": [-2, 0, 0], "mass": 1, "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1},
     "drive": "speed", "drive_times": [0, 0.5, 1, 1.5], "drive_values": [0, 4, 4, 0]},
    {"name": "wheel", "mobility": "rotor", "mass": 0.1, "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0.25, -4, 0]}],
    "cables": [{"name": "rope", "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 1, "layer_pitch": 0.01},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "load"}]}]})";
  const SceneResult scene = load_scene_text(text, "test");
  ASSERT_TRUE(scene) << to_string(scene.errors[0]);
  Result<Simulation> made = create_simulation(*scene);
  ASSERT_TRUE(made);
  Simulation& simulation = *made;
  RopeHistory history(200);
  history.observe(simulation);
  const CableReport before = simulation.cable_reports()[0];
  for (int i = 0; i < 90; ++i) {
    ASSERT_TRUE(simulation.step().ok());
    history.observe(simulation);
  }
  const CableReport after = simulation.cable_reports()[0];
  const double moved = std::abs(after.links[0].stored_length - before.links[0].stored_length);
  EXPECT_GT(moved, 0.8);
  const CableHistory told = history.history()[0];
  ASSERT_TRUE(told.followed);
  double bent = 0.0;
  double travel = 0.0;
  for (const SectionHistory& section : told.sections) {
    for (const SectionBends& bends : section.bends) {
      if (bends.link != 1) continue;
      EXPECT_EQ(bends.bends, 1);
      EXPECT_EQ(bends.diameter, 0.5);
      EXPECT_GT(bends.most_tension, 5.0);
      bent += section.to - section.from;
    }
  }
  for (const LayerTravel& layer : told.layers) travel += layer.travel;
  // A section counts as a whole: by one of 200 at either end.
  EXPECT_NEAR(bent, moved, 2.0 * before.total_length / 200.0);
  EXPECT_NEAR(travel, moved, 1e-9);
  EXPECT_GE(told.layers.size(), 2U);
}

}  // namespace
}  // namespace sheave::measure
