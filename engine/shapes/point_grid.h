#pragma once
// Points rounded to a grid, so that the side of a line or plane is decided exactly with integers.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/wide_integer.h"
#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

/// 2^40 cells: fine enough for engineering, coarse enough that a determinant of three differences
/// fits in 128 bits.
constexpr double grid_cells = 0x1p40;

/// Points that stand out from a line or plane by at most this many cells count as being on it.
/// Rounding moves a point by at most half a cell along each axis, 0.87 cells in all. Points that
/// were coplanar then stand out from the plane through three of them by twice that if the three
/// surround them, and by more otherwise.
constexpr double flat_cells = 4.0;

/// The limit of area over perimeter, or volume over surface, relative to the extent, for a set that
/// is flat as a whole. Rounded flat sets stay below flat_cells / grid_cells = 4e-12; a plate whose
/// thickness is 1e-8 of its width has 5e-9. The grid decides, because the volume of a needle in
/// floating point consists mainly of rounding errors.
constexpr double thinnest = 1e-9;

using GridPoint = std::array<std::int64_t, 3>;  ///< 0 .. 2^40 each

/// Points on a grid of cubic cells, 2^40 of them along the longest edge of the bounding box.
struct PointGrid {
  std::vector<GridPoint> points;  ///< distinct, in lexicographic order
  std::vector<int> source;        ///< index of the first given point that rounds to each

  /// The first `dimensions` coordinates of the points, rounded; the others are 0. An error if there
  /// are no points or one is not finite.
  [[nodiscard]] static Result<PointGrid> make(std::span<const Vector3> points, int dimensions);
};

}  // namespace sheave
