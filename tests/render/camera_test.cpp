#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace sheave::render {
namespace {

using Eigen::AlignedBox3d;

/// Smallest and largest place of the box's corners in the picture, as fractions of its size.
struct Extent {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
};

Extent extent_of(const AlignedBox3d& box, const Camera& camera, int width, int height) {
  const Projector projector(camera, width, height);
  Extent e;
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner = box.corner(static_cast<AlignedBox3d::CornerType>(i));
    const auto p = projector.project(corner);
    if (!p) return {};
    e.left = std::min(e.left, p->x / width);
    e.right = std::max(e.right, p->x / width);
    e.top = std::min(e.top, p->y / height);
    e.bottom = std::max(e.bottom, p->y / height);
  }
  return e;
}

TEST(FrameBox, FillsThePictureUpToItsMargins) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const double size = std::exp(8.0 * number(random));
    AlignedBox3d box;
    for (int k = 0; k < 2; ++k) {
      box.extend(Vector3(size * Vector3(number(random), number(random), number(random))));
    }
    FrameOptions options;
    options.aspect = std::exp(number(random));
    options.margins = {0.05, 0.2, 0.15, 0.02};
    if (i % 2 == 1) options.projection = Orthographic{};
    const Vector3 direction = Vector3(number(random), 0.9 * number(random), -1.0);
    const Camera camera = frame_box(box, direction, Vector3::UnitY(), options);
    EXPECT_TRUE(validate(camera).empty());
    const int height = 1000;
    const Extent e = extent_of(box, camera, static_cast<int>(height * options.aspect), height);
    EXPECT_GE(e.left, 0.05 - 2e-3);
    EXPECT_LE(e.right, 0.80 + 2e-3);
    EXPECT_GE(e.top, 0.15 - 2e-3);
    EXPECT_LE(e.bottom, 0.98 + 2e-3);
    // It touches both margins of one direction at least.
    const bool wide = e.left < 0.05 + 2e-3 && e.right > 0.80 - 2e-3;
    const bool tall = e.top < 0.15 + 2e-3 && e.bottom > 0.98 - 2e-3;
    EXPECT_TRUE(wide || tall) << "case " << i;
  }
}

TEST(FrameBox, TakesBoxesWithoutExtent) {
  AlignedBox3d point;
  point.extend(Eigen::Vector3d(3.0, 4.0, 5.0));
  for (const AlignedBox3d& box : {AlignedBox3d(), point}) {
    const Camera camera = frame_box(box, {0, 0, -1}, {0, 1, 0}, {});
    EXPECT_TRUE(validate(camera).empty());
    EXPECT_TRUE(camera.position.allFinite());
  }
  EXPECT_NEAR(frame_box(point, {0, 0, -1}, {0, 1, 0}, {}).target.x(), 3.0, 1e-9);
}

TEST(FrameBox, LooksAlongUpWithoutFailing) {
  const AlignedBox3d box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
  const Camera camera = frame_box(box, {0, -1, 0}, {0, 1, 0}, {});
  EXPECT_TRUE(validate(camera).empty());
  EXPECT_GT(camera.position.y(), 1.0);
}

TEST(DefaultView, LooksNearlyAlongThePlanesNormal) {
  const Vector3 direction = default_view_direction(Vector3::UnitY(), Vector3(Vector3::UnitZ()));
  EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
  EXPECT_LT(direction.z(), -0.9);
  EXPECT_LT(direction.y(), 0.0);  // from a little above
  EXPECT_NE(direction.x(), 0.0);  // and from the side
}

TEST(DefaultView, LooksDownOnAPlaneThatLiesFlat) {
  const Vector3 direction = default_view_direction(Vector3::UnitZ(), Vector3(Vector3::UnitZ()));
  EXPECT_NEAR(direction.z(), -1.0, 1e-12);
}

TEST(DefaultView, ComesFromAboveForAnyUp) {
  for (const Vector3& up :
       {Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0, -2, 0)}) {
    EXPECT_LT(default_view_direction(up, std::nullopt).dot(up), 0.0);
  }
}

TEST(Projector, PutsTheTargetInTheMiddle) {
  Camera camera;
  camera.position = {3, 4, 5};
  camera.target = {1, 1, 1};
  const Projector projector(camera, 200, 100);
  const auto p = projector.project(camera.target);
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x, 100.0, 1e-9);
  EXPECT_NEAR(p->y, 50.0, 1e-9);
  EXPECT_NEAR(p->depth, std::sqrt(29.0), 1e-12);
  EXPECT_FALSE(projector.project({5, 7, 9}));  // behind the eye
}

TEST(CameraCheck, NamesEveryFault) {
  EXPECT_TRUE(validate(Camera{}).empty());
  Camera camera;
  camera.target = camera.position;
  EXPECT_EQ(validate(camera).size(), 1U);
  camera = {};
  camera.up = {0, 0, 1};
  EXPECT_EQ(validate(camera).front().path, "/camera/up");
  camera.projection = Perspective{4.0};
  EXPECT_EQ(validate(camera).size(), 2U);
  camera = {};
  camera.projection = Orthographic{-1.0};
  EXPECT_NE(validate(camera).front().message.find("height is -1"), std::string::npos);
  camera = {};
  camera.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(validate(camera).empty());
}

}  // namespace
}  // namespace sheave::render
