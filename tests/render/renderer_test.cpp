// The whole way to pixels: determinism, refusals, and pictures that were looked at.
#include "render/renderer.h"

#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "render/overlay.h"
#include "tests/render/picture.h"

namespace sheave::render {
namespace {

constexpr int frame_width = 160;
constexpr int frame_height = 120;

Renderer& shared_renderer() {
  static Result<Renderer> renderer = Renderer::create(frame_width, frame_height);
  return renderer.value();
}

Camera camera_for(const DrawList& list) {
  FrameOptions options;
  options.aspect = static_cast<double>(frame_width) / frame_height;
  options.margins = overlay_margins(list, frame_width, frame_height);
  return frame_box(bounds(list),
                   default_view_direction(Vector3::UnitY(), Vector3(Vector3::UnitZ())),
                   Vector3::UnitY(), options);
}

Solid solid(const Shape& shape, const Vector3& position, const Color& color) {
  Solid s;
  s.shape = shape;
  s.position = position;
  s.color = color;
  return s;
}

/// One of each shape on a floor with a grid.
DrawList shapes() {
  DrawList list;
  auto tetrahedron = std::make_shared<TriangleMesh>();
  tetrahedron->vertices = {{0, 0, 0}, {0.6, 0, 0}, {0.3, 0, 0.6}, {0.3, 0.6, 0.3}};
  tetrahedron->triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  list.solids = {
      solid(BoxShape{{0.5, 0.5, 0.5}}, {-1.0, 0.25, 0.0}, rgb(0x5d7fa3)),
      solid(SphereShape{0.3}, {-0.3, 0.3, 0.3}, rgb(0xcdb98a)),
      solid(CylinderShape{0.2, 0.5}, {0.3, 0.2, 0.2}, rgb(0x7fa387)),
      solid(CapsuleShape{0.12, 0.4}, {0.5, 0.8, 0.0}, rgb(0x9b8fb5)),
      solid(SheaveShape{0.4, 0.12, 0.03, 0.0, 5}, {-0.4, 1.1, 0.0}, rgb(0x9aabbe)),
      solid(MeshShape{tetrahedron}, {0.7, 0.0, 0.0}, rgb(0xa9a196)),
  };
  list.solids[3].orientation = Quaternion(std::cos(0.5), 0.0, std::sin(0.5), 0.0);
  list.planes.push_back({.grid_spacing = 0.5});
  return list;
}

/// Two weights on a cable over a wheel, with all kinds of text.
DrawList pulley() {
  DrawList list;
  Tube cable;
  cable.radius = 0.03;
  cable.points.push_back({{-0.5, -1.0, 0.0}, sample(ColorMap::tension, 0.9)});
  for (int k = 0; k <= 40; ++k) {
    const double angle = pi - pi * k / 40.0;
    cable.points.push_back({{0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0},
                            sample(ColorMap::tension, 0.9 - 0.6 * k / 40.0)});
  }
  cable.points.push_back({{0.5, -0.6, 0.0}, sample(ColorMap::tension, 0.3)});
  list.tubes.push_back(cable);
  list.solids = {
      solid(SheaveShape{0.5, 0.15, 0.03, 0.0, 5}, {0, 0, 0}, rgb(0x9aabbe)),
      solid(BoxShape{{0.4, 0.4, 0.4}}, {-0.5, -1.2, 0.0}, rgb(0x5d7fa3)),
      solid(BoxShape{{0.3, 0.3, 0.3}}, {0.5, -0.75, 0.0}, rgb(0x7fa387)),
  };
  list.planes.push_back({.point = {0, -1.5, 0}, .grid_spacing = 0.5});
  list.labels.push_back({.anchor = {-0.5, -0.5, 0.0}, .text = "18.0 N", .direction = {1, 0, 0}});
  list.labels.push_back({.anchor = {0.5, -0.3, 0.0}, .text = "6.0 N", .direction = {1, 0, 0}});
  list.legend = Legend{.max = 20.0};
  list.title = "pulley";
  list.time = 1.25;
  return list;
}

/// A belt seen at a right angle without perspective, and without a floor.
DrawList belt() {
  DrawList list;
  Tube ring{{}, 0.04, true};
  for (int k = 0; k < 80; ++k) {
    const double angle = 2.0 * pi * k / 80.0;
    const double x = std::cos(angle) >= 0.0 ? 1.0 : 0.0;
    ring.points.push_back({{x + 0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.0},
                           std::sin(angle) > 0.0 ? slack_color : sample(ColorMap::tension, 0.6)});
  }
  list.tubes.push_back(ring);
  list.solids = {solid(SheaveShape{0.4, 0.12, 0.04, 0.0, 5}, {0, 0, 0}, rgb(0x9aabbe)),
                 solid(SheaveShape{0.4, 0.12, 0.04, 0.0, 0}, {1, 0, 0}, rgb(0x9aabbe))};
  return list;
}

TEST(Golden, Shapes) {
  const DrawList list = shapes();
  const auto image = shared_renderer().draw(list, camera_for(list));
  ASSERT_TRUE(image);
  EXPECT_EQ(test::compare_with_golden(*image, "shapes"), "");
}

TEST(Golden, Pulley) {
  const DrawList list = pulley();
  const auto image = shared_renderer().draw(list, camera_for(list));
  ASSERT_TRUE(image);
  EXPECT_EQ(test::compare_with_golden(*image, "pulley"), "");
}

TEST(Golden, BeltOrthographic) {
  const DrawList list = belt();
  FrameOptions options;
  options.aspect = static_cast<double>(frame_width) / frame_height;
  options.projection = Orthographic{};
  const Camera camera = frame_box(bounds(list), {0, 0, -1}, {0, 1, 0}, options);
  const auto image = shared_renderer().draw(list, camera);
  ASSERT_TRUE(image);
  EXPECT_EQ(test::compare_with_golden(*image, "belt"), "");
}

TEST(Renderer, SameInputGivesTheSameBytes) {
  const DrawList list = pulley();
  const Camera camera = camera_for(list);
  const auto first = shared_renderer().draw(list, camera);
  const auto other = shared_renderer().draw(shapes(), camera);  // what came before must not matter
  const auto again = shared_renderer().draw(list, camera);
  ASSERT_TRUE(first && other && again);
  EXPECT_EQ(*first, *again);
  EXPECT_NE(*first, *other);
  auto fresh = Renderer::create(frame_width, frame_height);
  ASSERT_TRUE(fresh);
  EXPECT_EQ(*fresh->draw(list, camera), *first);
}

TEST(Renderer, WorksInSeveralThreadsAtOnce) {
  const DrawList list = shapes();
  const Camera camera = camera_for(list);
  const auto expected = shared_renderer().draw(list, camera);
  ASSERT_TRUE(expected);
  std::vector<Image> images(2);
  std::vector<std::thread> threads;
  threads.reserve(images.size());
  for (Image& image : images) {
    threads.emplace_back([&] {
      auto renderer = Renderer::create(frame_width, frame_height);
      if (!renderer) return;
      if (auto drawn = renderer->draw(list, camera)) image = std::move(drawn).value();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Image& image : images) EXPECT_EQ(image, *expected);
}

TEST(Renderer, SceneFarFromTheOriginLooksTheSame) {
  DrawList list = shapes();
  list.planes[0].grid_spacing = 0.0;
  const auto near = shared_renderer().draw(list, camera_for(list));
  const Vector3 far{4096.0, -8192.0, 16384.0};  // exact in binary, so that only our own errors show
  for (Solid& s : list.solids) s.position += far;
  list.planes[0].point += far;
  const auto moved = shared_renderer().draw(list, camera_for(list));
  ASSERT_TRUE(near && moved);
  int different = 0;
  for (std::size_t i = 0; i < near->rgb.size(); ++i) {
    different += std::abs(static_cast<int>(near->rgb[i]) - moved->rgb[i]) > 24 ? 1 : 0;
  }
  EXPECT_LT(different, static_cast<int>(near->rgb.size() / 100));
}

TEST(Renderer, ShapesAreClippedBehindTheEye) {
  // A slab under the eye that goes on far behind it.
  DrawList list;
  list.solids = {solid(BoxShape{{100.0, 0.1, 100.0}}, {0.0, -1.0, 0.0}, rgb(0x2040ff))};
  Camera camera;
  camera.position = {0.0, 0.0, 0.0};
  camera.target = {0.0, 0.0, -5.0};
  const auto image = shared_renderer().draw(list, camera);
  ASSERT_TRUE(image);
  for (const int x : {2, frame_width / 2, frame_width - 3}) {
    const std::uint8_t* below = image->pixel(x, frame_height - 3);
    EXPECT_GT(below[2], below[0] + 40) << "the slab is blue";
    EXPECT_GT(image->pixel(x, 3)[0], 200) << "the sky is bright";
  }
}

TEST(Renderer, TheGroundHidesWhatIsUnderIt) {
  DrawList list;
  list.solids = {solid(SphereShape{0.5}, {0.0, 1.0, 0.0}, rgb(0x102030)),
                 solid(SphereShape{0.5}, {0.0, -1.0, 0.0}, rgb(0x102030))};
  list.planes.push_back({});
  Camera camera;
  camera.position = {0.0, 3.0, 12.0};
  const Projector projector(camera, frame_width, frame_height);
  const auto image = shared_renderer().draw(list, camera);
  ASSERT_TRUE(image);
  const auto brightness = [&](const Vector3& place) {
    const auto at = projector.project(place);
    return image->pixel(static_cast<int>(at->x), static_cast<int>(at->y))[1];
  };
  EXPECT_LT(brightness({0.0, 1.0, 0.0}), 120);
  EXPECT_GT(brightness({0.0, -1.2, 0.0}), 150);
}

TEST(Renderer, EmptyListIsABackground) {
  const auto image = shared_renderer().draw(DrawList{}, Camera{});
  ASSERT_TRUE(image);
  for (const std::uint8_t value : image->rgb) EXPECT_GT(value, 200);
}

TEST(Renderer, OptionsWork) {
  const DrawList list = pulley();
  const Camera camera = camera_for(list);
  RendererOptions plain;
  plain.samples = 1;
  plain.shadow_side = 0;
  plain.text = false;
  plain.line_width = 0.0;
  auto renderer = Renderer::create(frame_width, frame_height, plain);
  ASSERT_TRUE(renderer);
  const auto image = renderer->draw(list, camera);
  ASSERT_TRUE(image);
  // Without outlines, shadows and text nothing is near black, and the floor is bright.
  EXPECT_NE(*image, *shared_renderer().draw(list, camera));
  RendererOptions fine;
  fine.supersample = 2;
  auto large = Renderer::create(81, 61, fine);
  ASSERT_TRUE(large);
  const auto small = large->draw(list, camera);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->width, 81);
  EXPECT_EQ(small->height, 61);
}

TEST(Renderer, RefusesImpossibleSettings) {
  RendererOptions options;
  options.samples = 3;
  options.supersample = 9;
  options.shadow_side = 1;
  options.line_width = -1.0;
  const auto renderer = Renderer::create(0, 1000000, options);
  ASSERT_FALSE(renderer);
  EXPECT_EQ(renderer.errors().size(), 6U);
  EXPECT_EQ(renderer.errors()[1].message, "renderer: width is 0; it must lie between 16 and 8192");
}

TEST(Renderer, RefusesNumbersThatCannotBeDrawn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DrawList list = pulley();
  list.solids[0].position.x() = nan;
  list.solids[1].shape = BoxShape{{1.0, -1.0, 1.0}};
  list.solids[2].orientation.coeffs().setZero();
  list.tubes[0].points[3].position.y() = nan;
  list.labels[0].anchor.z() = nan;
  list.planes[0].normal = {0, 2, 0};
  list.legend->max = list.legend->min;
  const auto image = shared_renderer().draw(list, Camera{});
  ASSERT_FALSE(image);
  EXPECT_EQ(image.errors().size(), 7U);
  EXPECT_EQ(image.errors()[0].path, "/solids/0");
}

TEST(Validate, KnowsEveryShape) {
  const auto faulty = [](const Shape& shape) {
    DrawList list;
    list.solids.push_back(solid(shape, Vector3::Zero(), {}));
    return validate(list).size();
  };
  EXPECT_EQ(faulty(SphereShape{0.0}), 1U);
  EXPECT_EQ(faulty(CylinderShape{1.0, 0.0}), 1U);
  EXPECT_EQ(faulty(CapsuleShape{1.0, 0.0}), 0U);
  EXPECT_EQ(faulty(SheaveShape{1.0, 0.1, 1.0, 0.0, 5}), 1U);
  EXPECT_EQ(faulty(SheaveShape{1.0, 0.1, 0.1, 0.0, 65}), 1U);
  EXPECT_EQ(faulty(MeshShape{nullptr}), 1U);
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}};
  mesh->triangles = {{0, 0, 1}};
  EXPECT_EQ(faulty(MeshShape{mesh}), 1U);
}

TEST(Bounds, HoldTurnedShapes) {
  Solid s = solid(CylinderShape{1.0, 4.0}, {10, 0, 0}, {});
  Eigen::AlignedBox3d box = bounds(s);
  EXPECT_NEAR(box.max().x(), 11.0, 1e-12);
  EXPECT_NEAR(box.max().z(), 2.0, 1e-12);
  s.orientation = Quaternion(std::cos(pi / 4), 0.0, std::sin(pi / 4), 0.0);  // z axis onto x
  box = bounds(s);
  EXPECT_NEAR(box.max().x(), 12.0, 1e-12);
  EXPECT_NEAR(box.max().z(), 1.0, 1e-12);
  DrawList list;
  EXPECT_TRUE(bounds(list).isEmpty());
  list.tubes.push_back({{{{1, 2, 3}, {}}}, 0.5, false});
  EXPECT_NEAR(bounds(list).min().y(), 1.5, 1e-12);
}

}  // namespace
}  // namespace sheave::render
