// Sweeps of equilibria and of vibrations: closed forms, rows without a rest, journals.

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/sweep/table.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using command::parse_measure;
using command::RestFigure;
using command::SweepKind;
using nlohmann::json;
using testing::HasSubstr;

/// A weight on a spring of 200 N/m with a damper of 4 N s/m, on a vertical guide.
const std::string spring_scene = R"json({
  "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
  "bodies": [{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "position": [0, -1, 0], "mass": 2}],
  "joints": [{"type": "distance", "name": "spring", "body_b": "weight", "anchor_a": [0, 0, 0],
              "anchor_b": [0, -1, 0], "compliance": 0.005, "damping": 4}]
})json";

/// A ball at the end of a rod without mass, 2 m below a hinge.
const std::string pendulum_scene = R"json({
  "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
  "bodies": [{"name": "bob", "mass": 3, "position": [0, -2, 0],
              "shape": {"type": "sphere", "radius": 0.5}}],
  "joints": [{"type": "hinge", "name": "bearing", "body_b": "bob", "anchor": [0, 0, 0],
              "axis": [0, 0, 1]}]
})json";

const std::string falling_scene = R"json({
  "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1,
  "bodies": [{"name": "stone", "mass": 1, "shape": {"type": "sphere", "radius": 0.1}}]
})json";

