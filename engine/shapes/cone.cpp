#include "engine/shapes/cone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/shapes/frustum_section.h"

namespace sheave {

std::span<const Field> Cone::field_table() {
  static const std::array table{
      field<&Cone::radius>("radius", "m", above(0.0), required, "radius of the end at -z"),
      field<&Cone::top_radius>("top_radius", "m", at_least(0.0), optional,
                               "radius of the end at +z, other than `radius`; 0 is a tip"),
      field<&Cone::length>("length", "m", above(0.0), required, "length along z"),
  };
  return table;
}

Errors Cone::validate(const std::string& path) const {
  if (std::abs(top_radius - radius) >= least_slope * length) return {};
  return {{path + "/top_radius",
           "the radii of a cone must differ by a thousandth of its length or more; use a "
           "\"cylinder\" where they are equal"}};
}

MassProperties Cone::unit_density() const {
  // Integrals of discs of the radius r(z) = R + (T - R) z / L from the end with R, times powers of z.
  const double r = radius;
  const double t = top_radius;
  const double volume = pi * length / 3.0 * (r * r + r * t + t * t);
  const double first = pi * length * length * (r * r + 2.0 * r * t + 3.0 * t * t) / 12.0;
  const double second = pi * length * length * length * (r * r + 3.0 * r * t + 6.0 * t * t) / 30.0;
  const double spin =
      pi * length / 10.0 *
      (r * r * r * r + r * r * r * t + r * r * t * t + r * t * t * t + t * t * t * t);
  const double center = first / volume;
  const double tilt = 0.5 * spin + second - first * center;
  return {volume, {0.0, 0.0, center - 0.5 * length}, Vector3(tilt, tilt, spin).asDiagonal()};
}

void Cone::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  // As for a cylinder: the lowest point of each rim, and three more that support a flat end.
  Vector3 lowest(down.x(), down.y(), 0.0);
  const double slope = lowest.norm();
  lowest = slope > 1e-9 ? Vector3(lowest / slope) : Vector3(Vector3::UnitX());
  const Vector3 across = Vector3::UnitZ().cross(lowest);
  for (const double end : {-0.5, 0.5}) {
    const Vector3 center(0.0, 0.0, end * length);
    const double rim = end < 0.0 ? radius : top_radius;
    for (const Vector3& out : {lowest, Vector3(-lowest), across, Vector3(-across)}) {
      points.emplace_back(center + rim * out);
    }
  }
}

void Cone::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  append_frustum_section(radius, top_radius, length, plane, points);
}

Vector3 Cone::half_extent() const {
  const double widest = std::max(radius, top_radius);
  return {widest, widest, 0.5 * length};
}

}  // namespace sheave
