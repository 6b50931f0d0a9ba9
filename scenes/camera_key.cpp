#include "scenes/camera_key.h"

#include <array>

namespace sheave {

std::span<const Field> CameraKeyDef::field_table() {
  static const std::array table{
      field<&CameraKeyDef::time>("time", "s", at_least(0.0), required,
                                 "time of the keyframe, after that of the one before"),
      field<&CameraKeyDef::position>("position", "m", any_number(), required,
                                     "position of the eye"),
      field<&CameraKeyDef::target>("target", "m", any_number(), required,
                                   "point in the middle of the picture"),
      field<&CameraKeyDef::up>("up", "", any_number(), optional,
                               "up in the picture; default: that of the camera"),
      field<&CameraKeyDef::vertical_fov>(
          "vertical_fov", "rad", Range{0.0, pi, false, false}, optional,
          "perspective: full vertical opening angle; default: that of the camera"),
      field<&CameraKeyDef::height>("height", "m", above(0.0), optional,
                                   "orthographic: height of the picture; required there"),
  };
  return table;
}

}  // namespace sheave
