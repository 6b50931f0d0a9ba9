// `sheave run --rope-history`, `--rope-chart` and `--rope-life`.

#include <algorithm>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/csv.h"
#include "tests/command/process.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string bent_scene = SHEAVE_SOURCE_DIR "/scenes/analytic/rope-bends.json";

/// 1e6 bends at 20 kN and D/d = 50, a quarter if reverse.
const std::string rope_formulas = R"json({
  "format": "sheave-rope-life/1",
  "constants": {"S0": 20000},
  "definitions": {"load": "tension / 1[N] / S0", "bend": "50 * rope_diameter / sheave_diameter"},
  "simple_bends": "1000000 / (load^2 * bend)",
  "reverse_bends": "simple_bends / 4"
})json";

/// The rows of a table, by the names of their columns.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
  CsvReader reader(text);
  const auto names = std::get<std::vector<std::string>>(reader.names());
  std::vector<std::map<std::string, std::string>> rows;
  while (std::get<bool>(reader.next())) {
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = reader.cells()[i].text;
  }
  return rows;
}

TEST(RopeCommand, WritesATableThatAgreesWithTheJson) {
  const TemporaryFolder folder;
  const std::string life = folder.write("life.json", rope_formulas);
  const std::string csv = folder.path("ropes.csv");
  const std::string file = folder.path("ropes.json");
  const ProcessResult result =
      run_sheave({"run", bent_scene, "-q", "--rope-history", csv, "--rope-history", file,
                  "--rope-life", life, "--rope-diameter", "0.01", "--rope-sections", "50"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto rows = rows_of(read_file(csv));
  const json sections = json::parse(read_file(file))["cables"][0]["sections"];
  ASSERT_EQ(rows.size(), 50U);
  ASSERT_EQ(sections.size(), 50U);
  const auto number = [&](std::size_t i, const std::string& name) {
    return std::stod(rows[i].at(name));
  };
  int bent = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const json& section = sections[i];
    EXPECT_EQ(rows[i].at("cable"), "rope");
    EXPECT_EQ(number(i, "section"), static_cast<double>(i));
    EXPECT_EQ(number(i, "from [m]"), section["from"].get<double>());
    EXPECT_EQ(number(i, "to [m]"), section["to"].get<double>());
    EXPECT_EQ(number(i, "least_tension [N]"), section["least_tension"].get<double>());
    EXPECT_EQ(number(i, "mean_tension [N]"), section["mean_tension"].get<double>());
    EXPECT_EQ(number(i, "most_tension [N]"), section["most_tension"].get<double>());
    EXPECT_EQ(number(i, "tension_range [N]"),
              section["most_tension"].get<double>() - section["least_tension"].get<double>());
    EXPECT_EQ(number(i, "cycles"), section["cycles"]["count"].get<double>());
    EXPECT_EQ(number(i, "damage"), section["damage"].get<double>());
    int simple = 0;
    int reverse = 0;
    double least = 1e9;
    for (const json& one : section["bends"]) {
      const std::string link = "link" + std::to_string(one["link"].get<int>()) + ".";
      const int of_these = one["reverse"];
      EXPECT_EQ(number(i, link + "reverse_bends"), of_these);
      EXPECT_EQ(number(i, link + "simple_bends"), one["bends"].get<int>() - of_these);
      EXPECT_EQ(number(i, link + "D [m]"), one["diameter"].get<double>());
      EXPECT_EQ(number(i, link + "D/d"), one["diameter_ratio"].get<double>());
      EXPECT_EQ(number(i, link + "bend_tension [N]"), one["most_tension"].get<double>());
      simple += one["bends"].get<int>() - of_these;
      reverse += of_these;
      least = std::min(least, one["diameter"].get<double>());
    }
    EXPECT_EQ(number(i, "simple_bends"), simple);
    EXPECT_EQ(number(i, "reverse_bends"), reverse);
    if (section["bends"].empty()) {
      EXPECT_EQ(rows[i].at("least_D/d"), "") << "not bent: no ratio";
      continue;
    }
    ++bent;
    EXPECT_EQ(number(i, "least_D [m]"), least);
    EXPECT_NEAR(number(i, "least_D/d"), least / 0.01, 1e-9);
  }
  EXPECT_GT(bent, 20);
}

TEST(RopeCommand, TellsTheMostWornSection) {
  const TemporaryFolder folder;
  const std::string life = folder.write("life.json", rope_formulas);
  const std::string csv = folder.path("ropes.csv");
  const ProcessResult result = run_sheave({"run", bent_scene, "--json", "--rope-history", csv,
                                           "--rope-life", life, "--rope-diameter", "0.01"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json worn = json::parse(result.out)["rope_life"];
  ASSERT_EQ(worn.size(), 1U);
  double largest = 0.0;
  for (const auto& row : rows_of(read_file(csv))) {
    largest = std::max(largest, std::stod(row.at("damage")));
  }
  EXPECT_EQ(worn[0]["damage"].get<double>(), largest);
  EXPECT_EQ(worn[0]["repetitions"].get<double>(), 1.0 / largest);
  // One simple and two reverse bends, over D/d = 40 and 50, of at least 15.6 kN and at most 23.7 kN:
  // between (15.6 / 20)^2 x (1 + 2 x 4) and (23.7 / 20)^2 x (1 + 2 x 4) x 50 / 40 millionths.
  EXPECT_EQ(worn[0]["simple_bends"], 1);
  EXPECT_EQ(worn[0]["reverse_bends"], 2);
  EXPECT_GT(largest, 5.4e-6);
  EXPECT_LT(largest, 15.9e-6);
  const ProcessResult text =
      run_sheave({"run", bent_scene, "--rope-life", life, "--rope-diameter", "0.01"});
  EXPECT_THAT(text.out, HasSubstr("most worn section [m]"));
}

TEST(RopeCommand, ItsTableIsPlotted) {
  const TemporaryFolder folder;
  const std::string csv = folder.path("ropes.csv");
  ASSERT_EQ(run_sheave({"run", bent_scene, "-q", "--rope-history", csv}).exit_code, 0);
  const ProcessResult plot =
      run_sheave({"plot", csv, "-x", "from [m]", "-y", "simple_bends,most_tension [N]", "-o",
                  folder.path("plot.svg"), "--json"});
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const json series = json::parse(plot.out)["series"];
  EXPECT_EQ(series[0]["x"], "from");
  EXPECT_EQ(series[0]["points"], 100);
  EXPECT_EQ(series[0]["maximum"], 2.0);
  EXPECT_EQ(series[1]["quantity"], "most_tension");
  EXPECT_EQ(series[1]["unit"], "N");
  EXPECT_THAT(read_file(folder.path("plot.svg")), HasSubstr("from [m]"));
}

TEST(RopeCommand, DrawsTheRopeFromEndToEnd) {
  const TemporaryFolder folder;
  const std::string life = folder.write("life.json", rope_formulas);
  for (const char* name : {"ropes.svg", "ropes.png", "ropes.pdf"}) {
    const ProcessResult result =
        run_sheave({"run", bent_scene, "-q", "--rope-chart", folder.path(name), "--rope-life", life,
                    "--rope-diameter", "0.01"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(read_file(folder.path(name)).size(), 3000U);
  }
  const std::string svg = read_file(folder.path("ropes.svg"));
  for (const char* text : {"reverse bends", "tension [N]", "largest at a bend", "damage of the run",
                           "from its first end [m]"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(RopeCommand, WarnsWhereARunTellsNoLife) {
  const TemporaryFolder folder;
  const std::string life = folder.write("life.json", rope_formulas);
  const std::string none = folder.write(
      "none.json", R"({"format": "sheave-rope-life/1", "simple_bends": "1 - tension / 1[N]"})");
  const auto run = [&](const std::string& formulas, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "run",  bent_scene,        "--rope-life", formulas, "--rope-diameter",
        "0.01", "--rope-sections", "30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sheave(arguments);
  };
  const ProcessResult half = run(life, {"--duration", "2"});
  EXPECT_EQ(half.exit_code, 0);
  EXPECT_THAT(half.err, HasSubstr("cable \"rope\": the rope does not end where it began"));
  const ProcessResult unknown = run(none, {});
  EXPECT_EQ(unknown.exit_code, 0);
  EXPECT_THAT(unknown.err, HasSubstr("no positive number for a bend of the section from"));
  EXPECT_THAT(unknown.out, HasSubstr("unknown"));
  const std::string belt = SHEAVE_SOURCE_DIR "/scenes/analytic/belt.json";
  const ProcessResult closed =
      run_sheave({"run", belt, "-q", "--rope-life", life, "--rope-diameter", "0.01"});
  EXPECT_THAT(closed.err, HasSubstr("the cable is closed, cut or has touched a wrappable body"));
  const ProcessResult chart =
      run_sheave({"run", belt, "-q", "--rope-chart", folder.path("belt.svg")});
  EXPECT_EQ(chart.exit_code, 2);
  EXPECT_THAT(chart.err, HasSubstr("no cable has sections to draw"));
}

TEST(RopeCommand, RefusesOptionsThatDoNotFit) {
  const TemporaryFolder folder;
  const std::string life = folder.write("life.json", rope_formulas);
  struct Case {
    std::vector<std::string> options;
    int exit_code;
    std::string message;
  };
  const std::vector<Case> cases{
      {{"--rope-diameter", "0.01"}, 2, "need --rope-history, --rope-chart or --rope-life"},
      {{"--rope-life", life}, 2, "--rope-life needs --rope-diameter"},
      {{"--rope-chart", folder.path("a.txt")}, 2, "must end in .png, .svg or .pdf"},
      {{"--rope-history", life, "--rope-life", life, "--rope-diameter", "1"}, 2, "--rope-life"},
      {{"--rope-life", folder.path("no.json"), "--rope-diameter", "1"}, 66, "no.json"},
      {{"--rope-life", bent_scene, "--rope-diameter", "1"}, 65, "sheave-rope-life/1"},
      {{"--rope-life",
        folder.write("bad.json",
                     "{\"format\": \"sheave-rope-life/1\",\n \"simple_bends\": \"tension\"}"),
        "--rope-diameter", "1"},
       65,
       "bad.json:2:18: /simple_bends: the number of bends must be a pure number"},
      {{"--rope-life",
        folder.write("key.json",
                     R"({"format": "sheave-rope-life/1", "simple_bend": "1", "simple_bends": 1})"),
        "--rope-diameter", "1"},
       65,
       "did you mean \"simple_bends\"?"}};
  for (const Case& one : cases) {
    std::vector<std::string> arguments{"run", bent_scene, "-q"};
    arguments.insert(arguments.end(), one.options.begin(), one.options.end());
    const ProcessResult result = run_sheave(arguments);
    EXPECT_EQ(result.exit_code, one.exit_code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(one.message));
  }
}

}  // namespace
}  // namespace sheave::test
