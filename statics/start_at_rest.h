#pragma once
// Simulations that start at rest.
//
//   sheave::Errors none = sheave::start_at_rest(*simulation);
//   if (!none.empty()) report(none);  // the machine has no rest near its pose
//   simulation->step();               // nothing moves until a drive or a force does

#include <optional>

#include "cable/simulation.h"

namespace sheave {

/// Moves the simulation to the equilibrium near its pose (statics/equilibrium.h), with drives in
/// their places and without passing time. If no run can start there, the error has the reason and
/// the remedy, and the simulation is unchanged: a body has an initial velocity, nothing balances a
/// force, the equilibrium is unstable, or a cable parts on the way.
[[nodiscard]] Errors start_at_rest(Simulation& simulation);

/// An elastic span whose tension at the start is not the one at rest.
struct UnsettledSpan {
  int cable = 0;
  int span = 0;        ///< index in CableReport::spans
  double start = 0.0;  ///< tension by the law of the cable in the pose of the start [N]
  double rest = 0.0;   ///< [N]
};

/// The elastic span of a simulation at its start with the largest bounce, if its tension differs
/// from that at rest by more than `share` of the largest tension of its cable at rest. None if the
/// machine starts in motion or is driven, if it has no rest, if the rest is another pose than the
/// one that the stretch of the ropes explains, or if the machine is too large for a search before
/// each run. `simulation` is used up.
[[nodiscard]] std::optional<UnsettledSpan> find_unsettled_span(Simulation simulation, double share);

}  // namespace sheave
