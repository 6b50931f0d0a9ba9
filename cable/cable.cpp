#include "cable/cable.h"

#include <array>

namespace sheave {

namespace {

/// Laws of rope by tables.
std::array<Field, 5> law_fields() {
  return {
      field<&CableDef::strain_table>(
          "strain_table", "", at_least(0.0), optional,
          "strains of a table of tensions, rising from 0; instead of axial_stiffness"),
      field<&CableDef::tension_table>(
          "tension_table", "N", at_least(0.0), optional,
          "tension at each of these strains, rising from 0; between the points a smooth rising "
          "curve, beyond the last one along its tangent"),
      field<&CableDef::unloading_stiffness>(
          "unloading_stiffness", "N", above(0.0), optional,
          "slope of the line on which a rope with a table is let off and stretched again: it "
          "yields, "
          "and keeps the strain at which this line reaches the tension 0"),
      field<&CableDef::unloading_table>(
          "unloading_table", "N", at_least(0.0), optional,
          "tensions of a rope that is let off, at the strains of strain_table; at most those of "
          "tension_table"),
      field<&CableDef::transition_strain>(
          "transition_strain", "", above(0.0), optional,
          "strain over which a rope with unloading_table goes from one curve to the other where it "
          "turns"),
  };
}

auto damper_and_weight_fields() {
  return std::array{
      field<&CableDef::damping>("damping", "N s/m", at_least(0.0), optional,
                                "of each span whatever its length; needs an elastic cable"),
      field<&CableDef::axial_damping>(
          "axial_damping", "N s", at_least(0.0), optional,
          "of the cable's material: tension per rate of strain; a span of rest length L has a "
          "damper of axial_damping / L; needs axial_stiffness or tension_table, and no friction "
          "where cable slides over an arc"),
      field<&CableDef::linear_density>(
          "linear_density", "kg/m", at_least(0.0), optional,
          "mass per unstretched length; the rope then has weight, and spans hang as catenaries, "
          "also between pinholes, and wheels and drums in a vertical plane; needs axial_stiffness"),
      field<&CableDef::axial_inertia>(
          "axial_inertia", "", {}, optional,
          "the mass of linear_density also has inertia, so that rope that runs has momentum and "
          "kinetic energy; between attachments, wheels with inertia and drums"),
      field<&CableDef::floor>(
          "floor", "m", {}, optional,
          "height of a level floor above the origin, against gravity, on which the rope lies "
          "where it would hang below it; needs linear_density; default: none"),
      field<&CableDef::floor_friction>(
          "floor_friction", "", between(0.0, 10.0), optional,
          "coefficient of friction of the floor along the rope that lies between an anchor, an "
          "attachment at an end of the cable that stays in its place on the floor, and the next "
          "link; needs floor"),
  };
}

}  // namespace

std::span<const Field> CableDef::field_table() {
  static const std::array elasticity{
      field<&CableDef::name>("name", "", {}, required, "unique name"),
      field<&CableDef::closed>("closed", "", {}, optional,
                               "a last span joins the last link and the first: a belt"),
      field<&CableDef::compliance>("compliance", "m/N", at_least(0.0), optional,
                                   "of each span whatever its length, also of those that a touched "
                                   "body divides; 0 (default) is rigid; excludes axial_stiffness"),
      field<&CableDef::axial_stiffness>(
          "axial_stiffness", "N", above(0.0), optional,
          "EA of the cable's material; a span then has the compliance rest length / EA, and cable "
          "comes onto wheels with its strain"),
  };
  static const std::array others{
      choice_field<&CableDef::tangent_update>(
          "tangent_update", tangent_update_names, optional,
          "when tangents and rest lengths follow the bodies; substep is the paper's, for cables "
          "that stay on circles in one plane"),
      field<&CableDef::rest_lengths>(
          "rest_lengths", "m", above(0.0), optional,
          "of each span at time 0; default: its length, so that the cable is just taut"),
      field<&CableDef::pretension>(
          "pretension", "N", above(0.0), optional,
          "tension of all spans at time 0, instead of rest_lengths, which follow from it; needs an "
          "elastic cable"),
      field<&CableDef::pretensions>("pretensions", "N", at_least(0.0), optional,
                                    "the same, of each span"),
      field<&CableDef::wrap_friction>(
          "wrap_friction", "", at_least(0.0), optional,
          "capstan coefficient on wrappable bodies that the cable comes to touch"),
      field<&CableDef::most_wraps>(
          "most_wraps", "", between(0, 1000), optional,
          "on how many wrappable bodies it can lie at the same time; 0: it goes through them"),
      field<&CableDef::breaking_tension>("breaking_tension", "N", above(0.0), optional,
                                         "tension at which it breaks; default: never"),
      field<&CableDef::cut_time>("cut_time", "s", at_least(0.0), optional,
                                 "when it is cut; default: never"),
  };
  static const std::array table =
      joined(joined(joined(elasticity, law_fields()), damper_and_weight_fields()), others);
  return table;
}

}  // namespace sheave
