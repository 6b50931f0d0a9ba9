// sheave tune: closed forms, bounds, journals, and the statements at the end.

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using std::numbers::pi;
using testing::HasSubstr;

/// T = m g jib / (rope sin(2 angle) cos(aside)^2), with m g jib = 4000 N m.
const std::string jib_template = SHEAVE_SOURCE_DIR "/scenes/templates/jib.jsonnet";
constexpr double default_tolerance = 1e-4;  // of --tolerance

std::vector<std::string> tune_of(const std::string& scene, const std::vector<std::string>& more) {
  std::vector<std::string> words{"tune", scene, "-q"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> jib_tune(std::vector<std::string> more) {
  more.insert(more.begin(), {"--of", "statics", "--vary", "angle=0.2:1.2"});
  return tune_of(jib_template, more);
}

json tuned(std::vector<std::string> words, int exit_code = 0) {
  words.emplace_back("--json");
  const ProcessResult result = run_sheave(words);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  return result.out.empty() ? json::object() : json::parse(result.out);
}

TEST(Tune, FindsTheAngleOfAJibWithTheLeastTension) {
  const json result = tuned(jib_tune({"--minimise", "rope.0.tension"}));
  EXPECT_EQ(result["end"], "converged");
  EXPECT_EQ(result["method"], "cobyla");
  EXPECT_EQ(result["goal"], "minimise");
  // The range is 1 rad wide. Near the least, T grows by 2 T d^2 with a change d of the angle.
  EXPECT_NEAR(result["best"]["values"]["angle"].get<double>(), pi / 4.0, default_tolerance);
  EXPECT_NEAR(result["best"]["goal"].get<double>(), 4000.0 / 3.0, 2700.0 * 1e-8);
  EXPECT_LT(result["runs"].get<int>(), 40);
  const double best = result["best"]["goal"];
  for (const json& row : result["rows"]) {
    EXPECT_GE(row["measured"]["rope.0.tension"].get<double>(), best);
  }
}

TEST(Tune, FindsTwoSettingsAtOnce) {
  const json result = tuned(jib_tune({"--vary", "aside=-0.5:0.7", "--minimise", "rope.0.tension"}));
  EXPECT_EQ(result["method"], "bobyqa");
  EXPECT_EQ(result["end"], "converged");
  EXPECT_NEAR(result["best"]["values"]["angle"].get<double>(), pi / 4.0, default_tolerance);
  EXPECT_NEAR(result["best"]["values"]["aside"].get<double>(), 0.0, 1.2 * default_tolerance);
}

TEST(Tune, ABoundThatIsActiveDecidesASetting) {
  // A longer rope always pulls less, so the least tension lies at the longest one allowed.
  const json result = tuned(jib_tune({"--vary", "rope=1:3.6", "--minimise", "rope.0.tension",
                                      "--keep", "rope.0.length < 2.5", "--keep", "jib.y > -1"}));
  EXPECT_EQ(result["end"], "converged");
  const json& best = result["best"];
  EXPECT_NEAR(best["values"]["angle"].get<double>(), pi / 4.0, 3.0 * default_tolerance);
  EXPECT_NEAR(best["values"]["rope"].get<double>(), 2.5, 3.0 * default_tolerance);
  EXPECT_LE(best["bounds"][0]["value"].get<double>(), 2.5) << "kept, not nearly kept";
  EXPECT_EQ(best["bounds"][0]["active"], true);
  EXPECT_EQ(best["bounds"][1]["active"], false);
  EXPECT_NEAR(best["goal"].get<double>(), 1600.0, 1600.0 * 4.0 * default_tolerance);
  EXPECT_THAT(result["statement"].get<std::string>(), HasSubstr("active: rope.0.length < 2.5"));
}

TEST(Tune, FindsTheSpringOfAWantedFrequency) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("spring.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "position": [0, -1, 0],
                "mass": 2}],
    "joints": [{"type": "distance", "name": "spring", "body_b": "weight", "anchor_a": [0, 0, 0],
                "anchor_b": [0, -1, 0], "compliance": 0.005}]
  })json");
  const json result =
      tuned(tune_of(scene, {"--of", "modes", "--vary", "/joints/spring/compliance=1e-4:1e-1:log",
                            "--target", "frequency:1 = 2.5"}));
  EXPECT_EQ(result["end"], "converged");
  // Compliance 1 / (m (2 pi f)^2); the tolerance is a part of the range's logarithm, ln 1000.
  const double closed = 1.0 / (2.0 * std::pow(2.0 * pi * 2.5, 2));
  const double found = result["best"]["values"]["/joints/spring/compliance"];
  EXPECT_NEAR(std::log(found / closed), 0.0, std::log(1000.0) * default_tolerance);
}

