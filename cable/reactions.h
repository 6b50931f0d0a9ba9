#pragma once
// Forces and powers that are not the multiplier of a single constraint: reactions of bearings,
// torques of drives, dissipation by friction.
//
// All follow from the states at both ends of the last substep and its reported forces, by the
// balances of momentum, as means over the substep. A run computes and keeps nothing for them.
//
//   if (const auto reactions = Reactions::of(simulation)) bearing = reactions->bearing(wheel);

#include <memory>
#include <optional>

#include "cable/simulation.h"

namespace sheave {

/// Wrench of a rotor's bearings on the rotor. The opposite acts on its mount, or on the world.
struct BearingReaction {
  Vector3 force = Vector3::Zero();  ///< [N], world frame
  /// perpendicular to the axle, about the rotor's centre [N m], world frame
  Vector3 torque = Vector3::Zero();
};

/// Torque and power of a rotor's drive.
struct DriveReaction {
  double torque = 0.0;  ///< about the axle, on the rotor [N m]
  double power = 0.0;   ///< power put in [W]; for a mounted rotor including the work on the mount
  /// Present error of the driven quantity: angle [rad] or speed [rad/s]; 0 for a torque.
  double error = 0.0;
};

/// Reactions in the last substep of a simulation. The simulation must outlive this object and must
/// not step meanwhile. A value is NaN if it cannot be found because a force is not reported in full
/// (gears whose axes tilt).
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
  /// Power of the drive along a coordinate of a joint [W]; `coordinate` is an index in
  /// JointReport::coordinates.
  [[nodiscard]] double drive_power(int joint, int coordinate) const;
  /// Power of all drives of bodies and joints [W].
  [[nodiscard]] double drive_power() const;
  // Power dissipated by dry friction [W], >= 0 except for rounding.
  [[nodiscard]] double joint_friction(int joint) const;
  /// Of a cable that slides over a listed link.
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
/// Momentum of one body; angular momentum about its centre of mass. The mass of a mounted rotor
/// belongs to its carrier, and so does its inertia except the spin about the axle. The momentum of
/// a mounted rotor is therefore that spin only. A fixed or kinematic body has none.
[[nodiscard]] Momentum momentum(const World& world, int body);
/// Momentum of all bodies; angular momentum about the world's origin.
[[nodiscard]] Momentum momentum(const World& world);

}  // namespace sheave
