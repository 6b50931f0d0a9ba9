// sheave run: summary, overrides, checks, tables.

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"
#include "tests/support/state_bytes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

json run_json(const std::vector<std::string>& arguments, int expected_code = 0) {
  std::vector<std::string> all{"run", "--json"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const ProcessResult result = run_sheave(all);
  EXPECT_EQ(result.exit_code, expected_code) << result.err;
  json summary = json::parse(result.out, nullptr, false);
  EXPECT_FALSE(summary.is_discarded()) << result.out;
  return summary;
}

TEST(RunCommand, JsonSummaryHasEveryDocumentedField) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const json summary = run_json({scene});
  EXPECT_EQ(summary["scene"], scene);
  EXPECT_EQ(summary["name"], "Two weights");
  EXPECT_EQ(summary["status"], "done");
  EXPECT_EQ(summary["steps"], 100);
  EXPECT_DOUBLE_EQ(summary["sim_time"], 1.0);
  EXPECT_GT(summary["wall_time"], 0.0);
  EXPECT_GT(summary["us_per_step"], 0.0);
  EXPECT_EQ(summary["settings"]["iterations"], 20);
  EXPECT_EQ(summary["settings"]["solver"], "direct");
  EXPECT_EQ(summary["settings"]["integrator"], "rattle");
  for (const char* key : {"initial", "final", "max_drift"}) {
    EXPECT_TRUE(summary["energy"][key].is_number()) << key;
  }
  ASSERT_EQ(summary["cables"].size(), 1U);
  const json& rope = summary["cables"][0];
  EXPECT_EQ(rope["name"], "rope");
  EXPECT_LT(std::abs(rope["length_error"].get<double>()), 1e-12);
  EXPECT_TRUE(rope["max_stretch"].is_number());
  ASSERT_EQ(rope["spans"].size(), 2U);
  EXPECT_NEAR(rope["spans"][0]["tension"], 12.0, 1e-9);
  EXPECT_NEAR(rope["spans"][1]["tension"], 16.0, 1e-9);
  EXPECT_TRUE(rope["spans"][0]["length"].is_number());
  EXPECT_TRUE(rope["spans"][0]["rest_length"].is_number());
  ASSERT_EQ(summary["bodies"].size(), 3U);
  EXPECT_EQ(summary["bodies"][1]["name"], "light");
  EXPECT_EQ(summary["bodies"][1]["position"].size(), 3U);
  EXPECT_EQ(summary["bodies"][1]["orientation"].size(), 4U);
  EXPECT_NEAR(summary["bodies"][1]["velocity"][1], 2.0, 1e-9);
  EXPECT_EQ(summary["bodies"][1]["angular_velocity"].size(), 3U);
  EXPECT_EQ(summary["statistics"]["rows"], 2);
  EXPECT_EQ(summary["statistics"]["row_solves"], 2 * summary["statistics"]["rounds"].get<int>());
  EXPECT_EQ(run_json({scene, "--solver", "gauss-seidel", "--integrator",
                      "xpbd"})["statistics"]["row_solves"],
            2 * 20 * 100);
  EXPECT_TRUE(summary["events"].is_array());
  EXPECT_TRUE(summary["warnings"].is_array());
  EXPECT_EQ(summary["state_hash"].get<std::string>().size(), 16U);
  EXPECT_FALSE(summary.contains("checks"));
}

TEST(RunCommand, HumanSummaryGoesToStdoutAndNothingToAStderrThatIsNoTerminal) {
  const TemporaryFolder folder;
  const ProcessResult result = run_sheave({"run", folder.write("atwood.json", atwood_scene)});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("Two weights"));
  EXPECT_THAT(result.out, HasSubstr("done: 100 steps"));
  EXPECT_THAT(result.out, HasSubstr("rope.1"));
  EXPECT_THAT(result.out, HasSubstr("energy"));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST(RunCommand, QuietPrintsNothing) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_sheave({"run", "--quiet", folder.write("atwood.json", atwood_scene)});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, IsEmpty());
}

