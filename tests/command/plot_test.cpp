// Charts of runs.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Plot, DrawsTablesAndScenesAlike) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string csv = folder.path("run.csv");
  const std::string npy = folder.path("run.npy");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--out", csv, "--out", npy}).exit_code, 0);
  json series;
  for (const std::string& input : {scene, csv, npy}) {
    for (const char* name : {"chart.png", "chart.svg", "chart.pdf"}) {
      const ProcessResult result = run_sheave({"plot", input, "-y", "rope.*.tension,light.vy", "-o",
                                               folder.path(name), "--json", "--label", "run"});
      ASSERT_EQ(result.exit_code, 0) << input << result.err;
      const json drawn = json::parse(result.out)["series"];
      if (series.is_null()) series = drawn;
      EXPECT_EQ(drawn, series) << input;
      EXPECT_GT(read_file(folder.path(name)).size(), 3000U);
    }
  }
  ASSERT_EQ(series.size(), 3U);
  EXPECT_EQ(series[0]["quantity"], "rope.0.tension");
  EXPECT_EQ(series[0]["unit"], "N");
  EXPECT_EQ(series[0]["points"], 100) << "the tension at the start is not known";
  EXPECT_EQ(series[2]["points"], 101);
  // The closed form of the scene: 10 + 2 N, and 2 m/s after a second.
  EXPECT_NEAR(series[0]["maximum"].get<double>(), 12.0, 1e-6);
  EXPECT_NEAR(series[2]["maximum"].get<double>(), 2.0, 1e-6);
  const std::string svg = read_file(folder.path("chart.svg"));
  EXPECT_THAT(svg, HasSubstr("tension [N]"));
  EXPECT_THAT(svg, HasSubstr("t [s]"));
  EXPECT_THAT(svg, HasSubstr("light.vy [m/s]"));
}

TEST(Plot, MarksEvents) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("jointed.json", jointed_scene);
  const std::string csv = folder.path("run.csv");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--out", csv}).exit_code, 0);
  const std::string chart = folder.path("chart.svg");
  const ProcessResult from_scene =
      run_sheave({"plot", scene, "-y", "stone.y", "-o", chart, "--json"});
  ASSERT_EQ(from_scene.exit_code, 0) << from_scene.err;
  const json events = json::parse(from_scene.out)["events"];
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0]["event"], "string break");
  EXPECT_THAT(read_file(chart), HasSubstr("string break"));
  const ProcessResult from_table =
      run_sheave({"plot", csv, "-y", "stone.y", "-o", chart, "--json"});
  const json told = json::parse(from_table.out)["events"];
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0]["event"], "string broken");
}

TEST(Plot, DrawsSeveralRunsInOneChart) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string chart = folder.path("chart.svg");
  const ProcessResult result = run_sheave({"plot", scene, scene, "-y", "light.y", "-o", chart,
                                           "--label", "first,second", "--title", "Two runs"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(chart), HasSubstr("light.y, second"));
  EXPECT_THAT(read_file(chart), HasSubstr("Two runs"));
}

TEST(Plot, ReportsFaultsOfItsInput) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string chart = folder.path("chart.png");
  const auto refused = [&](const std::string& input, const std::string& y, int code,
                           const char* message) {
    const ProcessResult result = run_sheave({"plot", input, "-y", y, "-o", chart});
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(chart));
  };
  refused(scene, "rope.0.tensoin", 2, "did you mean \"rope.0.tension\"?");
  refused(folder.write("a.csv", "t,y\n0,1\n"), "z", 2, "there is no column \"z\"");
  refused(folder.write("b.csv", "t,y\n0,1\n1,two\n"), "y", 65, "b.csv:3:3: column \"y\": \"two\"");
  refused(folder.write("c.csv", "t,y\n0,1\n1\n"), "y", 65, "c.csv:3:1: 1 cells");
  refused(folder.write("d.csv", ""), "y", 65, "no line of names");
  refused(folder.write("e.npy", "\x93NUMPY"), "y", 65, "e.npy: is no .npy file");
  refused(folder.path("none.csv"), "y", 66, "there is no such file");
  EXPECT_EQ(run_sheave({"plot", scene, "-y", "t", "-o", folder.path("a.gif")}).exit_code, 2);
}