TEST(Tune, ATargetOutOfReachIsTold) {
  // The least tension is 4000 N m / 3 m.
  const json result = tuned(jib_tune({"--target", "rope.0.tension = 1000"}));
  EXPECT_EQ(result["end"], "converged");
  EXPECT_NEAR(result["best"]["values"]["angle"].get<double>(), pi / 4.0, default_tolerance);
  EXPECT_THAT(result["statement"].get<std::string>(), HasSubstr("off the target by 333.33"));
}

TEST(Tune, FindsTheCounterweightAtWhichATackleRests) {
  // A load of 300 kg on four parts rests with 75 kg; the effort decides the acceleration.
  const json result =
      tuned(tune_of(tackle_template, {"--param", "load=300", "--vary", "effort=10:200", "--target",
                                      "rate:hoist block.vy = 0", "--duration", "0.2"}));
  EXPECT_EQ(result["end"], "converged");
  EXPECT_NEAR(result["best"]["values"]["effort"].get<double>(), 75.0, 190.0 * default_tolerance);
}

TEST(Tune, ALocalSearchNeedsItsStartAndDirectDoesNot) {
  // The tension has its greatest values at both ends of the range; that at 0.2 is greater.
  const json local = tuned(jib_tune({"--maximise", "rope.0.tension", "--start", "angle=1.1"}));
  EXPECT_NEAR(local["best"]["values"]["angle"].get<double>(), 1.2, 1e-9);
  EXPECT_EQ(local["best"]["at_end_of_range"], json::array({"angle"}));
  const json global =
      tuned(jib_tune({"--maximise", "rope.0.tension", "--method", "direct", "--runs", "60"}));
  EXPECT_NEAR(global["best"]["values"]["angle"].get<double>(), 0.2, default_tolerance);
  EXPECT_LE(global["runs"].get<int>(), 60);
}

