#include "render/camera_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/field.h"

namespace sheave::render {
namespace {

Camera camera_at(const Vector3& position, const Vector3& target) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  return camera;
}

TEST(CameraPath, RestsBeforeTheFirstAndAfterTheLastKeyframe) {
  const CameraPath path({{1.0, camera_at({0.0, 0.0, 5.0}, Vector3::Zero())},
                         {3.0, camera_at({0.0, 2.0, 9.0}, Vector3::UnitX())}});
  for (const double time : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(path.at(time).position, Vector3(0.0, 0.0, 5.0)) << time;
  }
  for (const double time : {3.0, 4.0, 1e9}) {
    EXPECT_EQ(path.at(time).position, Vector3(0.0, 2.0, 9.0)) << time;
  }
}

TEST(CameraPath, GoesRoundATargetAtTheSameDistance) {
  // A quarter of a turn about y. Half of the time is half of the angle; rounding of the rotation is
  // some 1e-15 of 4 m.
  const Vector3 target(1.0, 2.0, 3.0);
  const CameraPath path({{0.0, camera_at(target + Vector3(0.0, 0.0, 4.0), target)},
                         {2.0, camera_at(target + Vector3(4.0, 0.0, 0.0), target)}});
  for (int k = 0; k <= 20; ++k) {
    const double u = 0.05 * k;
    const double angle = 0.5 * pi * u * u * (3.0 - 2.0 * u);
    const Camera camera = path.at(2.0 * u);
    const Vector3 expected = target + 4.0 * Vector3(std::sin(angle), 0.0, std::cos(angle));
    EXPECT_LT((camera.position - expected).norm(), 1e-13) << k;
    EXPECT_LT((axes(camera).up - Vector3::UnitY()).norm(), 1e-13) << k;
    EXPECT_TRUE(validate(camera).empty());
  }
}

TEST(CameraPath, MovesWithoutAJumpOfItsSpeed) {
  // The distance changes by equal ratios, so its logarithm is 3 u^2 - 2 u^3, whose rate is 0 at both
  // ends. The error of the difference quotient is half of its second derivative, 6, times the step.
  const CameraPath path({{0.0, camera_at({0.0, 0.0, 1.0}, Vector3::Zero())},
                         {1.0, camera_at({0.0, 0.0, std::exp(1.0)}, Vector3::Zero())},
                         {2.0, camera_at({0.0, 0.0, 1.0}, Vector3::Zero())}});
  const double step = 1e-4;
  for (const double time : {0.0, 1.0, 2.0}) {
    const double before = std::log(path.at(time - step).position.norm());
    const double after = std::log(path.at(time + step).position.norm());
    EXPECT_LT(std::abs(after - before) / step, 6.0 * step) << time;
  }
  EXPECT_NEAR(path.at(0.5).position.norm(), std::exp(0.5), 1e-14);
}

TEST(CameraPath, ChangesTheAngleAndTheHeight) {
  Camera wide = camera_at({0.0, 0.0, 5.0}, Vector3::Zero());
  Camera narrow = wide;
  wide.projection = Perspective{2.0 * std::atan(0.4)};
  narrow.projection = Perspective{2.0 * std::atan(0.1)};
  const Camera middle = CameraPath({{0.0, wide}, {1.0, narrow}}).at(0.5);
  EXPECT_NEAR(std::get<Perspective>(middle.projection).vertical_fov, 2.0 * std::atan(0.2), 1e-15);
  wide.projection = Orthographic{8.0};
  narrow.projection = Orthographic{2.0};
  const Camera flat = CameraPath({{0.0, wide}, {1.0, narrow}}).at(0.5);
  EXPECT_NEAR(std::get<Orthographic>(flat.projection).height, 4.0, 1e-14);
}

}  // namespace
}  // namespace sheave::render
