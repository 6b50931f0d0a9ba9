#include "scenes/scene_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string changed(std::string_view text, std::string_view pointer, std::string_view value) {
  const Result<std::string> result = with_setting(text, pointer, value);
  return result ? *result : "error: " + result.errors().front().message;
}

TEST(SceneText, ReplacesAValueAndNothingElse) {
  EXPECT_EQ(changed("// first\n{\"step\": { \"substeps\" : 4 /* why */, \"dt\": 1e-2}} // last\n",
                    "/step/substeps", "16"),
            "// first\n{\"step\": { \"substeps\" : 16 /* why */, \"dt\": 1e-2}} // last\n");
  EXPECT_EQ(changed(R"({"a": [{"b": "x"}, {"b": "{}\""}]})", "/a/1/b", "\"y\""),
            R"({"a": [{"b": "x"}, {"b": "y"}]})");
}

TEST(SceneText, AddsAMember) {
  EXPECT_EQ(changed("{\"step\": {\"dt\": 0.01 // so\n}}", "/step/substeps", "8"),
            "{\"step\": {\"dt\": 0.01, \"substeps\": 8 // so\n}}");
  EXPECT_EQ(changed(R"({"step": {/* none */}})", "/step/substeps", "8"),
            R"({"step": {"substeps": 8/* none */}})");
  EXPECT_EQ(changed("{\n  \"duration\": 1\n}\n", "/step/substeps", "8"),
            "{\n  \"duration\": 1,\n  \"step\": {\"substeps\": 8}\n}\n");
  // The byte order mark counts as text.
  EXPECT_EQ(changed("\xEF\xBB\xBF{\"a\": 1}", "/a", "2"), "\xEF\xBB\xBF{\"a\": 2}");
}

TEST(SceneText, RefusesChangesWithoutAPlace) {
  EXPECT_THAT(changed("{", "/a", "1"), HasSubstr("error: "));
  EXPECT_THAT(changed("{}", "/cables/0/tangent_update", "1"), HasSubstr("no object to hold it"));
  EXPECT_THAT(changed(R"({"a": [1]})", "/a/1", "1"), HasSubstr("no object to hold it"));
  EXPECT_THAT(changed("{}", "a", "1"), HasSubstr("not a JSON pointer"));
}

TEST(SceneText, AppliedChangesGiveTheScene) {
  const SceneResult from = load_scene_text(atwood_scene, "from");
  ASSERT_TRUE(from);
  EXPECT_THAT(step_changes(*from, *from), IsEmpty());
  Scene to = *from;
  to.model.step = {0.005, 7, 3, SolverKind::gauss_seidel, IntegratorKind::xpbd};
  to.cables[0].tangent_update = TangentUpdate::substep;
  const auto changes = step_changes(*from, to);
  EXPECT_THAT(changes, SizeIs(6));
  std::string text = atwood_scene;
  for (const Override& change : changes) text = changed(text, change.pointer, change.value);
  const SceneResult loaded = load_scene_text(text, "changed");
  ASSERT_TRUE(loaded) << to_string(loaded.errors.front());
  EXPECT_EQ(write_scene(*loaded), write_scene(to));
}

}  // namespace
}  // namespace sheave::test
