// Cost of a substep per span: one tangent in begin(), one per sweep, one in finish(); see bench/.

#include "cable/cable_system.h"

#include <algorithm>

#include "cable/drum_grooves.h"
#include "cable/floor_friction.h"
#include "cable/hanging_rope.h"
#include "cable/heavy_spans.h"
#include "cable/knots.h"
#include "cable/rope_memories.h"
#include "cable/sheaths.h"
#include "cable/span_law.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Whether begin() needs the geometry of the span.
bool asks_where(const SpanSetup& setup, const CompiledCable& cable) {
  return setup.kind != SpanKind::straight || cable.inverse_stiffness > 0.0 ||
         cable.linear_density > 0.0 || cable.tangent_update == TangentUpdate::substep;
}

/// Keeps the ends of a span in the frames of their bodies, for the substep.
void keep_places(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                 const SpanGeometry& span, SpanReference& reference) {
  const auto own_point = [&](int body, const Vector3& point) -> Vector3 {
    return substep.orientation(body).conjugate() * (point - substep.position(body));
  };
  reference.first_point = own_point(first.body, span.start);
  reference.second_point = own_point(second.body, span.end);
}

/// Freezes cables that ask for it; begin() cancels that if a span has to follow.
void freeze_where_asked(std::vector<CompiledCable>& cables) {
  for (CompiledCable& cable : cables) {
    cable.frozen = cable.tangent_update == TangentUpdate::substep && !cable.has_sheaths;
  }
}

/// Whether a frozen attachment would be wrong on this link. If the span leans to the link's plane,
/// the force would do work with the arm r cos(lean) while the rim takes cable with the arm r, at
/// any step size; for a lean below 1e-6 the difference is 5e-13, below rounding. On an outline a
/// frozen attachment jumps by an edge. And where cable with a material slides, its stretch depends
/// on the present length of the arc. The place in an opening depends on the present positions.
bool must_follow(const Substep& substep, const LinkGeometry& link, const SpanGeometry& span,
                 const CompiledCable& cable) {
  if (link.opening) return true;
  if (!link.wraps()) return false;
  if (link.geodesic || (cable.inverse_stiffness > 0.0 && link.slides_over())) return true;
  constexpr double least = 1e-6;
  const Vector3 normal = rotated(substep.orientation(link.carrier), link.normal);
  return link.outline || std::abs(dot(normal, span.direction)) > least;
}

}  // namespace

double CableSystem::compliance_of(const CompiledCable& cable, double rest_length) const {
  // The compliance of a material is proportional to the stretched length.
  return cable.compliance + cable.inverse_stiffness * std::max(rest_length, 0.0);
}

double CableSystem::longest() const {
  double longest = 0.0;
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    if (spans_[k].active) longest = std::max(longest, references_[k].rest_length);
  }
  return longest;
}

void CableSystem::begin(const Substep& substep, const FeatureState& state) {
  follow_state(substep, state);
  begin_geodesics(substep);
  begin_affine_spans(substep);
  known_.expect(spans_.size());
  knows_start_ = given_.knows_multipliers = false;
  given_.changes = 0;
  arrived_ = {};
  left_ = -1;
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  std::fill(sweeps_.begin(), sweeps_.end(), 0);
  std::fill(flips_.begin(), flips_.end(), 0);
  std::fill(run_work_.means.begin(), run_work_.means.end(), 0);
  if (driven_) begin_drives(state);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    slip_[i] = pending_slip_[i] = static_cast<int>(state.integers[i]);
    const auto link = static_cast<int>(i);
    if (strain_places_[i] < 0) {
      stored_arcs_[i] = state.reals[stored_length_index(link)];
      continue;
    }
    stored_arcs_[i] = stored_arc(state, link);
    stored_[at(strain_places_[i])] = stored_strain(state, link);
  }
  freeze_where_asked(cables_);
  if (!laid_.empty()) FloorFriction(*this).begin(substep, state);
  bool has_lifted = false;
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    has_lifted = has_lifted || !spans_[k].active;
    if (!spans_[k].active) continue;
    const int span = static_cast<int>(k);
    start_tensions_[k] = state.reals[tension_index(span)];
    // The length below the quantum counts in the row, too: over 1e5 spans its effect would exceed
    // that of gravity.
    const double below_quantum =
        state.reals[remainder_index(span, 0)] + state.reals[remainder_index(span, 1)];
    references_[k].rest_length = state.reals[k] + below_quantum;
    is_affine_[k] = affine_[k].possible && affine_[k].lasts(substep) ? 1 : 0;
    if (is_affine_[k] == 0) begin_moving_span(substep, state, span);
  }
  for (const CompiledCable& cable : cables_) {
    if (has_lifted || !cable.candidates.empty()) remember_sides(substep, cable, state);
    if (cable.shares && cable.compliance > 0.0) hold_drained(cable, state);
  }
  if (!sheaths_.empty()) Sheaths(*this).begin(substep, state);
  if (!memories_.empty()) RopeMemories(*this).begin(substep, state);
  if (!knots_.empty()) Knots(*this).begin();
  begin_bearings(substep);
  begin_arrivals(substep);
  known_.forget();
}