TEST(RunCommand, OptionsAndSetReplaceSettingsOfTheScene) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const json summary =
      run_json({scene, "--dt", ".02", "--substeps", "2", "--iterations", "30", "--duration", "0.5",
                "--solver", "gauss-seidel", "--integrator", "xpbd", "--set", "/bodies/1/mass=2"});
  EXPECT_DOUBLE_EQ(summary["settings"]["dt"], 0.02);
  EXPECT_EQ(summary["settings"]["substeps"], 2);
  EXPECT_EQ(summary["settings"]["iterations"], 30);
  EXPECT_EQ(summary["steps"], 25);
  EXPECT_NEAR(summary["bodies"][1]["velocity"][1], 0.0, 1e-9) << "equal weights do not move";
}

TEST(RunCommand, WrongOverridesAreWrongUsageAndNameTheOption) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::vector<std::vector<std::string>> cases{
      {"--dt", "-1"},
      {"--dt", "abc"},
      {"--iterations", "0"},
      {"--solver", "magic"},
      {"--set", "/bodies/1/mass"},
      {"--set", "bodies=1"},
      {"--set", "/bodies/7/mass=1"},
      {"--set", "/bodies/1/mass=-1"},
  };
  for (const auto& options : cases) {
    const ProcessResult result = run_sheave({"run", scene, options[0], options[1]});
    EXPECT_EQ(result.exit_code, 2) << options[0] << " " << options[1] << "\n" << result.err;
    EXPECT_THAT(result.err, HasSubstr(options[0]));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

TEST(RunCommand, ChecksThatHoldAreReported) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave({"run", scene, "--check"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("2 of 2 checks passed"));
  EXPECT_THAT(result.out, HasSubstr("(m2 - m1) g"));
  const json summary = run_json({scene, "--check"});
  EXPECT_EQ(summary["checks_passed"], true);
  ASSERT_EQ(summary["checks"].size(), 2U);
  const json& check = summary["checks"][0];
  EXPECT_NEAR(check["measured"], 2.0, 0.02);
  EXPECT_DOUBLE_EQ(check["expected"], 2.0);
  EXPECT_DOUBLE_EQ(check["tolerance"], 0.02);
  EXPECT_EQ(check["passed"], true);
}

TEST(RunCommand, ACheckThatFailsIsNamedAndGivesExitCode1) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::vector<std::string> wrong{"--check", "--set", "/checks/0/equals=3"};
  const ProcessResult result = run_sheave({"run", scene, wrong[0], wrong[1], wrong[2]});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("FAIL  light.vy"));
  EXPECT_THAT(result.out, HasSubstr("1 of 2 checks passed"));
  const json summary = run_json({scene, wrong[0], wrong[1], wrong[2]}, 1);
  EXPECT_EQ(summary["status"], "done");
  EXPECT_EQ(summary["checks_passed"], false);
  EXPECT_EQ(summary["checks"][0]["passed"], false);
  EXPECT_EQ(run_sheave({"run", scene, "--set", wrong[2]}).exit_code, 0) << "not asked to check";
  const ProcessResult quiet = run_sheave({"run", scene, wrong[0], wrong[1], wrong[2], "--quiet"});
  EXPECT_EQ(quiet.exit_code, 1);
  EXPECT_THAT(quiet.err, HasSubstr("FAIL  light.vy"));
}

TEST(RunCommand, ChecksOfAShortenedRunFailRatherThanPassByLuck) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const json summary = run_json({scene, "--check", "--steps", "50"}, 1);
  EXPECT_TRUE(summary["checks"][0]["measured"].is_null()) << "nothing measured, so no number";
}

TEST(RunCommand, ASceneWithoutChecksIsReported) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", runaway_scene);
  const ProcessResult result = run_sheave({"run", scene, "--check", "--steps", "1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("no checks"));
}

TEST(RunCommand, ColumnsComeInTheOrderThatIsAskedFor) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave(
      {"run", scene, "-q", "--steps", "1", "--columns", "rope.?.tension,light.y,*.y", "-o", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.substr(0, result.out.find('\n')),
            "t,rope.0.tension,rope.1.tension,light.y,wheel.y,heavy.y");
}

TEST(RunCommand, TwoRunsHaveTheSameHash) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(run_json({scene})["state_hash"], run_json({scene})["state_hash"]);
  EXPECT_NE(run_json({scene})["state_hash"], run_json({scene, "--steps", "99"})["state_hash"]);
}

