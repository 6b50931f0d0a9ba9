#pragma once
// What a user says about one body.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/body_id.h"
#include "engine/shape.h"
#include "engine/time_table.h"

namespace sheave {

/// Which motions a body has; its inverse mass and inverse inertia are restricted to them exactly.
enum class Mobility {
  fixed,      ///< "static": none
  free,       ///< all six
  planar,     ///< translation perpendicular to `axis`, rotation about it
  slider,     ///< translation along `axis`
  rotor,      ///< rotation about `axis`; on a fixed axle, or on an axle carried by `mount`
  kinematic,  ///< moves as a given function of time, whatever pulls at it
};
inline constexpr std::array<std::string_view, 6> mobility_names{"static", "free",  "planar",
                                                                "slider", "rotor", "kinematic"};

/// What a drive prescribes.
enum class DriveKind {
  none,
  speed,   ///< spin [rad/s], whatever it takes: a winch
  angle,   ///< angle [rad]; only its change counts, so that it need not start at 0
  torque,  ///< [N m], in addition to the constant torque
};
inline constexpr std::array<std::string_view, 4> drive_names{"none", "speed", "angle", "torque"};

/// Settings of one body. Positions and vectors are in the world frame at time 0.
struct BodyDef {
  std::string name;  ///< unique in the model, not "world"
  Mobility mobility = Mobility::free;
  /// planar: normal of the plane (default z). slider: direction (required). rotor: axle (default
  /// the body's own z axis). kinematic: normal of the plane in which it stays; default: one with a
  /// motion of its own keeps to that, one without goes wherever it is told to
  /// (World::set_motion()). Any length but 0; not for other mobilities.
  std::optional<Vector3> axis;
  /// rotor only: the body that carries the axle. The rotor's mass and its inertia across the axle
  /// are then part of that body, which may be free, planar, slider, static or kinematic.
  std::optional<BodyId> mount;
  Vector3 position = Vector3::Zero();               ///< origin of the body frame [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame, unit length
  Vector3 velocity = Vector3::Zero();               ///< of the body frame's origin [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]; absolute, also of a mounted rotor
  std::optional<double> mass;                       ///< [kg], > 0; excludes density
  std::optional<double> density;  ///< [kg/m3], > 0; mass and inertia follow from the shapes
  /// Moments of inertia [kg m2] about the centre of mass and the body's x, y, z axes, which are
  /// then principal axes. Default: from the shapes, scaled to the mass.
  std::optional<Vector3> inertia;
  /// rotor only: moment of inertia about the axle [kg m2], >= 0; replaces that of `inertia` and the
  /// shapes. 0 is a massless wheel, which turns as its cable moves it and passes the tension on
  /// unchanged.
  std::optional<double> spin_inertia;
  /// rotor only: speed, angle or torque about the axis as a function of time through the given
  /// points, constant outside; a single value without times is constant. Of a mounted rotor all of
  /// them are against its carrier, which bears the opposite torque, and the angle is that since
  /// time 0, with what the table has there as 0.
  DriveKind drive = DriveKind::none;
  std::vector<double> drive_times;   ///< [s], increasing; as many as values, or none
  std::vector<double> drive_values;  ///< [rad/s, rad or N m]
  Interpolation drive_interpolation = Interpolation::linear;  ///< between the points
  Vector3 force = Vector3::Zero();   ///< constant, at the centre of mass [N]
  Vector3 torque = Vector3::Zero();  ///< constant [N m]
  /// Drag at the centre of mass, -damping times its velocity [N s/m], >= 0; free, planar and slider
  /// bodies.
  double damping = 0.0;
  /// Torque -angular_damping times the angular velocity [N m s/rad], >= 0: free and planar bodies,
  /// and the bearings of rotors on fixed axles.
  double angular_damping = 0.0;
  /// kinematic only: the position is position + velocity t + oscillation (sin(2 pi f t + p) - sin
  /// p) and the body turns with angular_velocity.
  Vector3 oscillation = Vector3::Zero();  ///< amplitude [m]
  double oscillation_frequency = 0.0;     ///< f [Hz], >= 0
  double oscillation_phase = 0.0;         ///< p [rad]
  /// Whether things that are laid over bodies (cables) can come to lie on this one without being
  /// told. Needs a shape; not for massless wheels.
  bool wrappable = false;
  std::vector<PlacedShape> shapes;  ///< may be empty if mass and inertia are given

  [[nodiscard]] TimeTable drive_table() const {
    return TimeTable::of(drive_times, drive_values, drive_interpolation);
  }
  /// Every member but the shapes.
  static std::span<const Field> field_table();
};

}  // namespace sheave