void CableSystem::begin_moving_span(const Substep& substep, const FeatureState& state, int k) {
  const SpanSetup& setup = spans_[at(k)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  CompiledCable& cable = cables_[at(setup.cable)];
  SpanReference& reference = references_[at(k)];
  SpanGeometry span;
  if (asks_where(setup, cable)) span = known_.keep(k, geometry_of(substep, k));
  reference = span_reference(substep, setup, first, second, reference.rest_length, &span);
  const bool stretches = cable.inverse_stiffness > 0.0;
  if (stretches) strains_[at(k)] = strain_of(cable, span.length, reference.rest_length);
  if (hangs(substep, k)) HeavySpans(*this).begin(substep, k, span);
  if (first.feeds || second.feeds) {
    feed(state, substep.h, k);
    reference.rest_length += fed_[at(k)][0] + fed_[at(k)][1];
  }
  if (cable.tangent_update == TangentUpdate::substep) {
    keep_places(substep, first, second, span, reference);
    const bool follows =
        must_follow(substep, first, span, cable) || must_follow(substep, second, span, cable);
    cable.frozen = cable.frozen && !follows;
  }
}

SpanGeometry CableSystem::evaluate(const Substep& substep, int span, Row& row,
                                   StretchedSpan* kept) const {
  const SpanSetup& setup = spans_[at(span)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  const SpanReference& reference = references_[at(span)];
  row.lower = 0.0;  // a cable pulls and never pushes
  row.rate = first.feeds || second.feeds ? drive_work_.feed_rates[at(span)] : 0.0;
  const bool frozen = cable.frozen;
  SpanTransport transport;
  // One expression, so that the span is constructed in place.
  const SpanGeometry geometry =
      frozen ? evaluate_span_frozen(substep, first, second, reference, row)
      : has_layers_ && layered(span)
          ? evaluate_layered(substep, span, row, transport)
          : evaluate_span(substep, setup, first, second, reference, row, transport);
  if (kept != nullptr && hangs(substep, span)) {
    kept->arcs = {transport.from_first, transport.from_second};
    row.damping = cable.damper(row.value + geometry.length);
    row.compliance = compliance_of(cable, row.value + geometry.length);
  } else if (cable.inverse_stiffness > 0.0 && !frozen) {
    const StretchedSpan stretch = stretched(span, transport, geometry.length);
    row.value = stretch.value;
    row.compliance = compliance_of(cable, stretch.spring_length);
    row.damping = cable.damper(stretch.spring_length);
    if (cable.law) {
      const double length = stretch.spring_length;
      const double strain = length > 0.0 ? -stretch.value / length : 0.0;
      const double slack =
          knows_start_ && length > 0.0 ? std::max(start_values_[at(span)][0], 0.0) / length : 0.0;
      follow_law(cable, law_step(substep, knows_start_),
                 {stretch.start_strain, slack, stretch.memory}, strain, length, row);
    }
    row.past = row.value - (stretch.value + stretch.start_strain * stretch.spring_length);
    row.has_past = true;
    if (kept != nullptr) *kept = stretch;
  } else {
    row.damping = cable.damper(row.value + geometry.length);
    row.compliance = compliance_of(cable, row.value + geometry.length);
  }
  row.told = row.curved && cable.is_rigid() && !cable.has_friction && !setup.outlined &&
             cable.openings.empty() && setup.kind != SpanKind::spatial &&
             !(has_layers_ && layered(span));
  return geometry;
}

double CableSystem::sweep(Substep& substep) {
  turn_geodesics(substep);
  double correction = knots_.empty() ? 0.0 : Knots(*this).sweep(substep);
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const bool runs = cables_[i].shares && !cables_[i].knotted && !weighs_now(substep, cables_[i]);
    correction = std::max(correction, runs ? sweep_runs(substep, static_cast<int>(i))
                                           : sweep_spans(substep, cables_[i]));
  }
  given_.knows_multipliers = true;
  return std::max(correction, sweep_bearings(substep));
}

double CableSystem::solve_affine(Substep& substep, int span) {
  AffineSpan& affine = affine_[at(span)];
  double& multiplier = multipliers_[at(span)];
  affine.row.value = affine.value(substep, references_[at(span)].rest_length);
  if (affine.row.value >= 0.0 && multiplier == 0.0) return 0.0;  // slack
  return solve_row(affine.row, substep.h, multiplier, substep.moving);
}

double CableSystem::solve_span(Substep& substep, int span) {
  if (is_affine_[at(span)] != 0) return solve_affine(substep, span);
  Row& row = row_;
  row.clear();
  const SpanGeometry geometry = evaluate(substep, span, row);
  if (spans_[at(span)].kind == SpanKind::spatial) {
    references_[at(span)].ends = {geometry.start, geometry.end};
  }
  double& multiplier = multipliers_[at(span)];
  if (row.value >= 0.0 && multiplier == 0.0) return 0.0;  // slack
  return solve_row(row, substep.h, multiplier, substep.moving);
}

double CableSystem::sweep_spans(Substep& substep, const CompiledCable& cable) {
  if (cable.knotted) return Knots(*this).sweep_rest(substep, cable);
  if (weighs_now(substep, cable)) return HeavySpans(*this).sweep(substep, cable);
  if (cable.has_sheaths) return Sheaths(*this).sweep(substep, cable);
  double correction = 0.0;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (spans_[at(k)].active) correction = std::max(correction, solve_span(substep, k));
  }
  return correction;
}

