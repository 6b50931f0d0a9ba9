// sheave trade: orders of both integrators, answers, what --apply writes, errors of options. No
// time is judged.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/trade/table.h"
#include "scenes/scene.h"
#include "tests/command/journal_text.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string scenes = SHEAVE_SOURCE_DIR "/scenes/";

/// With all the time there is, so that nothing is left out on a busy machine.
ProcessResult trade(const std::string& scene, std::vector<std::string> options) {
  const auto add = [&](const std::string& option, const std::string& value) {
    if (std::find(options.begin(), options.end(), option) != options.end()) return;
    options.insert(options.end(), {option, value});
  };
  add("--repetitions", "1");
  add("--minutes", "1e6");
  add("--reference-seconds", "1e6");
  add("--tolerance", "none");  // tests/command/trade_tolerance_test.cpp
  options.insert(options.begin(), {"trade", scene});
  return run_sheave(options);
}

/// A clock by which all time passes between two looks at it: a hundredth of a second, however much
/// is done.
measure::Clock ticking_clock() {
  const auto ticks = std::make_shared<std::atomic<int>>(0);
  return {[ticks] { return 0.01 * ++*ticks; }, [] { return 0.0; }};
}

/// Measured in this process by that clock, with one thread.
json trade_by_ticks(const std::string& path, command::TradeOptions options) {
  const SceneResult scene = load_scene(path);
  EXPECT_TRUE(scene);
  options.repetitions = 1;
  options.grid.tolerances.clear();
  options.threads = 1;
  options.quiet = true;
  options.clock = ticking_clock();
  return json::parse(command::trade_json(command::measure_trade(*scene, options)));
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
  // The error of a substep h is c h + O(h^2) and c h^2 + O(h^4) (rattle is symmetric). With w h = 7
  // rad/s x 0.7 ms = 0.005 at most for xpbd, 0.08 for rattle, what is neglected changes the slope
  // by the order of w h T / 2 = 0.02 and 0.006.
  EXPECT_NEAR(order_on_the_pendulum("xpbd", "32,64,128,256"), 1.0, 0.03);
  EXPECT_NEAR(order_on_the_pendulum("rattle", "2,4,8,16"), 2.0, 0.03);
}

/// Empty if the file is not there (yet).
std::string read_file_or_nothing(const std::string& path) {
  return std::filesystem::exists(path) ? read_file(path) : std::string();
}

/// Runs on a file with two weights over a wheel.
class TradeOfAFile : public testing::Test {
 protected:
  TradeOfAFile() {
    const std::string step = R"("step": {)";
    std::string text = "// Two weights.\n" + atwood_scene;
    text.replace(text.find(step), step.size(),
                 R"("step": {/* rough */ "solver": "gauss-seidel", "integrator": "xpbd", )");
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
    // A constant acceleration a: xpbd falls a h t / 2 too far whatever the solver, and rattle not
    // at all if the tangents follow.
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
              HasSubstr(R"("step": {/* rough */ "solver": "direct", "integrator": "rattle", )"
                        R"("dt": 0.01, "substeps": 3, "iterations": 20},)"));
  EXPECT_THAT(after, HasSubstr(R"("tangent_update": "substep"})"));
  EXPECT_EQ(run_sheave({"validate", path}).exit_code, 0);
  // Once it is so, nothing changes any more.
  ASSERT_EQ(trade(path, {"--error", "0.01%", "--apply", "--solver", "direct", "--integrator",
                         "rattle", "--substeps", "3", "--tangents", "substep"})
                .exit_code,
            0);
  EXPECT_EQ(read_file(path), after);
}

