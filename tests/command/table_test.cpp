// The tables that sheave run writes: CSV and NumPy arrays.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/npy_file.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

struct Table : testing::Test {
  /// The table that a run with these options writes.
  std::string run(const std::string& name, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{"run", scene, "--quiet", "--out", folder.path(name)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessResult result = run_sheave(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(folder.path(name));
  }

  TemporaryFolder folder;
  std::string scene = folder.write("atwood.json", atwood_scene);
};

TEST_F(Table, CsvHasALineOfNamesAndARowPerStep) {
  const std::vector<std::string> lines = split(run("out.csv"), '\n');
  ASSERT_EQ(lines.size(), 102U);
  EXPECT_THAT(lines[0], testing::StartsWith("t,wheel.x,wheel.y,wheel.z,wheel.qw,"));
  EXPECT_THAT(lines[0], HasSubstr(",rope.0.tension,rope.0.length,rope.0.rest_length,"));
  EXPECT_THAT(lines[0], HasSubstr(",energy.total"));
  for (const std::string& line : lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','),
              std::count(lines[0].begin(), lines[0].end(), ','));
  }
  EXPECT_THAT(lines[1], testing::StartsWith("0,0,0,0,1,"));
  EXPECT_THAT(lines[1], HasSubstr(",,")) << "tensions at time 0 are missing values";
  EXPECT_THAT(lines[2], Not(HasSubstr(",,")));
  EXPECT_THAT(lines[2], testing::StartsWith("0.01,"));
  EXPECT_THAT(lines[101], testing::StartsWith("1,"));
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json", "out.csv"));
}

TEST_F(Table, NumbersAreTheShortestThatReadBack) {
  EXPECT_THAT(run("out.csv", {"--columns", "t"}), HasSubstr("\n0.07\n"));
}

/// Statistics count all steps, also those without a row: the light weight rises, so its lowest place
/// is that of the start, and its largest height that of the moment.
TEST_F(Table, ColumnsMayHaveStatisticsOverTime) {
  const std::vector<std::string> lines =
      split(run("out.csv", {"--every", "50", "--columns",
                            "light.y, max:light.y, max(light.y) - min(light.y), "
                            "light.y * /bodies/light/mass, drift:light.vy"}),
            '\n');
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0],
            "t,light.y,max:light.y,max(light.y) - min(light.y),light.y * /bodies/light/mass,"
            "drift:light.vy");
  const auto cells = [&](std::size_t row) {
    std::vector<double> numbers;
    for (const std::string& cell : split(lines[row], ',')) numbers.push_back(std::stod(cell));
    return numbers;
  };
  const std::vector<double> start = cells(1);
  const std::vector<double> end = cells(3);
  EXPECT_EQ(end[2], end[1]) << "it rises";
  EXPECT_EQ(end[3], end[1] - start[1]);
  EXPECT_GT(end[5], 0.0);
  const ProcessResult sampled = run_sheave({"statics", scene, "--quantity", "max(rope.0.tension)"});
  EXPECT_EQ(sampled.exit_code, 2);
  EXPECT_THAT(sampled.err, HasSubstr("has a statistic over time"));
}

TEST_F(Table, EveryNSteps) {
  const std::vector<std::string> lines =
      split(run("out.csv", {"--every", "25", "--columns", "t"}), '\n');
  EXPECT_THAT(lines, ElementsAre("t", "0", "0.25", "0.5", "0.75", "1"));
}

