#pragma once
// The contents of a JointSpace; internal to statics.

#include <string>
#include <vector>

#include "statics/coordinate_basis.h"
#include "statics/joint_space.h"
#include "statics/machine_pose.h"

namespace sheave {

struct JointSpace::Content {
  explicit Content(Simulation& own);

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(coordinates.size()); }
  /// The rate of v = Z u + v0 along the motion, with u fixed.
  [[nodiscard]] VectorX acceleration_by_turning();
  /// w x (angular momentum), for bodies whose inertia turns with them.
  [[nodiscard]] VectorX gyroscopic_torques() const;
  [[nodiscard]] VectorX gravity() const;
  /// Constant forces, and forces set by controls, along the degrees of freedom.
  [[nodiscard]] VectorX set_forces() const;
  /// Forces of springs, dampers and elastic stops of joints, along the degrees of freedom.
  [[nodiscard]] VectorX joint_forces(Configuration& configuration) const;
  /// Why these are no n finite numbers; empty if they are.
  [[nodiscard]] std::string fault_of(const ModalVector& values, const std::string& name) const;

  Simulation& simulation;
  State state;
  MachinePose pose;
  MatrixX mass;  ///< of the bodies, along their degrees of freedom
  std::vector<MachineCoordinate> coordinates;
  CoordinateBasis basis;
  VectorX rates;
  VectorX velocities;  ///< of the bodies, as joints allow them
};

}  // namespace sheave
