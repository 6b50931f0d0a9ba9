#include "engine/shapes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheave {

Result<PointGrid> PointGrid::make(std::span<const Vector3> points, int dimensions) {
  const Error not_finite{"", "the points must be finite numbers, and their distances too"};
  if (points.empty()) return Error{"", "no points are given"};
  Vector3 low = points.front();
  Vector3 high = points.front();
  for (const Vector3& point : points) {
    if (!point.allFinite()) return not_finite;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  PointGrid grid;
  double extent = 0.0;
  for (int k = 0; k < dimensions; ++k) extent = std::max(extent, high[k] - low[k]);
  if (!std::isfinite(extent)) return not_finite;
  std::vector<GridPoint> all(points.size(), GridPoint{0, 0, 0});
  for (std::size_t i = 0; i < points.size() && extent > 0.0; ++i) {
    for (int k = 0; k < dimensions; ++k) {
      all[i][k] = std::llround((points[i][k] - low[k]) / extent * grid_cells);
    }
  }
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return all[a] < all[b]; });
  for (const int index : order) {
    if (!grid.points.empty() && grid.points.back() == all[index]) continue;
    grid.points.push_back(all[index]);
    grid.source.push_back(index);
  }
  return grid;
}

}  // namespace sheave