TEST(RunCommand, SavedAndLoadedStateGivesTheHashOfAnUninterruptedRun) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string state = folder.path("half.state");
  const json whole = run_json({scene});
  const json half = run_json({scene, "--steps", "37", "--save-state", state});
  EXPECT_EQ(half["steps"], 37);
  const json rest = run_json({scene, "--load-state", state});
  EXPECT_EQ(rest["steps"], 63);
  EXPECT_DOUBLE_EQ(rest["sim_time"], 1.0);
  EXPECT_EQ(rest["state_hash"], whole["state_hash"]);
}

TEST(RunCommand, ReportsTriggersAndEndsAtAStopTrigger) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hoist.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 5, "step": {"dt": 0.01, "substeps": 1},
    "bodies": [{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 1}],
    "triggers": [
      {"name": "push", "at": 0.25, "action": "set", "target": "weight.force_y", "value": 30},
      {"name": "far", "quantity": "weight.y", "above": 1, "action": "stop"}],
    "controllers": [{"type": "pid", "name": "blind", "measures": "weight.y", "control": "gravity.x",
      "setpoint": 1e300, "proportional": 1e300}]})");
  const json run = run_json({scene});
  ASSERT_EQ(run["events"].size(), 2U);
  EXPECT_EQ(run["events"][0]["trigger"], "push");
  EXPECT_EQ(run["events"][0]["kind"], "set");
  EXPECT_EQ(run["events"][0]["time"], 0.25);
  EXPECT_EQ(run["events"][1]["trigger"], "far");
  EXPECT_EQ(run["status"], "done");
  // It falls to -0.3125 m at -2.5 m/s, and rises with 20 m/s2: 10 t^2 - 2.5 t = 1.3125, t = 0.5080
  // s. The run ends with the step of 0.01 s in which that instant lies.
  EXPECT_DOUBLE_EQ(run["sim_time"].get<double>(), 0.76);
  // The controller asks for a value that is no number.
  ASSERT_EQ(run["warnings"].size(), 1U) << run["warnings"];
  EXPECT_EQ(run["warnings"][0]["kind"], "control_refused");
}

TEST(RunCommand, StepsAndDurationExcludeEachOther) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(run_sheave({"run", scene, "--steps", "1", "--duration", "1"}).exit_code, 2);
}

TEST(RunCommand, ZeroStepsLeaveTensionsUnknown) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const json summary = run_json({scene, "--steps", "0"});
  EXPECT_TRUE(summary["cables"][0]["spans"][0]["tension"].is_null());
  EXPECT_TRUE(summary["us_per_step"].is_null());
  EXPECT_TRUE(summary["warnings"].empty());
}

TEST(RunCommand, ReportsADurationThatIsNoMultipleOfDt) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const json summary = run_json({scene, "--duration", "0.505", "--integrator", "rattle"});
  ASSERT_EQ(summary["warnings"].size(), 1U);
  EXPECT_EQ(summary["warnings"][0]["kind"], "duration");
}

TEST(RunCommand, ASpanWithoutTangentIsAWarningWithItsName) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("overlap.json", overlap_scene);
  const json summary = run_json({scene});
  ASSERT_EQ(summary["warnings"].size(), 1U);
  EXPECT_EQ(summary["warnings"][0]["kind"], "no_tangent");
  EXPECT_EQ(summary["warnings"][0]["subject"], "rope.1");
  EXPECT_GT(summary["statistics"]["geometry_fallbacks"], 0);
  EXPECT_EQ(summary["cables"][0]["length_error"], 0.0);
  const ProcessResult result = run_sheave({"run", scene});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("rope.1"));
}

