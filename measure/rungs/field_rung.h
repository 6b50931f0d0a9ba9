#pragma once
// Rungs that set fields to their defaults, using only the field tables.

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "engine/joint.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// Names of fields. Fields of joints with several coordinates begin with the coordinate's name:
/// "damping" also selects "twist_damping".
using FieldNames = std::vector<std::string_view>;

/// Each function returns the number of changed objects.
[[nodiscard]] int reset_bodies(Scene& scene, const FieldNames& fields);
[[nodiscard]] int reset_joints(Scene& scene, const FieldNames& fields);
[[nodiscard]] int reset_cables(Scene& scene, const FieldNames& fields);
/// For links of one type.
[[nodiscard]] int reset_links(Scene& scene, std::string_view type, const FieldNames& fields);
[[nodiscard]] int reset_colliders(Scene& scene, const FieldNames& fields);

}  // namespace sheave::measure
