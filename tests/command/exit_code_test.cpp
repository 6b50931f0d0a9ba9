// Exit codes, messages and what is left on disk when things go wrong.

#include <csignal>
#include <filesystem>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(ExitCode, HelpAndVersionSucceed) {
  EXPECT_THAT(run_sheave({"--version"}).out, StartsWith("sheave "));
  EXPECT_EQ(run_sheave({"--version"}).exit_code, 0);
  EXPECT_THAT(run_sheave({"--help"}).out, HasSubstr("validate"));
  for (const char* name :
       {"run", "live", "render", "bench", "validate", "generate", "schema", "reference"}) {
    const ProcessResult result = run_sheave({name, "--help"});
    EXPECT_EQ(result.exit_code, 0) << name;
    EXPECT_THAT(result.out, HasSubstr("Example")) << name;
    EXPECT_THAT(result.out, HasSubstr(std::string("sheave ") + name)) << name;
    EXPECT_THAT(result.err, IsEmpty()) << name;
  }
}

TEST(ExitCode, WrongUsageIs2WithASuggestion) {
  EXPECT_EQ(run_sheave({}).exit_code, 2);
  EXPECT_EQ(run_sheave({"run"}).exit_code, 2);
  EXPECT_EQ(run_sheave({"run", "a.json", "--every", "0", "--out", "a.csv"}).exit_code, 2);
  const ProcessResult subcommand = run_sheave({"rnu", "a.json"});
  EXPECT_EQ(subcommand.exit_code, 2);
  EXPECT_THAT(subcommand.err, HasSubstr("did you mean \"run\"?"));
  const ProcessResult option = run_sheave({"run", "a.json", "--itertions", "3"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_THAT(option.err, HasSubstr("did you mean \"--iterations\"?"));
}

TEST(ExitCode, BadSceneIs65WithAllFaults) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("bad.json", R"({
  "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": -1,
  "bodies": [{"name": "a", "mas": 1, "shape": {"type": "sphere", "radius": -2}}]
})");
  const ProcessResult result = run_sheave({"run", scene});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("bad.json:2:"));
  EXPECT_THAT(result.err, HasSubstr("/duration"));
  EXPECT_THAT(result.err, HasSubstr("/bodies/0/mas"));
  EXPECT_THAT(result.err, HasSubstr("radius"));
}

TEST(ExitCode, MissingSceneIs66) {
  const ProcessResult result = run_sheave({"run", "/nowhere/scene.json"});
  EXPECT_EQ(result.exit_code, 66);
  EXPECT_THAT(result.err, HasSubstr("/nowhere/scene.json"));
}

TEST(ExitCode, UnreadableSceneIs74) { EXPECT_EQ(run_sheave({"run", "/"}).exit_code, 74); }

TEST(ExitCode, OutputsThatCannotBeWrittenAre74AndNamed) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string missing = folder.path("no/such/folder/out.csv");
  for (const std::string& path : {missing, std::string("/proc/out.csv")}) {
    for (const char* option : {"--out", "--save-state"}) {
      const ProcessResult result = run_sheave({"run", scene, option, path});
      EXPECT_EQ(result.exit_code, 74) << option << " " << path;
      EXPECT_THAT(result.err, HasSubstr(path));
      EXPECT_THAT(result.out, IsEmpty()) << "found before anything is simulated";
    }
  }
  EXPECT_EQ(run_sheave({"run", scene, "--out", folder.path("table.txt")}).exit_code, 2);
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json"));
}

TEST(ExitCode, AFullDiskIs74) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::filesystem::create_symlink("/dev/full", folder.path("full.csv"));
  const ProcessResult result = run_sheave({"run", scene, "--out", folder.path("full.csv")});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_THAT(result.err, HasSubstr("full.csv"));
  EXPECT_THAT(result.err, HasSubstr("No space left"));
  const ProcessResult out = run_sheave({"run", scene}, {.stdout_path = "/dev/full"});
  EXPECT_EQ(out.exit_code, 74);
  EXPECT_THAT(out.err, HasSubstr("standard output"));
}

