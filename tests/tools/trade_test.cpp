// sheave trade: orders of both integrators, answers, what --apply writes, errors of options. No time is judged.

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/process.h"
#include "tests/tools/scenes.h"
#include "tools/failure.h"
#include "tools/trade_table.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string scenes = SHEAVE_SOURCE_DIR "/scenes/";

ProcessResult trade(const std::string& scene, std::vector<std::string> options) {
  options.insert(options.begin(), {"trade", scene, "--repetitions", "1"});
  return run_sheave(options);
}

double order_on_the_pendulum(const std::string& integrator, const std::string& substeps) {
  // Half a period, in 50 frames.
  const ProcessResult result = trade(scenes + "analytic/pendulum.json",
                                     {"--json", "--solver", "direct", "--integrator", integrator,
                                      "--substeps", substeps, "--duration", "1.1245773124377003"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  EXPECT_TRUE(table["reference"]["good"]);
  EXPECT_EQ(table["rows"].size(), 4U);
  EXPECT_EQ(table["compared_seconds"], table["simulated_seconds"]);
  return table["orders"][0]["order"].get<double>();
}

TEST(Trade, FindsTheOrderOfTheIntegrators) {
  // The error of a substep h is c h + O(h^2) and c h^2 + O(h^4) (rattle is symmetric). With w h = 7 rad/s x 0.7 ms = 0.005
  // at most for xpbd, 0.08 for rattle, what is neglected changes the slope by the order of w h T / 2 = 0.02 and 0.006.
  EXPECT_NEAR(order_on_the_pendulum("xpbd", "32,64,128,256"), 1.0, 0.03);
  EXPECT_NEAR(order_on_the_pendulum("rattle", "2,4,8,16"), 2.0, 0.03);
}

/// Runs on a file with two weights over a wheel.
class TradeOfAFile : public testing::Test {
 protected:
  TradeOfAFile() {
    const std::string step = R"("step": {)";
    std::string text = "// Two weights.\n" + atwood_scene;
    text.replace(text.find(step), step.size(), "\"step\": {/* rough */ ");
    path = folder.write("weights.json", text);
  }

  TemporaryFolder folder;
  std::string path;
};

TEST_F(TradeOfAFile, EveryTimeHasItsError) {
  const ProcessResult result =
      trade(path, {"--json", "--substeps", "1,2,4", "--iterations", "2,20"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  EXPECT_EQ(table["format"], "sheave-trade/1");
  // 3 x 2 x 2 integrators x 2 tangent updates, and without the iterations the direct solver's.
  ASSERT_EQ(table["rows"].size(), 24U + 12U);
  int on_front = 0;
  for (const json& row : table["rows"]) {
    SCOPED_TRACE(row["name"].get<std::string>());
    EXPECT_GT(row["seconds_per_simulated_second"]["median"], 0.0);
    EXPECT_GT(row["row_solves_per_simulated_second"], 0.0);
    EXPECT_LT(row["length_error"], 1e-12);
    on_front += row["on_front"].get<bool>() ? 1 : 0;
    // A constant acceleration a: xpbd falls a h t / 2 too far whatever the solver, and rattle not at all if the tangents follow.
    const double error = row["error"]["position"];
    if (row["name"] == "direct 1, rattle") {
      EXPECT_LT(error, 1e-9);
    }
    if (row["name"] == "direct 4") {
      EXPECT_NEAR(error, 0.25 * table["rows"][24]["error"]["position"].get<double>(), 1e-9);
    }
  }
  EXPECT_EQ(table["rows"][24]["name"], "direct 1");
  EXPECT_GE(on_front, 1);
  EXPECT_FALSE(table["cheapest"][2]["row"].is_null());
}

TEST_F(TradeOfAFile, AppliesTheAnswerAndKeepsTheRest) {
  const std::string before = read_file(path);
  const ProcessResult result =
      trade(path, {"--error", "0.01%", "--apply", "--solver", "direct", "--integrator", "rattle",
                   "--substeps", "3", "--tangents", "substep"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("--error 0.01%: direct 3, rattle, tangents per substep ("));
  const std::string after = read_file(path);
  EXPECT_THAT(after, HasSubstr("// Two weights.\n"));
  EXPECT_THAT(after,
              HasSubstr(R"("step": {/* rough */ "dt": 0.01, "substeps": 3, "iterations": 20, )"
                        R"("solver": "direct", "integrator": "rattle"},)"));
  EXPECT_THAT(after, HasSubstr(R"("tangent_update": "substep"})"));
  EXPECT_EQ(run_sheave({"validate", path}).exit_code, 0);
  // Once it is so, nothing changes any more.
  ASSERT_EQ(trade(path, {"--error", "0.01%", "--apply", "--solver", "direct", "--integrator",
                         "rattle", "--substeps", "3", "--tangents", "substep"})
                .exit_code,
            0);
  EXPECT_EQ(read_file(path), after);
}

TEST_F(TradeOfAFile, SaysWhenNoSettingAnswers) {
  const std::string before = read_file(path);
  const ProcessResult result =
      trade(path, {"--budget", "1e-9us/frame", "--apply", "--solver", "direct", "--substeps", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("--budget 1e-9us/frame: none of these settings"));
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(
      trade(path, {"--budget", "1s/frame", "--solver", "direct", "--substeps", "1"}).exit_code, 0);
}

TEST_F(TradeOfAFile, WrongUsage) {
  const auto refused = [&](const std::vector<std::string>& options) {
    const ProcessResult result = trade(path, options);
    EXPECT_EQ(result.exit_code, 2) << options[0] << " " << options[1];
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_THAT(refused({"--budget", "2ms"}), HasSubstr("2ms/frame"));
  EXPECT_THAT(refused({"--budget", "-2ms/frame"}), HasSubstr("must be a positive number"));
  EXPECT_THAT(refused({"--error", "little"}), HasSubstr("0.1% or 1e-3"));
  EXPECT_THAT(refused({"--error", "0%"}), HasSubstr("positive"));
  EXPECT_THAT(refused({"--apply", "--json"}), HasSubstr("--apply needs --budget or --error"));
  EXPECT_THAT(refused({"--solver", "magic"}), HasSubstr("magic"));
  EXPECT_THAT(refused({"--substeps", "1,0"}), HasSubstr("0"));
  EXPECT_THAT(refused({"--chart", "picture.gif"}), HasSubstr(".png or .svg"));
  EXPECT_THAT(refused({"--error", "1%", "--budget", "1ms/frame"}), HasSubstr("excludes"));
  EXPECT_EQ(trade(folder.path("none.json"), {}).exit_code, 66);
  EXPECT_EQ(run_sheave({"trade", "-", "--error", "1%", "--apply"}).exit_code, 2);
}

TEST_F(TradeOfAFile, WritesTablesAndCharts) {
  const std::string page = folder.path("trade.md");
  const std::string csv = folder.path("trade.csv");
  ASSERT_EQ(
      trade(path, {"--substeps", "1,2", "--solver", "direct", "--markdown", page, "--csv", csv})
          .exit_code,
      0);
  EXPECT_THAT(read_file(page), HasSubstr("# Two weights: speed against accuracy"));
  EXPECT_THAT(read_file(page), HasSubstr("| direct 2, rattle, tangents per substep |"));
  const auto lines = split(read_file(csv), '\n');
  ASSERT_GE(lines.size(), 9U);
  EXPECT_THAT(lines[0], testing::StartsWith("solver,integrator,substeps,"));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(split(lines[i] + "x", ',').size(), 17U) << lines[i];
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  for (const std::string name : {"chart.png", "chart.svg"}) {
    const ProcessResult result = trade(path, {"--substeps", "1,2", "--chart", folder.path(name)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(read_file(folder.path(name)), HasSubstr(name.ends_with(".png") ? "PNG" : "</svg>"));
  }
}

TEST(Trade, KnowsAChaoticScene) {
  // No time for more than two runs of the reference, with 16 and 32 substeps, whatever the machine.
  const ProcessResult result = trade(scenes + "analytic/double-pendulum.json",
                                     {"--json", "--solver", "direct", "--substeps", "16",
                                      "--duration", "20", "--reference-seconds", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  EXPECT_GT(table["reference"]["chaos_rate"], 0.0);
  EXPECT_EQ(table["reference"]["integrator"], "rattle");
  // The scene's own comment trusts 3 s with 16 substeps, to 1e-4 rad.
  EXPECT_GT(table["compared_seconds"], 3.0);
  EXPECT_LT(table["compared_seconds"], 20.0);
  EXPECT_LE(table["reference"]["error_compared"]["position"], 1e-4);
  // Within that time rattle is right; its energy to the end, long after positions mean anything: (w h)^2 = 1e-4 with 10 rad/s.
  EXPECT_EQ(table["rows"][1]["name"], "direct 16, rattle");
  EXPECT_LT(table["rows"][1]["error"]["position"], 1e-3);
  EXPECT_LT(table["rows"][1]["error"]["energy"], 1e-3);
}

TEST(Trade, WithoutAReferenceThereIsNothing) {
  TemporaryFolder folder;
  const ProcessResult result = trade(folder.write("runaway.json", runaway_scene), {});
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_THAT(result.err, HasSubstr("the reference diverged"));
  EXPECT_EQ(result.out, "");
}

tools::TradeRow trade_row(int substeps, double seconds, double error) {
  tools::TradeRow row;
  row.setting.step = {0.01, substeps, 10, SolverKind::direct, IntegratorKind::xpbd};
  row.seconds = {seconds, seconds, seconds, seconds, 5};
  row.error.position = error;
  return row;
}

TEST(TradeText, ShowsFailuresAndChoosesByWhatIsKnown) {
  tools::TradeTable table;
  table.dt = 0.01;
  table.rows = {trade_row(1, 1.0, 5e-2), trade_row(2, 2.0, 8e-3), trade_row(4, 4.0, 1e-3),
                trade_row(8, 3.0, 0.0)};
  table.rows[3].fault = "diverged: the wheel";
  table.doubt.position = 1e-4;
  tools::judge(table);
  EXPECT_TRUE(table.rows[1].on_front);
  EXPECT_FALSE(table.rows[3].on_front);
  const std::string text = tools::trade_text(table);
  EXPECT_THAT(text, HasSubstr("direct 8: failed: diverged: the wheel"));
  EXPECT_THAT(text, HasSubstr("cheapest setting for 1 %: direct 2: 20 ms per frame"));
  // 1e-3 is known up to 1e-4, so it may be more than 0.1 %.
  EXPECT_THAT(text, HasSubstr("cheapest setting for 0.1 %: none of these"));
  EXPECT_EQ(tools::answer(table, {.seconds_per_frame = 0.025}), 1U);
  EXPECT_THAT(tools::trade_chart_script(table, "a.svg"), HasSubstr("1 of 4 settings failed"));
}

TEST(TradeText, ReadsQuestions) {
  EXPECT_DOUBLE_EQ(tools::budget_seconds("2ms/frame"), 2e-3);
  EXPECT_DOUBLE_EQ(tools::budget_seconds("1.5e2us/frame"), 1.5e-4);
  EXPECT_DOUBLE_EQ(tools::error_share("0.1%"), 1e-3);
  EXPECT_DOUBLE_EQ(tools::error_share("1e-3"), 1e-3);
  for (const char* wrong : {"", "ms/frame", "nan%", "inf", "1 %", "0x1%"}) {
    EXPECT_THROW(static_cast<void>(tools::error_share(wrong)), tools::Failure) << wrong;
    EXPECT_THROW(static_cast<void>(tools::budget_seconds(wrong)), tools::Failure) << wrong;
  }
}

}  // namespace
}  // namespace sheave::test