TEST(Plot, RunDrawsAChart) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string chart = folder.path("chart.svg");
  const ProcessResult result =
      run_sheave({"run", scene, "-q", "--plot", "rope.0.tension", "--plot-file", chart});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(chart), HasSubstr("rope.0.tension [N]"));
  EXPECT_EQ(run_sheave({"run", scene, "-q", "--plot", "rope.9.tension"}).exit_code, 2);
}

TEST(Plot, DrawsExpressionsOfTablesAndScenesAlike) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string csv = folder.path("run.csv");
  const std::string npy = folder.path("run.npy");
  const std::string own = folder.path("own.csv");
  const std::string y =
      "hypot(light.vy, heavy.vy),(rope.1.tension - rope.0.tension) * 0.5,light.y * heavy.y";
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--out", csv, "--out", npy}).exit_code, 0);
  // A table whose columns are the expressions.
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--out", own, "--columns", y}).exit_code, 0);
  json series;
  for (const std::string& input : {scene, csv, npy, own}) {
    const ProcessResult result =
        run_sheave({"plot", input, "-x", input == own ? "t" : "t * 1", "-y", y, "-o",
                    folder.path("chart.svg"), "--json", "--label", "run"});
    ASSERT_EQ(result.exit_code, 0) << input << result.err;
    json drawn = json::parse(result.out)["series"];
    for (json& one : drawn) one.erase("x");
    if (series.is_null()) series = drawn;
    EXPECT_EQ(drawn, series) << input;
  }
  ASSERT_EQ(series.size(), 3U);
  // Speeds of 2 m/s after a second; tensions of 12 N and 16 N.
  EXPECT_NEAR(series[0]["maximum"].get<double>(), std::sqrt(8.0), 1e-6);
  EXPECT_NEAR(series[1]["maximum"].get<double>(), 2.0, 1e-6);
  EXPECT_EQ(series[0]["unit"], "m/s");
  EXPECT_EQ(series[1]["unit"], "N");
  EXPECT_EQ(series[2]["unit"], "m2");
  EXPECT_THAT(read_file(folder.path("chart.svg")), HasSubstr("light.y * heavy.y [m2]"));
  const ProcessResult bad =
      run_sheave({"plot", csv, "-y", "t + light.y", "-o", folder.path("bad.svg")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("\"t\" is in s, and \"light.y\" is in m"));
}

// A table of somebody else's must not keep gnuplot busy for hours, nor us.
TEST(Plot, RowsOfASweepAreNoZigZag) {
  const TemporaryFolder folder;
  const auto drawn = [&](const std::string& rows) {
    const std::string table =
        folder.write("sweep.csv", "run,load,parts,tension,status,end,certificate\n" + rows);
    const ProcessResult result =
        run_sheave({"plot", table, "-x", "load", "-y", "tension", "-o", folder.path("a.svg")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string svg = read_file(folder.path("a.svg"));
    // gnuplot draws a point as a reference to a symbol. One more is in the key.
    std::size_t points = 0;
    for (std::size_t at = svg.find("#gpPt6'"); at != std::string::npos;
         at = svg.find("#gpPt6'", at + 1)) {
      ++points;
    }
    return points;
  };
  // Two settings: the loads come again for each number of parts.
  EXPECT_EQ(drawn("0,50,2,250,done,1,0\n1,90,2,450,done,1,0\n2,50,4,125,done,1,0\n"), 4U);
  EXPECT_EQ(drawn("0,50,2,250,done,1,0\n1,90,2,450,done,1,0\n"), 0U) << "one setting: a line";
}

TEST(Plot, RefusesTooManyQuantities) {
  const TemporaryFolder folder;
  constexpr int columns = 200'000;
  std::string names = "t", row = "0";
  for (int i = 0; i < columns; ++i) {
    names += ",c" + std::to_string(i);
    row += ",1";
  }
  const std::string table = folder.write("a.csv", names + "\n" + row + "\n");
  const ProcessResult result = run_sheave({"plot", table, "-y", "*", "-o", folder.path("a.svg")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("200001 quantities are too many for a picture"));
}

}  // namespace
}  // namespace sheave::test
