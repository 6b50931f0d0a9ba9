#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/body_id.h"
#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

/// Makes a body touch others: with the shapes it has. Two colliders never touch if a joint holds
/// their bodies together, if one is mounted on the other or both on the same body, if neither can
/// move, or if a group keeps them apart.
struct ColliderDef {
  BodyId body;  ///< with at least one shape; one collider per body
  /// Coefficient of friction while sliding, >= 0. Of a pair the geometric mean of both, so 0 on one
  /// side is smooth.
  double friction = 0.0;
  std::optional<double> static_friction;  ///< while sticking, >= friction; default: friction
  /// Speed of parting over speed of meeting, 0 ... 1. Of a pair the larger one. Rigid bodies that
  /// meet more slowly than gravity would make them in two substeps do not bounce. Contacts with a
  /// compliance have it by a damper beside the spring, which is critical for all below e^-2 = 0.135,
  /// the default among them, and none for 1.
  double restitution = 0.0;
  double compliance = 0.0;           ///< of each point of contact [m/N], >= 0; of a pair the sum
  std::vector<std::string> groups;   ///< names of the user's choice
  std::vector<std::string> ignores;  ///< names of groups whose members it does not touch

  static std::span<const Field> field_table();
};

struct Model;
class BodySet;
/// What is wrong with the colliders of a model, with paths from "/colliders".
[[nodiscard]] Errors check_colliders(const Model& model, const BodySet& bodies);

}  // namespace sheave
