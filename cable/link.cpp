#include "cable/link.h"

#include <cmath>

namespace sheave {

std::span<const Field> LinkDef::common_field_table() {
  static const std::array table{
      field<&LinkDef::body>("body", "", {}, required, "the body the cable touches, or \"world\""),
  };
  return table;
}

bool on_one_outline(const LinkGeometry& a, const LinkGeometry& b) {
  constexpr double tolerance = 1e-9;
  if (!a.outline || !b.outline || a.body != b.body) return false;
  const bool parallel = cross(a.normal, b.normal).norm() <= tolerance;
  return parallel && std::abs(dot(a.normal, a.center - b.center)) <= tolerance * a.perimeter();
}

}  // namespace sheave
