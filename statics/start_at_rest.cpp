#include "statics/start_at_rest.h"

#include <algorithm>
#include <cmath>

#include "cable/tension_law.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/number_text.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"

namespace sheave {
namespace {

constexpr std::string_view remedy =
    "; start in the pose of the scene (\"start\": \"pose\"), or from a state that sheave statics "
    "--save-state has written (--load-state)";

Errors no_rest(const std::string& reason) {
  return {{"", "cannot start at rest: " + reason + std::string(remedy)}};
}

/// Why the motion of the start is not rest; empty if no body moves but those that are driven.
std::string initial_motion(const World& world) {
  const BodySet& bodies = world.bodies();
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& own = bodies[i];
    if (own.mobility == Mobility::kinematic || own.mobility == Mobility::knot) continue;
    if (own.prescribed()) continue;
    const BodyState& state = world.state().bodies[at(i)];
    const double speed = state.velocity.norm();
    const double spin = state.angular_velocity.norm();
    if (!(speed > 0.0) && !(spin > 0.0)) continue;
    // A mounted rotor and a sheave move with the body that carries them.
    if (own.mount >= 0) continue;
    return "body \"" + bodies.name(i) + "\" has an initial velocity, " +
           (speed > 0.0 ? number_text(speed) + " m/s" : number_text(spin) + " rad/s") +
           ", and at rest it has 0; leave out its velocity and angular_velocity";
  }
  return "";
}

/// The body that moves most in the least stable motion about the pose of the simulation.
std::string least_stable_body(Simulation& simulation) {
  const Modes modes = find_modes(simulation);
  if (modes.modes.empty() || modes.modes.front().body < 0) return "";
  return ", most of all body \"" + simulation.world.bodies().name(modes.modes.front().body) + "\"";
}

/// Why no run can start at this equilibrium; empty if one can.
std::string fault_of(const Equilibrium& rest, Simulation& simulation) {
  if (!rest.converged) return rest.message;
  for (const CableEvent& event : rest.events) {
    if (event.kind != CableEvent::Kind::cut) continue;
    return "cable \"" + event.cable + "\" parts on the way to the equilibrium";
  }
  if (rest.stability != Stability::unstable) return "";
  return "the equilibrium near its pose is unstable: " + std::to_string(rest.unstable_motions) +
         " of " + std::to_string(rest.eigenvalues.size()) + " independent motions run away" +
         least_stable_body(simulation);
}

Errors start_at_rest(Simulation& simulation, const EquilibriumSettings& settings) {
  if (const std::string motion = initial_motion(simulation.world); !motion.empty()) {
    return no_rest(motion);
  }
  const State before = simulation.world.state();
  const Equilibrium rest = find_equilibrium(simulation, settings);
  const std::string fault = fault_of(rest, simulation);
  if (fault.empty()) return {};
  const Errors errors = simulation.world.restore(before);
  return errors.empty() ? no_rest(fault) : errors;
}

/// The tension of an elastic cable in a span by its law, without dampers; NaN if it is rigid [N].
double elastic_tension(const CableDef& cable, const SpanReport& span) {
  return spring_tension(cable, span.length, span.rest_length).value_or(std::nan(""));
}

/// The span whose tension changes most between two lists of reports, of those that change by more
/// than `share` of the largest tension of their cable at rest.
std::optional<UnsettledSpan> most_unsettled(const std::vector<CableDef>& cables,
                                            const std::vector<CableReport>& start,
                                            const std::vector<CableReport>& rest, double share) {
  std::optional<UnsettledSpan> found;
  double most = 0.0;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    const double largest = rest[c].largest_tension();
    // A rope that is slack at rest holds nothing; its stretch at the start is meant to throw.
    if (!(largest > 0.0)) continue;
    for (std::size_t k = 0; k < std::min(start[c].spans.size(), rest[c].spans.size()); ++k) {
      const double before = elastic_tension(cables[c], start[c].spans[k]);
      const double after = elastic_tension(cables[c], rest[c].spans[k]);
      const double change = std::abs(after - before);
      if (!(change > share * largest) || !(change > most)) continue;
      most = change;
      found = UnsettledSpan{static_cast<int>(c), static_cast<int>(k), before, after};
    }
  }
  return found;
}

/// Sum over all spans of how much their stretch changes [m].
double change_of_stretch(const std::vector<CableReport>& start,
                         const std::vector<CableReport>& rest) {
  const auto stretch = [](const SpanReport& span) {
    return std::max(span.length - span.rest_length, 0.0);
  };
  double sum = 0.0;
  for (std::size_t c = 0; c < start.size(); ++c) {
    for (std::size_t k = 0; k < std::min(start[c].spans.size(), rest[c].spans.size()); ++k) {
      sum += std::abs(stretch(rest[c].spans[k]) - stretch(start[c].spans[k]));
    }
  }
  return sum;
}

double farthest_motion(const State& from, const State& to) {
  double most = 0.0;
  for (std::size_t i = 0; i < from.bodies.size(); ++i) {
    most = std::max(most, (to.bodies[i].position - from.bodies[i].position).norm());
  }
  return most;
}

/// Kinetic energy one step after this state [J]; NaN if the step fails.
double energy_after_a_step(Simulation& simulation) {
  return simulation.step().ok() ? simulation.world.energy().kinetic : std::nan("");
}

}  // namespace

Errors start_at_rest(Simulation& simulation) { return start_at_rest(simulation, {}); }

// The rest is searched for, since no local measure tells whether there is one: the imbalance of
// forces on a body at the start is the same whether its rope bounces or the machine falls. Three
// conditions tell a bounce from a motion that is meant:
//
// * All bodies come to rest by the stretch of the ropes. A body moves by the stretch of its ropes
//   times a leverage, and levers of machines are shorter than `longest_lever`. A pendulum that
//   starts aside, or a load above the ground, moves farther.
// * A machine at rest is nearly at rest one step later. From the pose the imbalance F of a mass m
//   makes the energy (F dt)^2 / 2 m. If the energy from the rest is more than a quarter of that, a
//   drive, a controller or a trigger moves the machine with more than half of its speed.
// * The search is short. Its matrices are dense, so its work grows with the cube of the number of
//   degrees of freedom; beyond `most_freedoms` a search could take longer than the run.
std::optional<UnsettledSpan> find_unsettled_span(Simulation simulation, double share) {
  constexpr double longest_lever = 10.0;
  constexpr double largest_energy = 0.25;
  constexpr int most_freedoms = 120;
  const std::vector<CableDef>& cables = *simulation.cable_definitions;
  const auto is_elastic = [](const CableDef& cable) { return cable.is_elastic(); };
  if (std::none_of(cables.begin(), cables.end(), is_elastic)) return {};
  if (simulation.world.bodies().coordinates().count() - 1 > most_freedoms) return {};
  const State start = simulation.world.state();
  const std::vector<CableReport> start_cables = simulation.cable_reports();
  EquilibriumSettings settings;
  settings.iterations = 40;
  if (!start_at_rest(simulation, settings).empty()) return {};
  const std::vector<CableReport> rest_cables = simulation.cable_reports();
  std::optional<UnsettledSpan> found = most_unsettled(cables, start_cables, rest_cables, share);
  if (!found) return {};
  const double stretch = change_of_stretch(start_cables, rest_cables);
  if (farthest_motion(start, simulation.world.state()) > longest_lever * stretch) return {};
  const double from_rest = energy_after_a_step(simulation);
  if (!simulation.world.restore(start).empty()) return {};
  const double from_start = energy_after_a_step(simulation);
  return from_rest <= largest_energy * from_start ? found : std::nullopt;
}

}  // namespace sheave