TEST_F(Table, ColumnsByNameAndPattern) {
  const std::vector<std::string> lines = split(
      run("out.csv", {"--columns", "rope.*.tension,light.y", "--columns", "energy.total"}), '\n');
  EXPECT_EQ(lines[0], "t,rope.0.tension,rope.1.tension,light.y,energy.total");
  const ProcessResult result =
      run_sheave({"run", scene, "--out", folder.path("bad.csv"), "--columns", "rope.0.tensoin"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("did you mean \"rope.0.tension\"?"));
}

// The wheel has I / r^2 = 2 kg: a = 2 m/s2, tensions 12 N and 16 N; the weights part by a t^2.
TEST_F(Table, ColumnsMayBeExpressions) {
  const std::vector<std::string> columns{"--columns",
                                         "light.y - heavy.y, hypot(light.vy, 0.0),'rope'.1.tension "
                                         "/ rope.0.tension,light.y - heavy.y"};
  const std::vector<std::string> lines = split(run("out.csv", columns), '\n');
  EXPECT_EQ(lines[0],
            "t,light.y - heavy.y,\"hypot(light.vy, 0.0)\",'rope'.1.tension / rope.0.tension");
  EXPECT_EQ(lines[1], "0,-2,0,") << "a quotient of tensions is unknown at the start";
  const NpyFile array = parse_npy(run("out.npy", columns));
  EXPECT_THAT(array.header, HasSubstr("('light.y - heavy.y', '<f8'), ('hypot(light.vy, 0.0)', "
                                      "'<f8'), (\"'rope'.1.tension / rope.0.tension\", '<f8')"));
  ASSERT_EQ(array.data.size(), 4U * 101U);
  for (std::size_t k = 1; k <= 100; ++k) {
    const double t = array.data[4 * k];
    // xpbd and rattle are exact for a steady acceleration but for a step of it.
    EXPECT_NEAR(array.data[4 * k + 1], -2.0 + 2.0 * t * t, 0.03) << t;
    EXPECT_NEAR(array.data[4 * k + 2], 2.0 * t, 1e-6) << t;
    EXPECT_NEAR(array.data[4 * k + 3], 16.0 / 12.0, 1e-6) << t;
  }
}

TEST_F(Table, FaultsOfExpressionsHaveTheirColumn) {
  const auto fault = [&](const std::string& columns) {
    const ProcessResult result =
        run_sheave({"run", scene, "--out", folder.path("bad.csv"), "--columns", columns});
    EXPECT_EQ(result.exit_code, 2) << columns;
    EXPECT_FALSE(std::filesystem::exists(folder.path("bad.csv")));
    return result.err;
  };
  EXPECT_THAT(fault("t,light.y + rope.0.tension"),
              HasSubstr("--columns: expression \"light.y + rope.0.tension\", column 9: + needs one "
                        "unit; \"light.y\" is in m, and \"rope.0.tension\" is in N"));
  EXPECT_THAT(fault("light.y - haevy.y"), HasSubstr("column 11: there is no quantity \"haevy.y\", "
                                                    "did you mean \"heavy.y\"?"));
  EXPECT_THAT(fault("rope.*.tensoin"), HasSubstr("no quantity matches \"rope.*.tensoin\""));
  EXPECT_THAT(fault("hypot(light.y"), HasSubstr("expected \",\" or \")\""));
  EXPECT_THAT(fault(std::string(2000, '(')), HasSubstr("at most 1000"));
  EXPECT_THAT(fault("light.y;"), HasSubstr("column 8"));
}

TEST_F(Table, ToStandardOutput) {
  const ProcessResult result = run_sheave({"run", scene, "--out", "-", "--columns", "t"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(split(result.out, '\n').size(), 102U) << "and no summary";
  EXPECT_EQ(run_sheave({"run", scene, "--out", "-", "--json"}).exit_code, 2);
}

TEST_F(Table, ALinkStaysALinkAndItsTargetIsReplaced) {
  std::filesystem::create_symlink("target.csv", folder.path("link.csv"));
  folder.write("target.csv", "old");
  run("link.csv", {"--columns", "t"});
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.csv")));
  EXPECT_EQ(split(read_file(folder.path("target.csv")), '\n').size(), 102U);
}

TEST_F(Table, FilesFollowTheUmask) {
  const mode_t old = ::umask(027);
  run("out.csv");
  ::umask(old);
  const auto permissions = std::filesystem::status(folder.path("out.csv")).permissions();
  EXPECT_EQ(static_cast<unsigned>(permissions), 0640U);
}

TEST_F(Table, NpyIsAStructuredArray) {
  const NpyFile array = parse_npy(run("out.npy", {"--columns", "light.y,rope.0.tension"}));
  EXPECT_THAT(array.header, testing::StartsWith("{'descr': [('t', '<f8'), ('light.y', '<f8'), "
                                                "('rope.0.tension', '<f8'), ], "
                                                "'fortran_order': False, 'shape': (101,), }"));
  ASSERT_EQ(array.data.size(), 3U * 101U);
  EXPECT_EQ(array.data[0], 0.0);
  EXPECT_TRUE(std::isnan(array.data[2])) << "tension at time 0";
  EXPECT_EQ(array.data[3], 0.01);
  EXPECT_EQ(array.data[300], 1.0);
}

TEST_F(Table, NpyOfThousandsOfColumnsHasALongHeader) {
  const std::string train = folder.path("train.json");
  ASSERT_EQ(run_sheave({"generate", "wheel-train", "--wheels", "250", "--out", train}).exit_code,
            0);
  const std::string file = folder.path("train.npy");
  const ProcessResult result =
      run_sheave({"run", train, "--steps", "2", "--iterations", "1", "--quiet", "--out", file});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("max_header_size"));
  const std::string bytes = read_file(file);
  EXPECT_EQ(bytes.at(6), 2) << "version 2.0";
  const NpyFile array = parse_npy(bytes);
  EXPECT_THAT(array.header, HasSubstr("'shape': (3,), }"));
}

TEST_F(Table, CsvAndNpyOfOneRunHoldTheSameNumbers) {
  const std::string npy = folder.path("out.npy");
  const std::vector<std::string> lines = split(run("out.csv", {"--out", npy}), '\n');
  const NpyFile array = parse_npy(read_file(npy));
  const std::vector<std::string> last = split(lines.back(), ',');
  ASSERT_EQ(array.data.size(), last.size() * 101U);
  for (std::size_t i = 0; i < last.size(); ++i) {
    EXPECT_EQ(std::stod(last[i]), array.data[last.size() * 100U + i]);
  }
}

}  // namespace
}  // namespace sheave::test
