// sheave trade with tolerances among its settings, and with references of a tolerance.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string machines = std::string(SHEAVE_SOURCE_DIR) + "/";

/// With the direct solver, one repetition and time enough.
ProcessResult trade_within(const std::string& scene, std::vector<std::string> options) {
  for (const char* const word : {"--quiet", "--no-ladder", "--repetitions", "1", "--minutes", "1e6",
                                 "--solver", "direct", "--tangents", "iteration"}) {
    if (std::string(word) != "--quiet") options.emplace_back(word);
  }
  options.insert(options.begin(), {"trade", scene});
  return run_sheave(options);
}

/// The row of a setting.
json row_of(const json& table, const std::string& name) {
  for (const json& row : table["rows"]) {
    if (row["name"] == name) return row;
  }
  ADD_FAILURE() << name << " is no row of " << table.dump(1);
  return {};
}

std::string cheapest(const json& table, double error) {
  for (const json& level : table["cheapest"]) {
    if (level["error"] == error && level["row"].is_string()) return level["row"];
  }
  return "none";
}

// A weight lands and is lifted again: with fixed substeps each landing is late by a part of a substep,
// an error of first order. bench/TOLERANCE.md has 0.17 mm with 256 substeps against the closed form,
// and 0.044 mm with a tolerance of 0.1 mm. The machine is some 2 m large, so 0.01 % of it is 0.2 mm.
TEST(TradeTolerance, WinsWhereSomethingHappens) {
  const ProcessResult result =
      trade_within(machines + "bench/tolerance/lands.json",
                   {"--json", "--integrator", "rattle", "--substeps", "1,4,16,64", "--tolerance",
                    "1mm,0.1mm", "--error", "0.01%"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  ASSERT_EQ(table["rows"].size(), 6U);
  EXPECT_GT(table["reference"]["tolerance"], 0.0) << "fixed substeps do not find the landing";
  EXPECT_LT(table["reference"]["error"]["position"], 1e-5);
  // The closed form has 4.4e-5 m with a tolerance of 0.1 mm, which fixed substeps would hide.
  // The machine is 2 m to 4 m large, and the error is a root mean square over three bodies.
  EXPECT_GT(row_of(table, "direct within 0.0001 m, rattle")["error"]["position"],
            4.4e-5 / 4.0 / 2.0);
  EXPECT_THAT(cheapest(table, 1e-4), HasSubstr("direct within 0.00"));
  const json fixed = row_of(table, "direct 64, rattle");
  const json within = row_of(table, "direct within 0.0001 m, rattle");
  EXPECT_GT(fixed["error"]["position"], 1e-4);
  EXPECT_LT(within["error"]["position"], 1e-4);
  EXPECT_EQ(within["settings"]["tolerance"], 1e-4);
  EXPECT_FALSE(fixed["settings"].contains("tolerance"));
}

// Without events the error of rattle is of second order, and the best fixed number needs no more
// work. On the pendulum 16 substeps leave 6.6e-5 m (bench/TOLERANCE.md).
TEST(TradeTolerance, CostsNoLessThanFixedSubstepsInSmoothMotion) {
  const ProcessResult result = trade_within(
      machines + "scenes/analytic/pendulum.json",
      {"--json", "--integrator", "rattle", "--substeps", "4,8,16", "--tolerance", "0.1mm"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json table = json::parse(result.out);
  const json fixed = row_of(table, "direct 16, rattle");
  const json within = row_of(table, "direct within 0.0001 m, rattle");
  EXPECT_LT(fixed["error"]["position"], 1e-4);
  EXPECT_LT(within["error"]["position"], 1e-4);
  const double ratio = within["row_solves_per_simulated_second"].get<double>() /
                       fixed["row_solves_per_simulated_second"].get<double>();
  EXPECT_GT(ratio, 0.8);
  EXPECT_LT(ratio, 2.0);
}

TEST(TradeTolerance, ShowsItsSettingsInTextAndTables) {
  TemporaryFolder folder;
  const std::string csv = folder.path("trade.csv");
  const std::string chart = folder.path("trade.svg");
  const bool draws = std::system("gnuplot --version > /dev/null 2>&1") == 0;
  std::vector<std::string> options{"--substeps", "1,2", "--tolerance", "1%,0.1%",
                                   "--duration", "0.5", "--csv",       csv};
  if (draws) options.insert(options.end(), {"--chart", chart});
  const ProcessResult result =
      trade_within(machines + "scenes/analytic/pendulum.json", std::move(options));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("direct within"));
  EXPECT_THAT(read_file(csv), HasSubstr(",tolerance\n"));
  if (draws) {
    EXPECT_THAT(read_file(chart), HasSubstr("direct, rattle, tolerance"));
  }
}

TEST(TradeTolerance, IsWrittenIntoTheScene) {
  TemporaryFolder folder;
  const std::string path =
      folder.write("lands.json", read_file(machines + "bench/tolerance/lands.json"));
  const ProcessResult result =
      trade_within(path, {"--integrator", "rattle", "--substeps", "1", "--tolerance", "0.1mm",
                          "--error", "0.01%", "--apply"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(path), HasSubstr("\"tolerance\": 1e-04"));
}

TEST(TradeTolerance, RefusesOtherWords) {
  const std::string scene = machines + "scenes/analytic/pendulum.json";
  for (const char* const word : {"5furlong", "-1mm", "0", "nan", "none,1mm", ""}) {
    const ProcessResult result = trade_within(scene, {"--tolerance", word});
    EXPECT_EQ(result.exit_code, 2) << word;
  }
  EXPECT_THAT(trade_within(scene, {"--tolerance", "5furlong"}).err, HasSubstr("um, mm, cm or m"));
}

TEST(TradeTolerance, ResumesAReferenceOfATolerance) {
  TemporaryFolder folder;
  const std::string journal = folder.path("lands.trade");
  const std::vector<std::string> options{"--json", "--integrator", "rattle", "--substeps",
                                         "1",      "--tolerance",  "1mm",    "--resume",
                                         journal};
  const ProcessResult first = trade_within(machines + "bench/tolerance/lands.json", options);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProcessResult second = trade_within(machines + "bench/tolerance/lands.json", options);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const json a = json::parse(first.out);
  const json b = json::parse(second.out);
  EXPECT_EQ(a["reference"], b["reference"]);
  EXPECT_GT(b["reference"]["tolerance"], 0.0);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a["rows"][i]["error"], b["rows"][i]["error"]);
}

}  // namespace
}  // namespace sheave::test
