// Frames drawn side by side: their order, their bytes, and what happens to those that fail.
#include "render/frame_line.h"

#include <gtest/gtest.h>

namespace sheave::render {
namespace {

constexpr int width = 96;
constexpr int height = 64;

/// A ball and a cable at the moment k of a film.
DrawList moment(int k) {
  DrawList list;
  Solid ball;
  ball.shape = SphereShape{0.3};
  ball.position = {0.1 * k, 0.4, 0.0};
  list.solids.push_back(ball);
  Tube cable;
  cable.radius = 0.03;
  cable.points = {{{0.0, 1.5, 0.0}, rgb(0xc04060)}, {ball.position, rgb(0xc04060)}};
  list.tubes.push_back(cable);
  list.planes.push_back({.grid_spacing = 0.5});
  list.time = 0.1 * k;
  return list;
}

Camera camera() { return {.position = {0.5, 1.0, 6.0}, .target = {0.5, 0.7, 0.0}}; }

std::vector<FrameLine::Frame> film(int threads, int frames) {
  auto line = FrameLine::create(width, height, {.threads = threads, .png = PngEffort::sequence});
  EXPECT_TRUE(line);
  std::vector<FrameLine::Frame> taken;
  const auto take = [&] {
    auto frame = line->take();
    ASSERT_TRUE(frame);
    taken.push_back(std::move(frame).value());
  };
  for (int k = 0; k < frames; ++k) {
    while (line->full()) take();
    line->put(moment(k), camera());
  }
  while (!line->empty()) take();
  return taken;
}

TEST(FrameLine, TheSameBytesWithAnyNumberOfThreads) {
  constexpr int frames = 12;
  auto renderer = Renderer::create(width, height);
  ASSERT_TRUE(renderer);
  const std::vector<FrameLine::Frame> one = film(1, frames);
  ASSERT_EQ(one.size(), static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    const auto image = renderer->draw(moment(k), camera());
    ASSERT_TRUE(image);
    const auto& frame = one[static_cast<std::size_t>(k)];
    EXPECT_EQ(*image, frame.image);
    EXPECT_EQ(frame.png, encode_png(*image, PngEffort::sequence).value());
  }
  EXPECT_NE(one[0].image, one[1].image);
  for (const int threads : {2, 3, 8}) {
    const std::vector<FrameLine::Frame> some = film(threads, frames);
    ASSERT_EQ(some.size(), one.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_EQ(some[k].image, one[k].image) << threads << " threads, frame " << k;
      EXPECT_EQ(some[k].png, one[k].png);
    }
  }
}

TEST(FrameLine, KeepsTwoFramesForEachThread) {
  auto line = FrameLine::create(width, height, {.threads = 3});
  ASSERT_TRUE(line);
  EXPECT_TRUE(line->empty());
  for (int k = 0; k < 6; ++k) {
    EXPECT_FALSE(line->full());
    line->put(moment(k), camera());
  }
  EXPECT_TRUE(line->full());
  EXPECT_TRUE(line->take());
  EXPECT_FALSE(line->full());
  // The others are dropped, drawn or not.
}

TEST(FrameLine, NamesTheFrameThatCannotBeDrawn) {
  auto line = FrameLine::create(width, height, {.threads = 2});
  ASSERT_TRUE(line);
  DrawList broken = moment(1);
  broken.solids[0].shape = SphereShape{-1.0};
  line->put(moment(0), camera());
  line->put(broken, camera());
  line->put(moment(2), camera());
  EXPECT_TRUE(line->take());
  const auto failed = line->take();
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.errors()[0].path, "/solids/0");
  EXPECT_TRUE(line->take());
}

TEST(FrameLine, RefusesImpossibleSettings) {
  EXPECT_FALSE(FrameLine::create(width, height, {.threads = 0}));
  EXPECT_FALSE(FrameLine::create(width, height, {.threads = 1025}));
  EXPECT_FALSE(FrameLine::create(0, height, {}));
}

}  // namespace
}  // namespace sheave::render
