#pragma once
// The poses of bodies at the time when something was defined in a running world.

#include <memory>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// A body's frame in the world.
struct BodyFrame {
  Vector3 position = Vector3::Zero();               ///< of its origin [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
};

/// One frame per body, by index. Null stands for the poses at time 0.
using BodyFrames = std::shared_ptr<const std::vector<BodyFrame>>;

}  // namespace sheave