TEST(Tune, SaysWhenThereIsNoSolution) {
  const TemporaryFolder folder;
  const std::string out = folder.path("best.json");
  const ProcessResult result = run_sheave(
      jib_tune({"--minimise", "rope.0.tension", "--keep", "rope.0.tension < 1300", "-o", out}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("no solution: none of "));
  EXPECT_THAT(result.out, HasSubstr("1333.3")) << "the nearest one is told";
  EXPECT_THAT(result.err, HasSubstr("is not written"));
  EXPECT_THAT(folder.entries(), testing::IsEmpty());
}

TEST(Tune, SaysWhenNothingChangesTheGoal) {
  const json result = tuned(
      tune_of(jib_template, {"--of", "statics", "--vary", "mass=50:150", "--minimise", "jib.x"}));
  EXPECT_EQ(result["end"], "flat");
  EXPECT_EQ(run_sheave(tune_of(jib_template, {"--of", "statics", "--vary", "mass=50:150",
                                              "--minimise", "jib.x", "--strict"}))
                .exit_code,
            76);
}

TEST(Tune, SaysWhenTheRunsEndFirst) {
  const json result = tuned(jib_tune({"--minimise", "rope.0.tension", "--runs", "5"}));
  EXPECT_EQ(result["end"], "limit");
  EXPECT_EQ(result["rows"].size(), 5U);
  EXPECT_THAT(result["statement"].get<std::string>(), HasSubstr("the limit of 5 runs came first"));
}

TEST(Tune, RunsWithoutAResultAreNeverTheBest) {
  // Below jib = 2.29 m the rope has nothing to hold, and the scene is not valid.
  const std::vector<std::string> task{"--of",    "statics",    "--vary",
                                      "jib=1:5", "--minimise", "rope.0.tension"};
  const json result = tuned(tune_of(jib_template, task));
  // T = 10 m jib / (rope sin(2 angle)) falls with the jib, down to the shortest valid one.
  const double least = 3.0 * std::cos(0.6);
  const double found = result["best"]["values"]["jib"];
  EXPECT_GT(found, least);
  EXPECT_LT(found, least + 0.1);
  std::size_t invalid = 0;
  for (const json& row : result["rows"]) invalid += row["status"] == "invalid" ? 1 : 0;
  EXPECT_GT(invalid, 0U);
  std::vector<std::string> bad = tune_of(jib_template, task);
  bad.insert(bad.end(), {"--start", "jib=1"});
  const ProcessResult refused = run_sheave(bad);
  EXPECT_EQ(refused.exit_code, 65);
  EXPECT_THAT(refused.err, HasSubstr("the run at the start (jib = 1) is invalid"));
  EXPECT_THAT(refused.err, HasSubstr("--method direct"));
}

TEST(Tune, AnUnstableRestIsNoResult) {
  // The ball hangs below its hinge while gravity points upwards: it rests, but cannot stay.
  const TemporaryFolder folder;
  const std::string scene = folder.write("pendulum.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, 10, 0], "duration": 1,
    "bodies": [{"name": "bob", "mass": 3, "position": [0, -2, 0],
                "shape": {"type": "sphere", "radius": 0.5}}],
    "joints": [{"type": "hinge", "name": "bearing", "body_b": "bob", "anchor": [0, 0, 0],
                "axis": [0, 0, 1]}]
  })json");
  const ProcessResult result = run_sheave(tune_of(
      scene, {"--of", "statics", "--vary", "/bodies/bob/mass=1:3", "--minimise", "eigenvalue:1"}));
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_THAT(result.err, HasSubstr("is unstable"));
}

TEST(Tune, AResumedSearchIsTheSameSearch) {
  const TemporaryFolder folder;
  const std::string journal = folder.path("jib.tune");
  std::vector<std::string> task = jib_tune({"--minimise", "rope.0.tension", "--csv", "-"});
  const std::string whole = run_sheave(task).out;
  task.insert(task.end(), {"--resume", journal});
  std::vector<std::string> part = task;
  part.insert(part.end(), {"--runs", "7"});
  ASSERT_EQ(run_sheave(part).exit_code, 0);
  const ProcessResult rest = run_sheave(task);
  EXPECT_THAT(rest.err, HasSubstr("7 runs are known"));
  EXPECT_EQ(rest.out, whole);
  // All is known now, so the journal does not grow.
  const std::string text = read_file(journal);
  EXPECT_EQ(run_sheave(task).out, whole);
  EXPECT_EQ(read_file(journal), text);
}

TEST(Tune, AJournalBelongsToItsTask) {
  const TemporaryFolder folder;
  const std::string journal = folder.path("jib.tune");
  ASSERT_EQ(run_sheave(jib_tune({"--minimise", "rope.0.tension", "--resume", journal})).exit_code,
            0);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--maximise", "rope.0.tension"},
        {"--minimise", "rope.0.tension", "--tolerance", "1%"},
        {"--minimise", "rope.0.tension", "--start", "angle=0.3"},
        {"--minimise", "rope.0.tension", "--param", "rope=2"}}) {
    std::vector<std::string> task = jib_tune(other);
    task.insert(task.end(), {"--resume", journal});
    const ProcessResult result = run_sheave(task);
    EXPECT_EQ(result.exit_code, 2) << other.front();
    EXPECT_THAT(result.err, HasSubstr("belongs to another scene, plan"));
  }
  const ProcessResult merged = run_sheave({"merge", journal});
  EXPECT_EQ(merged.exit_code, 65);
  EXPECT_THAT(merged.err, HasSubstr("is the journal of a tune"));
  const ProcessResult swept =
      run_sheave({"sweep", jib_template, "--of", "statics", "--vary", "angle=0.5,0.6", "--measure",
                  "rope.0.tension", "--resume", journal});
  EXPECT_EQ(swept.exit_code, 2);
  EXPECT_THAT(swept.err, HasSubstr("is the journal of a tune of statics, and this is a sweep"));
}

