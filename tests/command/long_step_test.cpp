// Steps that would take hours: signals and time limits are looked at within them.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The settings of a first step of 1e11 sweeps, some days.
const std::vector<std::string> days{"--substeps", "100000",       "--iterations", "1000000",
                                    "--solver",   "gauss-seidel", "--integrator", "xpbd"};

std::vector<std::string> with_days(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), days.begin(), days.end());
  return arguments;
}

/// What a run is that was ended within its first step.
void expect_start_alone(const TemporaryFolder& folder, const ProcessResult& result,
                        const std::string& status, const std::string& scene) {
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary["status"], status);
  EXPECT_EQ(summary["steps"], 0);
  EXPECT_EQ(summary["outputs"][0]["rows"], 1);
  const std::string table = read_file(folder.path("a.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
  const ProcessResult next =
      run_sheave({"run", scene, "--json", "--steps", "3", "--load-state", folder.path("c.state")});
  ASSERT_EQ(next.exit_code, 0) << next.err;
  const ProcessResult whole = run_sheave({"run", scene, "--json", "--steps", "3"});
  EXPECT_EQ(json::parse(next.out)["state_hash"], json::parse(whole.out)["state_hash"])
      << "the state is that before the step";
}

TEST(LongStep, ASignalEndsTheRunAndKeepsItsOutput) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("atwood.json", atwood_scene);
    Process process(with_days({"run", scene, "--json", "--out", folder.path("a.csv"),
                               "--save-state", folder.path("c.state")}));
    // It listens once its files are there.
    ASSERT_TRUE(process.wait_until([&] { return folder.entries().size() >= 3; }));
    // Most likely it is in the step by then; if not, what is left is the same.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    process.send(signal);
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_THAT(result.err, HasSubstr("interrupted at 0 s"));
    expect_start_alone(folder, result, "interrupted", scene);
  }
}

TEST(LongStep, ATimeLimitEndsTheRun) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  for (const char* limit : {"0", "1e-9", "0.2"}) {
    const ProcessResult result =
        run_sheave(with_days({"run", scene, "--json", "--out", folder.path("a.csv"), "--save-state",
                              folder.path("c.state"), "--time-limit", limit}));
    EXPECT_EQ(result.exit_code, 124) << result.err;
    EXPECT_THAT(result.err, HasSubstr("time limit at 0 s"));
    expect_start_alone(folder, result, "time limit", scene);
  }
}

TEST(LongStep, ATimeLimitEndsTheRunsOfAnErrorEstimate) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result = run_sheave({"run", scene, "--json", "--estimate-error", "--substeps",
                                           "25000", "--time-limit", "0.3", "--duration", "1e6"});
  EXPECT_EQ(result.exit_code, 124) << result.err;
}

TEST(LongStep, ASignalEndsTradeAndRender) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::vector<std::vector<std::string>> commands{{"trade", scene, "--minutes", "1e6", "--substeps",
                                                  "100000", "--iterations", "1000000", "--resume",
                                                  folder.path("a.trade")}};
  if (SHEAVE_HAS_RENDER != 0) {
    commands.push_back(with_days({"render", scene, "--png", folder.path("frames")}));
  }
  for (const auto& command : commands) {
    SCOPED_TRACE(command.front());
    Process process(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    process.send(SIGINT);
    const ProcessResult result = process.wait();
    // Before it listens, on a busy machine, the signal itself ends it.
    EXPECT_TRUE(result.exit_code == 130 || result.signal == SIGINT) << result.err;
  }
}

TEST(TimeLimit, AnUnreachedLimitChangesNothing) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult limited = run_sheave({"run", scene, "--json", "--time-limit", "1e9"});
  const ProcessResult whole = run_sheave({"run", scene, "--json"});
  ASSERT_EQ(limited.exit_code, 0) << limited.err;
  EXPECT_EQ(json::parse(limited.out)["state_hash"], json::parse(whole.out)["state_hash"]);
  EXPECT_EQ(json::parse(limited.out)["status"], json::parse(whole.out)["status"]);
}

