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
// So the scheme stays reversible and of second order.
//
// A damper resists the stretch s of the rope, and the sag takes the rest of the motion of the chord:
// ds/dc = a / (a - dE/dT). The force of the damper on the chord is therefore its coefficient times
// (ds/dc)^2 times the rate of the chord (Rayleigh's dissipation function). Rope that comes off a wheel
// brings its strain, which the damper does not resist. The force of the damper adds to that of the
// spring. The tension of the spring alone shapes the catenary, and the weight is that of its length.
//
// A span that ends on wheels leaves them at the tangents of its catenary (cable/wheel_catenary.h).
// Its rest length L is counted between the points of the straight tangent, over which rope passes from
// a span onto a wheel as without weight, so the value L - l and its gradient are those of a rope
// without weight. f has the additional arcs, and the load has the forces on the wheels: the tension
// at the tangent point, and the weight of additional and stored rope, each with its moment. Rope comes
// onto a wheel with the strain that it has at the point of the straight tangent, and comes off with
// the strain with which it lies there (cable/cable_material.cpp). The stored rope has its weight at
// the place of its arc between both points of the straight tangents; on a drum at the end of the
// rope, at the axle.
//
// The inertia of the rope has rows of its own: cable/rope_inertia.cpp.

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/floor_friction.h"
#include "cable/heavy_spans.h"
#include "cable/link_contact.h"
#include "cable/lying_rope.h"
#include "engine/index.h"

