// Sweeps: plans, rows, journals, shards.

#include <cmath>
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/sweep/plan.h"
#include "command/sweep/table.h"
#include "tests/command/journal_text.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using command::parse_axis;
using command::SweepDesign;
using command::SweepPlan;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

SweepPlan plan_of(const std::vector<std::string>& axes, SweepDesign design,
                  std::size_t samples = 0) {
  SweepPlan plan;
  for (const std::string& text : axes) plan.axes.push_back(parse_axis(text));
  plan.design = design;
  plan.samples = samples;
  return plan;
}

TEST(SweepPlan, ReadsListsAndRanges) {
  EXPECT_THAT(parse_axis("load=50:500:10").values,
              ElementsAre("50", "100", "150", "200", "250", "300", "350", "400", "450", "500"));
  EXPECT_THAT(parse_axis("/step/substeps=1,2,+4").values, ElementsAre("1", "2", "4"));
  EXPECT_THAT(parse_axis("v=[1,2],[3,4]").values, ElementsAre("[1,2]", "[3,4]"));
  EXPECT_THAT(parse_axis("s=direct,gauss-seidel").values, ElementsAre("direct", "gauss-seidel"));
  EXPECT_THAT(parse_axis("x=1:100:3:log").values, ElementsAre("1", "10", "100"));
  const command::SweepAxis range = parse_axis("x=-1:3");
  EXPECT_TRUE(range.values.empty());
  EXPECT_EQ(range.low, -1.0);
  EXPECT_EQ(range.high, 3.0);
}

TEST(SweepPlan, RefusesMeaninglessTexts) {
  for (const char* text : {"load", "=1", "load=", "load=1:2:0", "load=1:x", "load=0:1:3:log",
                           "load=1:2:3:4", "load=1,,2", "load=1:2:1", "load=3:3", "load=1:inf:3"}) {
    EXPECT_THROW((void)parse_axis(text), command::Failure) << text;
  }
  for (const char* text : {"0/2", "3/2", "1", "1/", "/2", "1/2/3", "a/b", "-1/2"}) {
    EXPECT_THROW((void)command::parse_shard(text), command::Failure) << text;
  }
  for (const char* text : {"", "max:", "most:load.y", "max:load.y@3", "load.y@1:2", "load.y@",
                           "max:load.y@3:2", "load.y@-1"}) {
    EXPECT_THROW((void)command::parse_measure(text), command::Failure) << text;
  }
  EXPECT_THROW((void)count_runs(plan_of({"a=1,2", "b=1,2,3"}, SweepDesign::list)),
               command::Failure);
  EXPECT_THROW((void)count_runs(plan_of({"a=1:2"}, SweepDesign::grid)), command::Failure);
  EXPECT_THROW((void)count_runs(plan_of({"a=1,2", "a=3"}, SweepDesign::grid)), command::Failure);
}

TEST(SweepPlan, LastAxisChangesFastest) {
  EXPECT_THAT(sweep_points(plan_of({"a=1,2", "b=x,y"}, SweepDesign::grid)),
              ElementsAre(ElementsAre("1", "x"), ElementsAre("1", "y"), ElementsAre("2", "x"),
                          ElementsAre("2", "y")));
  EXPECT_THAT(sweep_points(plan_of({"a=1,2", "b=x,y"}, SweepDesign::list)),
              ElementsAre(ElementsAre("1", "x"), ElementsAre("2", "y")));
}

TEST(SweepPlan, LatinHypercubeDrawsOnceFromEachInterval) {
  constexpr std::size_t count = 50;
  const SweepPlan plan = plan_of({"a=2:12", "b=1:1000:log"}, SweepDesign::latin_hypercube, count);
  const auto points = sweep_points(plan);
  std::vector<int> first(count, 0);
  std::vector<int> second(count, 0);
  for (const auto& point : points) {
    const double a = (std::stod(point[0]) - 2.0) / 10.0;
    const double b = std::log10(std::stod(point[1])) / 3.0;
    ++first.at(static_cast<std::size_t>(a * count));
    ++second.at(static_cast<std::size_t>(b * count));
  }
  EXPECT_THAT(first, testing::Each(1));
  EXPECT_THAT(second, testing::Each(1));
  EXPECT_EQ(points, sweep_points(plan)) << "the seed decides";
  SweepPlan other = plan;
  other.seed = 2;
  EXPECT_NE(points, sweep_points(other));
}

