#pragma once
// The joint of a scene that leaves a body the motions of its joints in a model.

#include <optional>

#include "scenes/import/log.h"
#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

enum class JointKind {
  none,         ///< no joint of a scene leaves these motions, or it has too few coordinates
  free,         ///< no joint
  hinge,        ///< one hinge
  slider,       ///< one slide
  ball,         ///< one ball
  universal,    ///< two hinges whose axes meet at a right angle
  cylindrical,  ///< a slide and a hinge along one direction
  plane,        ///< two slides and a hinge at right angles
  three_hinges  ///< at right angles that meet in one point: a ball
};

/// The kind of a body with at least one joint. A plane and a ball have no coordinates for slides and
/// for three hinges, so nothing may act along these.
[[nodiscard]] JointKind joint_kind(const Model& model, int body);
/// The point in the body frame at which the axes of two hinges of the body meet.
[[nodiscard]] std::optional<Vector3> meeting_point(const Joint& a, const Joint& b);

/// Gives each body whose joints are of no kind a chain of bodies, each with one of these joints.
/// Bodies between have small masses, which the log tells. The coordinates of the model stay.
void split_joints(Model& model, Log& log);

}  // namespace sheave::import::mjcf
