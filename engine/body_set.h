#pragma once
// Bodies compiled for the step: all constants that follow from the definitions.

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
  /// Mass of the body and of the rotors mounted on it [kg]; 0 where the mass does not affect the
  /// motion.
  double mass = 0.0;
  Vector3 center_of_mass = Vector3::Zero();  ///< [m], body frame
  /// Inertia about the centre of mass [kg m2], own frame. The mass of mounted rotors and their
  /// inertia across the axle are included, their inertia about the axle is not.
  Matrix3 inertia = Matrix3::Zero();
  /// Inverse of `inertia`; zero where the body cannot turn
  Matrix3 inverse_inertia = Matrix3::Zero();
  bool isotropic = false;  ///< free bodies: `inertia` is a multiple of the identity
  /// Free bodies with two equal principal moments (a capsule, a wheel): the unit axis of the third,
  /// own frame.
  std::optional<Vector3> symmetry_axis;
  /// Unit vector: planar normal, slider direction or axle, in the world frame; of a mounted rotor
  /// in its carrier's own frame.
  Vector3 axis = Vector3::UnitZ();
  /// Distance from the centre to the farthest point, roughly [m], > 0; converts turns into lengths.
  double size = 1.0;
  /// Moment of inertia about `axis` of planar bodies and rotors [kg m2]; 0: massless
  double axis_inertia = 0.0;
  Vector3 mount_position = Vector3::Zero();  ///< centre of a mounted rotor, carrier's own frame [m]
  Quaternion start_orientation = Quaternion::Identity();  ///< at angle 0; relative to the carrier
  DriveKind drive = DriveKind::none;                      ///< drive of a rotor on a fixed axle
  /// Drive of a mounted rotor, relative to the carrier; a drive to an angle has angle 0 at time 0.
  /// Rows apply it (engine/dynamics/mounted_drive.h).
  DriveKind mounted_drive = DriveKind::none;
  TimeTable drive_table;
  /// The kind of the drive, on a fixed axle or mounted.
  [[nodiscard]] DriveKind driven_by() const { return mount >= 0 ? mounted_drive : drive; }
  /// Whether a drive prescribes the rotation, so that constraints cannot turn the body.
  [[nodiscard]] bool prescribed() const {
    return drive == DriveKind::speed || drive == DriveKind::angle;
  }
  /// Whether this is a wheel that only its cable turns, without resistance. A driven wheel resists,
  /// even without inertia.
  [[nodiscard]] bool massless() const {
    return mobility == Mobility::rotor && axis_inertia == 0.0 && !prescribed();
  }
  std::vector<int> mounted_rotors;  ///< indices of the rotors that this body carries
};

/// All bodies of a model, ready to step. Immutable.
class BodySet {
 public:
  /// Checks and compiles the bodies. Reports the errors of all bodies, not only the first.
  static Result<BodySet> create(const Model& model);

  [[nodiscard]] int count() const { return static_cast<int>(definitions_.size()); }
  /// Index of `id` among count() + 1 bodies; the world comes last.
  [[nodiscard]] int index(BodyId id) const { return id.is_world() ? count() : id.index; }
  /// The body with that index; index() of the result.
  [[nodiscard]] BodyId id(int index) const {
    return index == count() ? BodyId::world() : BodyId{index};
  }
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
  /// Length scale of the scene [m]: about the greatest distance within the scene at time 0; 1 m if
  /// the scene is a single point.
  [[nodiscard]] double scale() const { return scale_; }

  /// The state at time 0, without features.
  [[nodiscard]] State initial_state() const;
  /// The state with bodies in these frames; a body without a frame has its pose at time 0.
  [[nodiscard]] State state_in(const BodyFrames& frames) const;
  /// The frame of a body or of the world; at time 0 if `frames` has none for the body.
  [[nodiscard]] BodyFrame frame(int index, const BodyFrames& frames) const;
  /// Pose at time 0 of the body frame's point `local` [m] of body `index`, or of the world.
  [[nodiscard]] Vector3 initial_point(int index, const Vector3& local) const;
  [[nodiscard]] Quaternion initial_orientation(int index) const;
  /// Whether all points of the body keep to planes with this normal (world frame at time 0).
  [[nodiscard]] bool stays_in_plane(int index, const Vector3& normal) const;

  /// Position [m] and velocity of a kinematic body's origin at `time`, and its rotation since time
  /// 0.
  [[nodiscard]] BodyState kinematic_state(int index, double time) const;

 private:
  std::vector<BodyDef> definitions_;
  std::vector<BodyProperties> properties_;  // one more than definitions_; the world comes last
  Coordinates coordinates_;
  Vector3 gravity_ = Vector3::Zero();
  double scale_ = 1.0;
};

}  // namespace sheave
