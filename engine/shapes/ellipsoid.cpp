#include "engine/shapes/ellipsoid.h"

#include <array>

namespace sheave {

std::span<const Field> Ellipsoid::field_table() {
  static const std::array table{
      field<&Ellipsoid::half_axes>("half_axes", "m", above(0.0), required,
                                   "half axes along x, y and z"),
  };
  return table;
}

Errors Ellipsoid::validate(const std::string& path) const {
  if (!(half_axes.minCoeff() > 0.0)) return {};  // the field's range has failed
  if (half_axes.maxCoeff() <= most_ratio * half_axes.minCoeff()) return {};
  return {{path + "/half_axes",
           "the longest half axis of an ellipsoid must be at most 100 times the shortest; use a "
           "\"cylinder\" or a \"prism\" for a disc, a \"capsule\" for a needle"}};
}

MassProperties Ellipsoid::unit_density() const {
  const double volume = 4.0 / 3.0 * pi * half_axes.prod();
  const Vector3 squares = half_axes.cwiseProduct(half_axes);
  const Vector3 moments(squares[1] + squares[2], squares[2] + squares[0], squares[0] + squares[1]);
  return {volume, Vector3::Zero(), (0.2 * volume * moments).asDiagonal()};
}

void Ellipsoid::append_contact_points(const Vector3& down, std::vector<Vector3>& points) const {
  const Vector3 scaled = half_axes.cwiseProduct(down);
  points.emplace_back(half_axes.cwiseProduct(scaled) / scaled.norm());
}

void Ellipsoid::append_section(const SectionPlane& plane, std::vector<Vector3>& points) const {
  // In units of the half axes the ellipsoid is a ball, and planes stay planes.
  const std::size_t first = points.size();
  append_ball_section(
      Vector3::Zero(), 1.0,
      {plane.point.cwiseQuotient(half_axes), half_axes.cwiseProduct(plane.normal).normalized()},
      points);
  for (std::size_t i = first; i < points.size(); ++i) {
    points[i] = half_axes.cwiseProduct(points[i]);
  }
}

}  // namespace sheave
