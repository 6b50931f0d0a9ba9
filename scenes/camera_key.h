#pragma once
// A keyframe of the camera with which films and pages are taken.

#include <optional>
#include <span>

#include "engine/field.h"
#include "engine/vector.h"

namespace sheave {

/// The camera rests at each keyframe and moves smoothly to the next one
/// (render/camera_path.h).
struct CameraKeyDef {
  double time = 0.0;                   ///< [s] >= 0, after that of the keyframe before
  Vector3 position = Vector3::Zero();  ///< of the eye [m]
  Vector3 target = Vector3::Zero();    ///< in the middle of the picture [m]; not the position
  std::optional<Vector3> up;           ///< up in the picture; default: that of the camera
  /// perspective: full vertical angle [rad], in (0, pi); default: that of the camera
  std::optional<double> vertical_fov;
  /// orthographic: height of the picture [m] > 0, required there
  std::optional<double> height;

  static std::span<const Field> field_table();
};

}  // namespace sheave