TEST(TimeLimit, MustBeANumberOfAtLeastZero) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  for (const char* limit : {"-1", "nan", "inf", "-inf", "1s", "", "1e999", "0x", "1 2"}) {
    const ProcessResult result =
        run_sheave({"run", scene, "--json", std::string("--time-limit=") + limit});
    EXPECT_EQ(result.exit_code, 2) << limit << ": " << result.err;
    EXPECT_EQ(result.out, "");
  }
}

#if SHEAVE_HAS_RENDER
TEST(SecondSignal, EndsAHangingEncoderAndKeepsTheFrames) {
  // Takes all frames and then works for ever.
  const TemporaryFolder folder;
  const std::string encoder =
      folder.write("ffmpeg", "#!/bin/sh\ncat > /dev/null\n: > \"$DONE\"\nwhile :; do :; done\n");
  std::filesystem::permissions(encoder, std::filesystem::perms::owner_all);
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string done = folder.path("done");
  ProcessOptions options;
  options.environment = {"DONE=" + done,
                         "PATH=" + folder.path("") + ":" + std::string(std::getenv("PATH"))};
  Process process({"render", scene, "-q", "--width", "96", "--height", "64", "--fps", "4", "--png",
                   folder.path("frames"), "--video", folder.path("a.mp4")},
                  options);
  ASSERT_TRUE(process.wait_until([&] { return std::filesystem::exists(done); }));
  process.send(SIGINT);
  // Signals less than half a second apart count as one. How much longer does not matter.
  std::this_thread::sleep_for(std::chrono::seconds(2));
  process.send(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 74) << result.err;
  EXPECT_THAT(result.err, HasSubstr("was ended before it was done"));
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.mp4")));
  EXPECT_TRUE(std::filesystem::exists(folder.path("frames/frame_000000.png")));
  for (const std::string& entry : folder.entries()) EXPECT_FALSE(entry.starts_with(".")) << entry;
}

TEST(FirstSignal, EndsAnEncoderThatSleeps) {
  const TemporaryFolder folder;
  const std::string encoder =
      folder.write("ffmpeg", "#!/bin/sh\ncat > /dev/null\n: > \"$DONE\"\nexec sleep 100000\n");
  std::filesystem::permissions(encoder, std::filesystem::perms::owner_all);
  const std::string scene = folder.write("atwood.json", atwood_scene);
  // Both wait for their encoders at the same time.
  std::vector<std::unique_ptr<Process>> processes;
  for (std::vector<std::string> command :
       {std::vector<std::string>{"render", scene, "-q", "--fps", "4"},
        std::vector<std::string>{"modes", scene, "--as-is"}}) {
    const std::string& name = command.front();
    const std::string done = folder.path("done-" + name);
    ProcessOptions options;
    options.environment = {"DONE=" + done,
                           "PATH=" + folder.path("") + ":" + std::string(std::getenv("PATH"))};
    command.insert(command.end(),
                   {"--width", "96", "--height", "64", "--video", folder.path(name + ".mp4")});
    processes.push_back(std::make_unique<Process>(command, options));
    ASSERT_TRUE(processes.back()->wait_until([&] { return std::filesystem::exists(done); }));
    processes.back()->send(SIGINT);
  }
  for (const auto& process : processes) {
    const ProcessResult result = process->wait();
    EXPECT_EQ(result.exit_code, 74) << result.err;
    EXPECT_THAT(result.err, HasSubstr("hangs: it has done nothing"));
  }
  for (const char* name : {"render.mp4", "modes.mp4"}) {
    EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name;
  }
}

TEST(SmallStack, IsNoLimitOfPictures) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result =
      run_sheave({"render", scene, "--width", "96", "--height", "64", "--png", folder.path("f"),
                  "--fps", "2", "--still", folder.path("a.png"), "--at", "0"},
                 {.stack_limit = 64 * 1024});
  EXPECT_EQ(result.exit_code, 0) << result.signal << ": " << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path("a.png")));
}
#endif

}  // namespace
}  // namespace sheave::test
