// Inputs that never end are read up to a size that docs/explanation/reliability.md
// states, and refused.

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

}  // namespace
}  // namespace sheave::test
