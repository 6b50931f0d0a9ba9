// Inputs that never end are read up to a size that docs/explanation/reliability.md
// states, and refused.

#include <csignal>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;

constexpr int bad_scene = 65;

class EndlessInput : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(EndlessInput, IsRefusedWithItsSize) {
  const TemporaryFolder folder;
  folder.write("atwood.json", atwood_scene);
  std::vector<std::string> arguments;
  for (const std::string& word : GetParam()) {
    arguments.push_back(word.starts_with('@') ? folder.path(word.substr(1)) : word);
  }
  const ProcessResult result = run_sheave(arguments);
  EXPECT_EQ(result.exit_code, bad_scene);
  EXPECT_THAT(result.err, HasSubstr("/dev/zero"));
  EXPECT_THAT(result.err, HasSubstr("bytes"));
}

INSTANTIATE_TEST_SUITE_P(
    All, EndlessInput,
    testing::Values(std::vector<std::string>{"run", "/dev/zero"},
                    std::vector<std::string>{"validate", "/dev/zero"},
                    std::vector<std::string>{"run", "@atwood.json", "--load-state", "/dev/zero"},
                    std::vector<std::string>{"merge", "/dev/zero"},
                    std::vector<std::string>{"bench", "--compare", "/dev/zero"}));

// A pipe without a writer, or with one that never ends, would be waited for without end.
TEST(EndlessJournal, OfAPipeIsRefused) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"sweep", scene, "--vary", "/bodies/heavy/mass=2,3", "--measure",
                                 "t", "--resume", pipe},
        std::vector<std::string>{"trade", scene, "--solver", "direct", "--substeps", "1",
                                 "--resume", pipe}}) {
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("pipe: is no file; a journal must be one"));
  }
}

/// Sends SIGINT while the command waits for bytes of a pipe.
ProcessResult interrupted_wait(const std::vector<std::string>& command, const std::string& pipe) {
  Process process(command);
  // The other end opens once the command has the pipe open.
  int writer = -1;
  EXPECT_TRUE(process.wait_until([&] {
    writer = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    return writer >= 0;
  }));
  process.send(SIGINT);
  ProcessResult result = process.wait();
  if (writer >= 0) ::close(writer);
  return result;
}

TEST(EndlessPipe, IsLeftAtTheFirstInterrupt) {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"plot", pipe, "--y", "t", "-o", folder.path("a.png")},
        std::vector<std::string>{"stress", pipe},
        std::vector<std::string>{"sweep", pipe, "--vary", "/gravity/1=-1,-2", "--measure", "t"}}) {
    const ProcessResult result = interrupted_wait(command, pipe);
    EXPECT_EQ(result.exit_code, 130) << command.front() << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("pipe: not read: interrupted"));
  }
}

TEST(EndlessPipe, IsReadAsAFileIfItEnds) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Process process({"run", pipe, "--json", "--steps", "1"});
  std::ofstream(pipe) << read_file(scene);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace sheave::test
