#pragma once
// The way of a cable through an opening; internal to the cable library.

#include "cable/link_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// A point of the shortest way from `from` to `to` among those that pass the inside of the surface,
/// a ball or an endless cylinder: the middle of the part of the straight line that lies inside, or
/// else the point of the surface at which the way turns. All in one frame [m].
[[nodiscard]] Vector3 opening_point(const SmoothSurface& surface, const Vector3& from,
                                    const Vector3& to);

/// Moves the centre of a link that is an opening to that point, for the present positions. The
/// links beside it are points.
void settle_opening(const Substep& substep, const LinkGeometry& before, const LinkGeometry& after,
                    LinkGeometry& opening);

}  // namespace sheave