void CableSystem::linearise(Substep& substep, RowList& rows) {
  turn_geodesics(substep);
  // Only `rattle` linearises before bodies have moved.
  const bool at_start = substep.time == substep.start.time;
  const std::size_t first = rows.size();
  // The speeds at the start can show that the substep fails, without any rounds.
  if (at_start && substep.resort != Resort::anything && !changing_links_.empty()) {
    substep.failed = turns_too_far(substep);
  }
  for (const CompiledCable& cable : cables_) {
    if (!cable.shares || cable.knotted || weighs_now(substep, cable)) {
      linearise_spans(substep, cable, rows);
      continue;
    }
    for_each_run(cable, [&](Run run) { linearise_run(substep, cable, run, rows); });
    if (at_start && cable.has_friction) remember_friction(substep, cable);
  }
  if (!knots_.empty()) Knots(*this).linearise(substep, rows);
  linearise_bearings(substep, first, rows);
  knows_start_ = knows_start_ || at_start;
}

void CableSystem::linearise_spans(Substep& substep, const CompiledCable& cable, RowList& rows) {
  if (weighs_now(substep, cable)) {
    return HeavySpans(*this).linearise(substep, cable, rows);
  }
  if (cable.has_sheaths) return Sheaths(*this).linearise(substep, cable, rows);
  if (cable.knotted) return Knots(*this).linearise_rest(substep, cable, rows);
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active) continue;
    if (is_affine_[at(k)] == 0) {
      linearise_run(substep, cable, {k, 1}, rows);
      continue;
    }
    const AffineSpan& affine = affine_[at(k)];
    Row& row = rows.append_copy(affine.row);
    row.value = affine.value(substep, references_[at(k)].rest_length);
    row.active = start_tensions_[at(k)] > 0.0;
  }
}

void CableSystem::finish_affine(const Substep& substep, int span, FeatureState& next) {
  const AffineSpan& affine = affine_[at(span)];
  const SpanTransport transport{AffineSpan::given(substep, affine.first),
                                AffineSpan::given(substep, affine.second)};
  if (affine.first.wheel >= 0 || affine.second.wheel >= 0)
    wind(span, transport, substep.at_rest, next);
  double& tension = next.reals[tension_index(span)];
  ends_[at(span)] = {tension, affine.length_now(substep)};
  tension = multipliers_[at(span)] / (substep.h * substep.h);
}

