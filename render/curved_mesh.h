#pragma once
// Triangles of cones, tori and ellipsoids.

#include "engine/shapes/cone.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/torus.h"
#include "render/draw_list.h"

namespace sheave::render {

[[nodiscard]] MeshShape drawable_cone(const Cone& cone);
[[nodiscard]] MeshShape drawable_torus(const Torus& torus);
[[nodiscard]] MeshShape drawable_ellipsoid(const Ellipsoid& ellipsoid);

}  // namespace sheave::render
