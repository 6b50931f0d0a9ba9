#include "cable/link.h"

#include <cmath>

#include "cable/link_geometry.h"

namespace sheave {

std::span<const Field> LinkDef::common_field_table() {
  static const std::array table{
      field<&LinkDef::body>("body", "", {}, required, "the body the cable touches, or \"world\""),
  };
  return table;
}

bool on_one_outline(const LinkGeometry& a, const LinkGeometry& b) {
  constexpr double tolerance = 1e-9;
  if (a.body != b.body || !a.wraps() || !b.wraps() || (!a.outline) != (!b.outline)) return false;
  const Vector3 between = a.center - b.center;
  const double near = tolerance * a.perimeter();
  if (cross(a.normal, b.normal).norm() > tolerance || std::abs(dot(a.normal, between)) > near)
    return false;
  // One body may have several circles.
  return a.outline != nullptr || between.norm() <= near;
}

}  // namespace sheave
