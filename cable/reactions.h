#pragma once
// Forces and powers that no constraint has as its own: what bearings bear, what drives do, what
// friction takes.
//
// They follow from the two ends of the last substep and the forces reported of it, by the balances
// of momentum (as means over the substep). Nothing is computed or kept in the course of a run for
// them.
//
//   if (const auto reactions = Reactions::of(simulation)) bearing = reactions->bearing(wheel);

#include <memory>
#include <optional>

#include "cable/simulation.h"

namespace sheave {

/// What the bearings of a rotor do to it; the opposite acts on its mount, or on the world.
struct BearingReaction {
  Vector3 force = Vector3::Zero();  ///< [N], world frame
  Vector3 torque =
      Vector3::Zero();  ///< across the axle, about the rotor's centre [N m], world frame
};

/// What the drive of a rotor does.
struct DriveReaction {
  double torque = 0.0;  ///< about the axle, on the rotor [N m]
  double power = 0.0;   ///< that it puts in [W]; of a mounted rotor with what it does to the mount
  /// By how much the rotor is off what the drive asks for now: its angle [rad], its speed [rad/s];
  /// 0 of a torque.
  double error = 0.0;
};

/// Of the last substep of a simulation, which must outlive it and not step meanwhile. What cannot
/// be told, because something acts that is not reported in full (gears whose axes tilt), is not a
/// number.
class Reactions {
 public:
  /// Nothing at time 0, and after World::restore() until the next step.
  static std::optional<Reactions> of(const Simulation& simulation);
  ~Reactions();
  Reactions(Reactions&&) noexcept;
  Reactions& operator=(Reactions&&) noexcept;

  /// `body` must be a rotor.
  [[nodiscard]] BearingReaction bearing(int body) const;
  /// `body` must be a rotor with a drive.
  [[nodiscard]] DriveReaction drive(int body) const;
  /// Power of the drive along a coordinate of a joint [W], as it is numbered in
  /// JointReport::coordinates.
  [[nodiscard]] double drive_power(int joint, int coordinate) const;
  /// Of all drives of bodies and joints [W].
  [[nodiscard]] double drive_power() const;
  // What dry friction takes [W], >= 0 but for rounding.
  [[nodiscard]] double joint_friction(int joint) const;
  /// Of a cable that slides over a link of its list.
  [[nodiscard]] double link_friction(int cable, int link) const;
  /// Of all joints, cables and contacts.
  [[nodiscard]] double friction() const;

 private:
  struct Content;
  explicit Reactions(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// Linear [kg m/s] and angular momentum [kg m2/s].
struct Momentum {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
};
/// Of one body, the angular one about its centre of mass. The mass of mounted rotors is their
/// carrier's, and so is their inertia but for the spin about the axle, which is all that they have
/// themselves. What is fixed or kinematic has none.
[[nodiscard]] Momentum momentum(const World& world, int body);
/// Of all bodies, the angular one about the world's origin.
[[nodiscard]] Momentum momentum(const World& world);

}  // namespace sheave
