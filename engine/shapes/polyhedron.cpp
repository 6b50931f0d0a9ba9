#include "engine/shapes/polyhedron.h"

// The solid is the sum of the tetrahedra (o, a, b, c) from one of its corners o = 0 to all surface
// triangles. For a tetrahedron of volume V = a . (area vector of a, b, c) / 3, with s = a + b + c,
//   integral of p        = V s / 4
//   integral of p p^T    = V / 20 (a a^T + b b^T + c c^T + s s^T).
// With S = integral of r r^T about the centre of mass, the inertia is trace(S) E - S.

#include <array>
#include <string>
#include <utility>

namespace sheave {
namespace {

constexpr std::size_t most_hull_points = 4096;

}  // namespace

std::span<const Field> Polyhedron::field_table() {
  static const std::array table{
      field<&Polyhedron::points>("points", "m", any_number(), required,
                                 "4 to 4096 points whose convex hull is the solid"),
  };
  return table;
}

Errors Polyhedron::validate(const std::string& path) const {
  const std::string here = path + "/points";
  if (points.size() < 4 || points.size() > most_hull_points) {
    return {{here, "points: " + std::to_string(points.size()) +
                       " points are given; between 4 and 4096 are needed"}};
  }
  const Result<Hull> surface = hull_3d(points);
  if (!surface) return {{here, "points: " + surface.errors().front().message}};
  return {};
}

MassProperties Polyhedron::unit_density() const {
  const Hull surface = hull();
  double volume = 0.0;
  Vector3 first_moment = Vector3::Zero();
  Matrix3 second_moment = Matrix3::Zero();
  for (const std::array<int, 3>& triangle : surface.triangles) {
    const Vector3 a = surface.vertices[triangle[0]] - surface.vertices[0];
    const Vector3 b = surface.vertices[triangle[1]] - surface.vertices[0];
    const Vector3 c = surface.vertices[triangle[2]] - surface.vertices[0];
    const Vector3 sum = a + b + c;
    const double part = a.dot(surface.area_vector(triangle)) / 3.0;
    volume += part;
    first_moment += part / 4.0 * sum;
    second_moment +=
        part / 20.0 *
        (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (!(volume > 0.0)) return {};
  const Vector3 center = first_moment / volume;
  // A separate matrix, because Eigen would scale one factor first and lose the symmetry.
  const Matrix3 square = center * center.transpose();
  const Matrix3 spread = second_moment - volume * square;
  return {volume, surface.vertices[0] + center, spread.trace() * Matrix3::Identity() - spread};
}

void Polyhedron::append_contact_points(const Vector3& /*down*/,
                                       std::vector<Vector3>& contacts) const {
  contacts.insert(contacts.end(), points.begin(), points.end());
}

Vector3 Polyhedron::half_extent() const {
  Vector3 extent = Vector3::Zero();
  for (const Vector3& point : points) {
    extent = extent.cwiseMax(point.cwiseAbs());
  }
  return extent;
}

Hull Polyhedron::hull() const {
  Result<Hull> surface = hull_3d(points);
  return surface ? std::move(surface).value() : Hull{};
}

void Polyhedron::append_section(const SectionPlane& plane, std::vector<Vector3>& section) const {
  append_hull_section(hull().vertices, plane, section);
}

ConvexSolid Polyhedron::solid() const { return solid_of_hull(hull()); }

}  // namespace sheave
