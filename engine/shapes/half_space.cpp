#include "engine/shapes/half_space.h"

#include <array>

namespace sheave {

std::span<const Field> HalfSpace::field_table() {
  static const std::array table{
      field<&HalfSpace::normal>("normal", "", any_number(), optional,
                                "away from the solid side, shape frame; any length but 0"),
  };
  return table;
}

Errors HalfSpace::validate(const std::string& path) const {
  if (normal.norm() > 1e-12) return {};
  return {{path + "/normal", "the normal must have a direction; its length is 0"}};
}

void HalfSpace::append_contact_points(const Vector3& /*down*/,
                                      std::vector<Vector3>& /*points*/) const {}

void HalfSpace::append_section(const SectionPlane& /*plane*/,
                               std::vector<Vector3>& /*points*/) const {}

ConvexSolid HalfSpace::solid() const {
  ConvexSolid solid;
  solid.kind = ConvexSolid::Kind::half_space;
  solid.vertices = {Vector3::Zero()};
  solid.faces = {{normal.normalized(), {0}}};
  return solid;
}

}  // namespace sheave
