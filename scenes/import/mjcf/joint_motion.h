#pragma once
// A model in its own velocities (MuJoCo's qvel): mass matrix, forces of tendons, motion.

#include <vector>

#include <Eigen/Core>

#include "scenes/import/mjcf/tendon_pull.h"

namespace sheave::import::mjcf {

using JointVector = Eigen::VectorXd;
using JointMatrix = Eigen::MatrixXd;

/// The velocities of a model in one pose.
class JointMotion {
 public:
  /// Both must outlive this object.
  JointMotion(const Model& model, const Pose& pose);

  /// Kinetic energy is half of u^T M u, with armatures [kg, kg m, kg m2].
  [[nodiscard]] JointMatrix mass_matrix() const;
  /// Forces along the velocities that keep them constant: centrifugal and Coriolis forces.
  [[nodiscard]] JointVector bias(const JointVector& velocities) const;
  /// d length / d velocity of a tendon, one per velocity [m/m or m/rad].
  [[nodiscard]] JointVector arms(const TendonPull& tendon) const;

 private:
  /// The motion by the velocities from `first` to before `end`.
  [[nodiscard]] Screw part(const JointVector& velocities, int first, int end) const;
  /// The powers of forces on bodies per velocity.
  [[nodiscard]] JointVector along(std::vector<Screw> behind) const;

  const Model& model_;
  const Pose& pose_;
  std::vector<Screw> screws_;  ///< per velocity: of the bodies behind it, about the origin
  std::vector<int> bodies_;    ///< per velocity: the first body that it moves
};

/// The coordinates after a time [s] at constant velocities.
void advance(const Model& model, const JointVector& velocities, double time,
             std::vector<double>& positions);

}  // namespace sheave::import::mjcf
