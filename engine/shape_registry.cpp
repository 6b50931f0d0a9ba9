// The shape types, one line each.

#include <array>

#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "engine/shapes/torus.h"

namespace sheave {

std::span<const TypeEntry<Shape>> shape_types() {
  static const std::array types{
      type_entry<Shape, Box>(),       type_entry<Shape, Sphere>(), type_entry<Shape, Cylinder>(),
      type_entry<Shape, Capsule>(),   type_entry<Shape, Cone>(),   type_entry<Shape, Torus>(),
      type_entry<Shape, Ellipsoid>(), type_entry<Shape, Prism>(),  type_entry<Shape, Polyhedron>(),
      type_entry<Shape, HalfSpace>(),
  };
  return types;
}

}  // namespace sheave
