#include "engine/shapes/capsule.h"

#include <array>

namespace sheave {

std::span<const Field> Capsule::field_table() {
  static const std::array table{
      field<&Capsule::radius>("radius", "m", above(0.0), required, "radius"),
      field<&Capsule::length>("length", "m", above(0.0), required,
                              "length of the cylindrical part along z"),
  };
  return table;
}

MassProperties Capsule::unit_density() const {
  // Together the two half balls are one ball of volume b. Their centres of mass are 3/8 r outside
  // the ends of the cylinder. The moment of inertia 2/5 b r^2 about the ball's centre becomes 2/5 b
  // r^2 + b (L/2)^2 + b (L/2) (3/8 r) 2 about the capsule's centre, by the parallel axis theorem.
  const double cylinder = pi * radius * radius * length;
  const double ball = 4.0 / 3.0 * pi * radius * radius * radius;
  const double half = 0.5 * length;
  const double spin = 0.5 * cylinder * radius * radius + 0.4 * ball * radius * radius;
  const double tilt = cylinder / 12.0 * (3.0 * radius * radius + length * length) +
                      ball * (0.4 * radius * radius + half * half + 0.75 * half * radius);
  return {cylinder + ball, Vector3::Zero(), Vector3(tilt, tilt, spin).asDiagonal()};
}

void Capsule::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  for (const double end : {-0.5, 0.5}) {
    points.emplace_back(Vector3(0.0, 0.0, end * length) + radius * down);
  }
}

void Capsule::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  append_cylinder_section(radius, length, plane, points);
  for (const double end : {-0.5, 0.5}) {
    append_ball_section(Vector3(0.0, 0.0, end * length), radius, plane, points);
  }
}

ConvexSolid Capsule::solid() const {
  return solid_about_segment(ConvexSolid::Kind::rounded, length, radius);
}

}  // namespace sheave
