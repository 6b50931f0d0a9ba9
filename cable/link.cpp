#include "cable/link.h"

namespace sheave {

std::span<const Field> LinkDef::common_field_table() {
  static const std::array table{
      field<&LinkDef::body>("body", "", {}, required, "the body the cable touches, or \"world\""),
  };
  return table;
}

}  // namespace sheave
