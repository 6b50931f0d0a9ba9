#pragma once
// The line of a helical spring.

#include <vector>

#include "engine/vector.h"

namespace sheave::render {

/// A spring as it is made: stretching changes neither its coils nor their
/// radius, only the pitch.
struct CoilShape {
  int coils = 8;        ///< > 0
  double radius = 0.1;  ///< of the coils' middle line [m], > 0
  double lead = 0.1;    ///< share of the length at either end that is straight, in [0, 0.5)
};

/// Points from `start` to `end` [m], which must differ: straight leads along
/// the line between them, coils about it. The coils begin on the side that
/// `side` points to, as far as it is across the line; it must not be along it.
[[nodiscard]] std::vector<Vector3> coil_points(const Vector3& start, const Vector3& end,
                                               const Vector3& side, const CoilShape& shape);

}  // namespace sheave::render
