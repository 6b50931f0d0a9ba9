#include "engine/shapes/prism.h"

// The cross-section is a fan of triangles (0, a, b) from its first corner. For a triangle of area A
//   integral of p        = A (a + b) / 3
//   integral of p p^T    = A / 12 (a a^T + b b^T + (a + b)(a + b)^T)
// and a length L along z multiplies both by L and adds (area) L^3 / 12 to the zz component. With
// S = integral of r r^T about the centre of mass, the inertia is trace(S) E - S.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "engine/shapes/convex_hull.h"

namespace sheave {
namespace {

constexpr std::size_t most_outline_points = 4096;

}  // namespace

std::span<const Field> Prism::field_table() {
  static const std::array table{
      field<&Prism::outline>("outline", "m", any_number(), required,
                             "3 to 4096 points [x, y, 0] whose convex hull is the cross-section"),
      field<&Prism::length>("length", "m", above(0.0), required,
                            "length along z, half to each side of the plane z = 0"),
  };
  return table;
}

Errors Prism::validate(const std::string& path) const {
  const std::string here = path + "/outline";
  if (outline.size() < 3 || outline.size() > most_outline_points) {
    return {{here, "outline: " + std::to_string(outline.size()) +
                       " points are given; between 3 and 4096 are needed"}};
  }
  const Result<std::vector<Vector3>> corners = hull_2d(outline);
  if (!corners) return {{here, "outline: " + corners.errors().front().message}};
  double extent = 0.0;
  for (const Vector3& corner : *corners) {
    extent = std::max(extent, (corner - corners->front()).norm());
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    // Allows for rounding in the program that placed a drawing in this plane.
    if (std::abs(outline[i].z()) <= 1e-9 * extent) continue;
    return {{here + "/" + std::to_string(i),
             "outline: this point has z = " + std::to_string(outline[i].z()) +
                 "; the outline is drawn in the plane z = 0, and length extends it along z"}};
  }
  return {};
}

MassProperties Prism::unit_density() const {
  const std::vector<Vector3> corners = hull();
  double area = 0.0;
  Vector3 first_moment = Vector3::Zero();
  Matrix3 second_moment = Matrix3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vector3 a = corners[i - 1] - corners[0];
    const Vector3 b = corners[i] - corners[0];
    const Vector3 sum = a + b;
    const double triangle = 0.5 * a.cross(b).z();
    area += triangle;
    first_moment += triangle / 3.0 * sum;
    second_moment +=
        triangle / 12.0 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  }
  if (!(area > 0.0)) return {};
  const Vector3 center = first_moment / area;
  // A separate matrix, because Eigen would scale one factor first and lose the symmetry.
  const Matrix3 square = center * center.transpose();
  Matrix3 spread = length * (second_moment - area * square);
  spread(2, 2) = area * length * length * length / 12.0;
  return {area * length, corners[0] + center, spread.trace() * Matrix3::Identity() - spread};
}

void Prism::append_contact_points(const Vector3& /*down*/, std::vector<Vector3>& points) const {
  for (const double end : {-0.5, 0.5}) {
    for (const Vector3& point : outline) {
      points.emplace_back(point.x(), point.y(), end * length);
    }
  }
}

Vector3 Prism::half_extent() const {
  Vector3 extent(0.0, 0.0, 0.5 * length);
  for (const Vector3& point : outline) {
    extent = extent.cwiseMax(Vector3(std::abs(point.x()), std::abs(point.y()), 0.0));
  }
  return extent;
}

std::vector<Vector3> Prism::hull() const {
  Result<std::vector<Vector3>> corners = hull_2d(outline);
  return corners ? std::move(corners).value() : std::vector<Vector3>{};
}

void Prism::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  std::vector<Vector3> corners;
  for (const Vector3& corner : hull()) {
    for (const double end : {-0.5, 0.5}) corners.emplace_back(corner.x(), corner.y(), end * length);
  }
  append_hull_section(corners, plane, points);
}

ConvexSolid Prism::solid() const { return solid_of_outline(hull(), length); }

}  // namespace sheave
