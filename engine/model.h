#pragma once
// A model is everything that a user defines and that no step changes.

#include <memory>
#include <optional>
#include <vector>

#include "engine/body.h"
#include "engine/contacts/collider.h"
#include "engine/contacts/ground.h"
#include "engine/joint.h"
#include "engine/parameter.h"
#include "engine/step_settings.h"

namespace sheave {

/// Everything a simulation is built from, except features of other libraries (cables).
struct Model {
  Vector3 gravity = Vector3::Zero();  ///< [m/s2]; "up" is against it
  StepSettings step;
  std::vector<BodyDef> bodies;  ///< BodyId indexes this list
  std::vector<std::shared_ptr<const JointDef>> joints;
  std::vector<ColliderDef> colliders;    ///< bodies that touch each other; empty: no contacts
  std::optional<GroundDef> ground;       ///< absent: no ground, and no stage for it
  std::vector<ParameterDef> parameters;  ///< numbers for expressions, without an effect

  /// Appends a body and returns its id.
  BodyId add(BodyDef body) {
    bodies.push_back(std::move(body));
    return {static_cast<int>(bodies.size()) - 1};
  }
};

}  // namespace sheave
