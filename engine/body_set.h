#pragma once
// Bodies as the step needs them: everything that follows from the definitions once and for all.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/body.h"
#include "engine/body_frames.h"
#include "engine/dynamics/coordinates.h"
#include "engine/result.h"
#include "engine/state.h"
#include "engine/time_table.h"

namespace sheave {

struct Model;

/// Constants of one body. "Own frame": axes of the body frame, origin at the centre of mass.
struct BodyProperties {
  Mobility mobility = Mobility::fixed;
  int mount = -1;  ///< index of the body that carries a mounted rotor; -1 for all others
  /// Of the body and the rotors mounted on it [kg]; 0 where it has no effect on the motion.
  double mass = 0.0;
  Vector3 center_of_mass = Vector3::Zero();  ///< [m], body frame
  /// About the centre of mass [kg m2], own frame, with the mounted rotors' mass and their inertia
  /// across the axle, but without their inertia about it.
  Matrix3 inertia = Matrix3::Zero();
  Matrix3 inverse_inertia = Matrix3::Zero();  ///< of `inertia`; zero where the body cannot turn
  bool isotropic = false;  ///< free bodies: `inertia` is a multiple of the identity
  /// Free bodies: two principal moments are equal (a capsule, a wheel), and this is the unit axis
  /// of the third, own frame.
  std::optional<Vector3> symmetry_axis;
  /// Unit vector: planar normal, slider direction or axle, in the world frame; of a mounted rotor
  /// in its carrier's own frame.
  Vector3 axis = Vector3::UnitZ();
  /// How far it reaches from its centre, about; what its turns are compared with lengths by [m], > 0.
  double size = 1.0;
  double axis_inertia = 0.0;  ///< about the axis [kg m2]; planar bodies and rotors, 0: massless
  Vector3 mount_position = Vector3::Zero();  ///< centre of a mounted rotor, carrier's own frame [m]
  Quaternion start_orientation = Quaternion::Identity();  ///< at angle 0; relative to the carrier
  DriveKind drive = DriveKind::none;                      ///< of rotors on fixed axles
  /// Of mounted rotors, against the carrier; one to an angle has 0 at time 0. Rows drive them
  /// (engine/dynamics/mounted_drive.h).
  DriveKind mounted_drive = DriveKind::none;
  TimeTable drive_table;
  /// Either of them.
  [[nodiscard]] DriveKind driven_by() const { return mount >= 0 ? mounted_drive : drive; }
  /// Its rotation is prescribed, so constraints cannot turn it.
  [[nodiscard]] bool prescribed() const {
    return drive == DriveKind::speed || drive == DriveKind::angle;
  }
  /// A wheel that only its cable turns, without any resistance. (A driven one resists, whatever its
  /// inertia.)
  [[nodiscard]] bool massless() const {
    return mobility == Mobility::rotor && axis_inertia == 0.0 && !prescribed();
  }
  std::vector<int> mounted_rotors;  ///< indices of the rotors this body carries
};

/// All bodies of a model, ready to step. Immutable.
class BodySet {
 public:
  /// Checks and compiles the bodies. Faults are reported for all bodies, not only the first.
  static Result<BodySet> create(const Model& model);

  [[nodiscard]] int count() const { return static_cast<int>(definitions_.size()); }
  /// Index of `id` among count() + 1 bodies; the world comes last.
  [[nodiscard]] int index(BodyId id) const { return id.is_world() ? count() : id.index; }
  /// Whether `id` is the world or one of these bodies.
  [[nodiscard]] bool contains(BodyId id) const {
    return id.index >= BodyId::world_index && id.index < count();
  }
  [[nodiscard]] const BodyProperties& operator[](int index) const {
    return properties_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const BodyDef& definition(int index) const {
    return definitions_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const std::string& name(int index) const;
  [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }
  [[nodiscard]] const Vector3& gravity() const { return gravity_; }
  /// Length [m] that "large" and "small" are measured by: about the greatest distance within
  /// the scene at time 0; 1 m if all that is a single point.
  [[nodiscard]] double scale() const { return scale_; }

  /// The state at time 0, without features.
  [[nodiscard]] State initial_state() const;
  /// The same with bodies in these frames; those that have none there are where they are at time 0.
  [[nodiscard]] State state_in(const BodyFrames& frames) const;
  /// That of a body, or of the world.
  [[nodiscard]] BodyFrame frame(int index, const BodyFrames& frames) const;
  /// Pose at time 0 of the body frame's point `local` [m] of body `index`, or of the world.
  [[nodiscard]] Vector3 initial_point(int index, const Vector3& local) const;
  [[nodiscard]] Quaternion initial_orientation(int index) const;
  /// Whether the body keeps every point of it in a plane with this normal (world frame at time 0).
  [[nodiscard]] bool stays_in_plane(int index, const Vector3& normal) const;

  /// Position [m] and velocity of a kinematic body's origin at `time`, and its rotation since 0.
  [[nodiscard]] BodyState kinematic_state(int index, double time) const;

 private:
  std::vector<BodyDef> definitions_;
  std::vector<BodyProperties> properties_;  // one more than definitions_: the world
  Coordinates coordinates_;
  Vector3 gravity_ = Vector3::Zero();
  double scale_ = 1.0;
};

}  // namespace sheave
