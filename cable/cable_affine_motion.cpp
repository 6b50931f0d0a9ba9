// Machines of which all spans are affine, in flat arrays: engine/solvers/affine_motion.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "engine/dynamics/affine_bodies.h"
#include "engine/index.h"
#include "engine/solvers/affine_rows.h"

namespace sheave {

void MovingSpans::find_link_ends(std::size_t links) {
  const std::size_t none = 2 * spans.size();
  for (std::vector<int>& ends : winding.link_ends) ends.assign(links, static_cast<int>(none));
  auto& [first, second] = winding.link_ends;
  // A link has at most two: those of the spans before it and after it.
  for (std::size_t e = 0; e < none; ++e) {
    const auto link = at(spans[e / 2].ends[e % 2].link);
    (at(first[link]) == none ? first : second)[link] = static_cast<int>(e);
  }
  moved.assign(none + 1, 0.0);
}

MovingSpan CableSystem::moving_span(const AffineBodies& bodies, const State& initial,
                                    const AffineSpan& affine, int index) const {
  const SpanSetup& setup = spans_[at(index)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  MovingSpan span;
  span.length = affine.length;
  span.cable = setup.cable;
  for (const std::size_t e : {0U, 1U}) {
    const AffineSpan::End& from = e == 0 ? affine.first : affine.second;
    MovingSpan::End& end = span.ends[e];
    end.link = e == 0 ? setup.first : setup.second;
    const LinkGeometry& link = links_[at(end.link)];
    end.runs_out = runs_out(cable, end.link);
    end.bounded = link.lifts || link.hybrid || end.runs_out;
    const double sense = e == 0 ? -1.0 : 1.0;
    if (from.slider >= 0) {
      end.slider = bodies.number_of(from.slider);
      const Vector3& axis = bodies.axis(end.slider);
      end.along = sense * dot(affine.direction, axis);
      // The number of the slider contains the component of its position along its axis; the rest of
      // the position is constant.
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
  moving_ = {};
  if (has_layers_ || !bearings_.empty()) return false;
  for (const CompiledCable& cable : cables_) {
    if (!cable.candidates.empty() || cable.may_lock) return false;
  }
  // The course is that of time 0, and so are the ends: in any other, integers of the state differ.
  moving_.bodies = &bodies.set();
  if (course_changes_) follow_course(bodies.set(), initial_);
  const std::vector<AffineSpan> affine = affine_spans(bodies.set(), true);
  const bool all = std::all_of(affine.begin(), affine.end(),
                               [](const AffineSpan& span) { return span.possible; });
  if (!all) return false;
  const State initial = bodies.set().initial_state();
  moving_.winding.least_stored.assign(links_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const MovingSpan& span =
        moving_.spans.emplace_back(moving_span(bodies, initial, affine[k], static_cast<int>(k)));
    const CompiledCable& cable = cables_[at(span.cable)];
    rows.add_row(cable.compliance, cable.damping, static_cast<int>(k));
    const auto& [first, second] = span.ends;
    moving_.winding.lengths.push_back(span.length);
    for (const std::size_t e : {0U, 1U}) {
      moving_.winding.wheels[e].push_back(span.ends[e].wheel);
      moving_.winding.given[e].push_back(span.ends[e].given);
    }
    if (span.slides) {
      moving_.sliding.push_back({static_cast<int>(k),
                                 {first.slider, second.slider},
                                 {first.along, second.along},
                                 span.length,
                                 AffineSpan::shortest * bodies.set().scale()});
    }
    moving_.elastic = moving_.elastic || cable.compliance > 0.0;
    if (span.driven) moving_.driven.push_back(static_cast<int>(k));
    for (const MovingSpan::End& end : span.ends) {
      rows.add_term(end.slider, -end.along);
      rows.add_term(end.wheel, end.given);
      if (end.bounded) moving_.winding.least_stored[at(end.link)] = 0.0;
    }
  }
  moving_.find_link_ends(links_.size());
  return true;
}

bool CableSystem::feeds(const MovingSpan& span, const FeatureState& state,
                        std::span<const double> motion, double rest_length) const {
  for (const MovingSpan::End& end : span.ends) {
    // `motion` is exact for driven wheels. The motion of other wheels does not matter here.
    const double most = std::abs(end.given * motion[at(end.wheel)]);
    if (rest_length < 2.0 * most) return false;
    if (end.runs_out && state.reals[stored_length_index(end.link)] < 2.0 * most) return false;
  }
  return true;
}

bool CableSystem::begin_affine(const AffineSubstep& substep, const FeatureState& state,
                               std::span<double> values, std::span<char> active) {
  if (substep.fresh && state.integers != initial_.integers) return false;
  if (substep.first && controlled_) follow_controls(Controls{});
  if (substep.first && course_changes_ && !follows(state)) follow_course(*moving_.bodies, state);
  const double* const rest_lengths = &state.reals[rest_length_index(0)];
  const double* const remainders = &state.reals[remainder_index(0, 0)];
  const double* const tensions = &state.reals[tension_index(0)];
  find_active(moving_.spans.size(), tensions, active.data());
  find_values(moving_.winding, rest_lengths, remainders, values.data());
  const double* const places = substep.places.data();
  const double* const speeds = substep.speeds.data();
  for (const FlatSlide& slide : moving_.sliding) {
    const auto k = static_cast<std::size_t>(slide.span);
    const auto [a, b] = slide.sliders;
    const auto [along_a, along_b] = slide.along;
    const double length = slide.length + along_a * places[a] + along_b * places[b];
    const double speed = std::abs(along_a * speeds[a]) + std::abs(along_b * speeds[b]);
    if (!(length > AffineSpan::margin * substep.h * speed + slide.shortest)) return false;
    values[k] = rest_lengths[k] + (remainders[2 * k] + remainders[2 * k + 1]) - length;
  }
  return std::all_of(moving_.driven.begin(), moving_.driven.end(), [&](int k) {
    return feeds(moving_.spans[at(k)], state, substep.motion, rest_lengths[at(k)]);
  });
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

bool CableSystem::finish_affine_cable(const CompiledCable& cable, const AffineSubstep& substep,
                                      const FeatureState& now, FeatureState& next) {
  const auto first = at(cable.first_span);
  const auto count = at(cable.span_count);
  const WindingCable wound{first, first + count, cable.quantum};
  const auto [shortest, most_moved] =
      wind_cable(moving_.winding, wound, substep.motion.data(), &now.reals[rest_length_index(0)],
                 &now.reals[remainder_index(0, 0)], &next.reals[rest_length_index(0)],
                 &next.reals[remainder_index(0, 0)], moving_.moved.data());
  const double strongest =
      find_tensions(count, 1.0 / (substep.h * substep.h), substep.multipliers.data() + first,
                    &next.reals[tension_index(0)] + first);
  return shortest >= 0.0 && strongest <= cable.breaking_tension &&
         CompiledCable::is_small(most_moved, 1.0 / cable.quantum);
}

bool CableSystem::finish_affine(const AffineSubstep& substep, const FeatureState& now,
                                FeatureState& next) {
  for (const CompiledCable& cable : cables_) {
    if (!finish_affine_cable(cable, substep, now, next)) return false;
  }
  if (!take_from_links(moving_.winding, &now.reals[stored_length_index(0)], moving_.moved.data(),
                       &next.reals[stored_length_index(0)])) {
    return false;
  }
  // Spans that do not slide keep their lengths.
  for (std::size_t k = 0; k < ends_.size() && (substep.fresh || !knows_lengths_); ++k) {
    ends_[k][1] = moving_.winding.lengths[k];
  }
  const double* const places = substep.places.data();
  const double* const motion = substep.motion.data();
  for (const FlatSlide& slide : moving_.sliding) {
    const auto [a, b] = slide.sliders;
    const double at_a = slide.along[0] * (places[a] + motion[a]);
    ends_[at(slide.span)][1] = slide.length + at_a + slide.along[1] * (places[b] + motion[b]);
  }
  if (substep.dissipates && moving_.elastic)
    substep.statistics->numerical_damping += affine_damping(substep, now, next);
  knows_lengths_ = true;
  end_slides_and_stalls();
  return true;
}

// Energy that implicit Euler takes from the vibration of elastic cables [J].
double CableSystem::affine_damping(const AffineSubstep& substep, const FeatureState& now,
                                   const FeatureState& next) const {
  double damped = 0.0;
  for (const CompiledCable& cable : cables_) {
    if (cable.compliance == 0.0) continue;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const double rest_length = next.reals[rest_length_index(k)];
      damped +=
          numerical_damping(cable, {now.reals[tension_index(k)], next.reals[tension_index(k)]},
                            ends_[at(k)][1] - rest_length, rest_length, 0.0, substep.h);
    }
  }
  return damped;
}

}  // namespace sheave
