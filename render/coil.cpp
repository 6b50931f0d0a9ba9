#include "render/coil.h"

#include <algorithm>
#include <cmath>

namespace sheave::render {
namespace {

constexpr int points_per_coil = 20;

}  // namespace

std::vector<Vector3> coil_points(const Vector3& start, const Vector3& end, const Vector3& side,
                                 const CoilShape& shape) {
  const Vector3 along = end - start;
  const Vector3 axis = along.normalized();
  const Vector3 first = (side - axis * axis.dot(side)).normalized();
  const Vector3 second = axis.cross(first);
  const int count = shape.coils * points_per_coil;
  std::vector<Vector3> points{start};
  for (int i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const double angle = 2.0 * pi * shape.coils * share;
    // The radius grows and fades over half a coil at the ends, so that the wire has no corner
    // there.
    const double from_end = std::min(share, 1.0 - share) * 2.0 * shape.coils;
    const double blend = std::min(from_end, 1.0);
    const double radius = shape.radius * blend * blend * (3.0 - 2.0 * blend);
    const double place = shape.lead + (1.0 - 2.0 * shape.lead) * share;
    points.push_back(start + along * place +
                     radius * (std::cos(angle) * first + std::sin(angle) * second));
  }
  points.push_back(end);
  return points;
}

}  // namespace sheave::render
