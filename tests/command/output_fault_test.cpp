// Outputs that fail leave the others whole, keep what was written, and are named.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/npy_file.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> lines_of(const std::string& path) { return split(read_file(path), '\n'); }

TEST(DivergentRun, NamesTheFeature) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  // Velocities of a step of 1e-300 s are beyond the largest double.
  const ProcessResult result = run_sheave({"run", scene, "--json", "--dt", "1e-300"});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_THAT(result.err, HasSubstr("diverged: cables: the state is not finite"));
  EXPECT_THAT(result.err, Not(HasSubstr("memory")));
  const json divergence = json::parse(result.out)["divergence"];
  EXPECT_EQ(divergence["body"], json());
  EXPECT_EQ(divergence["feature"], "cables");
}

TEST(DivergentRun, OfTheEnergyAloneEndsBeforeTheRowIsWritten) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  // Of a speed that is finite the square is not.
  const ProcessResult result =
      run_sheave({"run", scene, "--json", "--set", "/bodies/1/mass=1e99", "--set",
                  "/bodies/1/force=[0,-1e240,0]", "--out", folder.path("a.csv")});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_THAT(result.err,
              HasSubstr("/bodies/1/mass is 1e+99: results are reliable for numbers from"));
  EXPECT_EQ(json::parse(result.out)["status"], "diverged");
  EXPECT_THAT(read_file(folder.path("a.csv")), Not(HasSubstr("inf")));
  EXPECT_THAT(read_file(folder.path("a.csv")), Not(HasSubstr("nan")));
  const ProcessResult checked =
      run_sheave({"validate", "-"},
                 {.input = read_file(scene).replace(read_file(scene).find("0.15"), 4, "1e49")});
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_THAT(checked.err, HasSubstr("/bodies/0/shape/length is 1e+49"));
}

TEST(Outputs, ATableThatFailsKeepsItsRowsAndLeavesTheOthersWhole) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string whole = folder.path("whole.csv");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--out", whole}).exit_code, 0);
  const std::string cut = folder.path("cut.csv");
  const std::string array = folder.path("cut.npy");
  const std::string state = folder.path("end.state");
  // A limit as `ulimit -f` sets it: larger than the state, smaller than the tables.
  const ProcessResult result =
      run_sheave({"run", scene, "--json", "--out", cut, "--out", array, "--save-state", state},
                 {.file_size_limit = 8000});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_EQ(result.signal, 0);
  EXPECT_THAT(result.err, HasSubstr("cut.csv: cannot write: File too large; its first "));
  EXPECT_THAT(result.err, HasSubstr("cut.npy: cannot write: File too large; its first "));
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary["steps"], 100);
  ASSERT_EQ(summary["outputs"].size(), 3U);
  EXPECT_EQ(summary["outputs"][2]["complete"], true);

  const std::string text = read_file(cut);
  EXPECT_THAT(read_file(whole), StartsWith(text)) << "rows that are there are the same";
  EXPECT_EQ(text.back(), '\n') << "and whole";
  EXPECT_GT(text.size(), 7000U) << "and as many as there was room for";
  EXPECT_EQ(summary["outputs"][0]["complete"], false);
  EXPECT_EQ(summary["outputs"][0]["rows"], lines_of(cut).size() - 1);
  const NpyFile npy = parse_npy(read_file(array));
  EXPECT_EQ(summary["outputs"][1]["rows"], npy.rows);
  EXPECT_EQ(npy.data.size(), npy.rows * npy.columns) << "the header tells what is there";
  EXPECT_EQ(npy.data.at(npy.columns), 0.01) << "the time of the second row";

  const ProcessResult next =
      run_sheave({"run", scene, "-q", "--load-state", state, "--steps", "1"});
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_THAT(folder.entries(),
              ElementsAre("atwood.json", "cut.csv", "cut.npy", "end.state", "whole.csv"));
}

TEST(Outputs, AFullDeviceLeavesTheTableBesideIt) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::filesystem::create_symlink("/dev/full", folder.path("full.csv"));
  const ProcessResult result = run_sheave(
      {"run", scene, "-q", "--out", folder.path("full.csv"), "--out", folder.path("good.csv")});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_THAT(result.err, HasSubstr("full.csv: cannot write: No space left on device"));
  EXPECT_EQ(lines_of(folder.path("good.csv")).size(), 102U);
}

TEST(Outputs, AClosedPipeEndsARunWithoutOtherOutputs) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  const ProcessResult result = run_sheave({"run", scene, "--out", "-"}, {.closed_stdout = true});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_THAT(result.err, HasSubstr("standard output: cannot write: Broken pipe"));
}

TEST(Outputs, AKilledRunLeavesANpyWithItsNumberOfRows) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  Process process({"run", scene, "--out", folder.path("out.npy")});
  // Reading all of a file that grows may never end.
  const auto left = [&](std::size_t most) -> std::string {
    for (const std::string& name : folder.entries()) {
      if (!name.starts_with(".out.npy.")) continue;
      std::string bytes(std::min<std::size_t>(most, std::filesystem::file_size(folder.path(name))),
                        ' ');
      std::ifstream file(folder.path(name), std::ios::binary);
      file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      return bytes;
    }
    return {};
  };
  const auto has_rows = [&] {
    const std::string bytes = left(1 << 16);
    return !bytes.empty() && parse_npy(bytes, false).rows > 1;
  };
  ASSERT_TRUE(process.wait_until(has_rows));
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  const NpyFile npy = parse_npy(left(std::string().max_size()), false);
  ASSERT_GT(npy.rows, 1U);
  ASSERT_GE(npy.data.size(), npy.rows * npy.columns) << "no row is promised that is not there";
  EXPECT_NEAR(npy.data.at((npy.rows - 1) * npy.columns), 0.01 * static_cast<double>(npy.rows - 1),
              1e-9 * static_cast<double>(npy.rows));
}

