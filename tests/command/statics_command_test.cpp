// `sheave statics`, `sheave modes` and `sheave run --rope-history` as people and programs call them.

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"

namespace sheave::test {
namespace {

using nlohmann::json;

/// A weight of 2 kg that hangs from a rope of 1 m and 500 N/m on a rail.
const std::string hanging_scene = R"json({
  "format": "sheave-scene/1", "name": "Hanging", "gravity": [0, -10, 0], "duration": 0.1,
  "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
  "cables": [{"name": "rope", "compliance": 0.002, "links": [
    {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]
})json";

/// A table as it reads, whatever the widths of its columns.
std::string with_single_blanks(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ' || result.empty() || result.back() != ' ') result += c;
  }
  return result;
}

TEST(StaticsCommand, SavesNoStateWithoutEquilibrium) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("falls.json", R"json({
  "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1,
  "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2}]})json");
  const std::string state = folder.path("falls.state");
  EXPECT_EQ(run_sheave({"statics", scene, "--save-state", state}).exit_code, 75);
  EXPECT_FALSE(std::filesystem::exists(state));
  const std::string hangs = folder.write("hanging.json", hanging_scene);
  EXPECT_EQ(run_sheave({"statics", hangs, "--save-state", state}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(state));
}

TEST(StaticsCommand, ReportsAnEquilibrium) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const ProcessResult result = run_sheave({"statics", scene, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json one = json::parse(result.out)["cases"][0];
  EXPECT_TRUE(one["converged"]);
  EXPECT_EQ(one["stability"], "stable");
  EXPECT_NEAR(one["cables"][0]["spans"][0]["tension"].get<double>(), 20.0, 1e-8);
  EXPECT_NEAR(one["bodies"][0]["center_of_mass"][1].get<double>(), -1.04, 1e-10);
  const ProcessResult text = run_sheave({"statics", scene});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("at rest, stable"), std::string::npos) << text.out;
}

TEST(StaticsCommand, MakesATableOfLoadCases) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const ProcessResult result =
      run_sheave({"statics", scene, "--case", "one:/bodies/load/mass=1", "--case",
                  "three:/bodies/load/mass=3", "--quantity", "load.y", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json cases = json::parse(result.out)["cases"];
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_NEAR(cases[0]["quantities"]["load.y"].get<double>(), -1.02, 1e-10);
  EXPECT_NEAR(cases[1]["quantities"]["load.y"].get<double>(), -1.06, 1e-10);
}

TEST(StaticsCommand, ReportsQuantitiesOfOneEquilibrium) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const ProcessResult result = run_sheave({"statics", scene, "--quantity", "load.y"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // 1 m of rope and m g c = 2 x 10 x 0.002 m of its stretch.
  EXPECT_NE(with_single_blanks(result.out).find("load.y [m] -1.04"), std::string::npos)
      << result.out;
  EXPECT_EQ(run_sheave({"statics", scene}).out.find("quantity"), std::string::npos);
}

TEST(StaticsCommand, ReportsExpressions) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const ProcessResult result =
      run_sheave({"statics", scene, "--quantity", "abs(load.y) ^ 2 + 1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json quantities = json::parse(result.out)["cases"][0]["quantities"];
  EXPECT_NEAR(quantities["abs(load.y) ^ 2 + 1"].get<double>(), 1.04 * 1.04 + 1.0, 1e-9);
  const ProcessResult moving = run_sheave({"statics", scene, "--quantity", "2 * power.drives"});
  EXPECT_EQ(moving.exit_code, 2);
  EXPECT_NE(moving.err.find("this quantity needs motion"), std::string::npos) << moving.err;
}

TEST(StaticsCommand, ReportsFaultsOfItsInput) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  EXPECT_EQ(run_sheave({"statics", scene, "--case", "nonsense"}).exit_code, 2);
  const ProcessResult unknown = run_sheave({"statics", scene, "--quantity", "load.q"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--quantity: there is no quantity \"load.q\""), std::string::npos)
      << unknown.err;
  EXPECT_EQ(run_sheave({"statics", folder.path("none.json")}).exit_code, 66);
}

TEST(ModesCommand, ReportsFrequenciesAndWritesMatrices) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const ProcessResult result = run_sheave({"modes", scene, "--json", "--input", "force:load.y",
                                           "--output", "load.y", "--matrices", folder.path("m")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json found = json::parse(result.out);
  const double square = 500.0 / 2.0;
  EXPECT_NEAR(found["modes"][0]["eigenvalue"].get<double>(), square, 1e-6 * square);
  // From a force to the height: C B = 0, C A B = 1 / m.
  const double c = found["C"][0][0].get<double>();
  const double b = found["B"][1][0].get<double>();
  EXPECT_NEAR(c * b, 0.5, 1e-6);
  EXPECT_EQ(read_file(folder.path("m.A.npy")).substr(1, 5), "NUMPY");
  EXPECT_EQ(read_file(folder.path("m.K.npy")).size() % 8, 0U);
  EXPECT_EQ(run_sheave({"modes", scene, "--input", "drive:load"}).exit_code, 2);
}

TEST(ModesCommand, ReportsTheDirectionOfEachMode) {
  // A bob on a rope between two points of equal height moves on an ellipsoid of revolution: with the
  // half axes a = 5 and b = 3 m along the line between the points with w^2 = g b / a^2, across it
  // with w^2 = g / b. About the hole in its middle it turns freely.
  const TemporaryFolder folder;
  const std::string scene = folder.write("bob.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1,
    "bodies": [{"name": "bob", "mass": 2, "inertia": [1, 1, 1], "position": [0, -3, 0]}],
    "cables": [{"name": "track", "links": [
      {"type": "attachment", "body": "world", "point": [-4, 0, 0]}, {"type": "pinhole", "body": "bob"},
      {"type": "attachment", "body": "world", "point": [4, 0, 0]}]}]
  })json");
  const ProcessResult result = run_sheave({"modes", scene});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // sqrt(1.2) / (2 pi) = 0.1743455 Hz, sqrt(10 / 3) / (2 pi) = 0.2905758 Hz
  const std::string table = with_single_blanks(result.out);
  EXPECT_NE(table.find("bob (100 %) x 0.17434"), std::string::npos) << result.out;
  EXPECT_NE(table.find("bob (100 %) z 0.29057"), std::string::npos) << result.out;
  EXPECT_NE(table.find("bob (100 %) turn_"), std::string::npos) << result.out;
}

TEST(ModesCommand, ReportsAMachineThatCannotMove) {
  // A weight on a rail whose rigid rope leaves it nothing.
  const TemporaryFolder folder;
  std::string text = hanging_scene;
  text.erase(text.find("\"compliance\": 0.002, "), std::string("\"compliance\": 0.002, ").size());
  const std::string scene = folder.write("held.json", text);
  const ProcessResult result = run_sheave({"modes", scene});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("no body can move"), std::string::npos) << result.out;
  EXPECT_TRUE(json::parse(run_sheave({"modes", scene, "--json"}).out)["modes"].empty());
}

TEST(ModesCommand, TakesDrivesOfJointsAsInputs) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ram.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 0.1,
    "bodies": [
      {"name": "carriage", "mass": 4, "inertia": [1, 1, 1]},
      {"name": "tool", "mass": 1, "inertia": [1, 1, 1], "position": [0, 1, 0]}],
    "joints": [
      {"type": "slider", "name": "ram", "body_b": "carriage", "anchor": [0, 0, 0], "axis": [1, 0, 0],
       "stiffness": 50, "drive": "force", "drive_values": [0]},
      {"type": "cylindrical", "name": "guide", "body_a": "carriage", "body_b": "tool",
       "anchor": [0, 1, 0], "axis": [0, 1, 0], "travel_stiffness": 20, "angle_stiffness": 3,
       "travel_drive": "speed", "travel_drive_values": [0]}]
  })json");
  const ProcessResult result = run_sheave(
      {"modes", scene, "--json", "--input", "drive:ram", "--input", "drive:guide", "--output",
       "carriage.x", "--output", "tool.y", "--output", "carriage.x - 2 * tool.y"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json found = json::parse(result.out);
  // Two motions: both along x, and the tool about its guide; the drive's way is the last state.
  ASSERT_EQ(found["A"].size(), 5U);
  ASSERT_EQ(found["B"].size(), 5U);
  double accelerated = 0.0;  // of the carriage by a force: C A B = 1 / m of both
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t k = 0; k < 5; ++k) {
      accelerated += found["C"][0][i].get<double>() * found["A"][i][k].get<double>() *
                     found["B"][k][0].get<double>();
    }
  }
  EXPECT_NEAR(accelerated, 1.0 / 5.0, 1e-6);
  // Rows of C are linear in their outputs.
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(found["C"][2][k].get<double>(),
                found["C"][0][k].get<double>() - 2.0 * found["C"][1][k].get<double>(), 1e-9);
  }
  // What the drive has driven moves the tool as far.
  EXPECT_EQ(found["B"][4][1].get<double>(), 1.0);
  EXPECT_NEAR(found["C"][1][4].get<double>(), 1.0, 1e-6);
  const ProcessResult none = run_sheave({"modes", scene, "--input", "drive:guide.angle"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("has drives of guide.travel"), std::string::npos) << none.err;
  EXPECT_EQ(run_sheave({"modes", scene, "--input", "drive:rum"}).exit_code, 2);
}

