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

Result<int> given_side(const std::optional<Winding>& winding, const std::optional<Side>& side,
                       const std::string& path) {
  if (winding && side) {
    return Error{path + "/side",
                 "side and winding say the same and exclude each other; leave one out"};
  }
  if (!winding && !side) {
    return Error{path,
                 "the link needs a \"side\": \"left\", \"right\" or \"shortest\", the side of the "
                 "cable's way on which the wheel lies; or a \"winding\": \"counter-clockwise\" or "
                 "\"clockwise\", which are left and right"};
  }
  const bool left = winding ? *winding == Winding::counter_clockwise : *side != Side::right;
  return left ? 1 : -1;
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
