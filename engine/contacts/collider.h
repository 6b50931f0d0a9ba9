#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/body_id.h"
#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

/// Lets a body touch others with its shapes. Two colliders never touch in any of these cases: a
/// joint connects their bodies, one body is mounted on the other or both on the same body, neither
/// can move, or a group keeps them apart.
struct ColliderDef {
  BodyId body;  ///< must have at least one shape; one collider per body
  /// Coefficient of sliding friction, >= 0. A pair has the geometric mean of both, so 0 on one side
  /// is frictionless.
  double friction = 0.0;
  /// Coefficient of static friction, >= friction; default: friction
  std::optional<double> static_friction;
  /// Coefficient of restitution, 0 ... 1: separation speed over approach speed. A pair has the
  /// larger one. Rigid bodies do not rebound if they approach more slowly than the speed that
  /// gravity gives them in two substeps. For a compliant contact, the restitution determines a
  /// damper beside the spring. The damper is critical for all values up to e^-2 = 0.135, including
  /// the default, and absent for 1.
  double restitution = 0.0;
  double compliance = 0.0;  ///< of each point of contact [m/N], >= 0; a pair has the sum
  /// Groups to which this collider belongs; names of the user's choice
  std::vector<std::string> groups;
  std::vector<std::string> ignores;  ///< groups whose members this collider does not touch

  static std::span<const Field> field_table();
};

struct Model;
class BodySet;
/// The errors of a model's colliders, with paths below "/colliders".
[[nodiscard]] Errors check_colliders(const Model& model, const BodySet& bodies);

}  // namespace sheave
