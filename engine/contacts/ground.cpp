#include "engine/contacts/ground.h"

#include <array>

namespace sheave {

std::span<const Field> GroundDef::field_table() {
  static const std::array table{
      field<&GroundDef::point>("point", "m", any_number(), optional, "any point of the floor"),
      field<&GroundDef::normal>("normal", "", any_number(), optional,
                                "away from the solid side (default y)"),
  };
  return table;
}

}  // namespace sheave