TEST(RunCommand, ARigidCableThatDidNotHoldIsAWarning) {
  // Wheels of a billionth of the weights' mass swallow what a sweep corrects: the weights fall
  // freely, 4.9 m in a second, on a cable of which they hang 16 wheels apart.
  const TemporaryFolder folder;
  const std::string scene = folder.path("train.json");
  ASSERT_EQ(run_sheave({"generate", "wheel-train", "--wheel-mass", "1e-9", "--iterations", "10",
                        "--out", scene})
                .exit_code,
            0);
  const json rough = run_json({scene});
  ASSERT_GE(rough["warnings"].size(), 1U);
  EXPECT_EQ(rough["warnings"][0]["kind"], "stretched");
  EXPECT_EQ(rough["warnings"][0]["subject"], "cable");
  EXPECT_TRUE(
      run_json({scene, "--solver", "direct", "--integrator", "rattle"})["warnings"].empty());
  // A cable that may stretch is not meant; but where the sweeps leave it without the force of its
  // stretch, energy is wrong.
  const json elastic = run_json({scene, "--set", "/cables/0/compliance=0.1"});
  ASSERT_EQ(elastic["warnings"].size(), 1U);
  EXPECT_EQ(elastic["warnings"][0]["kind"], "energy_gain");
  EXPECT_TRUE(run_json({scene, "--set", "/cables/0/compliance=0.1", "--solver", "direct",
                        "--integrator", "rattle"})["warnings"]
                  .empty());
}

TEST(RunCommand, TheTextShowsWrapsAndTheFirstEvents) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("wrap.json", wrap_scene);
  const ProcessResult result = run_sheave({"run", scene});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("rope.0 "));
  EXPECT_THAT(result.out, HasSubstr("rope, on \"post\" "));
  // The ends' height 0.3 m sin(8 pi t) is that of the post's lowest point, 0.1 m, at 0.01352 s;
  // substeps take 0.0025 s.
  EXPECT_THAT(result.out, HasSubstr("0.015     rope     post  touch"));
  const json summary = run_json({scene});
  ASSERT_GT(summary["events"].size(), 11U);
  EXPECT_THAT(result.out, HasSubstr("... and " + std::to_string(summary["events"].size() - 10) +
                                    " more events; --json lists all"));
  // Before the cable touches anything there is neither.
  const ProcessResult start = run_sheave({"run", scene, "--steps", "1"});
  EXPECT_THAT(start.out, Not(HasSubstr("post\" ")));
  EXPECT_THAT(start.out, Not(HasSubstr("event")));
}

TEST(RunCommand, ReportsJointsAndTheirBreaking) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("jointed.json", jointed_scene);
  const json summary = run_json({scene});
  ASSERT_EQ(summary["joints"].size(), 2U);
  const json& string = summary["joints"][0];
  EXPECT_EQ(string["name"], "string");
  EXPECT_EQ(string["type"], "distance");
  EXPECT_EQ(string["force"], json({0.0, 0.0, 0.0}));
  // It falls 1 m in sqrt(2 / g) = 0.447 s, a step of the first order earlier or later.
  EXPECT_NEAR(string["broken_at"], 0.447, 0.01);
  ASSERT_EQ(summary["events"].size(), 1U);
  EXPECT_EQ(summary["events"][0],
            (json{{"time", string["broken_at"]}, {"joint", "string"}, {"kind", "break"}}));
  const json& bearing = summary["joints"][1];
  EXPECT_TRUE(bearing["broken_at"].is_null());
  ASSERT_EQ(bearing["coordinates"].size(), 1U);
  const json& angle = bearing["coordinates"][0];
  EXPECT_EQ(angle["name"], "angle");
  EXPECT_NEAR(angle["value"], 0.25, 1e-6);
  EXPECT_NEAR(angle["rate"], 0.0, 1e-6);
  // The drive holds the bar: m g cos(0.25) x 0.5 m; all of its weight is on the bearing.
  EXPECT_NEAR(angle["drive_force"], 15.0 * std::cos(0.25), 1e-3);
  EXPECT_NEAR(bearing["force"][1], 30.0, 1e-3);
  EXPECT_NEAR(bearing["torque"][2], 15.0 * std::cos(0.25), 1e-3);
  // Before the first step nobody knows the forces.
  const json start = run_json({scene, "--steps", "0"});
  EXPECT_TRUE(start["joints"][1]["force"].is_null());
  EXPECT_TRUE(start["joints"][1]["coordinates"][0]["drive_force"].is_null());
  EXPECT_EQ(start["joints"][1]["coordinates"][0]["value"], 0.0);
  EXPECT_TRUE(start["events"].empty());
}

