// bench/tables/report: one scene from measurement to page, and what the page makes of given numbers.

#include <cstdlib>
#include <filesystem>
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
using testing::Not;

const std::string tables_folder = SHEAVE_SOURCE_DIR "/bench/tables";

bool has_python() { return std::system("python3 --version > /dev/null 2>&1") == 0; }

json report_row(const std::string& name, const std::string& solver, const std::string& integrator,
                double seconds, double error, double solves) {
  return {
      {"name", name},
      {"settings", {{"dt", 0.01}, {"substeps", 1}, {"solver", solver}, {"integrator", integrator}}},
      {"timed_alone", true},
      {"seconds_per_simulated_second",
       {{"median", seconds},
        {"lower_quartile", 0.9 * seconds},
        {"upper_quartile", 1.1 * seconds},
        {"samples", 5}}},
      {"row_solves_per_simulated_second", solves},
      {"error", {{"position", error}, {"tension", nullptr}}}};
}

json report_result(const json& rows) {
  return {{"version", "1"},
          {"machine", {{"cpu", "abacus"}, {"compiler", "hand"}}},
          {"simulated_seconds", 2.0},
          {"compared_seconds", 2.0},
          {"motion", 0.02},
          {"reference",
           {{"integrator", "rattle"},
            {"substeps", 64},
            {"chaos_rate", nullptr},
            {"error_compared", {{"position", 1e-6}}}}},
          {"limits", json::array()},
          {"rows", rows},
          {"ladder", {{"skipped", "takes about 9 s, and 1 s are left"}}}};
}

/// What bench/tables/report_page.py writes about these results.
std::string page_of(const TemporaryFolder& folder, const json& results,
                    const std::string& others = "/nowhere") {
  const std::string input = folder.write("results.json", results.dump());
  const std::string output = folder.path("page.md");
  const std::string script =
      "import json, sys; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1]); "
      "import report_page; open(sys.argv[3], 'w').write(report_page.page("
      "json.load(open(sys.argv[2])), ['machine'], sys.argv[4]))";
  const std::string command =
      "python3 -c \"" + script + "\" " + tables_folder + " " + input + " " + output + " " + others;
  EXPECT_EQ(std::system(command.c_str()), 0);
  return read_file(output);
}

TEST(Report, ExplainsTheRatioFromTheNumbers) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  const TemporaryFolder folder;
  // 1 ms with 1000 solves of 1000 ns against 10 ms with 40000 of 250 ns.
  const json rows{report_row("direct 1, rattle", "direct", "rattle", 1e-3, 1e-5, 1e3),
                  report_row("gauss-seidel 4 x 10", "gauss-seidel", "xpbd", 1e-2, 5e-4, 4e4),
                  report_row("gauss-seidel 1 x 1", "gauss-seidel", "xpbd", 1e-4, 5e-3, 1e3)};
  const std::string page = page_of(folder, {{"machine", report_result(rows)}});
  EXPECT_THAT(page, HasSubstr("| machine | size | direct 1, rattle | 1.0e-05 | 1.00 | 1e+03 | "
                              "gauss-seidel 4 x 10 | 5.0e-04 | 10.0 | 4e+04 | 10.0 |"));
  EXPECT_THAT(page,
              HasSubstr("10.0 times less time, with 40.0 times fewer row solves at 1000 ns each "
                        "instead of 250 ns"));
  // Of a motion of 2 % of the size 0.1 % is 2e-5: only the direct solver's 1.1e-5 is within.
  EXPECT_THAT(page,
              HasSubstr("| machine | motion (2.0e-02 of the size) | direct 1, rattle | 1.0e-05 "
                        "| 1.00 | 1e+03 | gauss-seidel 4 x 10 (none is within) |"));
  EXPECT_THAT(page, HasSubstr("relative to their motion errors are 50.0 times as large"));
  EXPECT_THAT(page, HasSubstr("Not 20 times: a solve of the direct solver"));
  EXPECT_THAT(page, HasSubstr("takes 4.00 times as long"));
  EXPECT_THAT(page, Not(HasSubstr("already accurate enough")));
  EXPECT_THAT(page, HasSubstr("| 1 % | gauss-seidel 1 x 1 | 0.00100 | 0.100 |"));
  EXPECT_THAT(page, HasSubstr("| 0.1 % | direct 1, rattle |"));
  EXPECT_THAT(page, HasSubstr("Model ladder: takes about 9 s"));
  EXPECT_THAT(page, HasSubstr("not made yet, `dev/soak`"));
}

