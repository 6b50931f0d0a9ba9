#include "scenes/validate_pictures.h"

#include <utility>

#include <fmt/format.h>

#include "engine/field_check.h"

namespace sheave {
namespace {

/// Sine of the smallest angle between directions that count as not parallel.
constexpr double least_view_sine = 1e-6;

void check_key(const Scene& scene, std::size_t i, Errors& errors) {
  const CameraKeyDef& key = scene.camera_path[i];
  const CameraDef camera = scene.camera.value_or(CameraDef{});
  const std::string path = fmt::format("/camera_path/{}", i);
  check_fields(CameraKeyDef::field_table(), &key, path, errors);
  const auto fail = [&](std::string_view field, std::string message) {
    errors.push_back({fmt::format("{}/{}", path, field), "camera_path: " + std::move(message)});
  };
  if (i > 0 && !(key.time > scene.camera_path[i - 1].time)) {
    fail("time", fmt::format("time is {} s, not after the keyframe before, {} s; put the keyframes "
                             "in the order of time",
                             key.time, scene.camera_path[i - 1].time));
  }
  const bool orthographic = camera.projection == Projection::orthographic;
  if (orthographic && !key.height) {
    fail("height", "an orthographic picture needs a height in metres at each keyframe");
  }
  if (!orthographic && key.height) {
    fail("height",
         "only an orthographic picture has a height in metres; give vertical_fov, or projection "
         "\"orthographic\" to the camera");
  }
  if (orthographic && key.vertical_fov) {
    fail("vertical_fov", "only a perspective picture has an opening angle; give height instead");
  }
  const Vector3 view = key.target - key.position;
  if (!(view.norm() > 0.0)) return fail("target", "target must not be the position of the eye");
  const std::optional<Vector3> up = key.up ? key.up : camera.up;
  if (!up) return;
  if (!(up->norm() > 0.0)) {
    if (key.up) fail("up", "up must not be zero");
    return;
  }
  if (!(view.normalized().cross(up->normalized()).norm() > least_view_sine)) {
    fail(key.up ? "up" : "target", "up must not be parallel to the direction of view");
  }
}

}  // namespace

Errors validate_pictures(const Scene& scene) {
  Errors errors;
  for (std::size_t i = 0; i < scene.camera_path.size(); ++i) check_key(scene, i, errors);
  if (!scene.camera_path.empty() && scene.camera && scene.camera->position) {
    errors.push_back({"/camera/position",
                      "camera: position and target exclude camera_path, whose keyframes have them; "
                      "leave one out"});
  }
  if (!scene.camera_path.empty() && scene.camera && scene.camera->direction) {
    errors.push_back({"/camera/direction",
                      "camera: direction excludes camera_path, whose keyframes have their own; "
                      "leave one out"});
  }
  for (std::size_t i = 0; i < scene.annotations.size(); ++i) {
    const AnnotationDef& annotation = scene.annotations[i];
    const std::string path = fmt::format("/annotations/{}", i);
    check_fields(AnnotationDef::field_table(), &annotation, path, errors);
    for (Error& error : annotation.validate(path)) errors.push_back(std::move(error));
    const auto bodies = static_cast<int>(scene.model.bodies.size());
    if (annotation.body.index >= bodies || annotation.body.index < BodyId::world_index) {
      errors.push_back({path + "/body", fmt::format("annotation: body {} does not exist; the scene "
                                                    "has {} bodies",
                                                    annotation.body.index, bodies)});
    }
  }
  return errors;
}

}  // namespace sheave
