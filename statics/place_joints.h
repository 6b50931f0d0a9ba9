#pragma once
// Machines put into poses by the coordinates of their joints.
//
//   sheave::Result<sheave::Placement> placed =
//       sheave::place_joints(world, {{"elbow", 0.3}, {"shoulder", -1.2}}, sheave::Keep::tension);
//   if (!placed) report(placed.errors());

#include <string>
#include <vector>

#include "cable/live_world.h"
#include "statics/joint_space.h"

namespace sheave {

/// The value that a coordinate is to have.
struct CoordinateTarget {
  /// Name of a coordinate, "elbow.angle" or "base.x" (MachineCoordinate::name), or of a joint or body
  /// with one coordinate, "elbow", "drum". Coordinates that depend on others are allowed.
  std::string name;
  double value = 0.0;  ///< [m or rad]; angles with whole turns
};

/// Largest change of a coordinate by one placement: angles [rad], and lengths in sizes of the scene.
inline constexpr double most_placement = 1000.0;

/// Moves all bodies so that the coordinates have these values, and rigid joints are closed.
/// Coordinates that `targets` does not name keep their values, in the order of
/// JointSpace::coordinates(), as far as loops and targets leave them free; so do all rates. Drives,
/// springs, stops and cables do not hinder the placement. Time does not pass.
///
/// Cables follow along the straight way in the coordinates, as in LiveWorld::place(). With
/// Keep::length the unstretched lengths stay, and a rigid cable that is too short for the way is an
/// error. With Keep::tension each span gets the rest length with which its tension or its slack stays.
///
/// An error, without any change: a machine beyond JointSpace::most_freedoms, an unknown name, a value that is not finite or too far away, and
/// loops that cannot be closed, with the largest residual.
[[nodiscard]] Result<Placement> place_joints(LiveWorld& world,
                                             const std::vector<CoordinateTarget>& targets,
                                             Keep keep);

/// Sets the rates of coordinates [m/s or rad/s]; the names are those of place_joints(), but a
/// coordinate must be one of JointSpace::coordinates(). Other rates stay, and so does the pose.
[[nodiscard]] Errors set_joint_rates(LiveWorld& world, const std::vector<CoordinateTarget>& rates);

}  // namespace sheave
