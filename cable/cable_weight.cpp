// Ropes with weight.
//
// A free span of a rope with weight is a catenary (cable/catenary.h). Its row keeps the chord: with
// the rest length L, the chord c and the chord tension T as the unknown force,
//
//   C(x) + f(T) = 0,   C = L - c,   f(T) = a T - E(T),
//
// where a is the compliance of a span without weight and E the excess of the catenary over its
// chord. So the sag is a spring in series with the rope's own elasticity. f increases with T for
// all tensions, and a rope with weight is never slack. A round linearises f at the present tension.
//
// The forces at the ends are the mean tension t(T) = (H, V) of the catenary, and half of the weight.
// The row pulls along dt / dT, which is near the chord. A second row with a given force is the load:
// the weight, and t - T dt / dT. So the forces are exact at the tension of the last round, and their
// error is of second order in its change.
//
// `rattle` takes the mean over the substep, C0 + C1 + f0(T) + f1(T) = 0, with the ends at its start
// and at its end: the midpoint rule for this spring. The load acts in each half with the ends there.
// So the scheme stays reversible and of second order. A damper adds its force to that of the spring.
//
// The rope has weight and no inertia.

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/hanging_rope.h"
#include "engine/index.h"

namespace sheave {

bool CableSystem::has_weight(const Substep& substep, int span) const {
  return weight_of(cables_[at(spans_[at(span)].cable)], substep.gravity) > 0.0;
}

void CableSystem::begin_hanging(const Substep& substep, int k, const SpanGeometry& span) {
  const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
  const double rest_length = references_[at(k)].rest_length;
  hanging_[at(k)] = {hanging_rope(cable, substep.gravity, span), rest_length - span.length,
                     compliance_of(cable, rest_length)};
}

namespace {

/// Whether a span at rest is so stiff that it counts as rigid, with the length that its tension gives
/// it: its strain under this tension is near the rounding of lengths.
bool counts_as_rigid(const Substep& substep, const Row& row, const HangingSpan& hanging) {
  constexpr double least_strain = 1e-7;
  return substep.at_rest && hanging.tension * row.compliance < least_strain * hanging.span.length;
}

}  // namespace

double CableSystem::hanging_tension(const Substep& substep, int k, const HangingSpan& hanging,
                                    double value) const {
  // Before the first round the tension is that of the rope's length.
  const double multiplier = multipliers_[at(k)];
  if (multiplier == 0.0) return catenary_of_length(hanging.rope, hanging.rest_length).tension;
  double tension = multiplier / (substep.load_share * substep.h * substep.h);
  const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
  tension += cable.damping * (value - hanging_[at(k)].value) / substep.h;
  const double room = substep.load_share == 1.0 ? value : 0.5 * (value + hanging_[at(k)].value);
  return usable_tension(hanging.rope, tension, room);
}

HangingSpan CableSystem::evaluate_hanging(const Substep& substep, int k, Row& row) const {
  const SpanSetup& setup = spans_[at(k)];
  HangingSpan hanging;
  hanging.span = evaluate(substep, k, row);
  hanging.rope = hanging_rope(cables_[at(setup.cable)], substep.gravity, hanging.span);
  hanging.rest_length = row.value + hanging.span.length;
  hanging.tension = hanging_tension(substep, k, hanging, row.value);
  find_catenary(substep.gravity, hanging);
  row.lower = -Row::unbounded;
  row.told = false;
  row.active = true;
  row.index = k;
  turn_force(substep, hanging, links_[at(setup.first)], links_[at(setup.second)], row);
  const double value = row.value + row.compliance * hanging.tension - hanging.excess.length;
  if (substep.load_share == 1.0) {
    sag_at_end(hanging, row);
  } else {
    sag_in_mean(hanging, hanging_[at(k)], substep.h, row);
  }
  if (counts_as_rigid(substep, row, hanging)) {
    row.compliance = 0.0;
    row.value = value;
  }
  return hanging;
}

void CableSystem::linearise_hanging(const Substep& substep, int k, RowList& rows) {
  Row& row = rows.emplace_back();
  const HangingSpan hanging = evaluate_hanging(substep, k, row);
  // Only `rattle` linearises before bodies have moved.
  if (substep.time == substep.start.time) {
    row.value = hanging_[at(k)].value;
    row.compliance = 0.0;
  }
  load_span(substep, k, hanging, rows.emplace_back());
}

double CableSystem::sweep_hanging(Substep& substep, int k) {
  row_.clear();
  HangingSpan hanging = evaluate_hanging(substep, k, row_);
  const double residual = solve_row(row_, substep.h, multipliers_[at(k)], substep.moving);
  hanging.span = geometry_of(substep, k);
  row_.clear();
  load_span(substep, k, hanging, row_);
  return residual + solve_row(row_, substep.h, multipliers_[at(row_.index)], substep.moving);
}

void CableSystem::load_span(const Substep& substep, int k, const HangingSpan& hanging,
                            Row& row) const {
  const SpanSetup& setup = spans_[at(k)];
  row.index = static_cast<int>(spans_.size() + bearings_.size()) + k;
  load_ends(substep, hanging, links_[at(setup.first)], links_[at(setup.second)], row);
}

double CableSystem::potential_energy(const BodySet& bodies, const State& state,
                                     const FeatureState& own) const {
  const auto weighs = [](const CompiledCable& cable) { return cable.linear_density > 0.0; };
  if (std::none_of(cables_.begin(), cables_.end(), weighs)) return 0.0;
  const Substep now(bodies, state, 1.0, 1);
  Geometry current;
  find_geometry(now, own, current);
  double energy = 0.0;
  for (int k = 0; k < span_count(); ++k) {
    const SpanSetup& setup = current.spans[at(k)];
    if (!setup.active || !hangs(now, k)) continue;
    const SpanGeometry span =
        span_geometry(now, setup, current.links[at(setup.first)], current.links[at(setup.second)]);
    const HangingRope rope = hanging_rope(cables_[at(setup.cable)], now.gravity, span);
    const double rest_length = own.reals[rest_length_index(k)];
    const double height = -dot(now.gravity, span.start) / now.gravity.norm();
    energy += rope.weight *
              (rest_length * height + height_integral(rope, catenary_of_length(rope, rest_length)));
  }
  return energy;
}

}  // namespace sheave
