// What validate tells programs: codes, places, values.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/fault_code.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;

json validated(const std::vector<std::string>& paths, int exit_code) {
  std::vector<std::string> arguments{"validate", "--json"};
  arguments.insert(arguments.end(), paths.begin(), paths.end());
  const ProcessResult result = run_sheave(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_EQ(result.err, "");
  const json object = json::parse(result.out);
  EXPECT_EQ(object["format"], "sheave-validation/1");
  return object["scenes"];
}

TEST(ValidateJson, ReportsEachFaultWithCodePlaceAndValue) {
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.json", R"({
  "format": "sheave-scene/1", "gravity": [0, "down", 0], "duration": -1,
  "bodies": [{"name": "a b\u0007", "mas": 1, "mobility": "planer", "shape": {"type": "sphere", "radius": 1}},
             {"name": "c", "mass": 1, "shape": {"type": "sphere"}},
             {"name": "c", "mass": 1, "mass": 2, "shapes": [], "shape": {"type": "sphere", "radius": 1}}],
  "cables": [{"name": "r", "links": [{"type": "attachment", "body": "d"}, {"type": "attachment", "body": "c"}]}]
})");
  const std::string good = folder.write("good.json", atwood_scene);
  const json scenes = validated({good, bad, folder.path("none.json")}, 65);
  ASSERT_EQ(scenes.size(), 3U);
  EXPECT_EQ(scenes[0], json({{"path", good},
                             {"valid", true},
                             {"faults", json::array()},
                             {"warnings", json::array()}}));
  std::vector<std::string> found;
  for (const json& fault : scenes[1]["faults"]) {
    EXPECT_EQ(fault["severity"], "error");
    EXPECT_TRUE(fault["line"].is_number_integer() && fault["column"].is_number_integer());
    found.push_back(fault["code"].get<std::string>() + " " + fault["pointer"].get<std::string>());
  }
  EXPECT_THAT(found, testing::UnorderedElementsAre(
                         "wrong-type /gravity/1", "out-of-range /duration",
                         "bad-name /bodies/0/name", "unknown-key /bodies/0/mas",
                         "unknown-choice /bodies/0/mobility", "missing-key /bodies/1/shape/radius",
                         "duplicate-name /bodies/2/name", "duplicate-key /bodies/2/mass",
                         "exclusive-keys /bodies/2/shapes", "unknown-body /cables/0/links/0/body"));
  const json& duration = scenes[1]["faults"][1];
  EXPECT_EQ(duration["line"], 2);
  EXPECT_EQ(duration["column"], 70);
  EXPECT_EQ(duration["value"], "-1");
  EXPECT_EQ(duration["allowed"], "> 0 [s]");
  EXPECT_EQ(scenes[2]["faults"][0]["code"], "not-found");
  EXPECT_EQ(scenes[2]["faults"][0]["line"], json());
}

TEST(ValidateJson, ReportsTextsThatAreNoJson) {
  const TemporaryFolder folder;
  const auto code = [&](const std::string& text) {
    const json scenes = validated({folder.write("a.json", text)}, 65);
    return scenes[0]["faults"][0]["code"].get<std::string>();
  };
  EXPECT_EQ(code("{\"a\": }"), "syntax");
  EXPECT_EQ(code("// \xff\n{}"), "encoding");
  EXPECT_EQ(code(std::string("\xff\xfe{\0}\0", 6)), "encoding");
  EXPECT_EQ(code("{\"duration\": 1e999}"), "number-range");
  EXPECT_EQ(code(std::string(100, '[')), "too-large");
  EXPECT_EQ(code(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
                    "bodies": [{"name": "a", "mass": 1}]})"),
            "meaning");
  EXPECT_EQ(validated({"/"}, 74)[0]["faults"][0]["code"], "unreadable");
}

TEST(ValidateJson, ReportsWarningsWithTheirPlace) {
  const TemporaryFolder folder;
  std::string text = atwood_scene;
  text.replace(text.find("\"mass\": 4"), 9, "\"mass\": 1e99");
  const json scenes = validated({folder.write("a.json", text)}, 0);
  EXPECT_EQ(scenes[0]["valid"], true);
  ASSERT_EQ(scenes[0]["warnings"].size(), 1U);
  const json& warning = scenes[0]["warnings"][0];
  EXPECT_EQ(warning["code"], "magnitude");
  EXPECT_EQ(warning["severity"], "warning");
  EXPECT_EQ(warning["pointer"], "/bodies/0/mass");
  EXPECT_EQ(warning["line"], 8);
  EXPECT_EQ(warning["value"], "1e99");
}

// Programs rely on these: a line may be added, none may change or go.
TEST(ValidateJson, CodesNeverChange) {
  std::vector<std::string> names;
  for (const CodeEntry& entry : code_table()) names.emplace_back(entry.code);
  EXPECT_THAT(names, ElementsAre("not-found", "unreadable", "too-large", "encoding", "syntax",
                                 "number-range", "duplicate-key", "unknown-key", "missing-key",
                                 "exclusive-keys", "wrong-type", "out-of-range", "unknown-choice",
                                 "unknown-body", "bad-name", "duplicate-name", "bad-pointer",
                                 "meaning", "magnitude", "crossed-winding"));
  EXPECT_EQ(code_name(FaultCode::meaning), "meaning");
}

}  // namespace
}  // namespace sheave::test
