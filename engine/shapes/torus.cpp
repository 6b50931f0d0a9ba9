#include "engine/shapes/torus.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {

std::span<const Field> Torus::field_table() {
  static const std::array table{
      field<&Torus::radius>("radius", "m", above(0.0), required,
                            "radius of the circle in the middle of the tube"),
      field<&Torus::tube_radius>("tube_radius", "m", above(0.0), required,
                                 "radius of the tube, below `radius`"),
  };
  return table;
}

Errors Torus::validate(const std::string& path) const {
  if (tube_radius < radius) return {};
  return {{path + "/tube_radius",
           "the tube of a torus must leave a hole: give a tube_radius below the radius"}};
}

MassProperties Torus::unit_density() const {
  const double volume = 2.0 * pi * pi * radius * tube_radius * tube_radius;
  const double ring = radius * radius;
  const double tube = tube_radius * tube_radius;
  const double tilt = volume * (0.5 * ring + 0.625 * tube);
  return {volume, Vector3::Zero(), Vector3(tilt, tilt, volume * (ring + 0.75 * tube)).asDiagonal()};
}

void Torus::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  // The lowest point of the tube where the ring is lowest, and three more that support a flat ring.
  Vector3 lowest(down.x(), down.y(), 0.0);
  const double slope = lowest.norm();
  lowest = slope > 1e-9 ? Vector3(lowest / slope) : Vector3(Vector3::UnitX());
  const Vector3 across = Vector3::UnitZ().cross(lowest);
  for (const Vector3& out : {lowest, Vector3(-lowest), across, Vector3(-across)}) {
    const Vector3 level = dot(out, down) * out + down.z() * Vector3::UnitZ();
    const double size = level.norm();
    points.emplace_back(radius * out + tube_radius * (size > 0.0 ? Vector3(level / size) : out));
  }
}

void Torus::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  // The circle of the tube at each angle meets the plane at two points or none.
  const Vector3& n = plane.normal;
  for (int i = 0; i < curved_section_corners; ++i) {
    const double angle = 2.0 * pi * i / curved_section_corners;
    const Vector3 out(portable::cos(angle), portable::sin(angle), 0.0);
    const double across = dot(n, out);
    const double size = portable::hypot(across, n.z());
    const double share = dot(n, plane.point - radius * out) / (size * tube_radius);
    if (!(size > 1e-12) || !(std::abs(share) <= 1.0)) continue;
    const Vector3 steepest = (across * out + n.z() * Vector3::UnitZ()) / size;
    const Vector3 level = (across * Vector3::UnitZ() - n.z() * out) / size;
    for (const double sense : {-1.0, 1.0}) {
      points.emplace_back(radius * out +
                          tube_radius *
                              (share * steepest + sense * std::sqrt(1.0 - share * share) * level));
    }
  }
}

}  // namespace sheave