std::vector<std::string> words_and(std::vector<std::string> words,
                                   const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

json rows_of(const std::vector<std::string>& sweep) {
  const ProcessResult result = run_sheave(words_and(sweep, {"--json", "-q"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.exit_code == 0 ? json::parse(result.out)["rows"] : json::array();
}

TEST(RestMeasure, ReadsFiguresOfAMachineAtRest) {
  EXPECT_EQ(parse_measure("rope.0.tension", SweepKind::statics).course.quantity, "rope.0.tension");
  const auto largest = parse_measure("max:hoist rope.tension", SweepKind::statics);
  EXPECT_EQ(largest.figure, RestFigure::largest_tension);
  EXPECT_EQ(largest.course.quantity, "hoist rope");
  EXPECT_EQ(largest.unit, "N");
  const auto third = parse_measure("frequency:3", SweepKind::modes);
  EXPECT_EQ(third.figure, RestFigure::frequency);
  EXPECT_EQ(third.number, 3U);
  EXPECT_EQ(parse_measure("damping:1", SweepKind::modes).figure, RestFigure::damping);
  EXPECT_EQ(parse_measure("eigenvalue:1", SweepKind::statics).figure, RestFigure::eigenvalue);
}

TEST(RestMeasure, RefusesTimesAndStatistics) {
  const auto refused = [](const char* text, SweepKind kind, const char* message) {
    try {
      (void)parse_measure(text, kind);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const command::Failure& failure) {
      EXPECT_EQ(failure.code(), command::ExitCode::usage);
      EXPECT_THAT(failure.what(), HasSubstr(message)) << text;
    }
  };
  refused("", SweepKind::statics, "the quantity is missing");
  refused("load.y@2", SweepKind::statics, "a machine at rest has no times");
  refused("mean:load.y", SweepKind::statics, "eigenvalue:N, unstable_motions");
  refused("frequency:1", SweepKind::statics, "is a measure of --of modes");
  refused("frequency:1", SweepKind::run, "is a measure of --of modes, not of a run");
  refused("eigenvalue:1", SweepKind::run, "is a measure of --of statics and --of modes");
  for (const char* text : {"frequency:0", "frequency:", "frequency:x", "frequency:100001"}) {
    refused(text, SweepKind::modes, "from 1 to 100000");
  }
}

TEST(RestSweep, TensionsOfATackleAreItsWeightOverItsParts) {
  const json rows =
      rows_of({"sweep", tackle_template, "--of", "statics", "--vary", "load=100:900:3", "--vary",
               "parts=2,3,4,6", "--measure", "hoist rope.0.tension", "--measure",
               "max:hoist rope.tension", "--measure", "neutral_motions"});
  ASSERT_EQ(rows.size(), 12U);
  for (const json& row : rows) {
    const double closed =
        row["values"]["load"].get<double>() * 10.0 / row["values"]["parts"].get<double>();
    EXPECT_EQ(row["status"], "done") << row;
    // The search ends at a residual of 1e-11 of the largest force.
    EXPECT_NEAR(row["measured"]["hoist rope.0.tension"].get<double>(), closed, 1e-9 * closed);
    EXPECT_NEAR(row["measured"]["max:hoist rope.tension"].get<double>(), closed, 1e-9 * closed);
    EXPECT_EQ(row["measured"]["neutral_motions"], 1.0) << "the balanced tackle moves freely";
  }
}

TEST(RestSweep, FrequenciesAndDampingOfASpringAreThoseOfTheOscillator) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("spring.json", spring_scene);
  const json rows = rows_of({"sweep", scene, "--of", "modes", "--vary",
                             "/bodies/weight/mass=0.5,2,8", "--measure", "frequency:1", "--measure",
                             "damping:1", "--measure", "eigenvalue:1", "--measure", "weight.y"});
  ASSERT_EQ(rows.size(), 3U);
  for (const json& row : rows) {
    const double m = row["values"]["/bodies/weight/mass"];
    const double w = std::sqrt(200.0 / m);
    // The elastic part of the stiffness is exact; weight.y is a residual of 1e-11 of the load.
    EXPECT_NEAR(row["measured"]["frequency:1"].get<double>(), w / (2.0 * std::numbers::pi),
                1e-9 * w);
    EXPECT_NEAR(row["measured"]["damping:1"].get<double>(), 4.0 / (2.0 * m * w), 1e-9);
    EXPECT_NEAR(row["measured"]["eigenvalue:1"].get<double>(), w * w, 1e-8 * w * w);
    EXPECT_NEAR(row["measured"]["weight.y"].get<double>(), -1.0 - m * 10.0 / 200.0, 1e-9);
  }
}

TEST(RestSweep, AnUnstableRestIsTold) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("pendulum.json", pendulum_scene);
  const std::vector<std::string> sweep{"sweep",     scene,
                                       "--of",      "statics",
                                       "--vary",    "/gravity=[0,-10,0],[0,10,0]",
                                       "--measure", "eigenvalue:1",
                                       "--measure", "unstable_motions"};
  const json rows = rows_of(sweep);
  ASSERT_EQ(rows.size(), 2U);
  // m g L / (m L^2 + 2/5 m r^2); the geometric stiffness is a difference of forces, to 1e-6.
  const double closed = 10.0 * 2.0 / (4.0 + 0.4 * 0.25);
  EXPECT_EQ(rows[0]["status"], "done");
  EXPECT_NEAR(rows[0]["measured"]["eigenvalue:1"].get<double>(), closed, 1e-6 * closed);
  EXPECT_EQ(rows[1]["status"], "unstable");
  EXPECT_NEAR(rows[1]["measured"]["eigenvalue:1"].get<double>(), -closed, 1e-6 * closed);
  EXPECT_EQ(rows[1]["measured"]["unstable_motions"], 1.0);
  EXPECT_THAT(rows[1]["message"].get<std::string>(), HasSubstr("1 of 1 independent motions"));
  EXPECT_EQ(run_sheave(words_and(sweep, {"--strict"})).exit_code, 76);
}

TEST(RestSweep, AMachineWithoutARestIsARowWithItsReason) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("falling.json", falling_scene);
  for (const char* of : {"statics", "modes", "run"}) {
    const json rows = rows_of({"sweep", scene, "--of", of, "--from-rest", "--vary",
                               "/bodies/stone/mass=1,2", "--measure", "stone.y"});
    ASSERT_EQ(rows.size(), 2U) << of;
    EXPECT_EQ(rows[1]["status"], "no-rest") << of;
    EXPECT_TRUE(rows[1]["measured"]["stone.y"].is_null()) << of;
    EXPECT_THAT(rows[1]["message"].get<std::string>(), HasSubstr("on \"stone\" 20 N")) << of;
  }
}

TEST(RestSweep, AMissingModeIsNoNumber) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("spring.json", spring_scene);
  const json rows = rows_of({"sweep", scene, "--of", "modes", "--vary", "/bodies/weight/mass=1",
                             "--measure", "frequency:2"});
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(rows[0]["measured"]["frequency:2"].is_null());
  EXPECT_THAT(rows[0]["message"].get<std::string>(), HasSubstr("there are 1 independent motions"));
}

TEST(RestSweep, TellsThatLoadsOverTimeAreLeftOut) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("pulled.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [0, -1, 0]}],
    "cables": [{"name": "rope", "axial_stiffness": 1e5, "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}],
    "loads": [{"type": "force", "name": "pull", "body": "load", "forces": [[0, -200, 0]]}]})");
  for (const char* kind : {"statics", "modes"}) {
    const ProcessResult swept =
        run_sheave({"sweep", scene, "--of", kind, "--vary", "/bodies/load/mass=10,20", "--measure",
                    "rope.0.tension"});
    EXPECT_EQ(swept.exit_code, 0) << swept.err;
    EXPECT_THAT(swept.err, HasSubstr("the loads \"pull\" act in runs alone and are left out"));
    // Once for all rows.
    EXPECT_EQ(swept.err.find("act in runs"), swept.err.rfind("act in runs"));
  }
  const ProcessResult tuned =
      run_sheave({"tune", scene, "--of", "statics", "--vary", "/bodies/load/mass=10:20",
                  "--minimise", "rope.0.tension"});
  EXPECT_THAT(tuned.err, HasSubstr("the loads \"pull\" act in runs alone and are left out"));
  const ProcessResult run =
      run_sheave({"sweep", scene, "--vary", "/bodies/load/mass=10", "--measure", "rope.0.tension"});
  EXPECT_EQ(run.err.find("left out"), std::string::npos);
}

