// Where commands start their runs: --from-rest, "start" in the scene, --load-state.

#include <cstdio>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"

namespace sheave::test {
namespace {

using nlohmann::json;

/// A weight of 2 kg on a rope of 1 m and 500 N/m: it hangs 0.04 m below its place, with 20 N.
std::string hanging(const std::string& start = "") {
  return R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1, )" + start + R"(
    "step": {"dt": 0.01},
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
    "cables": [{"name": "rope", "compliance": 0.002, "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]})";
}

const std::string falling = R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1,
  "bodies": [{"name": "stone", "mass": 2, "inertia": [1, 1, 1]}]})";

std::vector<std::string> kinds_of_warnings(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"run", "--json"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProcessResult result = run_sheave(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> kinds;
  const json run = json::parse(result.out);
  for (const json& warning : run["warnings"]) kinds.push_back(warning["kind"]);
  return kinds;
}

TEST(Start, FromRestALoadStaysWhereItHangs) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging());
  const ProcessResult result = run_sheave(
      {"run", scene, "--from-rest", "-q", "--columns", "load.y,rope.0.tension", "--out", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);  // at time 0, when tensions are not known
  int rows = 0;
  while (std::getline(lines, line)) {
    double time = 0.0;
    double height = 0.0;
    double tension = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &height, &tension), 3) << line;
    EXPECT_NEAR(height, -1.04, 1e-10);
    EXPECT_NEAR(tension, 20.0, 2e-8);
    ++rows;
  }
  EXPECT_EQ(rows, 10);
}

TEST(Start, TheSceneAndTheOptionGiveTheSameBits) {
  const TemporaryFolder folder;
  const std::string pose = folder.write("pose.json", hanging());
  const std::string rest = folder.write("rest.json", hanging(R"("start": "rest",)"));
  const auto hash = [](const std::vector<std::string>& words) {
    return json::parse(run_sheave(words).out)["state_hash"];
  };
  const json by_scene = hash({"run", rest, "--json"});
  EXPECT_EQ(by_scene, hash({"run", pose, "--json", "--from-rest"}));
  EXPECT_NE(by_scene, hash({"run", pose, "--json"}));
  ASSERT_EQ(run_sheave({"statics", pose, "--save-state", folder.path("rest.state")}).exit_code, 0);
  EXPECT_EQ(by_scene, hash({"run", pose, "--json", "--load-state", folder.path("rest.state")}));
}

TEST(Start, AnUnstretchedRopeIsToldUnlessTheSceneSaysWhereItStarts) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging());
  EXPECT_EQ(kinds_of_warnings({scene}), std::vector<std::string>{"unsettled_start"});
  EXPECT_TRUE(kinds_of_warnings({scene, "--from-rest"}).empty());
  EXPECT_TRUE(kinds_of_warnings({scene, "--set", "/start=pose"}).empty());
  const ProcessResult result = run_sheave({"run", scene, "-q"});
  EXPECT_NE(result.err.find("cable \"rope\" starts with 0 N in span 0 and has 20 N at rest"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("--from-rest"), std::string::npos) << result.err;
}

/// A rope of 1 m that is drawn out to 2 m: 100 %, and 1e4 N of an EA of 1e4 N.
std::string drawn_out(const std::string& start = "", const std::string& more = "") {
  return R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.01, )" + start + R"(
    "step": {"dt": 0.01},
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -2, 0]}],
    "cables": [{"name": "rope", "axial_stiffness": 1e4, "rest_lengths": [1], )" +
         more + R"("links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]})";
}

TEST(Start, AbsurdStrainsAreToldByEveryCommand) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("drawn.json", drawn_out());
  const std::string told =
      "cable \"rope\" starts stretched by 100 % in span 0: 2 m long with a rest length of 1 m, so "
      "with 1e+04 N";
  EXPECT_EQ(kinds_of_warnings({scene}), std::vector<std::string>{"strained_start"});
  const std::vector<std::vector<std::string>> commands{
      {"run", scene, "-q"},
      {"statics", scene},
      {"modes", scene},
      {"validate", scene},
      {"sweep", scene, "--vary", "/bodies/load/mass=1,2", "--measure", "load.y", "-q"},
      {"plot", scene, "-y", "load.y", "-o", folder.path("a.svg"), "-q"}};
  for (const std::vector<std::string>& words : commands) {
    const ProcessResult result = run_sheave(words);
    EXPECT_EQ(result.exit_code, 0) << words[0] << result.err;
    const std::size_t first = result.err.find(told);
    ASSERT_NE(first, std::string::npos) << words[0] << result.err;
    EXPECT_EQ(result.err.find(told, first + 1), std::string::npos) << "told twice: " << result.err;
    EXPECT_NE(result.err.find("give longer rest_lengths"), std::string::npos) << result.err;
  }
}

