// Titles, captions and arrows in draw lists and pictures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/font.h"
#include "render/overlay.h"
#include "render/scene_view.h"
#include "render/text_lines.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::render {
namespace {

TEST(TextLines, BreakAtSpacesAndLoseNothing) {
  const std::string text = "a winch hauls the rope  over averyveryverylongword of steel";
  for (const double width : {1.0, 60.0, 130.0, 1e4}) {
    const std::vector<std::string> lines = text_lines(text, 14.0, width);
    std::string joined;
    for (const std::string& line : lines) {
      joined += (joined.empty() ? "" : " ") + line;
      const bool fits = Font::builtin().measure(line, 14.0).width <= width;
      EXPECT_TRUE(fits || line.find(' ') == std::string::npos) << line;
    }
    EXPECT_EQ(joined, "a winch hauls the rope over averyveryverylongword of steel") << width;
  }
  EXPECT_TRUE(text_lines("", 14.0, 100.0).empty());
  EXPECT_EQ(text_lines(text, 14.0, 1e4).size(), 1U);
}

/// Keeps all texts and counts lines.
class Record final : public Canvas {
 public:
  [[nodiscard]] int width() const override { return 640; }
  [[nodiscard]] int height() const override { return 360; }
  void fill(double, double, double, double, const Color&, double) override {}
  void line(double x0, double y0, double, double, double, const Color&, double alpha) override {
    if (alpha == 1.0) starts.push_back({x0, y0});
  }
  void text(double x, double y, std::string_view text, double, const Color&, double) override {
    texts.emplace_back(text);
    places.push_back({x, y});
  }
  std::vector<std::string> texts;
  std::vector<std::array<double, 2>> places;
  std::vector<std::array<double, 2>> starts;  ///< of opaque lines
};

Scene film() {
  SceneResult scene = load_scene_text(R"({
    "format": "sheave-scene/1", "name": "plain", "duration": 2, "gravity": [0, 0, 0],
    "bodies": [{"name": "load", "mass": 1, "mobility": "slider", "axis": [1, 0, 0],
                "velocity": [1, 0, 0], "shape": {"type": "sphere", "radius": 0.1}}],
    "camera_path": [{"time": 0, "position": [0, 0, 10], "target": [0, 0, 0]}],
    "annotations": [
      {"kind": "title", "text": "fast", "from": 1},
      {"kind": "caption", "text": "it runs", "to": 1},
      {"kind": "arrow", "text": "tip", "body": "load", "point": [0.1, 0, 0]}]})",
                                      "test");
  for (const SceneError& error : scene.errors) ADD_FAILURE() << to_string(error);
  return std::move(*scene.scene);
}

TEST(AnnotationPicture, FollowsTheBodyAndTheTime) {
  const Scene scene = film();
  Simulation simulation = std::move(create_simulation(scene)).value();
  const ViewBuilder builder(simulation.world, {}, scene_view_options(scene));
  const auto list_at = [&](double time) {
    while (simulation.world.state().time < time - 1e-9) EXPECT_TRUE(simulation.step().ok());
    return builder.build(simulation.world, {});
  };
  const DrawList early = list_at(0.5);
  EXPECT_EQ(early.title, "plain");
  EXPECT_EQ(early.caption, "it runs");
  ASSERT_EQ(early.arrows.size(), 1U);
  // The load moves at 1 m/s.
  EXPECT_NEAR(early.arrows[0].anchor.x(), 0.5 + 0.1, 1e-12);
  const DrawList late = list_at(1.5);
  EXPECT_EQ(late.title, "fast");
  EXPECT_EQ(late.caption, "");
  const Camera camera =
      scene_camera(scene, {}, bounds(late), late, 640, 360).at(simulation.world.state().time);
  Record canvas;
  draw_overlay(late, camera, canvas);
  EXPECT_THAT(canvas.texts, testing::ElementsAre("fast", "t = 1.50 s", "tip"));
  // A shaft and two strokes of the head, which begin at the projected point.
  const auto tip = Projector(camera, 640, 360).project({1.6, 0.0, 0.0});
  ASSERT_TRUE(tip);
  ASSERT_EQ(canvas.starts.size(), 3U);
  for (const auto& [x, y] : canvas.starts) {
    EXPECT_NEAR(x, tip->x, 1e-9);
    EXPECT_NEAR(y, tip->y, 1e-9);
  }
  // The text does not cover its point.
  EXPECT_GT(std::hypot(canvas.places[2][0] - tip->x, canvas.places[2][1] - tip->y), 10.0);
}

TEST(AnnotationPicture, KeepsLongCaptionsInThePictureAndTheMachineAboveThem) {
  DrawList list;
  list.caption =
      "a word and a word and a word and a word and a word and a word and a word and a "
      "word and a word and a word and a word and a word and a word and a word";
  DrawList shorter;
  shorter.caption = "a word";
  EXPECT_GT(overlay_margins(list, 640, 360).bottom, overlay_margins(shorter, 640, 360).bottom);
  Record canvas;
  draw_overlay(list, Camera{}, canvas);
  ASSERT_GT(canvas.texts.size(), 1U);
  double last = 0.0;
  for (std::size_t i = 0; i < canvas.texts.size(); ++i) {
    const TextSize size = Font::builtin().measure(canvas.texts[i], std::max(9.0, 0.0245 * 360));
    EXPECT_LE(canvas.places[i][0] + size.width, 640.0);
    EXPECT_GT(canvas.places[i][1], last);
    EXPECT_LE(canvas.places[i][1] + size.descent, 360.0);
    last = canvas.places[i][1];
  }
}

}  // namespace
}  // namespace sheave::render
