#pragma once
// A pointer that drags a body by a spring with a damper between a point of the body and a target.

#include <optional>

#include "cable/live_world.h"

namespace sheave::web {

/// The dragged body and the target. The force is computed implicitly: its value is that at the end
/// of the coming substep for a body without other constraints, so no stiffness can make the spring
/// unstable. A constrained body moves less, and the spring is then softer.
class PointerSpring {
 public:
  /// Grabs body `body` at a world point [m]. The stiffness is chosen for the machine: with a mass
  /// of a tenth of all bodies, or with the body's if that is larger, the spring is a critically
  /// damped oscillator of 2.5 Hz. Fails if the body cannot move.
  Errors grab(const LiveWorld& world, int body, const Vector3& point);
  /// Sets the target of the point [m].
  void move(const Vector3& target) { target_ = target; }
  /// Releases the body and removes the force.
  void release(LiveWorld& world);
  [[nodiscard]] bool holds() const { return body_ >= 0; }
  /// The grabbed body; -1: none.
  [[nodiscard]] int body() const { return body_; }
  /// Copies the grip from a world of the same machine.
  void copy_grip(const PointerSpring& other);

  /// Sets the force for a substep of `h` [s]. To be called before each substep.
  void act(LiveWorld& world, double h);
  /// Force in the last substep, world frame [N].
  [[nodiscard]] const Vector3& force() const { return force_; }

 private:
  void drag_kinematic(LiveWorld& world, double h) const;

  int body_ = -1;
  bool kinematic_ = false;
  double own_mass_ = 1.0;  // mass of the body [kg]
  double stiffness_ = 0.0;
  double damping_ = 0.0;
  Vector3 local_ = Vector3::Zero();
  Vector3 target_ = Vector3::Zero();
  Vector3 force_ = Vector3::Zero();
};

}  // namespace sheave::web
