#include "render/gl/view.h"

#include <algorithm>
#include <cmath>

namespace sheave::render {
namespace {

/// Depth by which edges are lifted off surfaces, in pixels: enough for the slope of a surface
/// across the width of a line, and too little to show hidden edges through thin parts.
constexpr double nudge_pixels = 1.5;

Eigen::Matrix4d look(const CameraAxes& a, const Vector3& eye) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = a.right.transpose();
  m.block<1, 3>(1, 0) = a.up.transpose();
  m.block<1, 3>(2, 0) = a.back.transpose();
  m.block<3, 1>(0, 3) = -(m.block<3, 3>(0, 0) * eye);
  return m;
}

Eigen::Matrix4d perspective(double fov, double aspect, double near, double far) {
  const double f = 1.0 / std::tan(0.5 * fov);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2.0 * far * near / (near - far);
  m(3, 2) = -1.0;
  return m;
}

Eigen::Matrix4d orthographic(double width, double height, double near, double far) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m(0, 0) = 2.0 / width;
  m(1, 1) = 2.0 / height;
  m(2, 2) = -2.0 / (far - near);
  m(2, 3) = -(far + near) / (far - near);
  return m;
}

/// Rounds a length up to one of a few sizes, so that the shadow map's texels keep their size while
/// bodies move.
double steady_size(double length) {
  return std::exp2(std::ceil(std::log2(std::max(length, 1e-300)) * 8.0) / 8.0);
}

}  // namespace

View make_view(const Camera& camera, int width, int height, const Eigen::AlignedBox3d& contents) {
  const double aspect = static_cast<double>(width) / height;
  View view;
  view.origin = camera.target;
  const CameraAxes a = axes(camera);
  const Vector3 eye = camera.position - view.origin;
  const double distance = eye.norm();
  Vector3 centre = Vector3::Zero();
  view.radius = 0.1 * distance;
  if (!contents.isEmpty()) {
    centre = contents.center() - view.origin;
    view.radius = std::max(0.5 * contents.diagonal().norm(), 1e-3 * distance);
  }
  const double reach = (eye - centre).norm();
  Eigen::Matrix4d projection;
  if (const auto* p = std::get_if<Perspective>(&camera.projection)) {
    const double half_height = distance * std::tan(0.5 * p->vertical_fov);
    view.nudge = static_cast<float>(nudge_pixels * 2.0 * half_height / (distance * height));
    view.ground_radius = std::max(4.0 * view.radius, 6.0 * half_height * std::max(1.0, aspect));
    const double far = reach + view.radius + 1.5 * view.ground_radius;
    // The near plane is near enough to show the ground at the lower edge of the picture.
    const double near =
        std::max(0.02 * std::min(distance, std::max(reach - view.radius, 0.0)), 1e-4 * far);
    projection = perspective(p->vertical_fov, aspect, near, far);
    view.eye_direction.setZero();
  } else {
    const double tall = std::get<Orthographic>(camera.projection).height;
    view.nudge = static_cast<float>(nudge_pixels * tall / (distance * height));
    view.ground_radius = std::max(4.0 * view.radius, 3.0 * tall * std::max(1.0, aspect));
    const double depth = reach + view.radius + 1.5 * view.ground_radius;
    projection = orthographic(tall * aspect, tall, -depth, depth);
    view.eye_direction = a.back.cast<float>();
  }
  view.view_projection = (projection * look(a, eye)).cast<float>();
  view.eye = eye.cast<float>();
  view.up = a.up.cast<float>();
  return view;
}

Light make_light(const Camera& camera, const Vector3& up, const View& view,
                 const Eigen::AlignedBox3d& contents, int shadow_side) {
  const CameraAxes a = axes(camera);
  // The light comes from above, from the left and from behind the viewer. The latter two directions
  // are level, so that shadows fall to one side on the ground.
  Vector3 level_right = a.right - up * up.dot(a.right);
  Vector3 level_back = a.back - up * up.dot(a.back);
  if (level_right.norm() < 1e-6) level_right = any_perpendicular(up);
  if (level_back.norm() < 1e-6) level_back = a.up - up * up.dot(a.up);
  if (level_back.norm() < 1e-6) level_back = any_perpendicular(up);
  const Vector3 to_light =
      (up - 0.42 * level_right.normalized() + 0.62 * level_back.normalized()).normalized();
  Light light;
  light.to_light = to_light.cast<float>();
  const double radius = steady_size(1.05 * view.radius);
  light.texel = 2.0 * radius / shadow_side;
  const Vector3 side = any_perpendicular(to_light);
  const CameraAxes frame{side, to_light.cross(side), to_light};
  Vector3 centre = Vector3::Zero();
  if (!contents.isEmpty()) centre = contents.center() - view.origin;
  // The centre moves in whole texels of a grid fixed in the world; otherwise the edges of shadows
  // would crawl.
  const auto snap = [&](const Vector3& axis) {
    const double offset = axis.dot(view.origin);
    return std::round((axis.dot(centre) + offset) / light.texel) * light.texel - offset;
  };
  const Vector3 snapped = frame.right * snap(frame.right) + frame.up * snap(frame.up) +
                          frame.back * frame.back.dot(centre);
  const Eigen::Matrix4d projection = orthographic(2.0 * radius, 2.0 * radius, 0.0, 4.0 * radius);
  light.shadow_matrix =
      (projection * look(frame, snapped + to_light * (2.0 * radius))).cast<float>();
  return light;
}

}  // namespace sheave::render
