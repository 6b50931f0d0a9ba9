#pragma once

#include "engine/vector.h"

namespace sheave {

/// A force and a torque about `about`, all in the world frame.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m]
  Vector3 about = Vector3::Zero();   ///< [m]
};

}  // namespace sheave