TEST(Start, AStrainThatIsMeantOrSmallIsNotTold) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("drawn.json", drawn_out());
  EXPECT_TRUE(kinds_of_warnings({scene, "--set", "/start=pose"}).empty());
  // 9 %; the rest, 0.2 %, is far away.
  EXPECT_EQ(kinds_of_warnings({scene, "--set", "/cables/rope/rest_lengths/0=1.835"}),
            std::vector<std::string>{"unsettled_start"});
}

TEST(Start, ATensionBeyondBreakingIsTold) {
  // 5 % and 500 N, where the rope bears 400 N.
  const TemporaryFolder folder;
  const std::string scene =
      folder.write("weak.json", drawn_out("", R"("breaking_tension": 400, )"));
  const ProcessResult result =
      run_sheave({"run", scene, "-q", "--set", "/cables/rope/rest_lengths/0=1.904761904761905"});
  EXPECT_NE(result.err.find("so with 500 N, and parts at once: its breaking tension is 400 N"),
            std::string::npos)
      << result.err;
}

TEST(Start, AMachineWithoutARestIsTold) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("falling.json", falling);
  const ProcessResult result = run_sheave({"run", scene, "--from-rest"});
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_NE(result.err.find("cannot start at rest: no equilibrium was found: on \"stone\""),
            std::string::npos)
      << result.err;
  EXPECT_EQ(run_sheave({"plot", scene, "--from-rest", "-y", "stone.y", "-o", folder.path("a.svg")})
                .exit_code,
            75);
  EXPECT_EQ(run_sheave({"modes", scene, "--as-is", "--from-rest"}).exit_code, 75);
  const ProcessResult swept = run_sheave(
      {"sweep", scene, "--from-rest", "--vary", "/bodies/stone/mass=1,2", "--measure", "stone.y"});
  EXPECT_NE(swept.out.find("cannot start at rest"), std::string::npos) << swept.out << swept.err;
}

TEST(Start, OneStartExcludesTheOther) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging());
  EXPECT_EQ(run_sheave({"run", scene, "--from-rest", "--load-state", "any.state"}).exit_code, 2);
  EXPECT_EQ(run_sheave({"stress", "--from-rest", "--list"}).exit_code, 2) << "without a scene";
}

TEST(Start, EveryCommandLoadsAState) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("hanging.json", hanging());
  const std::string state = folder.path("half.state");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--steps", "5", "--save-state", state}).exit_code, 0);
  const ProcessResult statics = run_sheave({"statics", scene, "--json", "--load-state", state});
  ASSERT_EQ(statics.exit_code, 0) << statics.err;
  const json body = json::parse(statics.out)["cases"][0]["bodies"][0];
  EXPECT_NEAR(body["center_of_mass"][1].get<double>(), -1.04, 1e-10);
  // The sweep continues the run: its first value is that of 0.05 s.
  const ProcessResult sweep = run_sheave({"sweep", scene, "--load-state", state, "--vary",
                                          "/duration=0.1", "--measure", "min:t@0:0.1", "--json"});
  ASSERT_EQ(sweep.exit_code, 0) << sweep.err;
  EXPECT_NE(sweep.out.find("0.05"), std::string::npos) << sweep.out;
  const ProcessResult plot = run_sheave({"plot", scene, "--load-state", state, "-y", "load.y", "-o",
                                         folder.path("a.svg"), "--json", "-q"});
  EXPECT_EQ(plot.exit_code, 0) << plot.err;
  const ProcessResult trade =
      run_sheave({"trade", scene, "--load-state", state, "--substeps", "1,2", "--iterations", "1",
                  "--no-ladder", "--repetitions", "1", "--minutes", "0.1", "--json"});
  ASSERT_EQ(trade.exit_code, 0) << trade.err;
  EXPECT_NEAR(json::parse(trade.out)["simulated_seconds"].get<double>(), 0.05, 1e-12);
}

}  // namespace
}  // namespace sheave::test
