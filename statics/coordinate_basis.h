#pragma once
// Independent coordinates of a machine, and the motions that they describe; internal to statics.

#include <vector>

#include "statics/joint_space.h"
#include "statics/machine_pose.h"

namespace sheave {

/// All coordinates of joints and bodies; some depend on others. Joints that carry bodies come first,
/// then bodies, then distance joints, gears and racks.
[[nodiscard]] std::vector<MachineCoordinate> all_coordinates(const World& world,
                                                             const MachinePose& pose);

/// The value and the gradient of a coordinate in the present pose.
[[nodiscard]] PoseMeasure measure(const MachinePose& pose, const MachineCoordinate& coordinate);

/// The coordinates, in their order, that are independent of the rigid joints and of the ones before
/// them. The first `given` are taken in any case. The result has the order of `candidates`.
[[nodiscard]] std::vector<MachineCoordinate> independent_coordinates(
    MachinePose& pose, const std::vector<MachineCoordinate>& candidates, std::size_t given);

/// Velocities along the degrees of freedom: v = motions u + drift.
struct CoordinateBasis {
  MatrixX gradients;  ///< G, n x degrees of freedom
  VectorX turning;    ///< rates of the coordinates by prescribed bodies: u = G v + turning
  MatrixX motions;    ///< Z, degrees of freedom x n
  VectorX drift;      ///< v0
};
/// In the present pose. The coordinates must be independent there.
[[nodiscard]] CoordinateBasis basis_of(MachinePose& pose,
                                       const std::vector<MachineCoordinate>& coordinates);

}  // namespace sheave
