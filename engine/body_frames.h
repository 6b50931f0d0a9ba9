#pragma once
// Where bodies were when something was defined that came into a running world.

#include <memory>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// The frame of a body, in the world.
struct BodyFrame {
  Vector3 position = Vector3::Zero();               ///< of its origin [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
};

/// One per body that there was, by index. Null stands for time 0.
using BodyFrames = std::shared_ptr<const std::vector<BodyFrame>>;

}  // namespace sheave
