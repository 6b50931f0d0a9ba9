#include "statics/supports.h"

#include <algorithm>

#include "engine/body_mass.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/shape.h"
#include "statics/configuration.h"

namespace sheave {
namespace {

void add_cable(const BodySet& bodies, const CableReport& report, std::vector<Vector3>& sums) {
  const CableReport whole = report.with_wraps_in_place();
  const std::size_t links = whole.links.size();
  for (std::size_t k = 0; k < whole.spans.size(); ++k) {
    const SpanReport& span = whole.spans[k];
    std::size_t next = (k + 1) % links;
    while (next != k && !whole.links[next].touched) next = (next + 1) % links;
    sums[at(bodies.index(whole.links[k].body))] += span.start_force;
    sums[at(bodies.index(whole.links[next].body))] += span.end_force;
  }
}

}  // namespace

std::vector<SupportReaction> support_reactions(Simulation& simulation,
                                               const std::vector<std::vector<double>>& forces) {
  const BodySet& bodies = simulation.world.bodies();
  const State state = simulation.world.state();
  Configuration configuration(simulation, state, 1.0);
  // Forces of cables come from their reports, because their rows omit bodies that cannot move.
  const std::size_t features = simulation.world.features().size();
  const std::size_t cables = simulation.cables != nullptr ? features - 1 : features;
  std::vector<Vector3> sums = configuration.forces_on_bodies(forces, cables);
  for (const CableReport& report : simulation.cable_reports()) add_cable(bodies, report, sums);
  const Vector3 gravity =
      state.controls.has_gravity ? state.controls.gravity : simulation.world.model().gravity;
  // The bearing transmits the forces on a mounted rotor to its carrier.
  for (int i = 0; i < bodies.count(); ++i) {
    const int carrier = bodies[i].mount;
    if (carrier < 0) continue;
    const BodyDef& rotor = bodies.definition(i);
    sums[at(i)] += rotor.force + defined_mass_properties(rotor).mass * gravity;
    sums[at(carrier)] += sums[at(i)];
  }
  std::vector<SupportReaction> reactions;
  double largest = 0.0;
  for (int i = 0; i <= bodies.count(); ++i) {
    Vector3 force = sums[at(i)];
    const bool world = i == bodies.count();
    if (!world) {
      const Mobility mobility = bodies[i].mobility;
      if (mobility == Mobility::free) continue;
      const BodyDef& body = bodies.definition(i);
      const bool moves = mobility != Mobility::fixed && mobility != Mobility::kinematic;
      if (moves && bodies[i].mount < 0)
        force += body.force + defined_mass_properties(body).mass * gravity;
    }
    largest = std::max(largest, force.norm());
    reactions.push_back({world ? BodyId::world() : BodyId{i}, -force});
  }
  // Weights carried by ropes leave rounding errors.
  constexpr double rounding = 1e-9;
  std::erase_if(reactions, [&](const SupportReaction& reaction) {
    return reaction.force.norm() <= rounding * largest;
  });
  return reactions;
}

}  // namespace sheave
