// A Hilbert curve in space, by its definition: the curve of order n visits the eight octants of a
// cube along a path of edges. In each octant it is the curve of order n - 1, rotated or mirrored so
// that the pieces join.
//
// There are many such curves. The paper lists 62 cable joints for its second and 498 for its third
// order, with 64 and 512 points. With wheels only at turns, and the cable's ends at the first and
// last point, a curve with s straight points has 8^order - s - 1 joints, so the table requires s =
// 1 and s = 13. The most common curves do not fit (s = 2 and 20, or 6 and 50; a curve that is the
// same from both ends has an even s). Among the curves with neighbouring ends whose octants are
// only rotated and mirrored, never reversed, five fit. The curve here is one of the five: its path
// through the octants is the usual one; only their orientations differ.

#include <array>

#include "scenes/generators.h"

namespace sheave {
namespace {

using Axes = std::array<Eigen::Vector3i, 3>;

/// Position of an octant, and the directions of its own curve's axes: axis[i] = 1, 2, 3 for x, y, z
/// of the whole cube, negative for the opposite direction.
struct Octant {
  std::array<int, 3> side;  // -1 or 1 along x, y, z
  std::array<int, 3> axis;
};
constexpr std::array<Octant, 8> octants{{
    {{-1, -1, -1}, {2, 3, 1}},
    {{1, -1, -1}, {1, 3, 2}},
    {{1, 1, -1}, {3, 1, 2}},
    {{-1, 1, -1}, {-2, -1, 3}},
    {{-1, 1, 1}, {-2, -1, 3}},
    {{1, 1, 1}, {-3, 1, -2}},
    {{1, -1, 1}, {-3, 1, -2}},
    {{-1, -1, 1}, {2, -3, -1}},
}};

/// Appends the curve through a cube, in half units.
void append_curve(int order, const Eigen::Vector3i& center, const Axes& axes,
                  std::vector<Eigen::Vector3i>& points) {
  if (order == 0) {
    points.push_back(center);
    return;
  }
  const int quarter = 1 << (order - 1);
  for (const Octant& octant : octants) {
    Eigen::Vector3i middle = center;
    Axes turned;
    for (std::size_t i = 0; i < 3; ++i) {
      middle += quarter * octant.side[i] * axes[i];
      const int axis = octant.axis[i];
      const Eigen::Vector3i& along = axes[static_cast<std::size_t>(std::abs(axis) - 1)];
      turned[i] = axis > 0 ? along : Eigen::Vector3i(-along);
    }
    append_curve(order - 1, middle, turned, points);
  }
}

}  // namespace

std::vector<Vector3> hilbert_curve(int order) {
  std::vector<Eigen::Vector3i> points;
  append_curve(order, Eigen::Vector3i::Zero(),
               {Eigen::Vector3i::UnitX(), Eigen::Vector3i::UnitY(), Eigen::Vector3i::UnitZ()},
               points);
  // Rotated so that the last step, whose direction depends on the order, points down.
  const Vector3 last = 0.5 * (points.back() - points[points.size() - 2]).cast<double>();
  const Vector3 up = -last;
  const Vector3 right(up.y(), up.z(), up.x());  // another axis
  Matrix3 turn;
  turn << right.transpose(), up.transpose(), right.cross(up).transpose();
  std::vector<Vector3> curve;
  curve.reserve(points.size());
  for (const Eigen::Vector3i& point : points) {
    curve.emplace_back(turn * (0.5 * point.cast<double>()));
  }
  return curve;
}

}  // namespace sheave
