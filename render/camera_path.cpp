#include "render/camera_path.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace sheave::render {
namespace {

double between_ratios(double a, double b, double s) { return a * std::pow(b / a, s); }

Quaternion turn_of(const CameraAxes& axes) {
  Matrix3 columns;
  columns << axes.right, axes.up, axes.back;
  return Quaternion(columns);
}

std::variant<Perspective, Orthographic> between(const Camera& a, const Camera& b, double s) {
  if (const auto* first = std::get_if<Perspective>(&a.projection)) {
    const auto& second = std::get<Perspective>(b.projection);
    const double tangent =
        between_ratios(std::tan(0.5 * first->vertical_fov), std::tan(0.5 * second.vertical_fov), s);
    return Perspective{2.0 * std::atan(tangent)};
  }
  return Orthographic{between_ratios(std::get<Orthographic>(a.projection).height,
                                     std::get<Orthographic>(b.projection).height, s)};
}

Camera camera_between(const Camera& a, const Camera& b, double s) {
  const Quaternion turn = turn_of(axes(a)).slerp(s, turn_of(axes(b)));
  const double distance =
      between_ratios((a.position - a.target).norm(), (b.position - b.target).norm(), s);
  Camera camera;
  camera.target = (1.0 - s) * a.target + s * b.target;
  camera.position = camera.target + distance * (turn * Vector3::UnitZ());
  camera.up = turn * Vector3::UnitY();
  camera.projection = between(a, b, s);
  return camera;
}

}  // namespace

Camera CameraPath::at(double time) const {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time,
                                     [](double t, const CameraKey& key) { return t < key.time; });
  if (next == keys_.begin()) return keys_.front().camera;
  if (next == keys_.end()) return keys_.back().camera;
  const CameraKey& before = *(next - 1);
  const double u = (time - before.time) / (next->time - before.time);
  return camera_between(before.camera, next->camera, u * u * (3.0 - 2.0 * u));
}

}  // namespace sheave::render
