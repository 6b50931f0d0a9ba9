// A run that checks its own numbers: what it prints, its status, --trust, --strict and exit code
// 76.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/process.h"
#include "tests/tools/scenes.h"

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

TEST(RunCertificate, ARunThatIsRightSaysHowWellItWasChecked) {
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