TEST(Report, ReportsScenesWithoutASufficientSetting) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  const TemporaryFolder folder;
  json rows{report_row("direct 1, rattle", "direct", "rattle", 1e-3, 1e-5, 1e3),
            report_row("gauss-seidel 4 x 10", "gauss-seidel", "xpbd", 1e-2, 2e-3, 4e4)};
  json skipped = report_row("gauss-seidel 8 x 10", "gauss-seidel", "xpbd", 0.0, 0.0, 0.0);
  skipped.erase("error");
  skipped["skipped"] = "takes about 80 s, and 20 s are left";
  rows.push_back(skipped);
  json diverged = skipped;
  diverged.erase("skipped");
  diverged["fault"] = "diverged";
  rows.push_back(diverged);
  const std::string page =
      page_of(folder, {{"machine", report_result(rows)}, {"lost", {{"fault", "exit code 75"}}}});
  EXPECT_THAT(page, HasSubstr("gauss-seidel 4 x 10 (none is within) | 2.0e-03 | 10.0 | 4e+04 | "
                              "more than 10.0 |"));
  EXPECT_THAT(page,
              HasSubstr("still wrong by 2.0e-03 of the size; 1 more expensive ones were skipped"));
  EXPECT_THAT(page,
              HasSubstr("times as large; 1 of 4 settings failed; 1 of 4 settings were skipped"));
  EXPECT_THAT(page, HasSubstr("lost: not measured: exit code 75"));
}

TEST(Report, SumsUpTheStabilityPage) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  const TemporaryFolder folder;
  folder.write("STRESS.md",
               "# Stability\n\n| map | setting | cells | worst error | wrong | silent |\n"
               "| --- | --- | --- | --- | --- | --- |\n"
               "| atwood | direct + xpbd | 91 | 2.5e-05 | - | - |\n"
               "| train | direct + xpbd | 9 | **4.0e+00** | 53 | 2 |\n"
               "| train | direct + rattle | 9 | 1.0e-06 | - | - |\n");
  const std::string page = page_of(folder, json::object(), folder.path(""));
  EXPECT_THAT(page, HasSubstr("[STRESS.md](STRESS.md)"));
  EXPECT_THAT(page, HasSubstr("| setting | cells | wrong | silent |"));
  EXPECT_THAT(page, HasSubstr("| direct + xpbd | 100 | 53 | 2 |"));
  EXPECT_THAT(page, HasSubstr("| direct + rattle | 9 | - | - |"));
}

TEST(Report, MeasuresASceneOnce) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  const TemporaryFolder folder;
  const std::string scene = folder.write("weights.json", atwood_scene);
  const std::string command = "python3 -B " + tables_folder +
                              "/report --sheave " SHEAVE_COMMAND " --scenes " + scene +
                              " --minutes 1e6 --out " + folder.path("out") + " --cache " +
                              folder.path("cache") + " 2> " + folder.path("log");
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(folder.path("log"));
  EXPECT_THAT(read_file(folder.path("log")), HasSubstr("1 of 1: weights"));
  const std::string page = read_file(folder.path("out/REPORT.md"));
  EXPECT_THAT(page, HasSubstr("# Speed against accuracy"));
  EXPECT_THAT(page, HasSubstr("![Errors over times of weights](report/weights.svg)"));
  EXPECT_THAT(page, HasSubstr("rotors as bodies with hinges"));
  EXPECT_THAT(read_file(folder.path("out/report/weights.svg")), HasSubstr("</svg>"));
  // The second time there is nothing to measure, and the page is the same.
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(read_file(folder.path("log")), Not(HasSubstr("1 of 1")));
  EXPECT_EQ(read_file(folder.path("out/REPORT.md")), page);
}

}  // namespace
}  // namespace sheave::test
