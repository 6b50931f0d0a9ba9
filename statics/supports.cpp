#include "statics/supports.h"

#include <algorithm>
#include <cmath>

#include "engine/body_mass.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/shape.h"
#include "statics/configuration.h"

namespace sheave {
namespace {

/// Unstretched length on a wheel between the end of a straight span and the point where a rope with
/// weight leaves the wheel [m], from the angle between both.
double additional_arc(const CableDef& cable, const LinkReport& wheel, const Vector3& point,
                      const Vector3& straight, const Vector3& tension, const Vector3& up) {
  const double size = tension.norm();
  if (!(wheel.radius > 0.0) || !(size > 0.0)) return 0.0;
  const Vector3 left = up - straight * straight.dot(up);
  const double angle = straight.cross(tension / size).norm();
  const double arc = wheel.radius * std::asin(std::min(angle, 1.0));
  const double length = arc / (1.0 + size / cable.axial_stiffness.value_or(size));
  // The rope leaves the upper side of a wheel later, and the lower side earlier.
  return left.dot(point - wheel.center) > 0.0 ? length : -length;
}

/// Adds the weight of the rope on wheels, which the forces of spans do not have.
void add_weight(const BodySet& bodies, const CableDef& cable, const Vector3& gravity,
                const CableReport& report, std::vector<Vector3>& sums) {
  if (!(cable.linear_density > 0.0) || is_zero(gravity) || report.cut) return;
  const Vector3 weight = cable.linear_density * gravity;
  const Vector3 up = -gravity.normalized();
  const std::size_t links = report.links.size();
  for (const LinkReport& link : report.links) {
    sums[at(bodies.index(link.body))] += link.stored_length * weight;
  }
  for (std::size_t k = 0; k < report.spans.size(); ++k) {
    const SpanReport& span = report.spans[k];
    // The floor of a rope is a part of the world.
    sums[at(bodies.count())] += span.floored * weight;
    if (!span.hangs || !(span.length > 0.0)) continue;
    const LinkReport& first = report.links[k];
    const LinkReport& second = report.links[(k + 1) % links];
    const Vector3 way = (span.end - span.start) / span.length;
    sums[at(bodies.index(first.body))] +=
        additional_arc(cable, first, span.start, way, span.start_force, up) * weight;
    sums[at(bodies.index(second.body))] +=
        additional_arc(cable, second, span.end, way, -span.end_force, up) * weight;
  }
}

void add_cable(const BodySet& bodies, const CableReport& report, std::vector<Vector3>& sums) {
  const CableReport whole = report.with_wraps_in_place();
  const std::size_t links = whole.links.size();
  for (std::size_t k = 0; k < whole.spans.size(); ++k) {
    const SpanReport& span = whole.spans[k];
    std::size_t next = (k + 1) % links;
    while (next != k && !whole.links[next].touched) next = (next + 1) % links;
    sums[at(bodies.index(whole.links[k].exit_body))] += span.start_force;
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
  const Vector3 gravity =
      state.controls.has_gravity ? state.controls.gravity : simulation.world.model().gravity;
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t c = 0; c < reports.size(); ++c) {
    add_cable(bodies, reports[c], sums);
    add_weight(bodies, (*simulation.cable_definitions)[c], gravity, reports[c], sums);
  }
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
      if (mobility == Mobility::free || mobility == Mobility::knot) continue;
      const BodyDef& body = bodies.definition(i);
      if (yields(mobility) && bodies[i].mount < 0)
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
