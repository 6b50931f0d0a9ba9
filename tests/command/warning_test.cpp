// Each way in which a run can be wrong without an error has a warning, which a run that is right
// has not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string train(const TemporaryFolder& folder, std::vector<std::string> options) {
  const std::string scene = folder.path("train.json");
  options.insert(options.begin(), {"generate", "wheel-train", "--out", scene});
  EXPECT_EQ(run_sheave(options).exit_code, 0);
  return scene;
}

json warnings_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"run", "--json", "--quiet"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return json::parse(run_sheave(command).out)["warnings"];
}

/// Kinds of the warnings, separated by spaces.
std::string warned(const std::vector<std::string>& arguments) {
  std::string kinds;
  for (const json& warning : warnings_of(arguments)) {
    kinds += (kinds.empty() ? "" : " ") + warning["kind"].get<std::string>();
  }
  return kinds;
}

TEST(Warnings, SweepsThatActLikeASpringAreAWarning) {
  // The cable gives way and comes back, so that at the end it is hardly longer than at half time;
  // accelerations are wrong by 25 %.
  const TemporaryFolder folder;
  const std::string swinging = train(
      folder, {"--wheel-mass", "1e-4", "--iterations", "10", "--dt", "1e-5", "--duration", "0.02"});
  EXPECT_EQ(warned({swinging}), "stretched");
  EXPECT_EQ(warned({swinging, "--solver", "direct"}), "");
  // It gives way in the beginning only, but things go on moving.
  const std::string short_run =
      train(folder, {"--wheels", "10", "--iterations", "10", "--duration", "0.16666666666666666"});
  EXPECT_EQ(warned({short_run, "--integrator", "rattle"}), "stretched");
}

TEST(Warnings, AWindingTheWrongWayRoundIsAWarning) {
  const TemporaryFolder folder;
  std::string text = atwood_scene;
  const std::string clockwise = "\"winding\": \"clockwise\"";
  text.replace(text.find(clockwise), clockwise.size(), "\"winding\": \"counter-clockwise\"");
  const std::string crossed = folder.write("crossed.json", text);
  EXPECT_EQ(warned({crossed}), "crossed_winding");
  EXPECT_EQ(warned({folder.write("atwood.json", atwood_scene)}), "");
  const ProcessResult result = run_sheave({"validate", crossed});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("link 1 on \"wheel\""));
  EXPECT_THAT(result.err, HasSubstr(clockwise));
}

TEST(Warnings, AVibrationThatTheStepDampsIsAWarning) {
  // w = 8.7 rad/s: in half a second xpbd takes w^2 h 0.5 s = 1.2 of it at 1/30 s, a hundredth of
  // that at 1/3000 s.
  const TemporaryFolder folder;
  const std::string scene = train(folder, {"--wheels", "1", "--iterations", "10", "--dt",
                                           "0.03333333333333333", "--duration", "0.5"});
  const std::vector<std::string> run{
      scene,   "--set",      "/cables/0/compliance=0.01", "--set", "/bodies/1/spin_inertia=0",
      "--set", "/start=pose"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), run.begin(), run.end());
    return more;
  };
  EXPECT_EQ(warned(run), "damped_vibration");
  EXPECT_EQ(warned(with({"--integrator", "rattle"})), "");
  EXPECT_EQ(warned(with({"--substeps", "100"})), "");
}

