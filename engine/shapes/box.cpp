#include "engine/shapes/box.h"

#include <array>

namespace sheave {

std::span<const Field> Box::field_table() {
  static const std::array table{
      field<&Box::size>("size", "m", above(0.0), required, "full edge lengths along x, y, z"),
  };
  return table;
}

MassProperties Box::unit_density() const {
  const double volume = size.prod();
  const Vector3 squares = size.cwiseAbs2();
  const Vector3 diagonal =
      volume / 12.0 *
      Vector3(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
  return {volume, Vector3::Zero(), diagonal.asDiagonal()};
}

void Box::append_contact_points(const Vector3& /*down*/, std::vector<Vector3>& points) const {
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                       (corner & 4) != 0 ? 0.5 : -0.5);
    points.emplace_back(sign.cwiseProduct(size));
  }
}

void Box::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  std::vector<Vector3> corners;
  append_contact_points(plane.normal, corners);
  append_hull_section(corners, plane, points);
}

ConvexSolid Box::solid() const {
  std::vector<Vector3> corners;
  append_contact_points(Vector3::UnitZ(), corners);
  // Corner i has the sign of bit k of i along axis k.
  return solid_of_faces(
      corners,
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}

}  // namespace sheave
