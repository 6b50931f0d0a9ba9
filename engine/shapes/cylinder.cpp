#include "engine/shapes/cylinder.h"

#include <array>

namespace sheave {

std::span<const Field> Cylinder::field_table() {
  static const std::array table{
      field<&Cylinder::radius>("radius", "m", above(0.0), required, "radius"),
      field<&Cylinder::length>("length", "m", above(0.0), required, "length along z"),
  };
  return table;
}

MassProperties Cylinder::unit_density() const {
  const double volume = pi * radius * radius * length;
  const double spin = 0.5 * volume * radius * radius;
  const double tilt = volume / 12.0 * (3.0 * radius * radius + length * length);
  return {volume, Vector3::Zero(), Vector3(tilt, tilt, spin).asDiagonal()};
}

void Cylinder::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  // A tilted rim touches at its lowest point. A flat face needs at least three points of its rim
  // for support. Four points, including the lowest, serve both cases. The points vary
  // continuously with `down` except where the face is exactly flat and any choice is right.
  Vector3 lowest(down.x(), down.y(), 0.0);
  const double slope = lowest.norm();
  lowest = slope > 1e-9 ? Vector3(lowest / slope) : Vector3(Vector3::UnitX());
  const Vector3 across = Vector3::UnitZ().cross(lowest);
  for (const double end : {-0.5, 0.5}) {
    const Vector3 center(0.0, 0.0, end * length);
    points.emplace_back(center + radius * lowest);
    points.emplace_back(center - radius * lowest);
    points.emplace_back(center + radius * across);
    points.emplace_back(center - radius * across);
  }
}

void Cylinder::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  append_cylinder_section(radius, length, plane, points);
}

ConvexSolid Cylinder::solid() const {
  return solid_about_segment(ConvexSolid::Kind::cylinder, length, radius);
}

}  // namespace sheave
