// A run that checks its own numbers: what it prints, its status, --trust, --strict and exit code
// 76.

#include <array>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A planar drum of 5 kg on a hinge with a speed drive of 2 rad/s winds up a load of 200 kg: ten
/// sweeps do not carry its weight to the drive, and the drum runs backwards while the tension reads
/// exactly right.
const std::string driven_drum = R"json({
  "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
  "step": {"solver": "gauss-seidel", "integrator": "xpbd", "iterations": 10},
  "bodies": [
    {"name": "drum", "mobility": "planar", "mass": 5, "shape": {"type": "cylinder", "radius": 0.2, "length": 0.3}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "position": [0.2, -10, 0], "mass": 200}],
  "joints": [{"type": "hinge", "name": "axle", "body_b": "drum", "anchor": [0, 0, 0], "axis": [0, 0, 1],
              "drive": "speed", "drive_values": [2]}],
  "cables": [{"name": "rope", "links": [
    {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 5},
    {"type": "attachment", "body": "load"}]}]
})json";

const std::vector<std::string> best{"--solver", "direct", "--integrator", "rattle"};

ProcessResult run_with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.begin(), "run");
  words.insert(words.end(), more.begin(), more.end());
  return run_sheave(words);
}

TEST(RunCertificate, ACleanRunReportsItsLargestResiduals) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult text = run_with({scene, "--strict"}, best);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("done: 100 steps"));
  EXPECT_THAT(text.out, HasSubstr("\nchecked: constraints within "));
  EXPECT_THAT(text.out, HasSubstr("forces balance within "));
  const json summary = json::parse(run_with({scene, "--json"}, best).out);
  EXPECT_EQ(summary["status"], "done");
  const json& certificate = summary["certificate"];
  EXPECT_EQ(certificate["clean"], true);
  EXPECT_EQ(certificate["trust"], 0.01);
  EXPECT_GE(certificate["substeps"], 2);
  EXPECT_THAT(certificate["text"].get<std::string>(), StartsWith("checked: "));
  ASSERT_FALSE(certificate["items"].empty());
  for (const json& item : certificate["items"]) {
    // Tolerance of the direct solver, 1e-10 of the size.
    EXPECT_LT(item["relative"], 1e-6) << item;
  }
}

TEST(RunCertificate, ARunThatContradictsItselfIsDoubtful) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("drum.json", driven_drum);
  const ProcessResult text = run_with({scene}, {});
  EXPECT_EQ(text.exit_code, 0) << "only with --strict it is more than a word";
  EXPECT_THAT(text.out, HasSubstr("doubtful: 60 steps"));
  EXPECT_THAT(text.out, HasSubstr("\ndoubtful: at "));
  EXPECT_EQ(run_with({scene, "--strict"}, {}).exit_code, 76);
  EXPECT_EQ(run_with({scene, "--strict"}, best).exit_code, 0);
  // Where there is no summary for people, standard error has it.
  const ProcessResult quiet = run_with({scene, "--quiet"}, {});
  EXPECT_EQ(quiet.out, "");
  EXPECT_THAT(quiet.err, HasSubstr("doubtful: at "));
  const ProcessResult machine = run_with({scene, "--json"}, {});
  EXPECT_THAT(machine.err, HasSubstr("doubtful: at "));
  const json summary = json::parse(machine.out);
  EXPECT_EQ(summary["status"], "doubtful");
  EXPECT_EQ(summary["certificate"]["clean"], false);
  const json& worst = summary["certificate"]["worst"];
  EXPECT_GT(worst["relative"], 0.01);
  EXPECT_GT(worst["time"], 0.0);
  EXPECT_FALSE(worst["name"].get<std::string>().empty());
  EXPECT_THAT(worst["advice"].get<std::string>(), HasSubstr("direct"));
}

std::string fault_scene(const std::string& name) {
  return std::string(SHEAVE_SOURCE_DIR) + "/dev/faults/" + name + ".json";
}

