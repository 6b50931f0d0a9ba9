#include "engine/contacts/collider.h"

#include <array>

#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/model.h"

namespace sheave {

std::span<const Field> ColliderDef::field_table() {
  static const std::array table{
      field<&ColliderDef::body>("body", "", {}, required, "a body with at least one shape"),
      field<&ColliderDef::friction>("friction", "", at_least(0.0), optional,
                                    "coefficient while sliding; of a pair the geometric mean"),
      field<&ColliderDef::static_friction>("static_friction", "", at_least(0.0), optional,
                                           "coefficient while sticking (default: friction)"),
      field<&ColliderDef::restitution>(
          "restitution", "", between(0.0, 1.0), optional,
          "separation speed over approach speed; of a pair the larger one. Rigid bodies do not "
          "rebound if they approach more slowly than the speed that gravity gives them in two "
          "substeps. A compliant contact has a damper for this ratio, which is critical below "
          "0.135"),
      field<&ColliderDef::compliance>("compliance", "m/N", at_least(0.0), optional,
                                      "of each point of contact; of a pair the sum; 0 is rigid"),
      field<&ColliderDef::groups>("groups", "", {}, optional,
                                  "groups to which the collider belongs, names of your choice"),
      field<&ColliderDef::ignores>("ignores", "", {}, optional,
                                   "groups whose members the collider does not touch"),
  };
  return table;
}

Errors check_colliders(const Model& model, const BodySet& bodies) {
  Errors errors;
  std::vector<char> taken(at(bodies.count()), 0);
  for (std::size_t i = 0; i < model.colliders.size(); ++i) {
    const ColliderDef& collider = model.colliders[i];
    const std::string path = "/colliders/" + std::to_string(i);
    check_fields(ColliderDef::field_table(), &collider, path, errors);
    if (collider.body.is_world() || !bodies.contains(collider.body)) {
      errors.push_back(
          {path + "/body", "a collider needs a body; for a floor use a static body with a shape"});
      continue;
    }
    const std::string& name = bodies.name(collider.body.index);
    const auto fail = [&](const char* field, const std::string& message) {
      errors.push_back({path + field, "collider of \"" + name + "\": " + message});
    };
    if (bodies.definition(collider.body.index).shapes.empty()) {
      fail("/body", "the body has no shape that could touch anything; give it one");
    }
    for (const PlacedShape& placed : bodies.definition(collider.body.index).shapes) {
      if (!placed.shape->solid().vertices.empty()) continue;
      fail("/body", "a " + std::string(placed.shape->type()) +
                        " meets cables and the ground, but no other body; build the form from "
                        "spheres, capsules, cylinders or polyhedra, or leave the collider out");
      break;
    }
    if (bodies[collider.body.index].massless()) {
      fail("/body", "a wheel without spin inertia cannot touch anything but its cable");
    }
    if (taken[at(collider.body.index)] != 0) {
      fail("/body", "the body has a collider already; one serves all of its shapes");
    }
    taken[at(collider.body.index)] = 1;
    if (collider.static_friction && *collider.static_friction < collider.friction) {
      fail("/static_friction", "must be at least friction, " + number_text(collider.friction) +
                                   "; nothing holds less well at rest than while sliding");
    }
  }
  return errors;
}

}  // namespace sheave
