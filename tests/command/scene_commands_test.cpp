// sheave validate, schema, reference and generate.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ValidateCommand, PrintsOkPerScene) {
  const TemporaryFolder folder;
  const std::string a = folder.write("a.json", atwood_scene);
  const std::string b = folder.write("b.json", endless_scene);
  const ProcessResult result = run_sheave({"validate", a, b});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, a + ": ok\n" + b + ": ok\n");
  EXPECT_THAT(result.err, IsEmpty());
}

TEST(ValidateCommand, ListsAllFaultsOfAllScenes) {
  const TemporaryFolder folder;
  const std::string good = folder.write("good.json", atwood_scene);
  const std::string bad = folder.write("bad.json", R"({"format": "sheave-scene/1",
  "gravity": [0, 0], "duration": 0, "bodies": []})");
  const ProcessResult result = run_sheave({"validate", bad, folder.path("none.json"), good});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_EQ(result.out, good + ": ok\n");
  EXPECT_THAT(result.err, HasSubstr("bad.json:2:"));
  EXPECT_THAT(result.err, HasSubstr("/gravity"));
  EXPECT_THAT(result.err, HasSubstr("/duration"));
  EXPECT_THAT(result.err, HasSubstr("none.json"));
  EXPECT_EQ(run_sheave({"validate", folder.path("none.json"), good}).exit_code, 66);
}

TEST(ValidateCommand, ReadsStandardInput) {
  EXPECT_EQ(run_sheave({"validate", "-"}, {.input = atwood_scene}).exit_code, 0);
  const ProcessResult result = run_sheave({"validate", "-"}, {.input = "{"});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_THAT(result.err, HasSubstr("standard input:1:"));
}

TEST(SchemaCommand, IsJson) {
  const ProcessResult result = run_sheave({"schema"});
  EXPECT_EQ(result.exit_code, 0);
  const json schema = json::parse(result.out, nullptr, false);
  ASSERT_FALSE(schema.is_discarded());
  EXPECT_THAT(schema["$schema"].get<std::string>(), HasSubstr("draft-07"));
  EXPECT_EQ(schema["additionalProperties"], false);
}

TEST(ReferenceCommand, IsMarkdown) {
  const ProcessResult result = run_sheave({"reference"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out.front(), '#');
  EXPECT_THAT(result.out, HasSubstr("iterations"));
}

TEST(GenerateCommand, RoundTripThroughValidateAndRun) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"wheel-train", "--wheels", "5"},
        {"block-and-tackle", "--parts", "2"},
        {"hilbert", "--order", "1"},
        {"chain", "--links", "20"},
        {"naive-rope", "--cable", "true"}}) {
    const std::string scene = folder.path(options[0] + ".json");
    const ProcessResult made =
        run_sheave({"generate", options[0], options[1], options[2], "--out", scene});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, IsEmpty());
    EXPECT_EQ(run_sheave({"validate", scene}).exit_code, 0);
    const ProcessResult run = run_sheave({"run", scene, "--check"});
    EXPECT_EQ(run.exit_code, 0) << run.out;
  }
}

TEST(GenerateCommand, WritesToStandardOutputAndTheSameEachTime) {
  const ProcessResult first = run_sheave({"generate", "wheel-train", "--wheels", "3"});
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.out, run_sheave({"generate", "wheel-train", "--wheels", "3"}).out);
  EXPECT_EQ(run_sheave({"run", "-", "--quiet"}, {.input = first.out}).exit_code, 0);
}

TEST(GenerateCommand, WrongOptionsAreWrongUsage) {
  for (const char* wheels : {"0", "-3", "many", "1e9", "2.5"}) {
    const ProcessResult result = run_sheave({"generate", "wheel-train", "--wheels", wheels});
    EXPECT_EQ(result.exit_code, 2) << wheels;
    EXPECT_THAT(result.err, HasSubstr("--wheels")) << wheels;
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_EQ(run_sheave({"generate"}).exit_code, 2);
  const ProcessResult kind = run_sheave({"generate", "wheel-tran"});
  EXPECT_EQ(kind.exit_code, 2);
  EXPECT_THAT(kind.err, HasSubstr("did you mean \"wheel-train\"?"));
  EXPECT_EQ(run_sheave({"generate", "wheel-train", "--out", "/no/such/folder/a.json"}).exit_code,
            74);
}

}  // namespace
}  // namespace sheave::test
