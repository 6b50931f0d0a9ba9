#pragma once
// The triangles of each shape of a draw list.

#include "render/draw_list.h"
#include "render/mesh.h"

namespace sheave::render {

/// Builds the surface of a shape; curved ones with `segments` >= 8 facets round their axis.
/// MeshShape must not be null.
[[nodiscard]] Mesh make_mesh(const Shape& shape, int segments);

/// Adds a grooved wheel (its own file, because it has many parts).
void add_sheave(MeshBuilder& builder, const SheaveShape& sheave, int segments);

}  // namespace sheave::render
