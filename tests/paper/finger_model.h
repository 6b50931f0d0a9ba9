#pragma once
// A digit of scenes/paper/hand.json as a potential of its joint angles, without constraints: an
// engine-free account of how tendons, ligaments, stops and weight share a posture.
//
//   V(t) = T f(t) + T0 e(t) + k e(t)^2 / 2 + sum_i s t_i^2 / 2 - sum_i m_i g . x_i(t)
//
// with the angles t since time 0, the way f of the flexor, which the drum pulls with T, the
// lengthening e = sum_i r_i t_i of the extensor with its first tension T0 and its stiffness k, and
// the stiffness s of the ligaments. Least where dV/dt = 0.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.h"

namespace sheave::test {

class FingerModel {
 public:
  /// Reads bodies, joints and tendons whose names begin with `digit` from the scene.
  FingerModel(const Scene& scene, const std::string& digit);

  /// Angles of least potential [rad], since time 0, under a tension of the flexor [N].
  [[nodiscard]] Eigen::VectorXd posture(double flexor_tension) const;
  /// Tension of the extensor at these angles [N].
  [[nodiscard]] double extensor_tension(const Eigen::VectorXd& angles) const;
  [[nodiscard]] double potential(const Eigen::VectorXd& angles, double flexor_tension) const;
  [[nodiscard]] const std::vector<std::string>& joints() const { return joints_; }

 private:
  struct Phalanx {
    Vector3 anchor, axis;  // of its hinge, world frame at time 0
    Vector3 center;        // of mass, world frame at time 0
    Vector3 hole;          // of the flexor, world frame at time 0
    double mass = 0.0;
    double stiffness = 0.0;     // of its hinge's ligament [N m/rad]
    double wheel_radius = 0.0;  // of the extensor at its hinge [m]
  };
  [[nodiscard]] double flexor_way(const std::vector<Vector3>& holes) const;

  std::vector<std::string> joints_;
  std::vector<Phalanx> phalanges_;
  Vector3 gravity_ = Vector3::Zero();
  Vector3 drum_ = Vector3::Zero();
  Quaternion drum_frame_ =
      Quaternion::Identity();  // x along the metacarpal, y towards the palm, z the axis
  double drum_radius_ = 0.0;
  double first_tension_ = 0.0, stiffness_ = 0.0;  // of the extensor
};

}  // namespace sheave::test
