#pragma once
// Drives that ask bodies for motions which their mobilities do not have.

#include <string>

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// How a joint lets its bodies turn against each other.
enum class Turning {
  about_one_axis,  ///< and not otherwise: a hinge
  freely,          ///< a ball joint, or locks that give
};

/// Appends an error if a drive without limit prescribes the angle about `axis` (world frame where
/// the joint was told), and neither body can turn about it. `path` is that of the drive's field.
void check_reach(const JointCoordinate& angle, const JointDef& joint, const Vector3& axis,
                 Turning turning, const BodySet& bodies, const std::string& path, Errors& errors);

}  // namespace sheave
