#include "command/camera_side.h"

#include <cmath>

#include <CLI/CLI.hpp>

namespace sheave::command {
namespace {

Vector3 up_of(const Scene& scene, const CameraDef& camera) {
  if (camera.up) return camera.up->normalized();
  const Vector3& gravity = scene.model.gravity;
  return gravity.norm() > 0.0 ? Vector3(-gravity.normalized()) : Vector3(Vector3::UnitY());
}

/// The axis nearest to the horizontal part of a direction.
Vector3 nearest_axis(const Vector3& direction, const Vector3& up) {
  const auto level = [&](const Vector3& v) { return Vector3(v - v.dot(up) * up); };
  Vector3 along = level(direction);
  // A camera that looks straight down has no front.
  constexpr double upright = 1e-3;
  if (!(along.norm() > upright)) along = level(-Vector3::UnitZ());
  if (!(along.norm() > upright)) along = level(Vector3::UnitY());
  Eigen::Index most = 0;
  along.cwiseAbs().maxCoeff(&most);
  return std::copysign(1.0, along[most]) * Vector3::Unit(most);
}

}  // namespace

void add_view_option(CLI::App& app, std::string& view) {
  app.add_option("--view", view,
                 "look from the front, from the side or from above, along an axis; default: the "
                 "scene's camera")
      ->check(CLI::IsMember({"front", "side", "top"}))
      ->option_text("SIDE");
}

void look_from(const std::string& view, Scene& scene) {
  if (view.empty()) return;
  CameraDef camera = scene.camera.value_or(CameraDef{});
  const Vector3 up = up_of(scene, camera);
  Vector3 direction = camera.direction.value_or(-Vector3::UnitZ());
  if (camera.position && camera.target) direction = *camera.target - *camera.position;
  const Vector3 front = nearest_axis(direction, up);
  scene.camera_path.clear();
  camera.position.reset();
  camera.target.reset();
  camera.height.reset();
  camera.direction = view == "front" ? front : view == "side" ? up.cross(front) : Vector3(-up);
  camera.up = view == "top" ? front : up;
  scene.camera = camera;
}

}  // namespace sheave::command