TEST(Tune, WritesTheBestSceneAndItsCourse) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_sheave(jib_tune({"--minimise", "rope.0.tension", "--keep", "rope.0.length < 5", "-o",
                           folder.path("best.json"), "--chart", folder.path("course.svg"), "--csv",
                           folder.path("runs.csv")}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ProcessResult rest = run_sheave({"statics", folder.path("best.json"), "--json"});
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NEAR(json::parse(rest.out)["cases"][0]["cables"][0]["spans"][0]["tension"].get<double>(),
              4000.0 / 3.0, 1e-4);
  const std::string chart = read_file(folder.path("course.svg"));
  for (const char* text : {"rope.0.tension [N]", "angle", "best so far"}) {
    EXPECT_THAT(chart, HasSubstr(text));
  }
  EXPECT_THAT(read_file(folder.path("runs.csv")),
              HasSubstr("run,angle,rope.0.tension,rope.0.length,status"));
}

TEST(Tune, RefusesATaskThatCannotBe) {
  const auto refused = [](const std::vector<std::string>& more, const char* message) {
    const ProcessResult result = run_sheave(jib_tune(more));
    EXPECT_EQ(result.exit_code, 2) << message << result.out;
    EXPECT_THAT(result.err, HasSubstr(message));
  };
  refused({}, "a tune needs one goal");
  refused({"--minimise", "jib.x", "--maximise", "jib.x"}, "a tune needs one goal");
  refused({"--minimise", "jib.q"}, "--minimise jib.q: there is no quantity");
  refused({"--minimise", "max:jib.x"}, "allowed with --of statics: QUANTITY");
  refused({"--target", "jib.x"}, "must be 'MEASURE = VALUE'");
  refused({"--target", "jib.x = fast"}, "\"fast\" is no number");
  refused({"--minimise", "jib.x", "--keep", "jib.y"}, "must be 'MEASURE < VALUE'");
  refused({"--minimise", "jib.x", "--keep", "< 3"}, "the measure is missing");
  refused({"--minimise", "jib.x", "--keep", "jib.z < inf"}, "\"inf\" is no number");
  refused({"--minimise", "jib.x", "--vary", "mass=1,2"}, "mass=LOW:HIGH or mass=LOW:HIGH:log");
  refused({"--minimise", "jib.x", "--vary", "angle=0.3:0.4"}, "angle: is varied twice");
  refused({"--minimise", "jib.x", "--start", "mass=1"}, "of a setting that --vary names");
  refused({"--minimise", "jib.x", "--start", "angle=2"}, "must be a number from 0.2 to 1.2");
  refused({"--minimise", "jib.x", "--method", "bobyqa"}, "cobyla does both");
  refused({"--minimise", "jib.x", "--method", "newton"}, "cobyla,bobyqa,direct");
  refused({"--minimise", "jib.x", "--method", "direct", "--start", "angle=0.3"},
          "--method direct searches the whole range");
  refused({"--minimise", "jib.x", "--tolerance", "20%"}, "must be from 1e-8 to 0.1");
  refused({"--minimise", "jib.x", "--runs", "0"}, "--runs");
  refused({"--minimise", "jib.x", "-o", "-"}, "name a file");
  refused({"--minimise", "jib.x", "-o", jib_template}, "an input must not be overwritten");
}

}  // namespace
}  // namespace sheave::test
