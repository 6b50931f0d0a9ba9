#include "tests/property/impossible.h"

#include <algorithm>

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
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

bool is_rigid(const CableDef& cable) {
  return !cable.axial_stiffness && cable.compliance.value_or(0.0) == 0.0;
}

bool moves_as_told(BodyId id, const BodySet& bodies) {
  if (id.is_world()) return true;
  const BodyProperties& body = bodies[id.index];
  return body.mobility == Mobility::fixed || body.mobility == Mobility::kinematic ||
         body.prescribed();
}

/// A wheel without inertia of its own, which turns as cable passes.
bool is_massless_wheel(const LinkDef& link, const BodySet& bodies) {
  if (dynamic_cast<const RollingLink*>(&link) == nullptr || link.body.is_world()) return false;
  const BodyProperties& body = bodies[link.body.index];
  return body.mobility == Mobility::rotor && body.axis_inertia == 0.0 && !body.prescribed();
}

/// Whether no cable passes: it ends there, or a wheel without slip takes it along.
bool holds(const LinkDef& link, const BodySet& bodies) {
  if (dynamic_cast<const AttachmentLink*>(&link) != nullptr) return true;
  if (is_massless_wheel(link, bodies)) return false;
  if (const auto* rolling = dynamic_cast<const RollingLink*>(&link)) return !rolling->friction;
  return dynamic_cast<const PinholeLink*>(&link) == nullptr;
}

/// A wheel on an axle of the world that cable slides over: what it turns by moves no cable.
bool turns_in_place(const LinkDef& link, const BodySet& bodies) {
  if (holds(link, bodies) || link.body.is_world()) return false;
  const BodyProperties& body = bodies[link.body.index];
  return body.mobility == Mobility::rotor && body.mount < 0;
}

/// At the start; the cable may touch it later.
bool is_lifted(const LinkDef& link) {
  const auto* rolling = dynamic_cast<const RollingLink*>(&link);
  return rolling != nullptr && rolling->lifted;
}

/// Of the links of a rigid cable from `first`, which holds it, to the next one that does. `now`:
/// null at the start.
bool stretch_is_led(const CableDef& cable, const CableReport* now, std::size_t first,
                    const BodySet& bodies) {
  bool told = true;
  bool one_body = true;
  const std::size_t count = cable.links.size();
  for (std::size_t i = first, n = 0; n <= count; ++i, ++n) {
    if (i >= count && !cable.closed) return false;
    const LinkDef& link = *cable.links[i % count];
    const bool passed = now != nullptr ? !now->links[i % count].touched : is_lifted(link);
    if (n > 0 && passed) continue;
    told = told && (moves_as_told(link.body, bodies) || turns_in_place(link, bodies));
    one_body = one_body && link.body.index == cable.links[first]->body.index;
    if (n > 0 && holds(link, bodies)) return told || one_body;
  }
  return false;
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

bool can_ask_the_impossible(const Machine& machine, const Simulation& now) {
  const Simulation s = start(machine);
  const std::vector<CableReport> reports = now.cable_reports();
  for (std::size_t c = 0; c < machine.cables.size(); ++c) {
    const CableDef& cable = machine.cables[c];
    if (!is_rigid(cable)) continue;
    for (std::size_t i = 0; i < cable.links.size(); ++i) {
      if (!holds(*cable.links[i], s.world.bodies())) continue;
      if (stretch_is_led(cable, nullptr, i, s.world.bodies())) return true;
      if (!reports[c].links[i].touched) continue;
      if (stretch_is_led(cable, &reports[c], i, s.world.bodies())) return true;
    }
  }
  return false;
}

}  // namespace sheave::test
