// Killed and interrupted at random times. When that is depends on the clock; what is left must be
// right whenever it is.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/trade/journal_check.h"
#include "tests/command/npy_file.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

using nlohmann::json;

/// `usual`, or as many as SHEAVE_INJECT says (dev/inject).
int rounds(int usual) {
  const char* text = std::getenv("SHEAVE_INJECT");
  return text == nullptr ? usual : std::max(usual, std::atoi(text));
}

/// Gravity in which the light weight of the scene does not come to its wheel within these steps.
const std::string slow = "/gravity=[0, -1e-4, 0]";
/// A row of a table takes 700 bytes, and a table is written each time that it has 256 kB: 6 times.
const std::string steps = "2500";

/// Starts the command and sends a signal after a random time of up to `most` milliseconds.
ProcessResult disturbed(const std::vector<std::string>& arguments, int signal, double most,
                        Random& random) {
  Process process(arguments);
  const auto wait = static_cast<long>(1e3 * random.between(0.0, most));
  std::this_thread::sleep_for(std::chrono::microseconds(wait));
  process.send(signal);
  return process.wait();
}

/// The content of an output, under its name or, of a run that was killed, under its temporary one;
/// empty if there is none.
std::string output_of(const TemporaryFolder& folder, const std::string& name) {
  for (const std::string& entry : folder.entries()) {
    if (entry == name || entry.starts_with("." + name + ".")) return read_file(folder.path(entry));
  }
  return {};
}

void expect_npy_prefix(const std::string& left, const NpyFile& all) {
  if (left.empty()) return;
  const NpyFile part = parse_npy(left, false);
  ASSERT_LE(part.rows, all.rows);
  const std::size_t count = part.rows * all.columns;
  ASSERT_GE(part.data.size(), count) << "a row is promised that is not there";
  if (count == 0) return;
  EXPECT_EQ(std::memcmp(part.data.data(), all.data.data(), count * sizeof(double)), 0);
}

TEST(Signals, AKilledRunLeavesAPrefixOfItsFullOutput) {
  // Enough rows for several writes of each table.
  const TemporaryFolder truth;
  const std::string scene = truth.write("atwood.json", atwood_scene);
  const auto command = [&](const TemporaryFolder& folder) {
    return std::vector<std::string>{"run",
                                    scene,
                                    "-q",
                                    "--set",
                                    slow,
                                    "--steps",
                                    steps,
                                    "--out",
                                    folder.path("a.csv"),
                                    "--out",
                                    folder.path("b.npy"),
                                    "--save-state",
                                    folder.path("c.state")};
  };
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run_sheave(command(truth)).exit_code, 0);
  const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - start;
  const std::string csv = read_file(truth.path("a.csv"));
  const NpyFile npy = parse_npy(read_file(truth.path("b.npy")));
  const std::string state = read_file(truth.path("c.state"));
  Random random(1);
  std::size_t most_left = 0;
  for (int i = 0; i < rounds(40); ++i) {
    const TemporaryFolder folder;
    const ProcessResult result = disturbed(command(folder), SIGKILL, whole.count(), random);
    ASSERT_TRUE(result.signal == SIGKILL || result.exit_code == 0);
    const std::string left = output_of(folder, "a.csv");
    EXPECT_TRUE(csv.starts_with(left));
    expect_npy_prefix(output_of(folder, "b.npy"), npy);
    most_left = std::max(most_left, left.size());
    for (const char* name : {"a.csv", "b.npy", "c.state"}) {
      if (!std::filesystem::exists(folder.path(name))) continue;
      EXPECT_EQ(read_file(folder.path(name)), read_file(truth.path(name)))
          << "what has its name is whole";
    }
  }
  if (most_left == 0) GTEST_SKIP() << "the machine was so busy that no run got to its first write";
}

/// What an interrupted command may end as: before it listens, by the signal; else with 130, or
/// done.
void expect_interrupted(const ProcessResult& result, int signal) {
  if (result.signal != 0) {
    EXPECT_EQ(result.signal, signal);
  } else {
    EXPECT_TRUE(result.exit_code == 130 || result.exit_code == 0) << result.exit_code << result.err;
  }
}

TEST(Signals, AnInterruptedRunKeepsItsOutput) {
  const TemporaryFolder truth;
  const std::string scene = truth.write("atwood.json", atwood_scene);
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run_sheave(
                {"run", scene, "-q", "--set", slow, "--steps", steps, "--out", truth.path("a.csv")})
                .exit_code,
            0);
  const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - start;
  const std::string csv = read_file(truth.path("a.csv"));
  Random random(2);
  for (int i = 0; i < rounds(20); ++i) {
    const TemporaryFolder folder;
    const int signal = i % 2 == 0 ? SIGINT : SIGTERM;
    const ProcessResult result = disturbed(
        {"run", scene, "--json", "--set", slow, "--steps", steps, "--out", folder.path("a.csv"),
         "--out", folder.path("b.npy"), "--save-state", folder.path("c.state")},
        signal, whole.count(), random);
    expect_interrupted(result, signal);
    if (result.signal != 0) {
      EXPECT_EQ(folder.entries(), std::vector<std::string>()) << "it had not begun";
      continue;
    }
    const json summary = json::parse(result.out);
    const std::string left = read_file(folder.path("a.csv"));
    EXPECT_TRUE(csv.starts_with(left));
    EXPECT_EQ(left.back(), '\n');
    EXPECT_EQ(parse_npy(read_file(folder.path("b.npy"))).rows, summary["outputs"][1]["rows"]);
    EXPECT_EQ(
        run_sheave({"run", scene, "-q", "--steps", "1", "--load-state", folder.path("c.state")})
            .exit_code,
        0);
  }
}

TEST(Signals, OtherInterruptedCommandsLeaveNoPartialFile) {
  Random random(3);
  for (int i = 0; i < rounds(4); ++i) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("atwood.json", atwood_scene);
    const int signal = i % 2 == 0 ? SIGINT : SIGTERM;
    const std::vector<std::vector<std::string>> commands{
        {"render", scene, "--width", "96", "--height", "64", "--png", folder.path("frames")},
        {"trade", scene, "--resume", folder.path("a.trade"), "--csv", folder.path("a.csv")},
        {"stress", "--quick", "--markdown", folder.path("a.md")}};
    for (const auto& command : commands) {
      if (command.front() == "render" && SHEAVE_HAS_RENDER == 0) continue;
      const ProcessResult result = disturbed(command, signal, 1000.0, random);
      expect_interrupted(result, signal);
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path("."))) {
      EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
      if (entry.path().extension() == ".png") {
        EXPECT_NE(read_file(entry.path()).find("IEND"), std::string::npos) << "a whole picture";
      }
      if (entry.path().extension() == ".trade") {
        EXPECT_NO_THROW(
            (void)command::checked_trade_journal(read_file(entry.path()), entry.path()));
      }
    }
  }
}

}  // namespace
}  // namespace sheave::test