TEST(RopeHistoryOption, WritesTheLoadsOfEachSection) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging_scene);
  const std::string file = folder.path("ropes.json");
  const ProcessResult result = run_sheave({"run", scene, "-q", "--rope-history", file,
                                           "--rope-sections", "4", "--rope-diameter", "0.01"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json cable = json::parse(read_file(file))["cables"][0];
  EXPECT_EQ(cable["name"], "rope");
  ASSERT_EQ(cable["sections"].size(), 4U);
  EXPECT_TRUE(cable["sections"][0]["bends"].empty());
  EXPECT_GT(cable["sections"][3]["most_tension"].get<double>(), 0.0);
}

// A load of 100 N would stretch the rope by 0.2 m more.
TEST(StaticsCommand, TellsThatLoadsOverTimeAreLeftOut) {
  const TemporaryFolder folder;
  std::string text = hanging_scene;
  text.insert(text.find("\"bodies\""),
              R"("loads": [{"type": "force", "name": "pull", "body": "load",
                 "forces": [[0, -100, 0]]}], )");
  const std::string scene = folder.write("pulled.json", text);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"statics", scene},
        std::vector<std::string>{"statics", scene, "--case", "a:/bodies/0/mass=2", "--case",
                                 "b:/bodies/0/mass=3"},
        std::vector<std::string>{"modes", scene}}) {
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string told = "the loads \"pull\" act in runs alone";
    const std::size_t first = result.err.find(told);
    EXPECT_NE(first, std::string::npos) << command.front() << ": " << result.err;
    EXPECT_EQ(result.err.find(told, first + 1), std::string::npos) << "once";
  }
}

}  // namespace
}  // namespace sheave::test
