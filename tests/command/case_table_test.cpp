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
  refused("a.csv", "case,\na,1\n", ":1:6: column 2 has no name");
  refused("a.csv", "case,load\na,\"1,5\"\n",
          ":2:3: column \"load\": \"1,5\" is no number; decimals need a point: 1.5");
  refused("a.csv", "case,load\na,1,5\n", ":2:5: 3 cells where the first line has 2 names; a comma");
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

/// The frequency of a weight on a spring of 200 N/m is sqrt(k / m) / 2 pi.
TEST(CaseTable, ModesHaveATableOfCases) {
  const std::string scene = SHEAVE_SOURCE_DIR "/scenes/analytic/spring-oscillator.json";
  const std::vector<std::string> arguments{"modes",  scene,
                                           "--case", "light:/bodies/free weight/mass=4",
                                           "--case", "heavy:/bodies/free weight/mass=8"};
  const ProcessResult told = run_sheave(arguments);
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("mode 1 [Hz]"));
  EXPECT_THAT(told.out, HasSubstr("light"));
  std::vector<std::string> as_json = arguments;
  as_json.emplace_back("--json");
  const json cases = json::parse(run_sheave(as_json).out)["cases"];
  ASSERT_EQ(cases.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(cases[i]["name"], i == 0 ? "light" : "heavy");
    const double closed = std::sqrt(200.0 / (i == 0 ? 4.0 : 8.0)) / (2.0 * std::numbers::pi);
    // The stiffness comes from differences of forces, exact to about 1e-8.
    EXPECT_NEAR(cases[i]["modes"][0]["frequency"].get<double>(), closed, 1e-6 * closed);
  }
  std::vector<std::string> film = arguments;
  film.insert(film.end(), {"--still", "a.png"});
  EXPECT_EQ(run_sheave(film).exit_code, 2) << "a picture of which case?";
}

/// The same tackle as one case of each command: a parameter and a setting; the last one counts.
TEST(CaseTable, ACaseIsTheSceneWithItsSettings) {
  const std::string one = "full:load=800;parts=8;/duration=0.25";
  const ProcessResult run =
      run_sheave({"run", tackle_template, "--param", "load=10", "--case", one, "-q", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProcessResult plain = run_sheave({"run", tackle_template, "--param", "load=800", "--param",
                                          "parts=8", "--duration", "0.25", "-q", "--json"});
  EXPECT_EQ(json::parse(run.out)["state_hash"], json::parse(plain.out)["state_hash"]);
  const ProcessResult swept =
      run_sheave({"sweep", tackle_template, "--of", "statics", "--case", "light:load=80;parts=4",
                  "--case", one, "--measure", "hoist rope.0.tension", "--json", "-q"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  const json rows = json::parse(swept.out)["rows"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[1]["measured"]["hoist rope.0.tension"].get<double>(), 1000.0, 1e-6);
  EXPECT_EQ(run_sheave({"run", tackle_template, "--case", "full"}).exit_code, 2);
  EXPECT_EQ(run_sheave({"trade", tackle_template, "--case", "full"}).exit_code, 2);
  const ProcessResult twice =
      run_sheave({"statics", tackle_template, "--case", "a:load=1", "--case", "a:load=2"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("two cases have this name"));
}

/// A table has one prefix per column: 800 N and 80 kN, m g / 4, are 0.8 kN and 80 kN.
TEST(CaseTable, TablesHaveUnitsAndPrefixes) {
  const ProcessResult told =
      run_sheave({"statics", tackle_template, "--case", "light:load=320;parts=4", "--case",
                  "heavy:load=32000;parts=4"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("max:hoist rope.tension [kN]"));
  EXPECT_THAT(told.out, HasSubstr(" 0.8\n")) << told.out;
  EXPECT_THAT(told.out, HasSubstr(" 80\n")) << told.out;
  const std::string scene = SHEAVE_SOURCE_DIR "/scenes/analytic/spring-oscillator.json";
  const ProcessResult swept =
      run_sheave({"sweep", scene, "--of", "modes", "--vary",
                  "/joints/spring/compliance=0.002,0.005", "--measure", "frequency:1", "-q"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_THAT(swept.out, HasSubstr("/joints/spring/compliance [mm/N]"));
  EXPECT_THAT(swept.out, HasSubstr("frequency:1 [Hz]"));
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
