// The axes and the line of the time in the corners of pictures.

#include "render/overlay_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/font.h"
#include "render/overlay.h"
#include "render/scene_view.h"
#include "scenes/scene.h"

namespace sheave::render {
namespace {

/// Keeps opaque lines, fills and texts.
class Marks final : public Canvas {
 public:
  [[nodiscard]] int width() const override { return 800; }
  [[nodiscard]] int height() const override { return 600; }
  void fill(double x, double y, double w, double h, const Color& /*color*/, double alpha) override {
    if (alpha == 1.0) fills.push_back({x, y, w, h});
  }
  void line(double x0, double y0, double x1, double y1, double /*width*/, const Color& color,
            double alpha) override {
    if (alpha == 1.0) lines.push_back({{x0, y0, x1, y1}, color});
  }
  void text(double x, double y, std::string_view text, double /*pixels*/, const Color& color,
            double /*halo*/) override {
    texts.push_back({std::string(text), x, y, color});
  }
  struct Line {
    std::array<double, 4> ends;
    Color color;
  };
  struct Text {
    std::string text;
    double x;
    double y;
    Color color;
  };
  std::vector<std::array<double, 4>> fills;
  std::vector<Line> lines;
  std::vector<Text> texts;
};

/// The direction of the axis with this name in the picture, up and right > 0; its length is 1 in the
/// plane of the picture.
Eigen::Vector2d drawn(const Marks& canvas, const std::string& name) {
  const double longest = 1.9 * MarkStyle{}.text;
  for (const Marks::Text& text : canvas.texts) {
    if (text.text != name) continue;
    for (const Marks::Line& line : canvas.lines) {
      if (line.color.r != text.color.r || line.color.g != text.color.g) continue;
      const auto [x0, y0, x1, y1] = line.ends;
      return Eigen::Vector2d(x1 - x0, y0 - y1) / longest;
    }
  }
  return Eigen::Vector2d::Constant(NAN);
}

TEST(OverlayTriad, ShowsTheAxesAsTheCameraSeesThem) {
  Camera front;  // looks along -z with y up
  Marks canvas;
  const Rectangle area = draw_triad(front, canvas, {});
  EXPECT_EQ(canvas.lines.size(), 2U) << "z points to the eye";
  EXPECT_NEAR((drawn(canvas, "x") - Eigen::Vector2d(1.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((drawn(canvas, "y") - Eigen::Vector2d(0.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(area.width, triad_side({}));
  EXPECT_LT(area.x + area.width, canvas.width());
  EXPECT_LT(area.y + area.height, canvas.height());
  // From above, with -z up in the picture.
  Camera above;
  above.position = {0.0, 10.0, 0.0};
  above.up = {0.0, 0.0, -1.0};
  Marks from_above;
  draw_triad(above, from_above, {});
  EXPECT_NEAR((drawn(from_above, "z") - Eigen::Vector2d(0.0, -1.0)).norm(), 0.0, 1e-12);
  // Along the diagonal of space: three axes of the length sqrt(2/3), 120 degrees from each other.
  Camera diagonal;
  diagonal.position = {5.0, 5.0, 5.0};
  Marks slanted;
  draw_triad(diagonal, slanted, {});
  ASSERT_EQ(slanted.lines.size(), 3U);
  for (const auto& [a, b] : {std::pair{"x", "y"}, {"y", "z"}, {"z", "x"}}) {
    EXPECT_NEAR(drawn(slanted, a).norm(), std::sqrt(2.0 / 3.0), 1e-12);
    EXPECT_NEAR(drawn(slanted, a).dot(drawn(slanted, b)), -0.5 * 2.0 / 3.0, 1e-12);
  }
}

TEST(OverlayTimeLine, MarksTheShareOfTheTime) {
  for (const double time : {0.0, 1.5, 6.0, 7.0}) {
    Marks canvas;
    const Rectangle area = draw_time_line(time, 6.0, 50.0, canvas, {});
    ASSERT_EQ(canvas.fills.size(), 3U);
    const auto& [x, y, w, h] = canvas.fills[2];
    EXPECT_NEAR((x + 0.5 * w - area.x) / area.width, std::min(time / 6.0, 1.0), 1e-12) << time;
    EXPECT_NEAR(canvas.fills[1][2] / area.width, std::min(time / 6.0, 1.0), 1e-12) << time;
    EXPECT_GT(y, 50.0);
    EXPECT_GT(h, w);
  }
}

/// A scene whose camera has these settings.
Scene with_camera(const std::string& camera) {
  SceneResult scene = load_scene_text(R"({"format": "sheave-scene/1", "name": "marks",
    "duration": 4, "gravity": [0, 0, 0], "bodies": [], "camera": {)" +
                                          camera + "}}",
                                      "test");
  EXPECT_TRUE(scene) << to_string(scene.errors.front());
  return *scene.scene;
}

DrawList list_of(const std::string& camera) {
  const ViewOptions options = scene_view_options(with_camera(camera));
  DrawList list;
  list.title = options.title;
  list.time = 1.0;
  list.duration = options.duration;
  list.axes = options.axes;
  return list;
}

TEST(OverlayMarks, AreDrawnOnRequestAndMakeRoom) {
  Marks plain;
  draw_overlay(list_of(""), {}, plain);
  ASSERT_EQ(plain.texts.size(), 2U);
  EXPECT_EQ(plain.texts[1].text, "t = 1.00 s");
  EXPECT_TRUE(plain.lines.empty() && plain.fills.empty());
  Marks marked;
  draw_overlay(list_of(R"("axes": true, "time_line": true)"), {}, marked);
  EXPECT_EQ(marked.texts[1].text, "t = 1.00 s of 4.00 s");
  EXPECT_EQ(marked.lines.size(), 2U);
  EXPECT_EQ(marked.fills.size(), 3U);
  const Margins bare = overlay_margins(list_of(""), 800, 600);
  const Margins room = overlay_margins(list_of(R"("time_line": true)"), 800, 600);
  EXPECT_GT(room.top, bare.top) << "the machine stays below the line";
}

TEST(OverlayMarks, ALongCaptionStaysBesideTheAxes) {
  DrawList list = list_of(R"("axes": true)");
  for (int i = 0; i < 60; ++i) list.caption += "word ";
  Marks canvas;
  draw_overlay(list, {}, canvas);
  const double side = triad_side({.text = 0.0245 * 600});
  double widest = 0.0;
  for (const Marks::Text& text : canvas.texts) {
    if (text.text.find("word") == std::string::npos) continue;
    widest = std::max(widest, text.x + Font::builtin().measure(text.text, 0.0245 * 600).width);
  }
  EXPECT_GT(widest, 0.5 * canvas.width());
  EXPECT_LT(widest, canvas.width() - side);
}

}  // namespace
}  // namespace sheave::render