TEST(RunCommand, TheTextHasATableOfJointsIfThereAreAny) {
  const TemporaryFolder folder;
  const ProcessResult result = run_sheave({"run", folder.write("jointed.json", jointed_scene)});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              ContainsRegex("joint +force \\[N\\] +torque \\[N m\\] +coordinate +value"));
  EXPECT_THAT(result.out, ContainsRegex("string +broken +extension \\[m\\]"));
  EXPECT_THAT(result.out, ContainsRegex("bearing +30 +14.53[0-9]* +angle \\[rad\\] +0.25 "));
  EXPECT_THAT(result.out, ContainsRegex("0.4[45][0-9]* +string +break"));
  const ProcessResult without = run_sheave({"run", folder.write("atwood.json", atwood_scene)});
  EXPECT_THAT(without.out, Not(HasSubstr("joint")));
}

TEST(RunCommand, ReportsAndWarnsOfDividedSubsteps) {
  // A weight on a cable of 1 m that runs 3 m in one step: no gradient of the start leads it back,
  // but in parts it does.
  const TemporaryFolder folder;
  const std::string scene = folder.write("swing.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "step": {"dt": 0.1, "substeps": 1, "solver": "direct", "integrator": "rattle"},
    "bodies": [{"name": "bob", "mobility": "planar", "position": [0, -1, 0], "velocity": [30, 0, 0],
                "mass": 1, "shape": {"type": "sphere", "radius": 0.1}}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "bob"}]}]})json");
  const json fast = run_json({scene});
  EXPECT_EQ(fast["statistics"]["integrator_fallbacks"], 0);
  EXPECT_GT(fast["statistics"]["cut_substeps"], 0);
  EXPECT_GE(fast["statistics"]["substep_parts"], 2 * fast["statistics"]["cut_substeps"].get<int>());
  ASSERT_EQ(fast["warnings"].size(), 1U);
  EXPECT_EQ(fast["warnings"][0]["kind"], "cut_substeps");
  const json slow = run_json({scene, "--substeps", "100"});
  EXPECT_EQ(slow["statistics"]["cut_substeps"], 0);
  EXPECT_TRUE(slow["warnings"].empty());
}

TEST(RunCommand, StatisticsOfTheDirectSolver) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::vector<std::string> xpbd{scene, "--integrator", "xpbd", "--solver"};
  const auto with = [&](const char* solver) {
    std::vector<std::string> arguments = xpbd;
    arguments.emplace_back(solver);
    return arguments;
  };
  const auto text = [&](const char* solver) {
    std::vector<std::string> arguments = with(solver);
    arguments.insert(arguments.begin(), "run");
    return run_sheave(arguments).out;
  };
  const json swept = run_json(with("gauss-seidel"));
  EXPECT_EQ(swept["statistics"]["rounds"], 0);
  EXPECT_THAT(text("gauss-seidel"), Not(HasSubstr("per substep")));
  const json direct = run_json(with("direct"));
  EXPECT_GE(direct["statistics"]["rounds"], 100);
  EXPECT_EQ(direct["statistics"]["row_solves"], 2 * direct["statistics"]["rounds"].get<int>());
  EXPECT_EQ(direct["statistics"]["solver_fallbacks"], 0);
  EXPECT_EQ(direct["statistics"]["redundant_rows"], 0);
  EXPECT_TRUE(direct["statistics"]["set_changes"].is_number());
  EXPECT_TRUE(direct["warnings"].empty());
  EXPECT_THAT(text("direct"),
              HasSubstr("2 rows: 1 rounds per substep, 0 substeps done by Gauss-Seidel"));
}