/// How much more energy there was than ever before, over the largest sum of kinetic and elastic
/// energy, from the table that a run writes. What comes back within 32 steps is no gain.
double gain_of(const TemporaryFolder& folder, const std::vector<std::string>& words) {
  const std::string table = folder.path("energy.csv");
  run_with(words, {"-q", "--out", table, "--columns", "energy.*"});
  std::ifstream file(table);
  std::string line;
  std::getline(file, line);
  std::vector<std::array<double, 4>> rows;  // time, kinetic, potential, elastic
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::array<double, 4> row{};
    char comma = 0;
    for (double& value : row) fields >> value >> comma;
    rows.push_back(row);
  }
  EXPECT_GT(rows.size(), 2U);
  double vivid = 0.0;
  double gain = 0.0;
  for (const auto& [time, kinetic, potential, elastic] : rows) {
    vivid = std::max(vivid, kinetic + elastic);
    const double first = rows[0][1] + rows[0][2] + rows[0][3];
    gain = std::max(gain, kinetic + potential + elastic - first);
  }
  return gain / vivid;
}

TEST(RunCertificate, AGainOfEnergyIsDoubtfulEvenIfSubstepsAreClean) {
  // Passive machines, which cannot gain energy. Whatever makes them do so, the run must say it, by
  // its status, its exit code and its certificate alike.
  const TemporaryFolder folder;
  int gains = 0;
  for (const char* name : {"light-slider", "long-step"}) {
    for (const char* substeps : {"1", "2", "8"}) {
      for (const char* solver : {"direct", "gauss-seidel"}) {
        const std::vector<std::string> words{fault_scene(name), "--substeps", substeps, "--solver",
                                             solver};
        SCOPED_TRACE(std::string(name) + " x " + substeps + " " + solver);
        const bool gained = gain_of(folder, words) > 0.01;
        gains += gained ? 1 : 0;
        const json summary = json::parse(run_with(words, {"--json"}).out);
        // A run that is ended by name, with exit code 75, says more than that.
        if (summary["status"] == "diverged") {
          EXPECT_EQ(run_with(words, {"--strict", "-q"}).exit_code, 75);
          continue;
        }
        const bool doubtful = summary["status"] == "doubtful";
        EXPECT_TRUE(doubtful || !gained);
        EXPECT_EQ(summary["certificate"]["clean"], !doubtful);
        EXPECT_EQ(run_with(words, {"--strict", "-q"}).exit_code, doubtful ? 76 : 0);
      }
    }
  }
  EXPECT_GT(gains, 0) << "otherwise this test tests nothing";
}

TEST(RunCertificate, AFeedPutsEnergyIn) {
  // A weight of 20 kg is wound up at 0.1 m/s: 19.6 J in 1 s.
  const TemporaryFolder folder;
  const std::string scene = folder.write("feed.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
    "bodies": [{"name": "m", "mobility": "slider", "axis": [0, 1, 0], "mass": 20, "position": [0, -1, 0],
                "shape": {"type": "sphere", "radius": 0.05}}],
    "cables": [{"name": "c", "links": [{"type": "attachment", "body": "world", "feed_speed": -0.1},
                                       {"type": "attachment", "body": "m"}]}]})json");
  const json summary = json::parse(run_with({scene, "--json"}, {}).out);
  EXPECT_EQ(summary["status"], "done");
  EXPECT_EQ(summary["warnings"], json::array()) << summary["warnings"];
  EXPECT_NEAR(summary["energy"]["max_drift"], 20.0 * 9.81 * 0.1, 0.2);
}

TEST(RunCertificate, TrustMovesTheLimit) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("drum.json", driven_drum);
  const json doubtful = json::parse(run_with({scene, "--json"}, {}).out);
  const double worst = doubtful["certificate"]["worst"]["relative"];
  const auto with = [&](double trust) {
    return run_with({scene, "--strict", "--trust", std::to_string(100.0 * trust) + "%"}, {});
  };
  EXPECT_EQ(with(1.01 * worst).exit_code, 0);
  EXPECT_EQ(with(0.99 * worst).exit_code, 76);
  for (const char* wrong : {"little", "-1%", "0", "1%%", "inf"}) {
    const ProcessResult refused = run_with({scene, "--trust", wrong}, {});
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_THAT(refused.err, HasSubstr("--trust")) << wrong;
  }
}

}  // namespace
}  // namespace sheave::test
