// Hulls in the plane: Andrew's monotone chain on the grid.

#include <cmath>

#include "engine/shapes/convex_hull.h"
#include "engine/shapes/point_grid.h"

namespace sheave {
namespace {

double distance(const GridPoint& a, const GridPoint& b) {
  // std::hypot differs between libraries in the last bit.
  const auto x = static_cast<double>(b[0] - a[0]);
  const auto y = static_cast<double>(b[1] - a[1]);
  return std::sqrt(x * x + y * y);
}

/// Twice the area of the triangle a, b, c in the plane z = 0, positive if counter-clockwise.
WideInteger turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return WideInteger{b[0] - a[0]} * (c[1] - a[1]) - WideInteger{b[1] - a[1]} * (c[0] - a[0]);
}

/// The corners of a counter-clockwise polygon that stand out from the line between their
/// neighbours.
std::vector<int> without_flat_corners(const std::vector<GridPoint>& points,
                                      const std::vector<int>& corners) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // The neighbours are corners that stay. Of points within rounding of each other one must
    // remain.
    const bool last = i + 1 == corners.size();
    const int next = !last ? corners[i + 1] : (kept.empty() ? corners : kept).front();
    const GridPoint& before = points[kept.empty() ? corners.back() : kept.back()];
    const GridPoint& after = points[next];
    const auto twice_area = static_cast<double>(turn(before, points[corners[i]], after));
    if (twice_area > flat_cells * distance(before, after)) kept.push_back(corners[i]);
  }
  return kept;
}

}  // namespace

Result<std::vector<Vector3>> hull_2d(std::span<const Vector3> points) {
  const Error flat{"",
                   "the points enclose no area; at least three points that do not lie on one line "
                   "are needed"};
  const Result<PointGrid> grid = PointGrid::make(points, 2);
  if (!grid) return grid.errors();
  // The lower border from left to right, then the upper one back.
  const int count = static_cast<int>(grid->points.size());
  std::vector<int> chain;
  const auto extend = [&](int point, std::size_t fixed) {
    while (chain.size() > fixed && turn(grid->points[chain[chain.size() - 2]],
                                        grid->points[chain.back()], grid->points[point]) <= 0) {
      chain.pop_back();
    }
    chain.push_back(point);
  };
  for (int i = 0; i < count; ++i) {
    extend(i, 1);
  }
  const std::size_t lower = chain.size();
  for (int i = count - 2; i >= 0; --i) {
    extend(i, lower);
  }
  chain.pop_back();  // the first point again
  const std::vector<int> kept = without_flat_corners(grid->points, chain);
  WideInteger twice_area = 0;
  double perimeter = 0.0;
  std::vector<Vector3> corners;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const GridPoint& a = grid->points[kept[i]];
    const GridPoint& b = grid->points[kept[(i + 1) % kept.size()]];
    twice_area += turn(grid->points[kept[0]], a, b);
    perimeter += distance(a, b);
    const Vector3& point = points[grid->source[kept[i]]];
    corners.emplace_back(point.x(), point.y(), 0.0);
  }
  if (0.5 * static_cast<double>(twice_area) <= thinnest * grid_cells * perimeter) return flat;
  return corners;
}

}  // namespace sheave
