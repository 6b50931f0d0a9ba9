#pragma once

#include <span>

#include "engine/field.h"
#include "engine/vector.h"

namespace sheave {

/// A flat, frictionless, immovable floor on which every moving body with a shape can come to rest.
struct GroundDef {
  Vector3 point = Vector3::Zero();    ///< any point of the floor [m]
  Vector3 normal = Vector3::UnitY();  ///< away from the solid side; any length but 0

  static std::span<const Field> field_table();
};

}  // namespace sheave
