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

TEST(Rainflow, CountsTheRepeatingExampleOfTheStandard) {
  // The same history repeated (5.4.5, figure 7): whole cycles of 3, 4, 7 and 9, wherever it begins.
  const std::vector<double> history{-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0};
  for (std::size_t begin = 0; begin < history.size(); ++begin) {
    Rainflow rainflow;
    for (std::size_t i = 0; i <= history.size(); ++i) {
      rainflow.add(history[(begin + i) % history.size()]);
    }
    std::vector<double> ranges;
    for (const LoadCycle& cycle : rainflow.closed_cycles()) {
      EXPECT_EQ(cycle.count, 1.0);
      ranges.push_back(cycle.range);
    }
    std::sort(ranges.begin(), ranges.end());
    EXPECT_EQ(ranges, (std::vector{3.0, 4.0, 7.0, 9.0})) << begin;
  }
}

TEST(Rainflow, LoadingAndUnloadingAreOneCycle) {
  Rainflow rainflow;
  EXPECT_TRUE(rainflow.closed_cycles().empty());
  rainflow.add(0.0);
  EXPECT_TRUE(rainflow.closed_cycles().empty());
  for (const double value : {4.0, 10.0, 7.0, 0.0}) rainflow.add(value);
  const std::vector<LoadCycle> cycles = rainflow.closed_cycles();
  ASSERT_EQ(cycles.size(), 1U);
  EXPECT_EQ(cycles[0].range, 10.0);
  EXPECT_EQ(cycles[0].mean, 5.0);
  EXPECT_EQ(cycles[0].count, 1.0);
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

TEST(RopeHistory, CountsSectionsThatPassOverAWheel) {
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

/// A rope of 12 m from a drum with `winding` over a wheel to a load, of sections of 0.06 m; the drum
/// has the speed of the table.
Result<Simulation> hoist(const char* winding, const char* times, const char* speeds,
                         const char* material = "") {
  const std::string text =
      std::string(R"({"format": "sheave-scene/1", "duration": 8, "gravity": [0, -10, 0], "bodies": [
    {"name": "drum", "mobility": "rotor", "position": [-4, -4, 0], "mass": 1, "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1},
     "drive": "speed", "drive_times": )") +
      times + R"(, "drive_values": )" + speeds + R"(},
    {"name": "wheel", "mobility": "rotor", "mass": 0.1, "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0.25, -4, 0]}],
    "cables": [{"name": "rope", )" +
      material + R"("links": [
      {"type": "spool", "body": "drum", "winding": ")" +
      winding + R"(", "stored_length": 3},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "load"}]}]})";
  const SceneResult scene = load_scene_text(text, "test");
  if (!scene) return Error{"", to_string(scene.errors[0])};
  return create_simulation(*scene);
}

TEST(RopeHistory, ALiftAndBackBendsEachSectionOnceAtMostEachWay) {
  // What vibrates on its elastic rope at the wheel's edges is not bent each time: up and down again
  // a section comes onto the wheel at most twice, and has one cycle of the load at most beside what
  // starting and stopping make. Both wheels bend the rope the same way, or one against the other.
  for (const bool reverse : {false, true}) {
    Result<Simulation> made =
        hoist(reverse ? "counter-clockwise" : "clockwise", "[0, 0.5, 2, 3, 4.5, 5]",
              reverse ? "[0, -2, -2, 2, 2, 0]" : "[0, 2, 2, -2, -2, 0]",
              R"("axial_stiffness": 200000, )");
    ASSERT_TRUE(made) << made.errors()[0].message;
    RopeHistory history(200);
    history.observe(*made);
    for (int i = 0; i < 480; ++i) {
      ASSERT_TRUE(made->step().ok());
      history.observe(*made);
    }
    const CableHistory told = history.history()[0];
    int on_wheel = 0;
    for (const SectionHistory& section : told.sections) {
      for (const SectionBends& bends : section.bends) {
        EXPECT_LE(bends.bends, bends.link == 1 ? 2 : 1) << section.from;
        if (bends.link != 1) continue;
        ++on_wheel;
        EXPECT_LE(bends.reverse, reverse ? 1 : 0) << section.from;
      }
    }
    // 2 rad/s x 0.25 m for 2 s, and half of that.
    EXPECT_GT(on_wheel, 10);
  }
}

TEST(RopeHistory, ASectionAtAnEdgeIsNotBentByRounding) {
  // A load that hangs at rest over a wheel that trembles by 1e-9 rad: nothing is bent.
  Result<Simulation> made = hoist("clockwise", "[0, 1]", "[0, 0]");
  ASSERT_TRUE(made);
  // So many sections that one of them has its middle within rounding of the wheel's edge.
  const CableReport report = made->cable_reports()[0];
  const double to_edge = report.links[0].stored_length + report.spans[0].rest_length;
  int sections = 100;
  for (int n = 100; n < 10000; ++n) {
    const double middles = to_edge / (report.total_length / n) - 0.5;
    const double best = to_edge / (report.total_length / sections) - 0.5;
    if (std::abs(middles - std::round(middles)) < std::abs(best - std::round(best))) sections = n;
  }
  RopeHistory history(sections);
  history.observe(*made);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(made->step().ok());
    history.observe(*made);
  }
  const std::vector<CableHistory> records = history.history();
  for (const SectionHistory& section : records[0].sections) {
    for (const SectionBends& bends : section.bends) EXPECT_LE(bends.bends, 1) << section.from;
  }
}

TEST(RopeHistory, ARopeWithWeightHasItsTensionAtEachPlace) {
  // 100 kg hang at rest on 20 m of rope of 4 kg/m, and the rope is counted from above or from below.
  // The tension at a section is the weight of the load and of the rope below it. In steps of 1/60 s,
  // the load vibrates about its equilibrium by no more than rounding.
  constexpr double g = 9.81;
  constexpr int sections = 20;
  for (const bool from_above : {true, false}) {
    const std::string top = R"({"type": "attachment", "body": "world"})";
    const std::string load = R"({"type": "attachment", "body": "load"})";
    const std::string text =
        R"({"format": "sheave-scene/1", "duration": 1, "gravity": [0, -9.81, 0], "start": "rest", "bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 100, "position": [0, -20, 0]}],
    "cables": [{"name": "rope", "linear_density": 4, "axial_stiffness": 1e6, "rest_lengths": [20],
      "links": [)" +
        (from_above ? top + ", " + load : load + ", " + top) + "]}]}";
    const SceneResult scene = load_scene_text(text, "test");
    ASSERT_TRUE(scene) << to_string(scene.errors[0]);
    Result<Simulation> made = create_simulation(*scene);
    ASSERT_TRUE(made) << made.errors()[0].message;
    RopeHistory history(sections);
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(made->step().ok());
      history.observe(*made);
    }
    const std::vector<SectionHistory> told = history.history()[0].sections;
    ASSERT_EQ(told.size(), 20U);
    for (std::size_t i = 0; i < told.size(); ++i) {
      const double below =
          from_above ? 19.5 - static_cast<double>(i) : 0.5 + static_cast<double>(i);
      const double closed = (100.0 + 4.0 * below) * g;
      EXPECT_NEAR(told[i].most_tension, closed, 1e-6 * closed) << i;
      EXPECT_NEAR(told[i].least_tension, closed, 1e-6 * closed) << i;
      EXPECT_TRUE(told[i].cycles.empty()) << i;
    }
  }
}

}  // namespace
}  // namespace sheave::measure
