// Machines of which all spans are affine, in flat arrays: engine/solvers/affine_motion.h.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/dynamics/affine_bodies.h"
#include "engine/index.h"
#include "engine/solvers/affine_rows.h"

namespace sheave {

MovingSpan CableSystem::moving_span(const AffineBodies& bodies, const State& initial,
                                    const AffineSpan& affine, int index) const {
  const SpanSetup& setup = spans_[at(index)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  MovingSpan span;
  span.length = affine.length;
  span.shortest = AffineSpan::shortest * bodies.set().scale();
  span.elastic = cable.compliance > 0.0;
  span.cable = setup.cable;
  span.breaking_tension = cable.breaking_tension;
  span.cut_time = cable.cut_time;
  span.quantum = cable.quantum;
  span.inverse_quantum = 1.0 / cable.quantum;
  for (const std::size_t e : {0U, 1U}) {
    const AffineSpan::End& from = e == 0 ? affine.first : affine.second;
    MovingSpan::End& end = span.ends[e];
    end.link = e == 0 ? setup.first : setup.second;
    const LinkGeometry& link = links_[at(end.link)];
    end.wraps = link.wraps();
    end.runs_out = runs_out(cable, end.link);
    end.bounded = link.lifts || link.hybrid || end.runs_out;
    const double sense = e == 0 ? -1.0 : 1.0;
    if (from.slider >= 0) {
      end.slider = bodies.number_of(from.slider);
      const Vector3& axis = bodies.axis(end.slider);
      end.along = sense * dot(affine.direction, axis);
      // Of the place itself only what the number counts moves.
      const Vector3& place = initial.bodies[at(from.slider)].position;
      span.length += sense * dot(affine.direction, place) - end.along * dot(axis, place);
      span.slides = true;
    }
    if (from.wheel >= 0) {
      end.wheel = bodies.number_of(from.wheel);
      end.given = dot(from.turn, bodies.axis(end.wheel));
      span.driven = span.driven || bodies.set()[from.wheel].prescribed();
    }
  }
  return span;
}

bool CableSystem::append_affine(const AffineBodies& bodies, AffineRows& rows) {
  moving_spans_.clear();
  bounded_links_.clear();
  if (has_layers_) return false;
  for (const CompiledCable& cable : cables_) {
    if (!cable.candidates.empty() || cable.may_lock) return false;
  }
  // The course is that of time 0, and so are the ends: in any other, integers of the state differ.
  affine_bodies_ = &bodies.set();
  if (course_changes_) follow_course(bodies.set(), initial_);
  const std::vector<AffineSpan> affine = affine_spans(bodies.set(), true);
  const bool all = std::all_of(affine.begin(), affine.end(),
                               [](const AffineSpan& span) { return span.possible; });
  if (!all) return false;
  const State initial = bodies.set().initial_state();
  std::vector<char> bounded(links_.size(), 0);
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const MovingSpan& span =
        moving_spans_.emplace_back(moving_span(bodies, initial, affine[k], static_cast<int>(k)));
    const CompiledCable& cable = cables_[at(span.cable)];
    rows.add_row(cable.compliance, cable.damping, static_cast<int>(k));
    for (const MovingSpan::End& end : span.ends) {
      rows.add_term(end.slider, -end.along);
      rows.add_term(end.wheel, end.given);
      if (end.bounded) bounded[at(end.link)] = 1;
    }
  }
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    if (bounded[i] != 0) bounded_links_.push_back(static_cast<int>(i));
  }
  return true;
}

bool CableSystem::feeds(const MovingSpan& span, const FeatureState& state,
                        std::span<const double> motion, double rest_length) const {
  for (const MovingSpan::End& end : span.ends) {
    // Of what is driven; of others it does not matter.
    const double most = std::abs(end.given * motion[at(end.wheel)]);
    if (rest_length < 2.0 * most) return false;
    if (end.runs_out && state.reals[stored_length_index(end.link)] < 2.0 * most) return false;
  }
  return true;
}