TEST_F(TradeOfAFile, ReportsThatNoSettingIsGoodEnough) {
  const std::string before = read_file(path);
  const ProcessResult result =
      trade(path, {"--budget", "1e-9us/frame", "--apply", "--solver", "direct", "--substeps", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("--budget 1e-9us/frame: none of these settings"));
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(
      trade(path, {"--budget", "1e9s/frame", "--solver", "direct", "--substeps", "1"}).exit_code,
      0);
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
  EXPECT_THAT(refused({"--tension-error", "some"}), HasSubstr("--tension-error some: must be"));
  EXPECT_THAT(refused({"--tension-error", "1%", "--budget", "1ms/frame"}), HasSubstr("excludes"));
  EXPECT_THAT(refused({"--solver", "magic"}), HasSubstr("magic"));
  EXPECT_THAT(refused({"--substeps", "1,0"}), HasSubstr("0"));
  EXPECT_THAT(refused({"--minutes", "0"}), HasSubstr("--minutes"));
  EXPECT_THAT(refused({"--parallel", "0"}), HasSubstr("--parallel"));
  EXPECT_THAT(refused({"--chart", "picture.gif"}), HasSubstr(".png, .svg or .pdf"));
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
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(split(lines[i] + "x", ',').size(), 20U) << lines[i];
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  for (const std::string name : {"chart.png", "chart.svg"}) {
    const ProcessResult result = trade(path, {"--substeps", "1,2", "--chart", folder.path(name)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(read_file(folder.path(name)), HasSubstr(name.ends_with(".png") ? "PNG" : "</svg>"));
  }
}

TEST_F(TradeOfAFile, LadderShowsTheEffectOfTheWheel) {
  // Both tangent updates are within 0.1 %, and equally dear by this clock: the first is chosen.
  command::TradeOptions options;
  options.grid.solvers = {SolverKind::direct};
  options.grid.integrators = {IntegratorKind::rattle};
  options.grid.substeps = {1};
  const json ladder = trade_by_ticks(path, options)["ladder"];
  EXPECT_EQ(ladder["setting"], "direct 1, rattle");
  bool found = false;
  for (const json& rung : ladder["rungs"]) {
    SCOPED_TRACE(rung["name"].get<std::string>());
    ASSERT_FALSE(rung.contains("fault"));
    EXPECT_GT(rung["seconds_per_simulated_second"]["median"], 0.0);
    if (rung["name"] == "rotors as bodies with hinges") {
      EXPECT_LT(rung["difference"]["position"], 1e-9);
      EXPECT_GT(rung["row_solves_per_simulated_second"], ladder["row_solves_per_simulated_second"]);
    }
    if (rung["name"] != "massless wheels") continue;
    found = true;
    EXPECT_EQ(rung["changed"], 1);
    // 40/3 N on both sides instead of 12 and 16 N.
    EXPECT_NEAR(rung["difference"]["tension"], std::hypot(4.0 / 3.0, 8.0 / 3.0) / 20.0, 1e-6);
  }
  EXPECT_TRUE(found);
  EXPECT_THAT(ladder["absent"], testing::Contains("no contacts"));
  EXPECT_EQ(
      json::parse(trade(path, {"--json", "--no-ladder", "--solver", "direct", "--substeps", "1"})
                      .out)["ladder"],
      json());
}

TEST_F(TradeOfAFile, ResumesItsMeasurements) {
  const std::string journal = folder.path("weights.trade");
  const std::vector<std::string> options{"--json", "--resume",   journal, "--solver",
                                         "direct", "--substeps", "1,2"};
  const ProcessResult first = trade(path, options);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProcessResult again = trade(path, options);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const json before = json::parse(first.out);
  json after = json::parse(again.out);
  ASSERT_EQ(after["rows"].size(), before["rows"].size());
  // Times are random to the last digit: where they are the same, they are those of the first run.
  for (std::size_t i = 0; i < after["rows"].size(); ++i) {
    after["rows"][i]["expected_seconds"] = before["rows"][i]["expected_seconds"];
  }
  EXPECT_EQ(after["rows"], before["rows"]);
  EXPECT_EQ(after["ladder"], before["ladder"]);
  EXPECT_EQ(after["reference"], before["reference"]);
  EXPECT_THAT(again.err, HasSubstr("8 settings are known"));
  // Another half: only the settings that are new are run, against the same reference. An error is a
  // number that both tell.
  json half = trade_journal_json(read_file(journal));
  half["rows"].erase("direct 2");
  half.erase("times");
  folder.write("weights.trade", trade_journal_text(half));
  const ProcessResult rest = trade(path, options);
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("7 settings are known"));
  for (std::size_t i = 0; i < before["rows"].size(); ++i) {
    EXPECT_EQ(json::parse(rest.out)["rows"][i]["error"], before["rows"][i]["error"]);
  }
}

TEST_F(TradeOfAFile, ContinuesAfterAnInterrupt) {
  // The first settings take milliseconds, the last one minutes, of which an interrupt waits for a
  // frame: a second or two.
  const std::string journal = folder.path("weights.trade");
  const std::vector<std::string> common{"trade",      path,        "--resume",     journal,
                                        "--tangents", "iteration", "--integrator", "xpbd"};
  std::vector<std::string> endless = common;
  endless.insert(endless.end(),
                 {"--minutes", "1e6", "--substeps", "1,16", "--iterations", "2,1000000"});
  Process process(endless);
  const auto kept = [&] {
    const json found = trade_journal_json(read_file_or_nothing(journal));
    return found.is_object() && found.contains("rows") ? found["rows"].size() : 0U;
  };
  ASSERT_TRUE(process.wait_until([&] { return kept() > 0; }));
  process.send(SIGINT);
  const ProcessResult stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  EXPECT_EQ(stopped.out, "");
  ASSERT_GT(kept(), 0U);
  std::vector<std::string> rest = common;
  rest.insert(rest.end(), {"--minutes", "1e6", "--substeps", "1,16", "--iterations", "2"});
  const ProcessResult resumed = run_sheave(rest);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, testing::ContainsRegex("[1-9][0-9]* settings are known"));
}

TEST_F(TradeOfAFile, DoesNotReuseResultsOfAnotherScene) {
  const std::string journal = folder.path("weights.trade");
  const std::vector<std::string> options{"--json", "--resume",   journal, "--solver",
                                         "direct", "--substeps", "1"};
  ASSERT_EQ(trade(path, options).exit_code, 0);
  std::string text = read_file(path);
  text.replace(text.find("\"mass\": 4"), 9, "\"mass\": 5");
  const std::string other = folder.write("other.json", text);
  const ProcessResult result = trade(other, options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err,
              HasSubstr("belongs to another scene, setting, machine or build; started again"));
  // A comment is no other scene.
  const ProcessResult same = trade(folder.write("same.json", "// Heavier.\n" + text), options);
  EXPECT_THAT(same.err, HasSubstr("4 settings are known"));
  // A file that is none of ours is not overwritten.
  const ProcessResult itself = trade(path, {"--resume", path});
  EXPECT_EQ(itself.exit_code, 2);
  EXPECT_THAT(itself.err, HasSubstr("an input must not be overwritten"));
  const ProcessResult wrong = trade(path, {"--resume", other});
  EXPECT_EQ(wrong.exit_code, 65);
  EXPECT_THAT(wrong.err, HasSubstr("\"format\": \"sheave-trade-journal/2\""));
  EXPECT_THAT(read_file(path), HasSubstr("Two weights"));
}

TEST_F(TradeOfAFile, ResultsDoNotDependOnTheNumberOfThreads) {
  const auto errors = [&](const std::string& threads) {
    const ProcessResult result = trade(path, {"--json", "--no-ladder", "--parallel", threads,
                                              "--substeps", "1,2", "--iterations", "3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    json list = json::array();
    const json table = json::parse(result.out);
    for (const json& row : table["rows"]) list.push_back(row["error"]);
    list.push_back(table["reference"]);
    return list;
  };
  EXPECT_EQ(errors("1"), errors("4"));
}

TEST_F(TradeOfAFile, SkipsAndReportsSettingsThatTakeTooLong) {
  // By this clock each of 100 frames takes 0.01 s when one looks after each of them: 1 s in one
  // substep, and so 64 s in 64, of which there are 6.
  command::TradeOptions options;
  options.minutes = 0.1;
  options.grid.substeps = {1, 64};
  options.grid.iterations = {2};
  options.grid.tangents = {TangentUpdate::iteration};
  const json table = trade_by_ticks(path, options);
  ASSERT_EQ(table["rows"].size(), 8U);
  for (const json& row : table["rows"]) {
    SCOPED_TRACE(row["name"].get<std::string>());
    const int substeps = row["settings"]["substeps"];
    EXPECT_NEAR(row["expected_seconds"], 1.0 * substeps, 1e-9);
    EXPECT_EQ(row.contains("skipped"), substeps == 64);
    EXPECT_EQ(row.contains("error"), substeps == 1);
  }
  const std::string why = table["rows"][1]["skipped"];
  EXPECT_THAT(why, testing::AnyOf(HasSubstr("takes about"), HasSubstr("finer than the reference")));
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
  // Within that time rattle is right; its energy to the end, long after positions mean anything: (w
  // h)^2 = 1e-4 with 10 rad/s.
  EXPECT_EQ(table["rows"][1]["name"], "direct 16, rattle");
  EXPECT_LT(table["rows"][1]["error"]["position"], 1e-3);
  EXPECT_LT(table["rows"][1]["error"]["energy"], 1e-3);
}

TEST(Trade, GivesNoResultWithoutAReference) {
  TemporaryFolder folder;
  const ProcessResult result = trade(folder.write("runaway.json", runaway_scene), {});
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_THAT(result.err, HasSubstr("the reference diverged"));
  EXPECT_EQ(result.out, "");
}

}  // namespace
}  // namespace sheave::test