void CableSystem::finish_span(Substep& substep, int k, FeatureState& next) {
  const SpanSetup& setup = spans_[at(k)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  const bool grows = has_layers_ && layered(k);
  if (grows) layered_ = layered_span(substep, k);
  SpanTransport transport;
  if (grows) transport = layered_.transport;
  const SpanGeometry span =
      grows ? layered_.geometry
            : moved_span(substep, setup, first, second, references_[at(k)], transport);
  known_.keep(k, span);
  run_work_.rest_lengths[at(k)] =
      references_[at(k)].rest_length + transport.from_first + transport.from_second;
  if (!span.has_tangent) note_missing_tangent(substep, k);
  const double shared = hangs(substep, k) ? HeavySpans(*this).settle_tension(substep, k) : 0.0;
  const bool on_wheels = hangs(substep, k) && (first.wraps() || second.wraps());
  if (on_wheels) {
    transport = HeavySpans(*this).transport(substep, k, span, transport, next);
  } else if (cable.inverse_stiffness > 0.0) {
    transport = material_transport(cable, k, transport, span.length, next);
  }
  double& rest_length = next.reals[rest_length_index(k)];
  if (first.wraps() || second.wraps()) wind(k, transport, substep.at_rest, next);
  const auto feed_in = [&](int link, int end) {
    double& remainder = next.reals[remainder_index(k, end)];
    const double amount = fed_[at(k)][at(end)];
    const double moved = std::max(cable.quantised(amount + remainder), std::min(-rest_length, 0.0));
    remainder += amount - moved;
    rest_length += moved;
    next.reals[slip_index(link)] += moved;
  };
  if (first.feeds) feed_in(setup.first, 0);
  if (second.feeds) feed_in(setup.second, 1);
  double& tension = next.reals[tension_index(k)];
  ends_[at(k)] = {tension, span.length};
  tension = shared > 0.0 ? shared : multipliers_[at(k)] / (substep.h * substep.h);
  if (hangs(substep, k)) {
    tension = HeavySpans(*this).keep_tension(substep, k, span, rest_length, tension);
  }
}

void CableSystem::finish(Substep& substep, FeatureState& next) {
  // This check comes before any notes are taken.
  substep.failed =
      substep.resort != Resort::anything && !changing_links_.empty() && turns_too_far(substep);
  if (substep.failed) return;
  knows_lengths_ = true;
  turn_geodesics(substep);
  if (!knots_.empty()) Knots(*this).finish(substep, next);
  known_.expect(spans_.size());
  for (const CompiledCable& cable : cables_) {
    if (cable.has_friction) hold_tensions(substep, cable);
  }
  if (!stored_.empty()) stored_end_ = stored_;
  keep_end_strains(substep);
  for (cable_parts::HangingStart& hanging : hanging_) hanging.beyond = {};
  for (int k = 0; k < span_count(); ++k) {
    if (!spans_[at(k)].active) continue;
    if (is_affine_[at(k)] != 0) {
      finish_affine(substep, k, next);
    } else {
      finish_span(substep, k, next);
    }
  }
  check_arrivals(substep);
  if (weighs_ && !substep.at_rest) left_ = HeavySpans(*this).left_wheel(next);
  if (!stored_end_.empty()) keep_strains(next);
  for (std::size_t b = 0; b < bearings_.size(); ++b) {
    next.reals[bearing_index(static_cast<int>(b))] =
        multipliers_[spans_.size() + b] / (substep.h * substep.h);
  }
  if (driven_ || notes_.slides) record_stalls(substep, next);
  for (const CompiledCable& cable : cables_) {
    if (!cable.candidates.empty() || !cable.openings.empty()) note_leans(substep, cable);
    if (cable.shares) share_lengths(substep, cable, next);
    if (cable.has_sheaths) Sheaths(*this).finish(substep, cable, next);
  }
  if (!memories_.empty()) RopeMemories(*this).finish(substep, next);
  if (!laid_.empty()) FloorFriction(*this).finish(substep, next);
  if (substep.load_share == 1.0) count_numerical_damping(substep, next);
  keep_geodesics(next);
  // The machine is never in the intermediate poses of a search for equilibrium: no end may change
  // and no cable may break there (statics/equilibrium.cpp).
  if (course_changes_ && !substep.at_rest) cut(substep, next);
  if (!changing_links_.empty()) {
    known_.forget();
    if (has_layers_) refresh_ends(next, links_, spans_);
    if (has_layers_ && !substep.at_rest) DrumGrooves(*this).finish(substep, next);
    if (!substep.at_rest) change_ends(substep, next);
  }
  if (course_changes_) leave_and_touch(substep, next);
  known_.forget();
}

void CableSystem::count_numerical_damping(Substep& substep, const FeatureState& next) const {
  for (int k = 0; k < span_count(); ++k) {
    const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
    if (!spans_[at(k)].active || (cable.compliance == 0.0 && cable.inverse_stiffness == 0.0)) {
      continue;
    }
    const double rest_length = next.reals[rest_length_index(k)];
    const auto [before, length] = ends_[at(k)];
    if (cable.linear_density > 0.0) continue;
    substep.statistics.numerical_damping +=
        numerical_damping(cable, {before, next.reals[tension_index(k)]}, length - rest_length,
                          rest_length, RopeMemories::of(*this, next, k), substep.h);
  }
}

// Implicit Euler on a spring: with the change dx of its length, the change dv of the relative
// velocity and the mass m of both ends, energy falls by dx^2 / 2a + m dv^2 / 2 per substep. In a
// vibration both parts are equal in the mean. Without damping dx = a dT; with damping b the row
// requires a T = x + a b dx / h. A slack span has no spring, and tensions are not known at time 0:
// a tension of 0 stands for both.
double CableSystem::numerical_damping(const CompiledCable& cable, std::array<double, 2> tensions,
                                      double stretch, double rest_length, double remembered,
                                      double h) const {
  // A damping below this fraction of the spring's force is lost in the rounding of the stretch.
  constexpr double negligible = 1e-6;
  double compliance = compliance_of(cable, rest_length);
  if (cable.memory && rest_length > 0.0) {
    compliance = rest_length / cable.memory->stiffness(stretch / rest_length, remembered);
  } else if (cable.law && rest_length > 0.0) {
    compliance = rest_length / cable.law->stiffness(stretch / rest_length);
  }
  // A span of a material without rest length cannot vibrate.
  if (!(compliance > 0.0)) return 0.0;
  const double share = cable.damper(rest_length) * compliance / h;
  const auto [before, now] = tensions;
  double change = before > 0.0 ? compliance * (now - before) : 0.0;
  if (share > negligible) {
    if (now == 0.0) return 0.0;
    const double before_it = stretch - (compliance * now - stretch) / share;
    change = std::max(stretch, 0.0) - std::max(before_it, 0.0);
  }
  return change * change / compliance;
}

void CableSystem::mark_notes(NoteMark mark) {
  Notes& notes = marked_notes_[static_cast<std::size_t>(mark)];
  notes.events = events_.size();
  if (notes.edition == notes_.edition) return;
  const std::size_t events = notes.events;
  notes = notes_;
  notes.events = events;
}

void CableSystem::return_to(NoteMark mark) {
  Notes& notes = marked_notes_[static_cast<std::size_t>(mark)];
  const std::uint64_t edition = notes_.edition;
  notes_ = notes;
  events_.resize(notes.events);
  // An edition must not return to an old number: the other mark may hold the notes that were just
  // discarded.
  notes.edition = notes_.edition = edition + 1;
}

SpanGeometry CableSystem::geometry_of(const Substep& substep, int span) const {
  if (const SpanGeometry* known = known_.find(span)) return *known;
  const SpanSetup& setup = spans_[at(span)];
  return span_geometry(substep, setup, links_[at(setup.first)], links_[at(setup.second)]);
}

void CableSystem::find_geometry(const Substep& now, const FeatureState& own,
                                Geometry& geometry) const {
  geometry.links = links_;
  geometry.spans = spans_;
  if (course_changes_ || !changing_links_.empty() || has_cut(own)) {
    refresh(now.bodies, own, geometry.links, geometry.spans);
  }
  settle_geodesics(now, geometry.links, geometry.spans);
}

}  // namespace sheave
