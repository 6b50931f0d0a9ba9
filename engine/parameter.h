#pragma once

#include <span>
#include <string>

#include "engine/field.h"

namespace sheave {

/// A named number that a model carries for expressions (scenes/expression.h), without an effect.
struct ParameterDef {
  std::string name;     ///< a word, as scenes/validate_parameters.h has it
  double value = 0.0;   ///< in the unit
  std::string unit;     ///< "N", "m/s2", ...; empty: a pure number
  std::string meaning;  ///< for readers

  static std::span<const Field> field_table();
};

}  // namespace sheave