TEST(ExitCode, ClosedStdoutIs74AndNoSignal) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", scene},
                                                    {"run", scene, "--json"},
                                                    {"run", scene, "--out", "-"},
                                                    {"validate", scene},
                                                    {"schema"},
                                                    {"--help"}}) {
    const ProcessResult result = run_sheave(arguments, {.closed_stdout = true});
    EXPECT_EQ(result.signal, 0) << arguments.back();
    EXPECT_EQ(result.exit_code, 74) << arguments.back();
    EXPECT_THAT(result.err, HasSubstr("standard output")) << arguments.back();
  }
}

TEST(ExitCode, DivergenceIs75NamesTheBodyAndKeepsTheOutput) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("runaway.json", runaway_scene);
  const std::string table = folder.path("out.csv");
  const std::string state = folder.path("out.state");
  const ProcessResult result =
      run_sheave({"run", scene, "--json", "--out", table, "--save-state", state});
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_THAT(result.err, HasSubstr("\"rocket\""));
  EXPECT_THAT(result.err, HasSubstr("time"));
  EXPECT_THAT(result.err, HasSubstr("partial"));
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary["status"], "diverged");
  EXPECT_EQ(summary["divergence"]["body"], "rocket");
  EXPECT_GT(summary["divergence"]["time"], 0.0);
  const std::vector<std::string> lines = split(read_file(table), '\n');
  EXPECT_EQ(lines.size(), 2 + summary["steps"].get<std::size_t>());
  EXPECT_THAT(folder.entries(), ElementsAre("out.csv", "runaway.json"));
}

/// Waits until a run has opened its outputs, which is after it has begun to listen to signals.
void wait_for_outputs(const Process& process, const TemporaryFolder& folder, std::size_t entries) {
  ASSERT_TRUE(process.wait_until([&] { return folder.entries().size() >= entries; }));
}

TEST(ExitCode, InterruptIs130AndLeavesValidFiles) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("endless.json", endless_scene);
    const std::string table = folder.path("out.csv");
    const std::string array = folder.path("out.npy");
    const std::string state = folder.path("out.state");
    Process process(
        {"run", scene, "--json", "--out", table, "--out", array, "--save-state", state});
    wait_for_outputs(process, folder, 4);
    process.send(signal);
    process.send(signal);  // as `timeout` does: to the process and again to its group
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    const json summary = json::parse(result.out);
    EXPECT_EQ(summary["status"], "interrupted");
    const std::string text = read_file(table);
    ASSERT_FALSE(text.empty());
    EXPECT_EQ(text.back(), '\n');
    const std::vector<std::string> lines = split(text, '\n');
    EXPECT_EQ(lines.size(), 2 + summary["steps"].get<std::size_t>());
    for (const std::string& line : lines) {
      ASSERT_EQ(split(line, ',').size(), split(lines.front(), ',').size());
    }
    EXPECT_THAT(folder.entries(), ElementsAre("endless.json", "out.csv", "out.npy", "out.state"));
    const ProcessResult next =
        run_sheave({"run", scene, "--json", "--load-state", state, "--steps", "1"});
    EXPECT_EQ(next.exit_code, 0) << "the state where it stopped is there to go on from";
  }
}

TEST(ExitCode, AKilledRunLeavesNoHalfFileUnderTheFinalName) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  const std::string table = folder.write("out.csv", "what was there before\n");
  Process process({"run", scene, "--out", table});
  wait_for_outputs(process, folder, 3);
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  EXPECT_EQ(read_file(table), "what was there before\n");
}

TEST(ExitCode, AFileProtectedFromWritingIsNotReplaced) {
  if (::geteuid() == 0) GTEST_SKIP() << "nothing is protected from root";
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string table = folder.write("out.csv", "mine\n");
  std::filesystem::permissions(table, std::filesystem::perms::owner_read);
  EXPECT_EQ(run_sheave({"run", scene, "--out", table}).exit_code, 74);
  EXPECT_EQ(read_file(table), "mine\n");
}

}  // namespace
}  // namespace sheave::test
