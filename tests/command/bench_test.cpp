// sheave bench: which rows there are, that no time stands without its error, baselines and charts.
// No time is judged.

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/bench/table.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Runs the bench on a folder in which the paper's "simple" is two weights over a wheel.
class Bench : public testing::Test {
 protected:
  Bench() { folder.write("simple.json", atwood_scene); }

  [[nodiscard]] ProcessResult bench(std::vector<std::string> options) const {
    // References as good as they are to be, on the slowest machine.
    options.insert(options.begin(), {"bench", "--scenes", folder.path(""), "--repetitions", "1",
                                     "--reference-seconds", "1e6"});
    return run_sheave(options);
  }

  TemporaryFolder folder;
};

TEST_F(Bench, ListsTheTablesRows) {
  const ProcessResult result = bench({"--list", "--filter", "HILBERT3"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out,
            "Hilbert3 gauss-seidel 1 x 10\nHilbert3 gauss-seidel 1 x 100\nHilbert3 direct 1\n"
            "Hilbert3 direct 1, rattle\n");
  EXPECT_THAT(bench({"--list"}).out, HasSubstr("Bow gauss-seidel 10 x 10\n"));
}

TEST_F(Bench, EveryTimeHasItsError) {
  const ProcessResult result = bench({"--json", "--filter", "simple"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  EXPECT_EQ(table["format"], "sheave-bench/1");
  ASSERT_EQ(table["rows"].size(), 4U);
  for (const json& row : table["rows"]) {
    SCOPED_TRACE(row["name"].get<std::string>());
    EXPECT_GT(row["seconds_per_frame"]["median"], 0.0);
    EXPECT_LE(row["seconds_per_frame"]["minimum"], row["seconds_per_frame"]["median"]);
    EXPECT_TRUE(row["error"]["position"].is_number());
    EXPECT_TRUE(row["reference_error"]["position"].is_number());
    EXPECT_LT(row["length_error"], 1e-12);
    EXPECT_GT(row["row_solves_per_frame"], 0.0);
    EXPECT_EQ(row["settings"]["dt"], 1.0 / 60.0);
  }
  // One substep of xpbd falls a h t / 2 too far, whatever the solver; a = 2 m/s2 after 1 s, in a
  // scene of some metres.
  const double scale = 0.5 * 2.0 / 60.0 / table["rows"][2]["error"]["position"].get<double>();
  EXPECT_GT(scale, 2.0);
  EXPECT_LT(scale, 5.0);
  // With rattle nothing is left, and the reference must be better than what it judges.
  EXPECT_LT(table["rows"][3]["error"]["position"], 1e-9);
  EXPECT_TRUE(table["references"][0]["good"]);
}

TEST_F(Bench, NamesMissingScenesAndInventsNothing) {
  const ProcessResult result = bench({"--json", "--filter", "gym"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no row has numbers"));
  const auto parsed = json::parse(result.out);
  for (const json& row : parsed["rows"]) {
    EXPECT_THAT(row["fault"].get<std::string>(), HasSubstr("missing: "));
    EXPECT_THAT(row["fault"].get<std::string>(), HasSubstr("gym.json"));
    EXPECT_FALSE(row.contains("seconds_per_frame"));
    EXPECT_FALSE(row.contains("error"));
  }
  EXPECT_THAT(bench({"--filter", "gym"}).out, HasSubstr("missing: "));
}

TEST_F(Bench, ShowsNoTimeOfABadScene) {
  folder.write("pulley.json", R"({"format": "sheave-scene/1", "gravity": [0, 0, 0]})");
  const ProcessResult result = bench({"--json", "--filter", "pulley"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no row has numbers"));
  const auto parsed = json::parse(result.out);
  for (const json& row : parsed["rows"]) {
    EXPECT_THAT(row["fault"].get<std::string>(), HasSubstr("duration"));
    EXPECT_FALSE(row.contains("seconds_per_frame"));
  }
}

TEST_F(Bench, ComparesWithABaseline) {
  const std::string baseline = folder.path("before.json");
  ASSERT_EQ(bench({"--filter", "simple gauss", "--save", baseline}).exit_code, 0);
  // So many times slower and faster that no machine's moods matter.
  const auto changed = [&](double factor) {
    json other = json::parse(read_file(baseline));
    for (json& row : other["rows"]) {
      for (auto& [name, value] : row["seconds_per_frame"].items()) {
        if (name != "samples") value = factor * value.get<double>();
      }
    }
    return other;
  };
  const std::string slow = folder.write("slower.json", changed(1e30).dump());
  const ProcessResult same = bench({"--filter", "simple", "--compare", slow});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("now / before"));
  EXPECT_THAT(same.out, HasSubstr("Simple direct 1: in one of the two files only"));
  json faster = changed(1e-30);
  faster["machine"]["cpu"] = "another one";
  const std::string path = folder.write("faster.json", faster.dump());
  const ProcessResult slower = bench({"--filter", "simple gauss", "--compare", path});
  EXPECT_EQ(slower.exit_code, 1);
  EXPECT_THAT(slower.out, HasSubstr("SLOWER"));
  EXPECT_THAT(slower.err, HasSubstr("another machine (another one)"));
}

TEST_F(Bench, RefusesAWrongBaselineBeforeMeasuring) {
  EXPECT_EQ(bench({"--compare", folder.path("none.json")}).exit_code, 66);
  for (const char* text : {"", "[]", "{}", R"({"format": "sheave-bench/2", "rows": []})",
                           R"({"format": "sheave-bench/1", "rows": 3})",
                           R"({"format": "sheave-bench/1", "rows": [7]})"}) {
    const std::string path = folder.write("wrong.json", text);
    const ProcessResult result = bench({"--compare", path});
    EXPECT_EQ(result.exit_code, 65) << text;
    EXPECT_THAT(result.err, HasSubstr("wrong.json")) << text;
    EXPECT_THAT(result.out, IsEmpty()) << text;
  }
}

TEST_F(Bench, WrongUsage) {
  EXPECT_EQ(bench({"--filter", "no such row"}).exit_code, 2);
  EXPECT_EQ(bench({"--chart", "picture.gif"}).exit_code, 2);
  EXPECT_EQ(bench({"--repetitions", "0"}).exit_code, 2);
  EXPECT_EQ(run_sheave({"bench", "--scenes", folder.path("nowhere")}).exit_code, 66);
}

TEST_F(Bench, WritesMarkdownAndCharts) {
  const std::string page = folder.path("table.md");
  ASSERT_EQ(bench({"--filter", "simple", "--markdown", page}).exit_code, 0);
  EXPECT_THAT(read_file(page), HasSubstr("| Simple | gauss-seidel 1 x 10 | 2 (paper 4) |"));
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  for (const std::string name : {"it's a chart.png", "chart.svg"}) {
    const std::string path = folder.path(name);
    const ProcessResult result = bench({"--filter", "simple", "--chart", path});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string picture = read_file(path);
    EXPECT_THAT(picture, HasSubstr(name.ends_with(".png") ? "PNG" : "</svg>"));
  }
  EXPECT_EQ(bench({"--filter", "simple", "--chart", folder.path("no/where.png")}).exit_code, 74);
  // Nothing unfinished stays behind.
  EXPECT_THAT(folder.entries(),
              ElementsAre("chart.svg", "it's a chart.png", "simple.json", "table.md"));
}

command::BenchRow measured_row(double error, double doubt) {
  command::BenchRow row;
  row.scene = "Some";
  row.seconds = {1e-3, 0.9e-3, 1.1e-3, 0.8e-3, 5};
  row.row_solves = 10.0;
  row.error.position = error;
  row.reference_error.position = doubt;
  return row;
}

TEST(BenchText, ShowsOnlyTheKnownDigitsOfErrors) {
  command::BenchTable table;
  table.rows = {measured_row(2e-3, 1e-5)};
  EXPECT_THAT(command::bench_text(table), HasSubstr("2.0e-03"));
  table.rows = {measured_row(2e-3, 1e-3)};
  EXPECT_THAT(command::bench_text(table), HasSubstr("< 3.0e-03"));
  table.rows = {measured_row(2e-3, INFINITY)};
  EXPECT_THAT(command::bench_text(table), HasSubstr("not verified"));
  table.rows = {measured_row(1e-15, 1e-16)};
  EXPECT_THAT(command::bench_text(table), HasSubstr("< 1.0e-11"));
  table.rows.front().fault = "missing";
  EXPECT_THAT(command::bench_text(table), Not(HasSubstr("1000")));
}

}  // namespace
}  // namespace sheave::test
