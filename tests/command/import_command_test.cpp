// sheave import, and models in place of scenes.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/import/import.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::string arm = R"(<mujoco model="arm">
  <worldbody>
    <light pos="0 0 1"/>
    <body name="bar">
      <joint name="hinge" axis="0 1 0"/>
      <geom type="capsule" size=".05" fromto="0 0 0 1 0 0"/>
    </body>
  </worldbody>
</mujoco>
)";

class ImportCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

TEST_F(ImportCommand, WritesASceneThatRunsAndTellsWhatIsMissing) {
  const TemporaryFolder folder;
  const std::string model = folder.write("arm.xml", arm);
  const std::string scene = folder.path("arm.json");
  const ProcessResult result = run_sheave({"import", model, "-o", scene, "--report"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("arm.xml:3: light: "));
  EXPECT_THAT(result.out, HasSubstr("1 skipped"));
  EXPECT_THAT(result.err, IsEmpty());
  const ProcessResult run = run_sheave({"run", scene});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("bar"));
}

TEST_F(ImportCommand, AModelInPlaceOfASceneRunsWithAWarning) {
  const TemporaryFolder folder;
  const std::string model = folder.write("arm.xml", arm);
  const ProcessResult direct = run_sheave({"run", model});
  EXPECT_EQ(direct.exit_code, 0) << direct.err;
  EXPECT_THAT(direct.err, HasSubstr("1 element of the model skipped"));
  EXPECT_EQ(run_sheave({"validate", model}).exit_code, 0);
  // A pipe: the scene is on standard output, and the numbers on standard error.
  const ProcessResult piped = run_sheave({"import", "-"}, {.input = arm});
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_THAT(piped.err, HasSubstr("1 skipped"));
  EXPECT_EQ(run_sheave({"run", "-"}, {.input = piped.out}).exit_code, 0);
}

TEST_F(ImportCommand, RefusesAllElseWithItsPlace) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", atwood_scene);
  EXPECT_EQ(run_sheave({"import", scene}).exit_code, 65);
  EXPECT_EQ(run_sheave({"import", folder.path("none.xml")}).exit_code, 66);
  const std::string bad = folder.write("bad.xml",
                                       "<mujoco><worldbody>\n<geom size='x'/>\n"
                                       "<body>\n<joint axis='0'/></body></worldbody>"
                                       "</mujoco>");
  const ProcessResult result = run_sheave({"import", bad});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_THAT(result.err, HasSubstr("2 faults"));
  EXPECT_THAT(result.err, HasSubstr("bad.xml:2:"));
  EXPECT_THAT(result.err, HasSubstr("bad.xml:4:"));
  const std::string model = folder.write("arm.xml", arm);
  EXPECT_EQ(run_sheave({"import", model, "--key", "home"}).exit_code, 65);
  EXPECT_EQ(run_sheave({"import", model, "-o", folder.path("no/where.json")}).exit_code, 74);
}

}  // namespace
}  // namespace sheave::test
