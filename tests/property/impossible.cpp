#include "tests/property/impossible.h"

#include <algorithm>

#include "cable/links/attachment.h"
#include "engine/body_set.h"
#include "engine/shapes/half_space.h"
#include "tests/property/limits.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// Rigid, and all that moves its links moves them as it is told.
bool is_led(const CableDef& cable, const BodySet& bodies) {
  if (cable.axial_stiffness || cable.compliance.value_or(0.0) > 0.0) return false;
  bool led = false;
  for (const auto& link : cable.links) {
    const auto* end = dynamic_cast<const AttachmentLink*>(link.get());
    led = led || (end != nullptr && end->feed_speed.value_or(0.0) != 0.0);
    if (link->body.is_world()) continue;
    const BodyProperties& body = bodies[link->body.index];
    const bool given = body.mobility == Mobility::kinematic || body.prescribed();
    if (!given && body.mobility != Mobility::fixed) return false;
    led = led || given;
  }
  return led;
}

struct Floor {
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::UnitY();
  bool stops_all = false;  ///< moving bodies, not only those with a collider
};

std::vector<Floor> floors_of(const Model& model) {
  std::vector<Floor> floors;
  if (model.ground)
    floors.push_back({model.ground->point, model.ground->normal.normalized(), true});
  for (const BodyDef& body : model.bodies) {
    for (const PlacedShape& placed : body.shapes) {
      const auto* half = dynamic_cast<const HalfSpace*>(placed.shape.get());
      if (half == nullptr) continue;
      floors.push_back({body.position, body.orientation * half->normal.normalized(), false});
    }
  }
  return floors;
}

/// Whether the centre of a body is nearer to a floor than half of the shortest half edge of the
/// boxes round its shapes.
bool begins_beneath_a_floor(const Model& model) {
  const std::vector<Floor> floors = floors_of(model);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyDef& body = model.bodies[i];
    if (body.mobility == Mobility::fixed || body.mobility == Mobility::kinematic) continue;
    const bool collides =
        std::any_of(model.colliders.begin(), model.colliders.end(),
                    [&](const ColliderDef& own) { return own.body.index == static_cast<int>(i); });
    double least = 1e300;
    for (const PlacedShape& placed : body.shapes) {
      least = std::min(least, placed.shape->half_extent().minCoeff());
    }
    if (body.shapes.empty()) continue;
    for (const Floor& floor : floors) {
      if (!floor.stops_all && !collides) continue;
      if (floor.normal.dot(body.position - floor.point) < 0.5 * least) return true;
    }
  }
  return false;
}

}  // namespace

bool asks_the_impossible(const Machine& machine) {
  if (begins_beneath_a_floor(machine.model)) return true;
  const Simulation s = start(machine);
  const bool led =
      std::any_of(machine.cables.begin(), machine.cables.end(),
                  [&](const CableDef& cable) { return is_led(cable, s.world.bodies()); });
  return led || shortest_span(s) < 1e-6 * s.world.bodies().scale();
}

}  // namespace sheave::test
