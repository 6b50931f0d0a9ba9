// Tables of load cases, and the commands that read them.

#include "command/input/case_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using command::LoadCase;
using command::read_cases;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(CaseTable, ReadsCsvAsSpreadsheetsWriteIt) {
  const TemporaryFolder folder;
  const auto cases = read_cases(folder.write("loads.csv",
                                             "\xef\xbb\xbf"
                                             "case,load,/bodies/hoist effort/mass\r\n\"full, "
                                             "\"\"wet\"\"\",+.5,\r\n\r\nempty,direct,3\r\n"));
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].name, "full, \"wet\"");
  EXPECT_THAT(cases[0].values, ElementsAre(Pair("load", "0.5"))) << "an empty cell sets nothing";
  EXPECT_THAT(cases[1].values,
              ElementsAre(Pair("load", "direct"), Pair("/bodies/hoist effort/mass", "3")));
}

TEST(CaseTable, ReadsJsonWithValuesOfAnyKind) {
  const TemporaryFolder folder;
  const auto cases = read_cases(folder.write(
      "loads.json",
      R"([{"case": "a", "/bodies/x/position": [1, 2, 3], "load": "text"}, {"case": "b"}])"));
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_THAT(cases[0].values,
              ElementsAre(Pair("/bodies/x/position", "[1, 2, 3]"), Pair("load", "\"text\"")));
  EXPECT_TRUE(cases[1].values.empty()) << "the scene as it is";
}

TEST(CaseTable, RefusesEveryFaultWithItsLine) {
  const TemporaryFolder folder;
  const auto refused = [&](const char* name, const std::string& text, const char* message) {
    const std::string path = folder.write(name, text);
    try {
      (void)read_cases(path);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const command::Failure& failure) {
      EXPECT_EQ(failure.code(), command::ExitCode::bad_scene) << text;
      EXPECT_THAT(failure.what(), HasSubstr(path + ":"));
      EXPECT_THAT(failure.what(), HasSubstr(message)) << text;
    }
  };
  refused("a.csv", "", ":1:1: there is no line of names");
  refused("a.csv", "case,load\n", "the table has no case");
  refused("a.csv", "case;load\na;1\n", "separated by commas, not by semicolons");
  refused("a.csv", "name,load\na,1\n", "the first column must be \"case\"");
  refused("a.csv", "case\na\n", "there must be a second column");
  refused("a.csv", "case,load,load\na,1,2\n", "the column \"load\" is there twice");
  refused("a.csv", "case,\na,1\n", "column 2 has no name");
  refused("a.csv", "case,lo=ad\na,1\n", "must not contain =");
  refused("a.csv", "case,load\na,1\na,2\n", ":3:1: the case \"a\" is there twice");
  refused("a.csv", "case,load\na\n", ":2:1: 1 cells where the first line has 2 names");
  refused("a.csv", "case,load\n,1\n", ":2:1: the case has no name");
  refused("a.csv", "case,load\n\"a,1\n", ":2:1: a quote has no end");
  refused("a.json", "[", "syntax error");
  refused("a.json", "{}", "must be a list of cases");
  refused("a.json", "[]", "the table has no case");
  refused("a.json", "[1]", "must be an object");
  refused("a.json", "[\n{\"case\": 1}]", ":2:1: \"case\" must be a text");
  refused("a.json", R"([{"case": "a", "load": 1, "load": 2}])", "duplicate key");
  refused("a.json", std::string(1000, '['), "a.json:1:");
  std::string many = "case,load\n";
  for (std::size_t i = 0; i <= command::most_cases; ++i) many += std::to_string(i) + ",1\n";
  refused("a.csv", many, "at most 10000 cases");
  EXPECT_THROW((void)read_cases(folder.path("a.txt")), command::Failure);
  EXPECT_THROW((void)read_cases(folder.path("missing.csv")), command::Failure);
}

