// sheave new and sheave explain: scenes that run at once, and sentences that are true.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/jsonnet/evaluate.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The text of `sheave explain` of a shipped scene, or of another file.
std::string explained(const std::string& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{
      "explain", scene.starts_with('/') ? scene : SHEAVE_SOURCE_DIR "/scenes/" + scene};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProcessResult result = run_sheave(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

class Starters : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!jsonnet::is_available()) GTEST_SKIP() << "built without libjsonnet";
  }
};
INSTANTIATE_TEST_SUITE_P(All, Starters, testing::Values("crane", "elevator", "hand", "robot"));

TEST_P(Starters, RunAtOnceWithACleanCertificateAndTrueChecks) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("scene.jsonnet");
  const ProcessResult made = run_sheave({"new", GetParam(), "-o", scene});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const ProcessResult run = run_sheave({"run", scene, "--check", "--strict"});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_THAT(run.err, Not(HasSubstr("warning"))) << run.err;
}

TEST_P(Starters, AreExplainedWithoutASuspicion) {
  const TemporaryFolder folder;
  const ProcessResult made = run_sheave({"new", GetParam()});
  const std::string scene = folder.write("scene.jsonnet", made.out);
  EXPECT_THAT(explained(scene), HasSubstr("Nothing looks like a mistake."));
}

TEST(NewCommand, NamesTheKindsThatThereAre) {
  const ProcessResult wrong = run_sheave({"new", "bridge"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(run_sheave({"new"}).exit_code, 2);
  // The command reads other names as JSON.
  const ProcessResult misnamed = run_sheave({"new", "crane", "-o", "crane.json"});
  EXPECT_EQ(misnamed.exit_code, 2);
  EXPECT_THAT(misnamed.err, HasSubstr("ends with .jsonnet"));
  const ProcessResult elsewhere =
      run_sheave({"new", "crane", "-o", "/no/such/folder/crane.jsonnet"});
  EXPECT_EQ(elsewhere.exit_code, 74);
}

TEST(NewCommand, KeepsAFileThatExists) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("crane.jsonnet", "// edited\n");
  const ProcessResult again = run_sheave({"new", "crane", "-o", scene});
  EXPECT_EQ(again.exit_code, 74);
  EXPECT_THAT(again.err, HasSubstr("exists"));
  EXPECT_EQ(read_file(scene), "// edited\n");
}

// A cube of 1 m at the origin and one of 8 m3 at x = 4.5 m: the centre is at 8/9 of 4.5 m.
TEST(ExplainCommand, TellsTheCentreThatShapesGive) {
  const TemporaryFolder folder;
  const auto scene_with = [&](const std::string& given) {
    return folder.write("scene.json", R"({
      "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
      "bodies": [{"name": "two", "mass": 9, )" +
                                          given + R"("shapes": [
        {"type": "box", "size": [1, 1, 1]},
        {"type": "box", "size": [2, 2, 2], "position": [4.5, 0, 0]}]}]})");
  };
  EXPECT_THAT(explained(scene_with("")),
              HasSubstr("9 kg, its centre of mass, by its shapes, at (4, 0, 0) of the body"));
  const std::string given = R"("center_of_mass": [0, 0, 0], "inertia": [1, 1, 1], )";
  EXPECT_THAT(explained(scene_with(given)), Not(HasSubstr("by its shapes")));
}

// n parts of rope: a metre of the block takes n metres of rope, and the effort is n times as fast.
TEST(ExplainCommand, TellsTheRatioOfATackle) {
  for (const char* parts : {"2", "4", "6", "8"}) {
    const std::string name = std::string("analytic/block-and-tackle-") + parts + ".json";
    EXPECT_THAT(explained(name), AllOf(HasSubstr(std::string(parts) + " m per metre of "),
                                       HasSubstr(std::string(parts) + " times that of ")))
        << name;
  }
}

// The radius of the drum is the length per radian; a hook on two parts moves by half of it.
TEST(ExplainCommand, TellsTheRatioOfAWinch) {
  if (!jsonnet::is_available()) GTEST_SKIP() << "built without libjsonnet";
  const TemporaryFolder folder;
  const std::string scene = folder.write("crane.jsonnet", run_sheave({"new", "crane"}).out);
  EXPECT_THAT(explained(scene),
              AllOf(HasSubstr("\"winch\" winds 0.2 m of it per radian"),
                    HasSubstr("moves by 0.1 m per radian of \"winch\""),
                    HasSubstr("over \"head sheave\" on its right"),
                    HasSubstr("over \"hook sheave 1\" on its left by 180 degrees")));
}

TEST(ExplainCommand, CountsDegreesOfFreedom) {
  EXPECT_THAT(explained("analytic/double-pendulum.json"), HasSubstr("leave 2 of them"));
  EXPECT_THAT(explained("analytic/four-bar.json"), HasSubstr("leave 1 of them"));
  // Two weights and a wheel, and a rigid cable that rolls: one motion.
  EXPECT_THAT(explained("analytic/atwood.json"),
              AllOf(HasSubstr("3 degrees of freedom"), HasSubstr("one motion is left")));
}

// e^(friction x angle): half a turn more by each turn.
TEST(ExplainCommand, TellsWhereACableSlides) {
  EXPECT_THAT(explained("analytic/capstan-1-turns.json"), HasSubstr("it slides once one tension"));
  EXPECT_THAT(explained("analytic/massless-tackle.json"),
              HasSubstr("the tension is the same on both sides"));
}

// A rope with weight is longer than its chord and not slack.
TEST(ExplainCommand, LetsRopesWithWeightHang) {
  const std::string text = explained("analytic/hanging-ropes.json");
  EXPECT_THAT(text, AllOf(HasSubstr("101 m lie free"), Not(HasSubstr("slack"))));
}

TEST(ExplainCommand, NamesWhatLooksLikeAMistake) {
  const TemporaryFolder folder;
  std::string text = atwood_scene;
  const std::string bodies = "\"bodies\": [";
  text.replace(
      text.find(bodies), bodies.size(),
      bodies +
          R"({"name": "lost", "mass": 1, "shape": {"type": "sphere", "radius": 1}}, {"name": "idle", "mobility": "rotor",
                          "mass": 1, "shape": {"type": "cylinder", "radius": 1, "length": 1}},)");
  const std::string rope = "{\"name\": \"rope\", ";
  text.replace(text.find(rope), rope.size(), rope + "\"axial_stiffness\": 1e5, ");
  EXPECT_THAT(explained(folder.write("scene.json", text)),
              AllOf(HasSubstr("\"lost\" has no joint, no cable and no contact"),
                    HasSubstr("\"idle\" has no cable, no joint and no drive"),
                    HasSubstr("\"rope\" starts without stretch")));
}

TEST(ExplainCommand, RefusesABadScene) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_sheave({"explain", folder.write("bad.json", "{")}).exit_code, 65);
  EXPECT_EQ(run_sheave({"explain", folder.path("none.json")}).exit_code, 66);
}

}  // namespace
}  // namespace sheave::test