TEST(SweepPlan, RandomDrawsAreEvenlyDistributed) {
  // The mean of 4000 even draws from [0, 1) has the deviation 1 / sqrt(12 x 4000) = 0.0046; four of
  // them are allowed.
  double sum = 0.0;
  for (const auto& point : sweep_points(plan_of({"a=0:1"}, SweepDesign::random, 4000))) {
    sum += std::stod(point[0]);
  }
  EXPECT_NEAR(sum / 4000.0, 0.5, 0.019);
}

/// The Atwood machine over its heavy mass and its substeps.
std::vector<std::string> atwood_sweep(const std::string& scene) {
  return {"sweep",     scene,
          "--vary",    "/bodies/heavy/mass=2:4:5",
          "--vary",    "/step/substeps=1,2",
          "--measure", "mean:rope.0.tension",
          "--measure", "light.vy",
          "--quiet"};
}

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Sweep, EveryRowHasTheClosedForm) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave(with(atwood_sweep(scene), {"--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  ASSERT_EQ(table["rows"].size(), 10U);
  for (const json& row : table["rows"]) {
    const double heavy = row["values"]["/bodies/heavy/mass"];
    // m1 = 1 kg, I / r^2 = 2 kg, g = 10 m/s2.
    const double a = (heavy - 1.0) * 10.0 / (heavy + 1.0 + 2.0);
    EXPECT_EQ(row["status"], "done");
    // A run of a second: constant tensions and acceleration, exact but for rounding and the
    // solver's tolerance.
    EXPECT_NEAR(row["measured"]["mean:rope.0.tension"].get<double>(), 10.0 + a, 1e-6);
    EXPECT_NEAR(row["measured"]["light.vy"].get<double>(), a, 1e-6);
    EXPECT_LT(row["certificate"].get<double>(), 1e-6);
  }
  EXPECT_EQ(table["measures"][0]["unit"], "N");
  EXPECT_EQ(table["measures"][1]["unit"], "m/s");
}

// The weights part at 2 a, and the tensions differ by the force a I / r^2, which turns the wheel.
TEST(Sweep, MeasuresExpressions) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave({"sweep", scene, "--vary", "/bodies/heavy/mass=2,4",
                                           "--measure", "max:light.vy - heavy.vy", "--measure",
                                           "mean:rope.1.tension - rope.0.tension@0.2:0.8",
                                           "--measure", "light.vy * heavy.momentum_y", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  EXPECT_EQ(table["measures"][0]["unit"], "m/s");
  EXPECT_EQ(table["measures"][1]["unit"], "N");
  EXPECT_EQ(table["measures"][2]["unit"], "N m");
  for (const json& row : table["rows"]) {
    const double heavy = row["values"]["/bodies/heavy/mass"];
    const double a = (heavy - 1.0) * 10.0 / (heavy + 1.0 + 2.0);
    const json& measured = row["measured"];
    EXPECT_NEAR(measured["max:light.vy - heavy.vy"].get<double>(), 2.0 * a, 1e-6);
    EXPECT_NEAR(measured["mean:rope.1.tension - rope.0.tension@0.2:0.8"].get<double>(), 2.0 * a,
                1e-6);
    EXPECT_NEAR(measured["light.vy * heavy.momentum_y"].get<double>(), -heavy * a * a, 1e-5);
  }
  const ProcessResult bad = run_sheave({"sweep", scene, "--vary", "/bodies/heavy/mass=2,4",
                                        "--measure", "max:light.vy - rope.0.tension"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("- needs one unit; \"light.vy\" is in m/s"));
}

TEST(Sweep, DoesNotDependOnCoresOrShards) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const auto sweep = atwood_sweep(scene);
  const ProcessResult one = run_sheave(with(sweep, {"--parallel", "1", "--csv", "-"}));
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, run_sheave(with(sweep, {"--parallel", "4", "--csv", "-"})).out);
  std::vector<std::string> merge{"merge"};
  for (const char* shard : {"3/3", "1/3", "2/3"}) {
    const std::string journal = folder.path(std::string("part") + shard[0]);
    const ProcessResult part =
        run_sheave(with(sweep, {"--shard", shard, "--resume", journal, "--json"}));
    ASSERT_EQ(part.exit_code, 0) << part.err;
    merge.push_back(journal);
  }
  const ProcessResult all = run_sheave(with(merge, {"--csv", "-"}));
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(all.out, one.out);
  merge.pop_back();
  const ProcessResult some = run_sheave(merge);
  EXPECT_EQ(some.exit_code, 1);
  EXPECT_THAT(some.err, HasSubstr("3 of 10 runs are missing, the first of them run 1"));
  const ProcessResult twice = run_sheave({"merge", merge[1], merge[1]});
  EXPECT_EQ(twice.exit_code, 65);
}

TEST(Sweep, ContinuesAfterAKill) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string journal = folder.path("atwood.sweep");
  const std::vector<std::string> sweep{"sweep",     scene,
                                       "--vary",    "/bodies/heavy/mass=2:4:400",
                                       "--measure", "max:rope.0.tension",
                                       "--quiet",   "--parallel",
                                       "2"};
  const std::string whole = run_sheave(with(sweep, {"--csv", "-"})).out;
  const auto resumed = with(sweep, {"--resume", journal, "--csv", "-"});
  for (int kills = 0; kills < 3; ++kills) {
    const std::size_t before = kills == 0 ? 0 : split(read_file(journal), '\n').size();
    Process process(resumed);
    const bool more = process.wait_until([&] {
      return std::filesystem::exists(journal) &&
             split(read_file(journal), '\n').size() > before + 3;
    });
    if (more) process.send(SIGKILL);
    (void)process.wait();
  }
  // A line that a power loss has cut off.
  std::string text = read_file(journal);
  text.resize(text.size() - 7);
  folder.write("atwood.sweep", text);
  const ProcessResult last = run_sheave(resumed);
  EXPECT_EQ(last.exit_code, 0) << last.err;
  EXPECT_THAT(last.err, HasSubstr("runs are known"));
  EXPECT_THAT(last.err, HasSubstr("the last line is incomplete"));
  EXPECT_EQ(last.out, whole);
}

TEST(Sweep, JournalIsReadStrictly) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string journal = folder.path("atwood.sweep");
  const auto sweep = with(atwood_sweep(scene), {"--resume", journal});
  ASSERT_EQ(run_sheave(sweep).exit_code, 0);
  const std::string good = read_file(journal);
  const auto refused = [&](const std::string& from, const std::string& to, const char* message) {
    std::string bad = without_checksums(good);
    ASSERT_NE(bad.find(from), std::string::npos) << from;
    bad.replace(bad.find(from), from.size(), to);
    bad = with_checksums(bad);
    folder.write("atwood.sweep", bad);
    const ProcessResult result = run_sheave(sweep);
    EXPECT_EQ(result.exit_code, 65) << from << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_THAT(result.err, testing::ContainsRegex("atwood.sweep:[0-9]+:[0-9]+: "));
    EXPECT_EQ(read_file(journal), bad) << "what is wrong is not written over";
  };
  refused("\"run\":3", "\"run\":-3", "from 0 to");
  refused("\"run\":3", "\"run\":4", "twice");
  refused("\"run\":3", "\"run\":30", "does not belong to this shard");
  refused("\"status\":0", "\"status\":9", "from 0 to 6");
  refused("\"measured\":[", "\"measured\":[1,", "must have 2 elements");
  refused("\"message\"", "\"massage\"", "did you mean \"message\"?");
  refused("\"end\":", "\"end\":\"1\",\"x\":", "must be a number");
  folder.write("atwood.sweep", good);
  const ProcessResult other = run_sheave(with(sweep, {"--measure", "heavy.y"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("belongs to another scene, plan, shard or build"));
  EXPECT_EQ(read_file(journal), good);
}

TEST(Sweep, ReportsInvalidScenesInTheirRows) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave({"sweep", scene, "--vary", "/bodies/heavy/mass=2,-1,3",
                                           "--measure", "max:rope.0.tension", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json rows = json::parse(result.out)["rows"];
  EXPECT_EQ(rows[1]["status"], "invalid");
  EXPECT_THAT(rows[1]["message"].get<std::string>(), HasSubstr("must be > 0"));
  EXPECT_TRUE(rows[1]["measured"]["max:rope.0.tension"].is_null());
  EXPECT_EQ(rows[2]["status"], "done");
  const std::vector<std::string> strict{
      "sweep", scene, "--vary", "/bodies/heavy/mass=2,-1", "--measure", "light.y", "--strict"};
  EXPECT_EQ(run_sheave(strict).exit_code, 76);
  const ProcessResult wrong = run_sheave(
      {"sweep", scene, "--vary", "/bodies/heavy/mass=2", "--measure", "max:rope.0.tensoin"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean \"rope.0.tension\"?"));
}

}  // namespace
}  // namespace sheave::test