/// The tension of a tackle at rest is m g / n, with g = 10 m/s2.
TEST(CaseTable, EachCaseIsARowWithItsName) {
  const TemporaryFolder folder;
  const std::string table =
      folder.write("loads.csv", "case,load,parts\nlight,80,4\nheavy,800,4\nreeved,800,8\n");
  const std::vector<double> closed{200.0, 2000.0, 1000.0};
  const ProcessResult swept =
      run_sheave({"sweep", tackle_template, "--of", "statics", "--cases", table, "--measure",
                  "hoist rope.0.tension", "--json", "-q"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  const json rows = json::parse(swept.out)["rows"];
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2]["values"]["case"], "reeved");
  const ProcessResult listed = run_sheave({"statics", tackle_template, "--cases", table, "--json"});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  const json cases = json::parse(listed.out)["cases"];
  ASSERT_EQ(cases.size(), 3U);
  EXPECT_EQ(cases[1]["name"], "heavy");
  for (std::size_t i = 0; i < closed.size(); ++i) {
    // The search ends at a residual of 1e-11 of the largest force.
    EXPECT_NEAR(rows[i]["measured"]["hoist rope.0.tension"].get<double>(), closed[i],
                1e-9 * closed[i]);
    EXPECT_NEAR(cases[i]["quantities"]["max:hoist rope.tension"].get<double>(), closed[i],
                1e-9 * closed[i]);
  }
}

TEST(CaseTable, CasesAreCombinedWithVariedSettings) {
  const TemporaryFolder folder;
  const std::string table = folder.write("loads.csv", "case,load\nlight,80\nheavy,800\n");
  const std::vector<std::string> sweep{"sweep",     tackle_template,
                                       "--of",      "statics",
                                       "--cases",   table,
                                       "--vary",    "parts=2,4",
                                       "--measure", "hoist rope.0.tension",
                                       "--csv",     "-",
                                       "-q"};
  const ProcessResult result = run_sheave(sweep);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("run,case,parts,hoist rope.0.tension"));
  EXPECT_THAT(result.out, HasSubstr("\n3,heavy,4,"));
  const ProcessResult twice = run_sheave({"sweep", tackle_template, "--cases", table, "--vary",
                                          "load=1,2", "--measure", "hoist rope.0.tension"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("--vary load: is varied twice"));
}

TEST(CaseTable, TheJournalBelongsToItsTable) {
  const TemporaryFolder folder;
  const std::string table =
      folder.write("loads.csv", "case,load\nlight,80\nmiddle,90\nheavy,800\n");
  const std::vector<std::string> sweep{"sweep",     tackle_template,
                                       "--of",      "statics",
                                       "--cases",   table,
                                       "--measure", "hoist rope.0.tension",
                                       "--resume",  folder.path("a.sweep"),
                                       "-q"};
  ASSERT_EQ(run_sheave(sweep).exit_code, 0);
  EXPECT_THAT(run_sheave(sweep).err, HasSubstr("3 runs are known"));
  // The middle case is neither the first nor the last scene.
  folder.write("loads.csv", "case,load\nlight,80\nmiddle,91\nheavy,800\n");
  const ProcessResult other = run_sheave(sweep);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("belongs to another scene, plan"));
}

TEST(CaseTable, AFaultInACaseNamesTheCase) {
  const TemporaryFolder folder;
  const std::string table = folder.write("loads.csv", "case,load\nfine,80\nbroken,-3\n");
  const ProcessResult listed = run_sheave({"statics", tackle_template, "--cases", table});
  EXPECT_EQ(listed.exit_code, 65);
  EXPECT_THAT(listed.err, HasSubstr("case \"broken\": "));
  const ProcessResult swept = run_sheave({"sweep", tackle_template, "--of", "statics", "--cases",
                                          table, "--measure", "hoist rope.0.tension"});
  EXPECT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_THAT(swept.out, HasSubstr("run 1 (case = broken): "));
}

TEST(CaseTable, ACaseOfTheCommandLineMayHaveParameters) {
  const ProcessResult result = run_sheave(
      {"statics", tackle_template, "--case", "small:load=80;parts=4;/gravity=[0,-5,0]", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json one = json::parse(result.out)["cases"][0];
  EXPECT_NEAR(one["quantities"]["max:hoist rope.tension"].get<double>(), 100.0, 1e-7);
}

}  // namespace
}  // namespace sheave::test