TEST(RestSweep, RefusesWhatOnlyRunsHave) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const auto refused = [&](const std::vector<std::string>& more, const char* message) {
    const ProcessResult result = run_sheave(
        words_and({"sweep", scene, "--of", "statics", "--vary", "/bodies/heavy/mass=1,2"}, more));
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr(message));
  };
  refused({"--measure", "rope.0.tension", "--trust", "1%"}, "--trust is for runs");
  refused({"--measure", "rope.0.tension", "--time-limit", "1"}, "--time-limit is for runs");
  refused({"--measure", "max:rope.0.tension"}, "write rope.0.tension");
  refused({"--measure", "max:rop.tension"}, "there is no cable \"rop\"");
  refused({"--measure", "energy.power_of_drives"}, "there is no quantity");
  refused({"--measure", "rope.0.tension", "--of", "movement"}, "run,statics,modes");
}

TEST(RestSweep, ShardsAreMergedToTheSameTable) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("spring.json", spring_scene);
  const auto sweep = [&](const std::string& of) {
    return std::vector<std::string>{"sweep",     scene,      "--of",
                                    of,          "--vary",   "/bodies/weight/mass=1:5:5",
                                    "--measure", "weight.y", "-q"};
  };
  for (const std::string of : {"statics", "modes"}) {
    const std::string whole = run_sheave(words_and(sweep(of), {"--csv", "-"})).out;
    std::vector<std::string> merge{"merge"};
    for (const char* shard : {"1/2", "2/2"}) {
      merge.push_back(folder.path(of + shard[0]));
      const ProcessResult part =
          run_sheave(words_and(sweep(of), {"--shard", shard, "--resume", merge.back()}));
      ASSERT_EQ(part.exit_code, 0) << part.err;
    }
    EXPECT_EQ(run_sheave(words_and(merge, {"--csv", "-"})).out, whole);
  }
  const ProcessResult mixed = run_sheave({"merge", folder.path("statics1"), folder.path("modes2")});
  EXPECT_EQ(mixed.exit_code, 65);
  EXPECT_THAT(mixed.err, HasSubstr("a sweep of statics"));
  EXPECT_THAT(mixed.err, HasSubstr("a sweep of modes: rows of one kind alone can be merged"));
  const ProcessResult resumed =
      run_sheave(words_and(sweep("modes"), {"--resume", folder.path("statics1")}));
  EXPECT_EQ(resumed.exit_code, 2);
  EXPECT_THAT(resumed.err, HasSubstr("is the journal of a sweep of statics, and this is a sweep of "
                                     "modes"));
}

/// A table of tensions over two axes.
command::SweepTable two_axes(double size) {
  command::SweepTable table;
  table.head.scene = "a.json";
  table.head.axes = {"load", "parts"};
  table.head.measures.push_back({"rope.0.tension", "N"});
  for (std::size_t i = 0; i < 4; ++i) {
    command::SweepRow row;
    row.run = i;
    row.values = {i < 2 ? "20000" : "40000", i % 2 == 0 ? "2" : "4"};
    row.measured = {size * (1.0 + static_cast<double>(i))};
    table.rows.push_back(row);
  }
  return table;
}

TEST(SweepChart, AMapHasNumbersWithPrefixes) {
  const std::string script =
      sweep_chart_script(two_axes(38'200.0), command::ChartFormat::svg).text();
  for (const char* text : {"rope.0.tension [kN]", "|38.2\n", "|76.4\n", "|153\n", "|20000\n"}) {
    EXPECT_THAT(script, HasSubstr(text));
  }
  EXPECT_THAT(script, HasSubstr("boxxyerror")) << "a map, not a line";
  EXPECT_THAT(script, testing::Not(HasSubstr("lines")));
}

TEST(SweepChart, NumbersThatHardlyDifferHaveMoreDigits) {
  command::SweepTable table = two_axes(1.0);
  for (std::size_t i = 0; i < 4; ++i) {
    table.rows[i].measured = {50'000.0 + static_cast<double>(i)};
  }
  const std::string script = sweep_chart_script(table, command::ChartFormat::svg).text();
  for (const char* text : {"|50.001\n", "|50.002\n"}) EXPECT_THAT(script, HasSubstr(text));
}

}  // namespace
}  // namespace sheave::test
