#pragma once
// Detects drives that prescribe motions which the mobilities of the bodies exclude.

#include <string>

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// The relative rotations that a joint permits.
enum class Turning {
  about_one_axis,  ///< one axis only: a hinge
  freely,          ///< all: a ball joint, or locks with compliance
};

/// Appends an error if a drive without a limit prescribes the angle about `axis`, and neither body
/// can turn about it. `axis` is in the world frame at the definition of the joint. `path` is that
/// of the drive's field.
void check_reach(const JointCoordinate& angle, const JointDef& joint, const Vector3& axis,
                 Turning turning, const BodySet& bodies, const std::string& path, Errors& errors);

}  // namespace sheave
