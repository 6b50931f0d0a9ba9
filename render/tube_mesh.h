#pragma once
// Round lines: the surface swept by a circle along a polyline.

#include "render/draw_list.h"
#include "render/mesh.h"

namespace sheave::render {

/// Appends the surface of a tube with `sides` >= 3 facets, its positions relative to `origin` [m]
/// (so that single precision suffices far from the world's origin). Coincident points are merged; a
/// tube without extent adds nothing. Vertices have the colours of their points.
void append_tube(const Tube& tube, const Vector3& origin, int sides, Mesh& mesh);

}  // namespace sheave::render
