#pragma once
// The definition of one body.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/body_id.h"
#include "engine/shape.h"
#include "engine/time_table.h"

namespace sheave {

/// The motions that a body has. Its inverse mass and inertia are projected onto these motions
/// exactly.
enum class Mobility {
  fixed,      ///< "static": none
  free,       ///< all six
  planar,     ///< translation perpendicular to `axis`, rotation about it
  slider,     ///< translation along `axis`
  rotor,      ///< rotation about `axis`; on a fixed axle, or on an axle carried by `mount`
  kinematic,  ///< moves as a given function of time; no force changes that
  knot,       ///< a point without mass at which ends of cables meet; their forces place it
};
inline constexpr std::array<std::string_view, 7> mobility_names{
    "static", "free", "planar", "slider", "rotor", "kinematic", "knot"};
/// Whether forces move bodies of this mobility: not if their motion is given, nor if they have no
/// mass.
[[nodiscard]] constexpr bool yields(Mobility mobility) {
  return mobility != Mobility::fixed && mobility != Mobility::kinematic &&
         mobility != Mobility::knot;
}

/// The quantity that a drive prescribes.
enum class DriveKind {
  none,
  speed,   ///< spin [rad/s] at any torque: a winch
  angle,   ///< angle [rad]; only its changes count, so a table may start at any value
  torque,  ///< [N m], in addition to the constant torque
};
inline constexpr std::array<std::string_view, 4> drive_names{"none", "speed", "angle", "torque"};

/// Settings of one body. Positions and vectors are in the world frame at time 0.
struct BodyDef {
  std::string name;  ///< unique in the model, not "world"
  Mobility mobility = Mobility::free;
  /// planar: normal of the plane (default z). slider: direction (required). rotor: axle (default:
  /// the body's own z axis). kinematic: normal of the plane in which the body stays. A kinematic
  /// body without an axis keeps to the directions of the motion defined here; if no motion is
  /// defined either, World::set_motion() may move it anywhere. Any length but 0; not for other
  /// mobilities.
  std::optional<Vector3> axis;
  /// rotor only: the body that carries the axle. The rotor's mass and its inertia across the axle
  /// are then part of that body, which may be free, planar, slider, static or kinematic.
  std::optional<BodyId> mount;
  Vector3 position = Vector3::Zero();               ///< origin of the body frame [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame, unit length
  Vector3 velocity = Vector3::Zero();               ///< of the body frame's origin [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]; absolute, also for a mounted rotor
  std::optional<double> mass;                       ///< [kg], > 0; excludes density
  std::optional<double> density;  ///< [kg/m3], > 0; mass and inertia follow from the shapes
  /// [m], body frame; needs mass. Default: from the shapes; without shapes the body's origin
  std::optional<Vector3> center_of_mass;
  /// Moments of inertia [kg m2] about the centre of mass and the body's x, y, z axes: the diagonal
  /// of the inertia tensor. Default: from the shapes, scaled to the mass.
  std::optional<Vector3> inertia;
  /// The entries xy, xz and yz of that tensor [kg m2], so the first is the integral of -x y dm;
  /// needs inertia. Default: 0, and the body's axes are principal axes.
  Vector3 products_of_inertia = Vector3::Zero();
  /// rotor only: moment of inertia about the axle [kg m2], >= 0; replaces the value from `inertia`
  /// or from the shapes. 0 is a massless wheel: its cable turns the wheel without resistance, and
  /// the tensions on both sides are equal.
  std::optional<double> spin_inertia;
  /// rotor only: speed, angle or torque about the axis as a function of time through the given
  /// points, constant before the first and after the last; a single value without times is
  /// constant. For a mounted rotor all three are relative to the carrier, which takes the opposite
  /// torque. The angle of a mounted rotor counts from time 0, at which the table's value stands for
  /// angle 0.
  DriveKind drive = DriveKind::none;
  std::vector<double> drive_times;   ///< [s], increasing; as many as values, or none
  std::vector<double> drive_values;  ///< [rad/s, rad or N m]
  Interpolation drive_interpolation = Interpolation::linear;  ///< between the points
  Vector3 force = Vector3::Zero();   ///< constant, at the centre of mass [N]
  Vector3 torque = Vector3::Zero();  ///< constant [N m]
  /// Drag coefficient [N s/m], >= 0, for free, planar and slider bodies: the force at the centre of
  /// mass is -damping times its velocity.
  double damping = 0.0;
  /// Rotational drag coefficient [N m s/rad], >= 0, for free and planar bodies and for the bearings
  /// of rotors on fixed axles: the torque is -angular_damping times the angular velocity.
  double angular_damping = 0.0;
  /// kinematic only: the position at time t is position + velocity t + oscillation (sin(2 pi f t +
  /// p) - sin p), and the body turns with angular_velocity.
  Vector3 oscillation = Vector3::Zero();  ///< amplitude [m]
  double oscillation_frequency = 0.0;     ///< f [Hz], >= 0
  double oscillation_phase = 0.0;         ///< p [rad]
  /// Whether a cable that comes to touch this body wraps around it. Needs a shape; not for massless
  /// wheels.
  bool wrappable = false;
  std::vector<PlacedShape> shapes;  ///< may be empty if mass and inertia are given

  [[nodiscard]] TimeTable drive_table() const {
    return TimeTable::of(drive_times, drive_values, drive_interpolation);
  }
  /// Every member but the shapes.
  static std::span<const Field> field_table();
};

}  // namespace sheave