TEST(Warnings, ALossOfTheIntegratorIsReportedAndAWarning) {
  // Of Atwood's machine after t xpbd has taken a h t / 2 x (m2 - m1) g, and the kinetic energy is a
  // t^2 / 2 x (m2 - m1) g: h / t of it. 1 s and 0.01 s: 1 %; a duration of 0.5 s: 2 %.
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::vector<std::string> run{"run",    "--json",       "--quiet", scene,        "--solver",
                                     "direct", "--integrator", "xpbd",    "--duration", "0.5"};
  const json summary = json::parse(run_sheave(run).out);
  // (m2 - m1) g = 10 N, a = 2 m/s2.
  EXPECT_NEAR(summary["energy"]["integrator_loss"], 10.0 * 2.0 * 0.01 * 0.5 / 2.0, 1e-6);
  EXPECT_NEAR(summary["energy"]["flow"], 10.0 * 2.0 * 0.5 * 0.5 / 2.0, 1e-6);
  EXPECT_EQ(warned({scene, "--solver", "direct", "--integrator", "xpbd", "--duration", "0.5"}),
            "integrator_loss");
  EXPECT_EQ(warned({scene, "--solver", "direct", "--integrator", "xpbd", "--duration", "1.5"}), "");
  EXPECT_EQ(warned({scene, "--solver", "direct", "--integrator", "rattle"}), "");
}

TEST(Warnings, MotionInTheRoundingOfPositionsIsAWarning) {
  // g h^2 = 5e-16 m, and the last digit of 2 m is 4e-16 m.
  const TemporaryFolder folder;
  const std::string scene = train(folder, {"--wheels", "1", "--dt", "1e-5", "--duration", "0.02"});
  EXPECT_EQ(warned({scene, "--set", "/gravity=[0, 5e-6, 0]"}), "rounding");
  EXPECT_EQ(warned({scene, "--set", "/gravity=[0, 5e-3, 0]"}), "");
  EXPECT_EQ(warned({scene}), "");
}

TEST(Warnings, AMotionTooFastForTheStepIsAWarning) {
  // A block of 16 t pulls the light effort of its tackle round the wheel at 400 m/s, where it
  // swings by some radians per substep; substeps of a five-hundredth of that resolve it.
  const std::string scene = std::string(SHEAVE_SOURCE_DIR) + "/scenes/paper/pulley.json";
  const std::vector<std::string> extreme{scene,
                                         "--solver",
                                         "direct",
                                         "--duration",
                                         "1.2",
                                         "--set",
                                         "/bodies/4/mass=16393.075247154153",
                                         "--set",
                                         "/bodies/1/mass=528",
                                         "--set",
                                         "/bodies/2/mass=252.6",
                                         "--set",
                                         "/bodies/3/mass=100.9",
                                         "--set",
                                         "/bodies/5/mass=0.0658",
                                         "--set",
                                         "/bodies/6/mass=0.01307",
                                         "--set",
                                         "/bodies/7/mass=0.2447"};
  EXPECT_NE(warned(extreme), "");
  // What is advised is not what is in use.
  for (const json& warning : warnings_of(extreme)) {
    EXPECT_THAT(warning["message"], testing::Not(HasSubstr("--solver direct")));
  }
  std::vector<std::string> resolved = extreme;
  resolved.insert(resolved.end(), {"--substeps", "2000"});
  EXPECT_EQ(warned(resolved), "");
  EXPECT_EQ(warned({scene, "--solver", "direct"}), "");
}

TEST(Warnings, AWinchThatHasDrawnAllItsCableIsAWarning) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("winch.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 2,
    "step": {"dt": 0.01, "solver": "direct"},
    "bodies": [
      {"name": "drum", "mobility": "rotor", "mass": 1, "drive": "speed", "drive_values": [2],
       "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
      {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.2, -0.5, 0]}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "load"},
      {"type": "spool", "body": "drum", "winding": "counter-clockwise", "stored_length": 0}]}]
  })json");
  EXPECT_EQ(warned({scene}), "stalled");
  EXPECT_EQ(warned({scene, "--duration", "1"}), "");
  const json summary = json::parse(run_sheave({"run", "--json", "--quiet", scene}).out);
  ASSERT_EQ(summary["events"].size(), 1U);
  EXPECT_EQ(summary["events"][0]["kind"], "stall");
  EXPECT_EQ(summary["events"][0]["body"], "drum");
  EXPECT_NEAR(summary["events"][0]["time"].get<double>(), 1.25, 0.011);
}

