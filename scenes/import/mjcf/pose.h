#pragma once
// Where the bodies and joints of a model are for given coordinates.

#include <span>
#include <vector>

#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

struct BodyPose {
  Frame frame;                                 ///< in the world
  Vector3 velocity = Vector3::Zero();          ///< of the origin, world frame [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< world frame [rad/s]
};

/// The joint after the joints before it on the same body have moved.
struct JointPose {
  Vector3 anchor = Vector3::Zero();  ///< world frame [m]
  Vector3 axis = Vector3::UnitZ();   ///< world frame, unit vector
};

struct Pose {
  std::vector<double> positions;  ///< coordinates, as MuJoCo's qpos
  std::vector<BodyPose> bodies;
  std::vector<JointPose> joints;
};

/// The coordinates in which the text describes the model.
[[nodiscard]] std::vector<double> reference_positions(const Model& model);

/// `velocities` may be empty, which means 0.
[[nodiscard]] Pose pose_of(const Model& model, std::vector<double> positions,
                           std::span<const double> velocities);

}  // namespace sheave::import::mjcf
