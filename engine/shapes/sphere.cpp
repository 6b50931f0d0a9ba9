#include "engine/shapes/sphere.h"

#include <array>

namespace sheave {

std::span<const Field> Sphere::field_table() {
  static const std::array table{
      field<&Sphere::radius>("radius", "m", above(0.0), required, "radius"),
  };
  return table;
}

MassProperties Sphere::unit_density() const {
  const double volume = 4.0 / 3.0 * pi * radius * radius * radius;
  return {volume, Vector3::Zero(), 0.4 * volume * radius * radius * Matrix3::Identity()};
}

void Sphere::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  points.emplace_back(radius * down);
}

void Sphere::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  append_ball_section(Vector3::Zero(), radius, plane, points);
}

ConvexSolid Sphere::solid() const {
  return solid_about_segment(ConvexSolid::Kind::rounded, 0.0, radius);
}

}  // namespace sheave
