#include "scenes/annotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/scene.h"

namespace sheave::test {
namespace {

using Kind = AnnotationDef::Kind;

AnnotationDef text_from(Kind kind, const char* text, double from, std::optional<double> to) {
  AnnotationDef made;
  made.kind = kind;
  made.text = text;
  made.from = from;
  made.to = to;
  return made;
}

TEST(Annotation, IsShownFromItsFirstToItsLastTime) {
  const AnnotationDef text = text_from(Kind::caption, "slack", 1.0, 2.0);
  EXPECT_FALSE(text.is_shown(0.99));
  EXPECT_TRUE(text.is_shown(1.0));
  // 60 steps of 1/60 s are 1 s but for rounding.
  EXPECT_TRUE(text.is_shown(1.0 - 1e-15));
  EXPECT_TRUE(text.is_shown(2.0));
  EXPECT_FALSE(text.is_shown(2.01));
  EXPECT_TRUE(text_from(Kind::caption, "taut", 1.0, {}).is_shown(1e9));
}

TEST(Annotation, TheLastCaptionThatIsShownCounts) {
  const std::vector<AnnotationDef> texts{text_from(Kind::caption, "all the time", 0.0, {}),
                                         text_from(Kind::title, "title", 0.0, {}),
                                         text_from(Kind::caption, "between", 1.0, 2.0)};
  EXPECT_EQ(shown_text(texts, Kind::caption, 0.5), "all the time");
  EXPECT_EQ(shown_text(texts, Kind::caption, 1.5), "between");
  EXPECT_EQ(shown_text(texts, Kind::caption, 2.5), "all the time");
  EXPECT_EQ(shown_text(texts, Kind::title, 1.5), "title");
  EXPECT_EQ(shown_text({}, Kind::title, 1.5), "");
}

/// The first fault of a scene with these members; empty if it loads.
std::string fault_of(const std::string& members) {
  const SceneResult scene = load_scene_text(
      R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, )" + members +
          R"(, "bodies": [{"name": "load", "mass": 1, "mobility": "slider", "axis": [0, 1, 0]}]})",
      "test");
  return scene.errors.empty() ? "" : scene.errors[0].pointer + ": " + scene.errors[0].message;
}

TEST(Annotation, TellsItsFaultsByTheirPlace) {
  using testing::StartsWith;
  const auto text = [](const std::string& rest) {
    return fault_of(R"("annotations": [{"kind": "caption", "text": "a")" + rest + "}]");
  };
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(fault_of(R"("annotations": [{"kind": "arrow", "text": "a", "body": "load"}])"), "");
  EXPECT_THAT(fault_of(R"("annotations": [{"kind": "caption", "text": ""}])"),
              StartsWith("/annotations/0/text: annotation: text has 0 bytes"));
  EXPECT_THAT(
      fault_of(R"("annotations": [{"kind": "title", "text": ")" + std::string(401, 'x') + "\"}]"),
      StartsWith("/annotations/0/text: annotation: text has 401 bytes; 1 to 400"));
  EXPECT_THAT(fault_of(R"("annotations": [{"kind": "title", "text": "a\nb"}])"),
              StartsWith("/annotations/0/text: annotation: text has a line break"));
  EXPECT_THAT(text(R"(, "from": 2, "to": 1)"), StartsWith("/annotations/0/to: annotation: to is"));
  EXPECT_THAT(text(R"(, "body": "load")"), StartsWith("/annotations/0/body: annotation: only an"));
  EXPECT_THAT(text(R"(, "point": [1, 0, 0])"), StartsWith("/annotations/0/point: annotation"));
  EXPECT_THAT(text(R"(, "from": -1)"), StartsWith("/annotations/0/from"));
}

TEST(Annotation, OfABodyThatDoesNotExistIsAFault) {
  Scene scene = *load_scene_text(
                     R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1})", "test")
                     .scene;
  scene.annotations.push_back(text_from(Kind::arrow, "here", 0.0, {}));
  scene.annotations.back().body = BodyId{3};
  const Errors errors = validate_scene(scene);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_THAT(errors[0].message, testing::HasSubstr("body 3 does not exist; the scene has 0"));
}

TEST(CameraKey, TellsItsFaultsByTheirPlace) {
  using testing::StartsWith;
  const auto path = [](const std::string& second, const std::string& more = "") {
    return fault_of(R"("camera_path": [{"time": 1, "position": [0, 0, 5], "target": [0, 0, 0]}, )" +
                    second + "]" + more);
  };
  const std::string good = R"({"time": 2, "position": [0, 5, 5], "target": [0, 0, 0]})";
  EXPECT_EQ(path(good), "");
  EXPECT_THAT(path(R"({"time": 1, "position": [0, 5, 5], "target": [0, 0, 0]})"),
              StartsWith("/camera_path/1/time: camera_path: time is 1 s, not after"));
  EXPECT_THAT(path(R"({"time": 2, "position": [0, 0, 0], "target": [0, 0, 0]})"),
              StartsWith("/camera_path/1/target: camera_path: target must not be"));
  EXPECT_THAT(path(R"({"time": 2, "position": [0, 5, 0], "target": [0, 0, 0], "up": [0, 1, 0]})"),
              StartsWith("/camera_path/1/up: camera_path: up must not be parallel"));
  EXPECT_THAT(path(R"({"time": 2, "position": [0, 5, 5], "target": [0, 0, 0], "height": 3})"),
              StartsWith("/camera_path/1/height: camera_path: only an orthographic"));
  EXPECT_THAT(path(good, R"(, "camera": {"projection": "orthographic"})"),
              StartsWith("/camera_path/0/height: camera_path: an orthographic picture needs"));
  EXPECT_THAT(path(good, R"(, "camera": {"direction": [0, 0, 1]})"),
              StartsWith("/camera/direction: camera: direction excludes camera_path"));
  EXPECT_THAT(path(good, R"(, "camera": {"position": [0, 0, 1], "target": [0, 0, 0]})"),
              StartsWith("/camera/position: camera: position and target exclude camera_path"));
}

}  // namespace
}  // namespace sheave::test
