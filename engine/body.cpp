#include "engine/body.h"

namespace sheave {
namespace {

auto mass_and_motion_table() {
  return std::array{
      field<&BodyDef::name>("name", "", {}, required, "unique name, not \"world\""),
      choice_field<&BodyDef::mobility>("mobility", mobility_names, optional,
                                       "which motions the body has; knot: ends of cables meet"),
      field<&BodyDef::axis>(
          "axis", "", any_number(), optional,
          "planar: normal (default z); slider: direction (required); rotor: axle (default the "
          "body's own z axis); kinematic: normal of the plane that the body keeps"),
      field<&BodyDef::mount>("mount", "", {}, optional,
                             "rotor: the body that carries the axle; none: the axle does not move"),
      field<&BodyDef::position>("position", "m", any_number(), optional,
                                "origin of the body frame"),
      field<&BodyDef::orientation>("orientation", "", any_number(), optional,
                                   "unit quaternion [w, x, y, z], body frame to world frame"),
      field<&BodyDef::velocity>("velocity", "m/s", any_number(), optional,
                                "of the body frame's origin"),
      field<&BodyDef::angular_velocity>("angular_velocity", "rad/s", any_number(), optional,
                                        "absolute, also for a mounted rotor"),
      field<&BodyDef::mass>("mass", "kg", above(0.0), optional,
                            "excludes density; the shapes share it by their volumes, overlaps "
                            "counted twice, which places the centre of mass; without shapes that "
                            "is the body's origin"),
      field<&BodyDef::density>("density", "kg/m3", above(0.0), optional,
                               "mass and inertia follow from the shapes; excludes mass"),
      field<&BodyDef::center_of_mass>("center_of_mass", "m", any_number(), optional,
                                      "in the body frame, with mass and inertia; default: from "
                                      "the shapes"),
      field<&BodyDef::inertia>("inertia", "kg m2", above(0.0), optional,
                               "moments Ixx, Iyy, Izz about the centre of mass and the body's x, "
                               "y, z axes; default: from the shapes, scaled to the mass"),
      field<&BodyDef::products_of_inertia>(
          "products_of_inertia", "kg m2", any_number(), optional,
          "entries Ixy, Ixz, Iyz of the inertia tensor, Ixy = -(integral of x y dm), about the "
          "centre of mass; with inertia"),
      field<&BodyDef::spin_inertia>("spin_inertia", "kg m2", at_least(0.0), optional,
                                    "rotor: moment of inertia about the axle, in place of that of "
                                    "the shapes; 0: a massless wheel"),
  };
}

auto drive_and_load_table() {
  return std::array{
      choice_field<&BodyDef::drive>(
          "drive", drive_names, optional,
          "rotor: quantity that drive_values prescribe about the axis; for a mounted rotor "
          "relative to the carrier, which takes the opposite torque"),
      field<&BodyDef::drive_times>(
          "drive_times", "s", any_number(), optional,
          "increasing times of the drive's values; none for one constant value"),
      field<&BodyDef::drive_values>("drive_values", "rad/s, rad or N m", any_number(), optional,
                                    "values of the drive, one per time"),
      choice_field<&BodyDef::drive_interpolation>("drive_interpolation", interpolation_names,
                                                  optional, interpolation_meaning),
      field<&BodyDef::wrappable>("wrappable", "", {}, optional,
                                 "whether cables that come against the body are wrapped round it"),
      field<&BodyDef::force>("force", "N", any_number(), optional,
                             "constant, at the centre of mass"),
      field<&BodyDef::torque>("torque", "N m", any_number(), optional, "constant"),
      field<&BodyDef::damping>("damping", "N s/m", at_least(0.0), optional,
                               "drag: force per velocity; free, planar and slider bodies"),
      field<&BodyDef::angular_damping>(
          "angular_damping", "N m s/rad", at_least(0.0), optional,
          "torque per angular velocity; free and planar bodies and rotors on fixed axles"),
      field<&BodyDef::oscillation>("oscillation", "m", any_number(), optional,
                                   "kinematic: amplitude A of the motion position + velocity t + "
                                   "A (sin(2 pi f t + p) - sin p)"),
      field<&BodyDef::oscillation_frequency>("oscillation_frequency", "Hz", at_least(0.0), optional,
                                             "kinematic: frequency f of the oscillation"),
      field<&BodyDef::oscillation_phase>("oscillation_phase", "rad", any_number(), optional,
                                         "kinematic: phase p of the oscillation"),
  };
}

}  // namespace

std::span<const Field> BodyDef::field_table() {
  static const std::array table = joined(mass_and_motion_table(), drive_and_load_table());
  return table;
}

}  // namespace sheave
