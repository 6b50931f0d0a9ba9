#include "engine/parameter.h"

#include <array>

namespace sheave {

std::span<const Field> ParameterDef::field_table() {
  static const std::array table{
      field<&ParameterDef::name>(
          "name", "", {}, required,
          "a word of letters, digits and _ that begins with a letter, and is "
          "no word of expressions; unique among the parameters"),
      field<&ParameterDef::value>("value", "", any_number(), required, "the number, in its unit"),
      field<&ParameterDef::unit>("unit", "", {}, optional,
                                 "made of m, kg, s, rad, N, J, W and Hz, as N m or m/s2; default: "
                                 "a pure number"),
      field<&ParameterDef::meaning>("meaning", "", {}, optional, "for readers"),
  };
  return table;
}

}  // namespace sheave
