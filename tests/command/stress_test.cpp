// sheave stress: maps as text, JSON, Markdown and charts; that a cell's command gives what the map
// says.

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Stress, ListsItsMaps) {
  const ProcessResult result = run_sheave({"stress", "--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("atwood: "));
  EXPECT_THAT(result.out, HasSubstr("spin: "));
}

TEST(Stress, PrintsTheScenesInTheProgram) {
  const ProcessResult result = run_sheave({"stress", "--print", "gym"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("\"format\": \"sheave-scene/1\""));
  const ProcessResult unknown = run_sheave({"stress", "--print", "foot"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("hand, gym, bow"));
}

TEST(Stress, JsonHasEveryCellAndItsCommand) {
  const ProcessResult result = run_sheave({"stress", "--quick", "--map", "atwood", "--solver",
                                           "direct", "--integrator", "rattle", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json object = json::parse(result.out);
  EXPECT_EQ(object["format"], "sheave-stress/1");
  ASSERT_EQ(object["maps"].size(), 1U);
  const json& map = object["maps"][0];
  EXPECT_EQ(map["cells"].size(), map["x"]["values"].size() * map["y"]["values"].size());
  for (const json& cell : map["cells"]) {
    EXPECT_EQ(cell["outcome"], "right") << cell;
    EXPECT_FALSE(cell["silent"]);
    EXPECT_THAT(cell["command"].get<std::string>(), HasSubstr("sheave generate wheel-train"));
  }
}

TEST(Stress, ReportsDivergedCellsOfAScene) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("runaway.json", runaway_scene);
  const ProcessResult result =
      run_sheave({"stress", scene, "--quick", "--map", "gravity", "--solver", "direct", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json object = json::parse(result.out);
  for (const json& map : object["maps"]) {
    for (const json& cell : map["cells"]) {
      EXPECT_EQ(cell["outcome"], "diverged");
      EXPECT_TRUE(cell["error"].is_null());
      EXPECT_FALSE(cell["silent"]);
      EXPECT_THAT(cell["detail"].get<std::string>(), HasSubstr("rocket"));
    }
  }
}

TEST(Stress, WritesMarkdownAndCharts) {
  const TemporaryFolder folder;
  const std::string page = folder.path("stress.md");
  std::vector<std::string> arguments{"stress", "--quick",      "--map", "spans",      "--solver",
                                     "direct", "--integrator", "xpbd",  "--markdown", page};
  const bool gnuplot = std::system("gnuplot --version > /dev/null 2>&1") == 0;
  if (gnuplot) arguments.insert(arguments.end(), {"--chart", folder.path("charts")});
  const ProcessResult result = run_sheave(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("spans"));
  EXPECT_THAT(read_file(page), HasSubstr("## spans, direct + xpbd"));
  EXPECT_EQ(read_file(page).find("charts/spans-direct-xpbd.png") != std::string::npos, gnuplot);
  if (!gnuplot) GTEST_SKIP() << "no gnuplot";
  EXPECT_THAT(read_file(folder.path("charts/spans-direct-xpbd.png")), HasSubstr("PNG"));
  EXPECT_THAT(read_file(folder.path("charts/spans-direct-xpbd.svg")), HasSubstr("</svg>"));
}

TEST(Stress, WrongUsage) {
  const ProcessResult map = run_sheave({"stress", "--map", "atwod"});
  EXPECT_EQ(map.exit_code, 2);
  EXPECT_THAT(map.err, HasSubstr("did you mean \"atwood\"?"));
  EXPECT_EQ(run_sheave({"stress", "--solver", "magic"}).exit_code, 2);
  EXPECT_EQ(run_sheave({"stress", "nowhere.json"}).exit_code, 66);
}

}  // namespace
}  // namespace sheave::test
