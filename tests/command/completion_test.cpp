// `sheave completion`: scripts that shells can read, with every subcommand and option of the help.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/process.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;

TEST(Completion, NamesSubcommandsAndOptionsForEveryShell) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const ProcessResult result = run_sheave({"completion", shell});
    EXPECT_EQ(result.exit_code, 0) << shell;
    for (const char* word : {"validate", "hilbert", "estimate-error", "completion"}) {
      EXPECT_THAT(result.out, HasSubstr(word)) << shell;
    }
  }
  EXPECT_EQ(run_sheave({"completion", "tcsh"}).exit_code, 2);
}

}  // namespace
}  // namespace sheave::test
