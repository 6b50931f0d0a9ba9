// sheave run: what it draws on a terminal while it runs.

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What an endless run says on standard error before it is stopped: on a terminal after it has
/// drawn its progress.
std::string endless_run_stderr(const ProcessOptions& options) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  Process process({"run", scene, "--out", folder.path("out.csv")}, options);
  if (options.terminal_stderr) {
    EXPECT_TRUE(process.wait_for_terminal(" left"));
  } else {
    // It listens to signals before it opens its output. Then there is time for what must not come,
    // whenever it would.
    EXPECT_TRUE(process.wait_until([&] { return folder.entries().size() >= 2; }));
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  process.send(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130);
  return result.err;
}

TEST(RunProgress, IsDrawnOnATerminalAndLeavesItClean) {
  const std::string colored =
      endless_run_stderr({.environment = {"TERM=xterm"}, .terminal_stderr = true});
  EXPECT_THAT(colored, HasSubstr(" % t = "));
  EXPECT_THAT(colored, HasSubstr(" left"));
  EXPECT_THAT(colored, HasSubstr("\033[32m"));
  EXPECT_THAT(colored, HasSubstr("  \rsheave: "));
}

TEST(RunProgress, HasNoColorIfNoColorIsSet) {
  const std::string plain =
      endless_run_stderr({.environment = {"TERM=xterm", "NO_COLOR=1"}, .terminal_stderr = true});
  EXPECT_THAT(plain, HasSubstr(" % t = "));
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
}

TEST(RunProgress, IsNotWrittenToALog) {
  const std::string log = endless_run_stderr({});
  EXPECT_THAT(log, Not(HasSubstr("%")));
  EXPECT_THAT(log, Not(HasSubstr("\r")));
}

}  // namespace
}  // namespace sheave::test