namespace sheave {

using End = StoredStrain::End;

bool CableSystem::weighs_now(const Substep& substep, const CompiledCable& cable) const {
  return weighs_ && weight_of(cable, substep.gravity) > 0.0;
}

bool HeavySpans::passes(const CompiledCable& cable, int link) const {
  const bool ends = !cable.closed && (link == cable.first_link || link == cable.last_listed_link());
  return cable.shares && !ends && s_.links_[at(link)].passes();
}

void HeavySpans::begin(const Substep& substep, int k, const SpanGeometry& span) {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  const double rest_length = s_.references_[at(k)].rest_length;
  cable_parts::HangingStart& start = s_.hanging_[at(k)];
  start = {};
  const HeavyShape shape = shape_of(substep, k, span);
  start.rope = shape.rope;
  start.value = rest_length - span.length;
  start.compliance = s_.compliance_of(cable, rest_length);
  start.direction = start.began = span.direction;
  start.wheels = shape.wheels;
  const bool shares = passes(cable, setup.first) || passes(cable, setup.second);
  const auto begin_damper = [&](double slope) {
    start.began_share = start.damper_share = stretch_share(start.compliance, slope);
  };
  if (!start.wheels.has_wheels) {
    const Catenary rope = catenary_of_length(start.rope, rest_length);
    if (shares) start.now.tension = rope.tension;
    if (cable.is_damped()) begin_damper(excess_of(start.rope, rope).slope);
    return;
  }
  const WheelCatenary rope = wheel_catenary_of_length(start.wheels.span, rest_length);
  if (cable.is_damped()) begin_damper(excess_of(start.wheels.span, rope, span.length).slope);
  if (shares) start.now.tension = rope.catenary.tension;
  start.strain = std::max(rope.catenary.tension, 0.0) * cable.inverse_stiffness;
  start.strains = {std::max(rope.first_tension, 0.0) * cable.inverse_stiffness,
                   std::max(rope.second_tension, 0.0) * cable.inverse_stiffness};
  start.above = {rope.first_tension - rope.catenary.tension,
                 rope.second_tension - rope.catenary.tension};
}

namespace {

/// Whether a span at rest is so stiff that it counts as rigid, with the length that its tension gives
/// it: its strain under this tension is near the rounding of lengths.
bool counts_as_rigid(const Substep& substep, double compliance, const HangingSpan& hanging) {
  constexpr double least_strain = 1e-7;
  return substep.at_rest && hanging.tension * compliance < least_strain * hanging.span.length;
}

/// Scale of the load of a span whose ends meet [m].
constexpr double least_scale = 1e-3;

/// Makes the force of the row that of a span in a run, per multiplier of the run.
void take_share(const Vector3& gravity, double weight, HangingSpan& hanging) {
  if (!hanging.wheels.has_wheels && !hanging.catenary.lies) {
    // A larger tension draws rope, and its weight, out of the span.
    const HangingRope& rope = hanging.rope;
    const double shorter = (hanging.excess.slope - hanging.catenary.length * rope.yield) /
                           (1.0 + rope.yield * hanging.tension);
    const Vector3 sinks = -0.5 * rope.weight * shorter / gravity.norm() * gravity;
    hanging.slopes = {EndForce{hanging.pull - sinks, hanging.span.start},
                      EndForce{-hanging.pull - sinks, hanging.span.end}};
  }
  for (EndForce& slope : hanging.slopes) slope.force *= weight;
}

}  // namespace

double HeavySpans::tension_of(const Substep& substep, int k, const HangingSpan& hanging,
                              double value, double share) const {
  const double shared = s_.hanging_[at(k)].now.tension;
  if (share != 0.0 && shared > 0.0) return shared;
  // Before the first round the tension is that of the rope's length.
  const double multiplier = s_.multipliers_[at(k)];
  if (multiplier == 0.0 || share == 0.0) {
    return hanging.wheels.has_wheels
               ? wheel_catenary_of_length(hanging.wheels.span, hanging.rest_length).catenary.tension
               : catenary_of_length(hanging.rope, hanging.rest_length).tension;
  }
  double tension = multiplier / (share * substep.h * substep.h);
  const CompiledCable& cable = s_.cables_[at(s_.spans_[at(k)].cable)];
  // A machine at rest has no rates.
  if (!substep.at_rest) {
    const double change = damped_change(k, value, hanging.gained[0] + hanging.gained[1]);
    tension += damper_of(cable, k, hanging.rest_length) * change / substep.h;
  }
  const double before = s_.hanging_[at(k)].value;
  const double room = substep.load_share == 1.0 ? value : 0.5 * (value + before);
  return usable_tension(hanging.rope, tension, room);
}

std::array<double, 2> HeavySpans::gained(int k, const std::array<double, 2>& arcs,
                                         const std::array<double, 2>& strains) const {
  const SpanSetup& setup = s_.spans_[at(k)];
  const auto gain = [&](std::size_t end, int link, End side) {
    const double arc = arcs[end];
    const int place = s_.strain_places_[at(link)];
    if (!(arc > 0.0) || place < 0) return arc / (1.0 + strains[end]);
    return s_.stored_[at(place)].rest_of(side, arc, strains[end]);
  };
  return {gain(0, setup.first, End::outgoing), gain(1, setup.second, End::incoming)};
}

HangingSpan HeavySpans::on_wheels(const Substep& substep, int k, const SpanGeometry& span,
                                  const std::array<double, 2>& arcs, double share,
                                  bool mean) const {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  const cable_parts::HangingStart& start = s_.hanging_[at(k)];
  HangingSpan hanging;
  hanging.span = span;
  const HeavyShape shape = shape_of(substep, k, span);
  hanging.rope = shape.rope;
  hanging.wheels = shape.wheels;
  hanging.arcs = arcs;
  hanging.scale = start.wheels.size();
  hanging.strains = start.strains;
  const bool shares = start.now.tension > 0.0;
  // The strain hardly depends on the length that it gives, so two rounds find both.
  for (int round = 0; round < 2; ++round) {
    hanging.gained = gained(k, arcs, hanging.strains);
    hanging.rest_length = s_.references_[at(k)].rest_length + hanging.gained[0] + hanging.gained[1];
    hanging.tension = tension_of(substep, k, hanging, hanging.rest_length - span.length, share);
    if (cable.is_damped()) hanging.borne = hanging.rest_length;
    find_catenary(substep.gravity, substep.at_rest, hanging);
    const double yield = cable.inverse_stiffness;
    std::array<double, 2> tensions{hanging.on_wheels.first_tension,
                                   hanging.on_wheels.second_tension};
    if (mean) {
      // The tension of `rattle` is that of the middle.
      const WheelCatenary before = wheel_catenary_of_tension(
          start.wheels.span, shares ? start.then.tension : hanging.tension);
      tensions = {0.5 * (tensions[0] + before.first_tension),
                  0.5 * (tensions[1] + before.second_tension)};
    }
    for (const std::size_t end : {0U, 1U}) {
      hanging.strains[end] = std::max(tensions[end] * yield, 0.0);
      hanging.above[end] = tensions[end] - (shares ? start.unknown : hanging.tension);
    }
  }
  hanging.gained = gained(k, arcs, hanging.strains);
  hanging.rest_length = s_.references_[at(k)].rest_length + hanging.gained[0] + hanging.gained[1];
  return hanging;
}

HangingSpan HeavySpans::evaluate(const Substep& substep, int k, Row& row) {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  cable_parts::HangingStart& start = s_.hanging_[at(k)];
  cable_parts::StretchedSpan moved;
  HangingSpan hanging;
  hanging.span = s_.evaluate(substep, k, row, &moved);
  if (run_.shares) find_shared_tension(substep, k, hanging.span);
  if (start.wheels.has_wheels) {
    hanging = on_wheels(substep, k, hanging.span, moved.arcs, substep.load_share,
                        substep.load_share != 1.0);
    row.value = hanging.rest_length - hanging.span.length;
    row.compliance = s_.compliance_of(cable, hanging.rest_length);
    row.damping = cable.damper(hanging.rest_length);
    start.direction = hanging.span.direction;
    start.arcs = hanging.arcs;
    start.gained = hanging.gained;
    start.above = hanging.above;
  } else {
    hanging.rope = shape_of(substep, k, hanging.span).rope;
    hanging.rest_length = row.value + hanging.span.length;
    hanging.tension = tension_of(substep, k, hanging, row.value, substep.load_share);
    find_catenary(substep.gravity, substep.at_rest, hanging);
    if (run_.shares) hanging.scale = std::max(start.rope.chord(), least_scale);
  }
  row.lower = -Row::unbounded;
  row.told = false;
  row.curved = row.curved && !hanging.catenary.lies;
  row.approximate = true;
  row.active = true;
  row.index = k;
  hanging.unknown = run_.shares ? start.unknown : hanging.tension;
  if (run_.shares) take_share(substep.gravity, start.now.weight, hanging);
  turn_force(substep, hanging, s_.links_[at(setup.first)], s_.links_[at(setup.second)], row);
  if (run_.shares) {
    const double compliance = row.compliance - hanging.excess.slope;
    share_law(hanging, start, run_.now.unknown(), substep.load_share != 1.0,
              counts_as_rigid(substep, compliance, hanging), row);
    return hanging;
  }
  const double value = row.value + row.compliance * hanging.tension - hanging.excess.length;
  if (cable.is_damped()) {
    const double now = stretch_share(row.compliance, hanging.excess.slope);
    start.damper_share = substep.load_share == 1.0 ? now : 0.5 * (start.began_share + now);
    row.damping = damper_of(cable, k, hanging.rest_length);
  }
  const double came = hanging.gained[0] + hanging.gained[1];
  if (substep.load_share == 1.0) {
    const double change = damped_change(k, row.value, came);
    sag_at_end(hanging, row);
    row.past = row.value - change;
    row.has_past = true;
  } else {
    sag_in_mean(hanging, start, start.strain * came, substep.h, row);
  }
  if (counts_as_rigid(substep, row.compliance, hanging)) {
    row.compliance = 0.0;
    row.value = value;
  }
  return hanging;
}

void HeavySpans::linearise(const Substep& substep, const CompiledCable& cable, RowList& rows) {
  // The load of a wheel needs the spans on both sides.
  std::vector<std::pair<int, HangingSpan>> spans;
  for (const cable_parts::Run run : runs_of(cable)) {
    run_ = {};
    run_.shares = run.count > 1;
    if (!run_.shares) s_.hanging_[at(run.first)].now = {};
    for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
      Row& row = rows.emplace_back();
      spans.emplace_back(k, evaluate(substep, k, row));
      row.tied = i > 0;
      // Only `rattle` linearises before bodies have moved.
      if (substep.time == substep.start.time) {
        row.value = s_.hanging_[at(k)].value;
        row.compliance = 0.0;
      }
    }
  }
  run_ = {};
  for (const auto& [k, hanging] : spans) load(substep, k, hanging, rows.emplace_back());
}

