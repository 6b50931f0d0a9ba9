// sheave run: states that are saved and loaded.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"
#include "tests/command/scenes.h"
#include "tests/support/state_bytes.h"

namespace sheave::test::run_state {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(RunStates, AStateOfAnotherSceneIsRefused) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string other = folder.write("other.json", endless_scene);
  const std::string state = folder.path("s.state");
  ASSERT_EQ(run_sheave({"run", other, "--steps", "1", "--save-state", state}).exit_code, 0);
  EXPECT_EQ(run_sheave({"run", scene, "--load-state", state}).exit_code, 65);
  EXPECT_EQ(run_sheave({"run", scene, "--load-state", scene}).exit_code, 65) << "no state at all";
  const ProcessResult step =
      run_sheave({"run", other, "--steps", "1", "--dt", "0.02", "--load-state", state});
  EXPECT_EQ(step.exit_code, 65);
  EXPECT_THAT(step.err, HasSubstr("another dt"));
  EXPECT_EQ(run_sheave({"run", scene, "--load-state", folder.path("none")}).exit_code, 66);
  EXPECT_EQ(run_sheave({"run", scene, "--load-state", folder.path("")}).exit_code, 74);
}

TEST(RunStates, AStateNamesItsMachineAndShowsDamage) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string state = folder.path("s.state");
  ASSERT_EQ(run_sheave({"run", scene, "--steps", "5", "--save-state", state}).exit_code, 0);
  const auto load = [&](const std::string& path, const std::string& setting) {
    std::vector<std::string> words{"run", scene, "-q", "--steps", "1", "--load-state", path};
    if (!setting.empty()) words.insert(words.end(), {"--set", setting});
    return run_sheave(words);
  };
  EXPECT_EQ(load(state, "").err, "");
  EXPECT_EQ(load(state, "/step/substeps=7").err, "") << "how it is stepped is free";
  const ProcessResult heavier = load(state, "/bodies/heavy/mass=7");
  EXPECT_EQ(heavier.exit_code, 0);
  EXPECT_THAT(heavier.err, HasSubstr("with other settings"));
  std::string text = atwood_scene;
  for (std::size_t i = 0; (i = text.find("\"light", i)) != std::string::npos; ++i) {
    text.replace(i, 6, "\"other");
  }
  const ProcessResult renamed = run_sheave(
      {"run", folder.write("renamed.json", text), "--steps", "1", "--load-state", state});
  EXPECT_EQ(renamed.exit_code, 65);
  EXPECT_THAT(renamed.err, HasSubstr("another machine"));
  std::string bytes = read_file(state);
  const ProcessResult old = load(folder.write("old.state", without_checksum(bytes)), "");
  EXPECT_EQ(old.exit_code, 0);
  EXPECT_THAT(old.err, HasSubstr("without a checksum"));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  const ProcessResult damaged = load(folder.write("damaged.state", bytes), "");
  EXPECT_EQ(damaged.exit_code, 65);
  EXPECT_THAT(damaged.err, HasSubstr("checksum"));
}

// A run from a saved state at time 0, as `sheave statics` writes it, is a whole run. One that begins later lacks the values
// before, so a check that asks for them is refused rather than answered from the rest.
TEST(RunStates, AChecksWindowMustNotBeginBeforeTheState) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string start = folder.path("start.state");
  const std::string middle = folder.path("middle.state");
  ASSERT_EQ(run_sheave({"run", scene, "--steps", "0", "--save-state", start}).exit_code, 0);
  ASSERT_EQ(run_sheave({"run", scene, "--steps", "50", "--save-state", middle}).exit_code, 0);
  const ProcessResult whole = run_sheave({"run", scene, "--check", "--load-state", start});
  EXPECT_EQ(whole.exit_code, 0) << whole.err << whole.out;
  const ProcessResult late = run_sheave({"run", scene, "--check", "--load-state", middle});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, HasSubstr("the check of light.vy begins at 0 s, but the saved state is of "
                                  "0.5 s"));
  EXPECT_EQ(run_sheave({"run", scene, "--check", "--load-state", middle, "--set",
                        "/checks/0/from=0.6", "--set", "/checks/1/from=0.5"})
                .exit_code,
            0);
}

}  // namespace
}  // namespace sheave::test::run_state