TEST(Warnings, HingesThatContradictEachOtherAreAWarning) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("bar.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "step": {"dt": 0.01, "solver": "direct"},
    "bodies": [
      {"name": "led", "mobility": "kinematic", "position": [1, 0, 0], "velocity": [0.3, 0, 0]},
      {"name": "bar", "mass": 2, "position": [0.5, 0, 0],
       "shape": {"type": "box", "size": [1, 0.1, 0.1]}}],
    "joints": [
      {"name": "a", "type": "hinge", "body_b": "bar", "anchor": [0, 0, 0], "axis": [0, 0, 1]},
      {"name": "b", "type": "hinge", "body_a": "led", "body_b": "bar", "anchor": [1, 0, 0],
       "axis": [0, 0, 1]}]
  })json");
  EXPECT_THAT(warned({scene}), HasSubstr("joint_open"));
  EXPECT_EQ(warned({scene, "--set", "/bodies/0/velocity=[0, 0, 0]"}), "");
}

// The truck goes 1 m/s x 0.2 s beyond the end of its rope, and nothing else is there that could give.
TEST(Warnings, ARopeBetweenPrescribedMotionsIsAWarning) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("truck.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.2,
    "bodies": [
      {"name": "truck", "mobility": "kinematic", "position": [1, 0, 0], "velocity": [1, 0, 0]}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "truck"}]}]
  })json");
  EXPECT_EQ(warned({scene}), "stretched impossible");
  const json warnings = warnings_of({scene});
  EXPECT_THAT(warnings[0]["message"].get<std::string>(), HasSubstr("0.2 m longer"));
  EXPECT_THAT(warnings[1]["message"].get<std::string>(), HasSubstr("by up to 0.2 m"));
  EXPECT_EQ(warned({scene, "--set", "/bodies/0/velocity=[-1, 0, 0]"}), "");
}

// The rope beneath the eyelet has 0.5 m less 0.51 m/s x 0.4 s, and the rail is 0.4 m from it.
TEST(Warnings, ALoadDrawnBeyondTheNearestPointOfItsRailIsAWarning) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("rail.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.4, "step": {"dt": 0.004},
    "bodies": [
      {"name": "load", "mobility": "slider", "axis": [1, 0, 0], "position": [0.3, 0, 0], "mass": 1},
      {"name": "winch", "mobility": "kinematic", "position": [0, 1.4, 0],
       "velocity": [0, 0.51, 0]}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "load"},
      {"type": "pinhole", "body": "world", "point": [0, 0.4, 0]},
      {"type": "attachment", "body": "winch"}]}]
  })json");
  EXPECT_EQ(warned({scene}), "stretched dead_end");
  EXPECT_THAT(warnings_of({scene})[1]["message"].get<std::string>(), HasSubstr("up to 0.104 m"));
  EXPECT_EQ(warned({scene, "--set", "/bodies/1/velocity=[0, 0.2, 0]"}), "");
}

// A brake asks for the speed 0. The rate of a drum that the brake holds after 16.7 rad is the rounding of that angle over a
// substep of 78 us: 1e-11 rad/s, of which 0 is no part.
TEST(Warnings, ABrakeThatHoldsGivesNoWarning) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("brake.json", R"({
    "format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1,
    "step": {"dt": 0.01, "substeps": 128, "integrator": "xpbd"},
    "bodies": [{"name": "drum", "mobility": "rotor", "mass": 1, "spin_inertia": 2,
                "angular_velocity": [0, 0, 100]}],
    "joints": [{"type": "hinge", "name": "brake", "body_b": "drum", "anchor": [0, 0, 0],
                "axis": [0, 0, 1], "drive": "speed", "drive_values": [0], "drive_limit": 600}]})");
  EXPECT_EQ(warned({scene}), "");
}

}  // namespace
}  // namespace sheave::test