double HeavySpans::sweep_span(Substep& substep, int k) {
  Row& row = s_.row_;
  row.clear();
  HangingSpan hanging = evaluate(substep, k, row);
  const double residual = solve_row(row, substep.h, s_.multipliers_[at(k)], substep.moving);
  if (!hanging.wheels.has_wheels) hanging.span = s_.geometry_of(substep, k);
  row.clear();
  load(substep, k, hanging, row);
  return residual + solve_row(row, substep.h, s_.multipliers_[at(row.index)], substep.moving);
}

StoredLoad HeavySpans::stored_on(const CompiledCable& cable, int link, double weight) const {
  const LinkGeometry& wheel = s_.links_[at(link)];
  if (!wheel.wraps()) return {};
  const bool ends = !cable.closed && link == cable.last_listed_link();
  const int in = CableSystem::span_before(cable, link, s_.spans_);
  const int out = ends ? -1 : CableSystem::span_after(cable, link);
  const int place = s_.strain_places_[at(link)];
  double arc = s_.stored_arcs_[at(link)];
  double length = place < 0 ? arc : arc - s_.stored_[at(place)].total().stretch;
  Vector3 turned = Vector3::Zero();
  if (in >= 0) {
    arc -= s_.hanging_[at(in)].arcs[1];
    length -= s_.hanging_[at(in)].gained[1];
    turned += s_.hanging_[at(in)].direction;
  }
  if (out >= 0) {
    arc -= s_.hanging_[at(out)].arcs[0];
    length -= s_.hanging_[at(out)].gained[0];
    turned -= s_.hanging_[at(out)].direction;
  }
  return stored_load(weight, length, arc, wheel.signed_radius, turned);
}

