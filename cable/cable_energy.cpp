// The potential energy of cables: of their springs, and of the weight of ropes.

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/floor_friction.h"
#include "cable/hanging_rope.h"
#include "cable/link_contact.h"
#include "cable/rope_memories.h"
#include "engine/index.h"

namespace sheave {

double CableSystem::elastic_energy(const BodySet& bodies, const State& state,
                                   const FeatureState& own) const {
  const auto elastic = [](const CompiledCable& cable) {
    return cable.compliance > 0.0 || cable.inverse_stiffness > 0.0 || cable.linear_density > 0.0;
  };
  if (std::none_of(cables_.begin(), cables_.end(), elastic)) return 0.0;
  const Substep now(bodies, state, 1.0, 1);
  Geometry current;
  find_geometry(now, own, current);
  double energy = stored_energy(own);
  for (int k = 0; k < span_count(); ++k) {
    const SpanSetup& setup = current.spans[at(k)];
    if (!setup.active) continue;
    const double rest_length = own.reals[rest_length_index(k)];
    const double compliance = compliance_under(state.controls, setup.cable, rest_length);
    const SpanGeometry span =
        span_geometry(now, setup, current.links[at(setup.first)], current.links[at(setup.second)]);
    if (hangs(now, k)) {
      const CompiledCable& cable = cables_[at(setup.cable)];
      FloorProfile room;
      const WheelPlane wheels = wheel_plane_of(
          now, cable, setup, current.links[at(setup.first)], current.links[at(setup.second)], span,
          FloorFriction::grip_in(*this, now.gravity, own, k, room));
      energy += hanging_energy(cable, now.gravity, span, wheels, rest_length);
      continue;
    }
    const double stretch = span.length - rest_length;
    if (cables_[at(setup.cable)].memory) {
      energy += RopeMemories::energy(*this, own, k, setup.second, stretch);
    } else if (const TensionLaw* law = cables_[at(setup.cable)].law.get(); law != nullptr) {
      if (rest_length > 0.0) energy += rest_length * law->energy(stretch / rest_length);
    } else if (compliance > 0.0 && stretch > 0.0) {
      energy += 0.5 * stretch * stretch / compliance;
    }
  }
  return energy;
}

double CableSystem::potential_energy(const BodySet& bodies, const State& state,
                                     const FeatureState& own) const {
  const auto weighs = [](const CompiledCable& cable) { return cable.linear_density > 0.0; };
  if (std::none_of(cables_.begin(), cables_.end(), weighs)) return 0.0;
  const Substep now(bodies, state, 1.0, 1);
  Geometry current;
  find_geometry(now, own, current);
  double energy = 0.0;
  std::vector<Vector3> turned(links_.size(), Vector3::Zero());
  std::vector<char> sides(links_.size(), 0);  // per link: number of spans
  for (int k = 0; k < span_count(); ++k) {
    const SpanSetup& setup = current.spans[at(k)];
    if (!setup.active || !hangs(now, k)) continue;
    const LinkGeometry& first = current.links[at(setup.first)];
    const LinkGeometry& second = current.links[at(setup.second)];
    const SpanGeometry span = span_geometry(now, setup, first, second);
    const CompiledCable& cable = cables_[at(setup.cable)];
    FloorProfile room;
    const WheelPlane wheels =
        wheel_plane_of(now, cable, setup, first, second, span,
                       FloorFriction::grip_in(*this, now.gravity, own, k, room));
    energy += hanging_potential(cable, now.gravity, span, wheels, own.reals[rest_length_index(k)]);
    turned[at(setup.first)] -= span.direction;
    turned[at(setup.second)] += span.direction;
    ++sides[at(setup.first)];
    ++sides[at(setup.second)];
  }
  for (const CompiledCable& cable : cables_) {
    if (!(weight_of(cable, now.gravity) > 0.0)) continue;
    for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
      const LinkGeometry& wheel = current.links[at(i)];
      const double length = own.reals[stored_length_index(i)];
      if (!wheel.wraps() || sides[at(i)] == 0) continue;
      const StoredLoad load =
          stored_load(cable.linear_density, length, stored_arc(own, i), wheel.signed_radius,
                      sides[at(i)] == 2 ? turned[at(i)] : Vector3(Vector3::Zero()));
      energy -= dot(now.gravity, load.weight * center_of(now, wheel, 0) + load.offset);
    }
  }
  return energy;
}

}  // namespace sheave