TEST(RunCommand, CountsRedundantRowsAndReleasesNone) {
  const TemporaryFolder folder;
  const json summary =
      run_json({folder.write("redundant.json", redundant_scene), "--integrator", "rattle"});
  EXPECT_EQ(summary["statistics"]["solver_fallbacks"], 0);
  EXPECT_GT(summary["statistics"]["redundant_rows"], 0);
  EXPECT_TRUE(summary["warnings"].empty());
}

TEST(RunCommand, ReportsTheStrainOfElasticRopes) {
  // 1000 kg at rest on EA = 7e6 N: strained by 9810 / 7e6 = 0.00140143, and never more.
  const TemporaryFolder folder;
  const std::string scene = folder.write("load.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 0.1,
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 1000, "position": [0, -10, 0]}],
    "cables": [{"name": "rope", "axial_stiffness": 7e6, "rest_lengths": [9.986005326821], "links": [
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}, {"type": "attachment", "body": "load"}]}]
  })");
  const json summary = run_json({scene});
  EXPECT_EQ(summary["cables"][0]["max_stretch"], 0.0) << "an error of rigid ropes";
  EXPECT_NEAR(summary["cables"][0]["max_strain"], 9810.0 / 7e6, 1e-8);
  EXPECT_THAT(run_sheave({"run", scene}).out, ContainsRegex("rope +9.98[0-9]+ +0 +0.0014014"));
}

TEST(RunCommand, EstimatesTheErrorOfItsStep) {
  // xpbd on a constant acceleration of 2 m/s2: a t h / 2 = 0.01 m too far after 1 s with h = 0.01
  // s, of order 1.
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::vector<std::string> options{scene,          "--solver", "direct",
                                         "--integrator", "xpbd",     "--estimate-error"};
  const json summary = run_json(options);
  const json& estimate = summary["error_estimate"];
  EXPECT_EQ(estimate["substeps"], json({1, 2, 4}));
  EXPECT_EQ(estimate["position_kind"], "regular");
  EXPECT_EQ(estimate["tension_kind"], "rounding");
  ASSERT_EQ(estimate["bodies"].size(), 3U);
  const json& light = estimate["bodies"][1]["position"];
  EXPECT_EQ(estimate["bodies"][1]["name"], "light");
  EXPECT_NEAR(light["order"], 1.0, 1e-6);
  EXPECT_NEAR(light["largest"], 0.005, 1e-8);
  EXPECT_NEAR(light["error"], 0.01, 1e-8);
  EXPECT_NEAR(light["time"], 1.0, 1e-12);
  EXPECT_NEAR(estimate["bodies"][0]["turn"]["error"], 0.02, 1e-8) << "a wheel of 0.5 m";
  EXPECT_EQ(estimate["spans"][1]["name"], "rope.1");
  // Beside itself: the run is the same as without.
  const json alone = run_json({scene, "--solver", "direct", "--integrator", "xpbd"});
  EXPECT_EQ(summary["state_hash"], alone["state_hash"]);
  EXPECT_FALSE(alone.contains("error_estimate"));
  std::vector<std::string> shown{"run"};
  shown.insert(shown.end(), options.begin(), options.end());
  const ProcessResult text = run_sheave(shown);
  EXPECT_THAT(text.out, HasSubstr("1 substep against 2 and 4, to t = 1 s"));
  EXPECT_THAT(text.out, ContainsRegex("light position +0.005 m +1 +[0-9.]+ % +1.00"));
  EXPECT_THAT(text.out, HasSubstr("by the step alone positions are off by about"));
  const ProcessResult fine = run_sheave({"run", scene, "--substeps", "25001", "--estimate-error"});
  EXPECT_EQ(fine.exit_code, 2);
  EXPECT_THAT(fine.err, HasSubstr("at most 25000"));
}

TEST(RunCommand, ReadsASceneFromStandardInput) {
  const ProcessResult result = run_sheave({"run", "-", "--json"}, {.input = atwood_scene});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["steps"], 100);
}

}  // namespace
}  // namespace sheave::test