void HeavySpans::load(const Substep& substep, int k, const HangingSpan& hanging, Row& row) const {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  row.index = static_cast<int>(s_.spans_.size() + s_.bearings_.size()) + k;
  std::array<StoredLoad, 2> stored;
  if (hanging.wheels.has_wheels) {
    // The rope on a wheel belongs to the span behind it.
    const double weight = hanging.wheels.span.weight;
    stored[0] = stored_on(cable, setup.first, weight);
    const bool ends = !cable.closed && setup.second == cable.last_listed_link();
    if (ends) stored[1] = stored_on(cable, setup.second, weight);
  }
  load_ends(substep, hanging, stored, s_.links_[at(setup.first)], s_.links_[at(setup.second)], row);
}

SpanTransport HeavySpans::transport(const Substep& substep, int k, const SpanGeometry& span,
                                    const SpanTransport& arcs, FeatureState& next) {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  const std::array<double, 2> way{arcs.from_first, arcs.from_second};
  // Multipliers are those of the whole substep by now.
  HangingSpan hanging = on_wheels(substep, k, span, way, 1.0, s_.knows_start_);
  if (substep.at_rest) {
    // The poses of a search have lengths, or multipliers, with tensions far from those at rest.
    const HangingSpan by_length = on_wheels(substep, k, span, way, 0.0, false);
    if (by_length.tension < hanging.tension) hanging = by_length;
  }
  s_.hanging_[at(k)].beyond = {hanging.on_wheels.first_arc.length,
                               hanging.on_wheels.second_arc.length};
  const auto wind = [&](std::size_t end, int link, End side) {
    const int place = s_.strain_places_[at(link)];
    const double gained = hanging.gained[end];
    if (place < 0 || gained == 0.0) return;
    StoredStrain& stored = s_.stored_end_[at(place)];
    const double strain = hanging.strains[end];
    if (gained < 0.0) {
      stored.put(side, -gained, strain, cable.strain_energy());
      return;
    }
    const StoredStrain::Piece off = stored.take(side, gained, cable.strain_energy());
    next.reals[s_.creep_index(place)] +=
        0.5 / cable.inverse_stiffness *
        (off.square - 2.0 * strain * off.stretch + strain * strain * off.length);
  };
  wind(0, setup.first, End::outgoing);
  wind(1, setup.second, End::incoming);
  s_.hanging_[at(k)].strains = hanging.strains;
  return {hanging.gained[0], hanging.gained[1]};
}

int HeavySpans::left_wheel(const FeatureState& next) const {
  constexpr double rounding = 1e-6;  // times the perimeter
  for (const CompiledCable& cable : s_.cables_) {
    if (!(cable.linear_density > 0.0)) continue;
    for (int i = cable.first_link; i < cable.first_link + cable.listed_links; ++i) {
      const LinkGeometry& link = s_.links_[at(i)];
      const bool end = !cable.closed && (i == cable.first_link || i == cable.last_listed_link());
      if (end || !link.wraps()) continue;
      const int in = CableSystem::span_before(cable, i, s_.spans_);
      const int out = CableSystem::span_after(cable, i);
      const double arc = next.reals[s_.stored_length_index(i)] + s_.hanging_[at(in)].beyond[1] +
                         s_.hanging_[at(out)].beyond[0];
      if (arc < -rounding * link.perimeter()) return i;
    }
  }
  return -1;
}

double HeavySpans::keep_tension(const Substep& substep, int k, const SpanGeometry& span,
                                double rest_length, double tension) {
  cable_parts::HangingStart& start = s_.hanging_[at(k)];
  if (start.now.tension > 0.0) return tension;  // find_spare() does that
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  const auto [wheels, rope, straight] = shape_of(substep, k, span);
  if (cable.has_floor()) {
    tension = std::max(
        tension, std::min(least_tension(start.rope, start.wheels), least_tension(rope, wheels)));
  }
  const Catenary catenary = wheels.has_wheels
                                ? catenary_of(cable, wheels, rest_length, tension).catenary
                                : catenary_of(cable, rope, rest_length, tension);
  start.most = std::max(catenary.start_tension(), catenary.end_tension());
  return tension;
}

}  // namespace sheave
