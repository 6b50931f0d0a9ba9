#pragma once
// The length of a spatial tendon in a pose, and how bodies change it.

#include <optional>
#include <vector>

#include "scenes/import/mjcf/pose.h"

namespace sheave::import::mjcf {

/// Two vectors of a body about the world's origin, world frame: force and torque, or linear
/// velocity of the point at the origin and angular velocity.
struct Screw {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();

  [[nodiscard]] double dot(const Screw& other) const {
    return linear.dot(other.linear) + angular.dot(other.angular);
  }
};

/// A unit of lengthening: the work of `pulls` at a motion of the bodies is the change of the
/// length.
struct TendonPull {
  double length = 0.0;       ///< of the path over the divisor [m]
  std::vector<Screw> pulls;  ///< per body of the model: force [1], torque [m]
};

/// Nothing if a side site lies in its geom, or the tendon has no path, joints, or branches.
[[nodiscard]] std::optional<TendonPull> tendon_pull(const Model& model, const Pose& pose,
                                                    const Tendon& tendon);

}  // namespace sheave::import::mjcf
