// Inputs that never end are read up to a size that docs/explanation/reliability.md
// states, and refused.

#include <sys/stat.h>

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

}  // namespace
}  // namespace sheave::test
