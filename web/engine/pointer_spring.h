#pragma once
// A pointer that drags a body: a spring with a damper from a point of the body to a place.

#include <optional>

#include "cable/live_world.h"

namespace sheave::web {

/// What is dragged, and where to. The force is that at the end of the coming substep for a body that
/// nothing else holds, so that no stiffness makes it unstable; what is held yields less, and the
/// spring is the softer for it.
class PointerSpring {
 public:
  /// Takes hold of body `body` at a world point [m]. The spring is as strong as the whole machine
  /// asks for: of a mass that is its tenth, or the body's, it makes an oscillator of 2.5 Hz,
  /// critically damped. Fails where nothing can move the body.
  Errors grab(const LiveWorld& world, int body, const Vector3& point);
  /// Where the point is to go [m].
  void move(const Vector3& target) { target_ = target; }
  /// Lets go: the body is as free as it was.
  void release(LiveWorld& world);
  [[nodiscard]] bool holds() const { return body_ >= 0; }
  /// The body that is held, -1 if none is.
  [[nodiscard]] int body() const { return body_; }
  /// The same grip on a world that is the same machine.
  void copy_grip(const PointerSpring& other);

  /// Sets the force of a substep of `h` [s]. To be called before each.
  void act(LiveWorld& world, double h);
  /// Of the last substep, in the world [N].
  [[nodiscard]] const Vector3& force() const { return force_; }

 private:
  void drag_kinematic(LiveWorld& world, double h) const;

  int body_ = -1;
  bool kinematic_ = false;
  double own_mass_ = 1.0;  // of the body [kg]
  double stiffness_ = 0.0;
  double damping_ = 0.0;
  Vector3 local_ = Vector3::Zero();
  Vector3 target_ = Vector3::Zero();
  Vector3 force_ = Vector3::Zero();
};

}  // namespace sheave::web
