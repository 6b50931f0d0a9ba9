#include "cable/cable.h"

namespace sheave {

std::span<const Field> CableDef::field_table() {
  static const std::array table{
      field<&CableDef::name>("name", "", {}, required, "unique name"),
      field<&CableDef::closed>("closed", "", {}, optional,
                               "a last span joins the last link and the first: a belt"),
      field<&CableDef::compliance>("compliance", "m/N", at_least(0.0), optional,
                                   "of each span; 0 (default) is rigid; excludes axial_stiffness"),
      field<&CableDef::axial_stiffness>(
          "axial_stiffness", "N", above(0.0), optional,
          "EA of the cable's material; a span then has the compliance rest length / EA"),
      field<&CableDef::damping>("damping", "N s/m", at_least(0.0), optional,
                                "of each span; needs an elastic cable"),
      choice_field<&CableDef::tangent_update>(
          "tangent_update", tangent_update_names, optional,
          "when tangents and rest lengths follow the bodies; substep is the paper's"),
      field<&CableDef::rest_lengths>(
          "rest_lengths", "m", above(0.0), optional,
          "of each span at time 0; default: its length, so that the cable is just taut"),
  };
  return table;
}

}  // namespace sheave
