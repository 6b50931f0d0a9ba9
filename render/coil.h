#pragma once
// The line of a helical spring.

#include <vector>

#include "engine/vector.h"

namespace sheave::render {

/// A spring: stretching changes only its pitch, neither the number nor the radius of its coils.
struct CoilShape {
  int coils = 8;        ///< > 0
  double radius = 0.1;  ///< of the coils' middle line [m], > 0
  double lead = 0.1;    ///< fraction of the length at either end that is straight, in [0, 0.5)
};

/// Points from `start` to `end` [m], which must differ: straight leads along the line between them,
/// coils about it. The coils begin on the side to which the component of `side` perpendicular to
/// the line points; `side` must not be parallel to the line.
[[nodiscard]] std::vector<Vector3> coil_points(const Vector3& start, const Vector3& end,
                                               const Vector3& side, const CoilShape& shape);

}  // namespace sheave::render