bool CableSystem::begin_affine(const AffineSubstep& substep, const FeatureState& state,
                               std::span<double> values, std::span<char> active) {
  if (state.integers != initial_.integers) return false;
  if (controlled_) follow_controls(Controls{});
  if (course_changes_ && !follows(state)) follow_course(*affine_bodies_, state);
  const double* const rest_lengths = &state.reals[rest_length_index(0)];
  const double* const remainders = &state.reals[remainder_index(0, 0)];
  const double* const tensions = &state.reals[tension_index(0)];
  const std::size_t count = moving_spans_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const MovingSpan& span = moving_spans_[k];
    active[k] = tensions[k] > 0.0 ? 1 : 0;
    double length = span.length;
    if (span.slides) {
      double speed = 0.0;
      for (const MovingSpan::End& end : span.ends) {
        length += end.along * substep.places[at(end.slider)];
        speed += std::abs(end.along * substep.speeds[at(end.slider)]);
      }
      if (!(length > AffineSpan::margin * substep.h * speed + span.shortest)) return false;
    }
    if (span.driven && !feeds(span, state, substep.motion, rest_lengths[k])) return false;
    values[k] = rest_lengths[k] + (remainders[2 * k] + remainders[2 * k + 1]) - length;
  }
  return true;
}

void CableSystem::end_slides_and_stalls() {
  if (notes_.slides) {
    ++notes_.edition;
    for (Stall& slide : notes_.slides_at) slide.now = false;
    notes_.slides = false;
  }
  if (!driven_) return;
  for (const CompiledCable& cable : cables_) {
    for (const int link : cable.driven_links) {
      Stall& stall = notes_.stalls[at(link)];
      if (stall.now) ++notes_.edition;
      stall.now = false;
    }
  }
}

bool CableSystem::finish_affine(const AffineSubstep& substep, FeatureState& next) {
  double* const rest_lengths = &next.reals[rest_length_index(0)];
  double* const remainders = &next.reals[remainder_index(0, 0)];
  double* const tensions = &next.reals[tension_index(0)];
  double* const stored = next.reals.data() + stored_length_index(0);
  const double inverse_square = 1.0 / (substep.h * substep.h);
  const double cut_before = substep.end_time + 0.5 * substep.h;
  const std::size_t count = moving_spans_.size();
  const double* const motion = substep.motion.data();
  const double* const places = substep.places.data();
  bool holds = true;
  double damped = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const MovingSpan& span = moving_spans_[k];
    double rest_length = rest_lengths[k];
    double length = span.length;
    if (span.slides) {
      for (const MovingSpan::End& end : span.ends) {
        length += end.along * (places[end.slider] + motion[end.slider]);
      }
    }
    for (std::size_t e = 0; e < 2; ++e) {
      const MovingSpan::End& end = span.ends[e];
      if (!end.wraps) continue;
      const double amount = end.given * motion[end.wheel];
      const double remainder = remainders[2 * k + e];
      const double moved =
          CompiledCable::quantised(amount + remainder, span.quantum, span.inverse_quantum);
      remainders[2 * k + e] = remainder + (amount - moved);
      rest_length += moved;
      stored[end.link] -= moved;
    }
    rest_lengths[k] = rest_length;
    const double before = tensions[k];
    const double tension = substep.multipliers[k] * inverse_square;
    ends_[k] = {before, length};
    tensions[k] = tension;
    holds &= rest_length >= 0.0;
    holds &= tension <= span.breaking_tension;
    holds &= cut_before <= span.cut_time;
    if (!span.elastic || !substep.dissipates) continue;
    damped += numerical_damping(cables_[at(span.cable)], {before, tension}, length - rest_length,
                                rest_length, substep.h);
  }
  for (const int link : bounded_links_) holds &= stored[link] >= 0.0;
  if (!holds) return false;
  substep.statistics->numerical_damping += damped;
  knows_lengths_ = true;
  end_slides_and_stalls();
  return true;
}

}  // namespace sheave