TEST(Outputs, ALinkToAFileThatIsNotYetThereStaysALink) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::filesystem::create_symlink("target.csv", folder.path("link.csv"));
  EXPECT_EQ(run_sheave({"run", scene, "-q", "--out", folder.path("link.csv")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.csv")));
  EXPECT_EQ(lines_of(folder.path("target.csv")).size(), 102U);
}

TEST(OutputPaths, NoOutputIsAnInput) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("self.json", atwood_scene);
  const std::string state = folder.path("a.state");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--save-state", state}).exit_code, 0);
  const std::string before = read_file(state);
  std::filesystem::create_hard_link(scene, folder.path("other.csv"));
  std::filesystem::create_symlink("self.json", folder.path("linked.csv"));
  const std::vector<std::vector<std::string>> commands{
      {"run", scene, "--save-state", scene},
      {"run", scene, "--out", folder.path("other.csv")},
      {"run", scene, "--out", folder.path("linked.csv")},
      {"run", scene, "--load-state", state, "--save-state", state},
      {"trade", scene, "--csv", scene},
      {"trade", scene, "--resume", scene},
      {"bench", "--compare", scene, "--save", scene}};
  for (const auto& command : commands) {
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 2) << command.back();
    EXPECT_THAT(result.err, HasSubstr("an input must not be overwritten"));
  }
  EXPECT_EQ(read_file(scene), atwood_scene);
  EXPECT_EQ(read_file(state), before);
}

TEST(OutputPaths, NoTwoOutputsAreOneFile) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::filesystem::create_symlink("new.csv", folder.path("link.csv"));
  const std::string path = folder.path("new.csv");
  const std::string same = folder.path("./new.csv");
  const std::string link = folder.path("link.csv");
  const std::vector<std::vector<std::string>> commands{
      {"run", scene, "--out", path, "--out", path},
      {"run", scene, "--out", path, "--out", same},
      {"run", scene, "--out", path, "--out", link},
      {"run", scene, "--out", path, "--save-state", same},
      {"run", scene, "--out", "-", "--out", "-"},
      {"trade", scene, "--csv", path, "--markdown", same}};
  for (const auto& command : commands) {
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 2) << command.back();
    EXPECT_THAT(result.err, testing::AnyOf(HasSubstr("each output needs a name of its own"),
                                           HasSubstr("already goes to standard output")));
  }
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json", "link.csv")) << "nothing was begun";
  // A device takes any number.
  EXPECT_EQ(
      run_sheave({"run", scene, "-q", "--out", "/dev/null", "--save-state", "/dev/null"}).exit_code,
      2)
      << "but a table needs its ending";
}

TEST(CommandLine, RefusesTextsThatAreNoNumbers) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string still = folder.path("a.png");
  const std::vector<std::vector<std::string>> commands{
      {"render", scene, "--still", still, "--at", "nan"},
      {"render", scene, "--still", still, "--at", "inf"},
      {"render", scene, "--video", folder.path("a.mp4"), "--fps", "nan"},
      {"render", scene, "--video", folder.path("a.mp4"), "--speed", "nan"},
      {"run", scene, "--dt", "nan"},
      {"run", scene, "--duration", "inf"},
      {"run", scene, "--trust", "nan"},
      {"trade", scene, "--minutes", "nan"},
      {"trade", scene, "--error", "nan%"},
      {"bench", "--reference-seconds", "nan"}};
  for (const auto& command : commands) {
    EXPECT_EQ(run_sheave(command).exit_code, 2) << command[0] << " " << command[command.size() - 2];
  }
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json"));
}

TEST(Messages, ShowNoControlCharactersOfNames) {
  const TemporaryFolder folder;
  // Red, a bell, a byte that is no UTF-8, and U+009B, which some terminals take for ESC [.
  const std::string name = "\x1b[31m\x07\xff\xc2\x9b.json";
  const ProcessResult missing = run_sheave({"run", folder.path(name)});
  EXPECT_EQ(missing.exit_code, 66);
  EXPECT_THAT(missing.err, HasSubstr("\\x1b[31m\\x07\\xff\\xc2\\x9b.json"));
  const std::string scene = folder.write(name, atwood_scene);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"validate", scene}, {"run", scene}}) {
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("\\x1b[31m"));
    for (const char* raw : {"\x1b", "\x07", "\xff", "\xc2\x9b"}) {
      EXPECT_THAT(result.out + result.err, Not(HasSubstr(raw)));
    }
  }
  // Letters of any alphabet are shown as they are.
  EXPECT_THAT(run_sheave({"run", folder.path("Seil\xc3\xbc")}).err, HasSubstr("Seil\xc3\xbc"));
}

}  // namespace
}  // namespace sheave::test
