// Spans that share a tension.
//
// Cable passes freely through pinholes without friction and over massless wheels. Cable slides over
// a link with friction once the ratio of the tensions on both sides reaches e^(m a)
// (Euler-Eytelwein; a: wrap angle). A run is a maximal sequence of spans joined by such links.
// Cable that moves between spans of a run moves no body, so only the sum of their rest lengths
// counts, and one multiplier l determines all tensions, T_i = k_i l / h^2, where k_i is the product
// of the e^(+-m a) up to span i (1 without friction). One step of XPBD for the run, with C_i = rest
// length - length:
//
//   sum_i (C_i + k_i a~_i l) = 0,   motion  x += W sum_i grad C_i d(k_i l)
//   =>  l' = (-sum C_i + sum_j w_j l_j) / sum_j k_j (w_j + a~_j),
//       w_j = (sum_i grad C_i) W grad C_j^T
//
// where l_j is the present multiplier of span j. Dampers: cable/cable_damping.cpp. Without friction
// this is one ordinary row, so any number of pinholes is solved exactly in one visit. (Algorithm 1
// of the paper instead moves rest length across each pinhole so that the ratios of length to rest
// length become equal; as printed it swaps the two excesses, see tests/physics/pinhole_test.cpp.)
//
// The sweeps determine whether a link with friction sticks or slides: cable/cable_friction.cpp.
//
// A span of constant compliance c can be stretched by its whole length. Such a span has no cable
// left to give, so its tension can no longer follow that of the next span. The tension is then its
// length / c, and the link holds until the other side pulls less.
//
// At the end of the substep rest length is moved within each run so that every span has its
// tension. The cable that passed a link is its slip, or turns the massless wheel. A slack run is
// not changed, except that a span that has become longer than its rest length takes the missing
// length from the nearest spans that have some to spare.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/heavy_spans.h"
#include "cable/massless_wheels.h"
#include "cable/slack_run.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Replaces the lengths of spans [m] by the rest lengths with which their springs and dampers have
/// forces in the ratios of `tensions` [N]. The tensions themselves do not fit: those of `rattle`
/// are at the middle of the substep, and half of that during its rounds. Therefore all strains are
/// those of s times the tensions, with the factor s for which the sum of `rest_lengths` is kept; no
/// strain is below 0. False if the cable has friction and no span is stretched at the end: tensions
/// existed in the mean, but slack cable does not slide.
bool shorten_by_strain(const CompiledCable& cable, const std::vector<double>& rest_lengths,
                       const std::vector<double>& tensions,
                       const std::vector<cable_parts::SpanDamping>& dampings,
                       std::vector<double>& lengths) {
  if (cable.is_rigid()) return true;
  double excess = 0.0;
  double whole = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    excess += lengths[i] - rest_lengths[i];
    whole += lengths[i];
  }
  if (!(excess > 0.0)) return !cable.has_friction;
  const auto shortened = [&](std::size_t i, double s) {
    return cable.inverse_stiffness > 0.0
               ? lengths[i] / (1.0 + dampings[i].end(s * tensions[i] * cable.inverse_stiffness))
               : std::max(lengths[i] - dampings[i].end(s * tensions[i] * cable.compliance), 0.0);
  };
  // The sum is convex, so Newton's method approaches s from below.
  double s = 0.0;
  for (int round = 0; round < 20; ++round) {
    double left = excess;
    double slope = 0.0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const double now = shortened(i, s);
      left -= lengths[i] - now;
      if (cable.inverse_stiffness > 0.0) {
        const double yield = tensions[i] * cable.inverse_stiffness;
        slope += now * yield / (1.0 + dampings[i].share) / (1.0 + dampings[i].end(s * yield));
      } else if (now > 0.0) {
        slope += tensions[i] * cable.compliance / (1.0 + dampings[i].share);
      }
    }
    if (!(left > 1e-15 * whole) || !(slope > 0.0)) break;
    s += left / slope;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = shortened(i, s);
  return true;
}

/// Replaces the lengths of spans [m] by the rest lengths with which springs without tension lose
/// their stretch against their dampers.
void shorten_without_pull(const CompiledCable& cable,
                          const std::vector<cable_parts::SpanDamping>& dampings,
                          std::vector<double>& lengths) {
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double left = dampings[i].end(0.0);
    lengths[i] = cable.inverse_stiffness > 0.0 ? lengths[i] / (1.0 + left)
                                               : std::max(lengths[i] - left, 0.0);
  }
}

}  // namespace

bool CableSystem::shared(int link) const {
  return (links_[at(link)].frictionless() && held_[at(link)] == 0) || slip_[at(link)] != 0;
}

void CableSystem::hold_drained(const CompiledCable& cable, const FeatureState& start) {
  std::fill_n(held_.begin() + cable.first_link, cable.link_count, 0);
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active || references_[at(k)].rest_length > cable.quantum) continue;
    const double tension = start.reals[tension_index(k)];
    const auto hold = [&](int link, int other_span) {
      const LinkGeometry& geometry = links_[at(link)];
      if (other_span < 0 || geometry.massless || !geometry.frictionless()) return;
      if (start.reals[tension_index(other_span)] >= tension) held_[at(link)] = 1;
    };
    const int first = spans_[at(k)].first;
    const int second = spans_[at(k)].second;
    hold(first, span_before(cable, first, spans_));
    const bool ends = !cable.closed && second == cable.last_listed_link();
    hold(second, ends ? -1 : span_after(cable, second));
  }
}

double CableSystem::sweep_runs(Substep& substep, int cable_index) {
  const CompiledCable& cable = cables_[at(cable_index)];
  double correction = 0.0;
  for_each_run(cable, [&](Run run) {
    const double corrected =
        run.count == 1 ? solve_span(substep, run.first) : solve_run(substep, cable, run);
    correction = std::max(correction, corrected);
  });
  const int sweeps = ++sweeps_[at(cable_index)];
  if (cable.has_friction && sweeps < substep.iterations) update_slip(substep, cable);
  return correction;
}

double CableSystem::evaluate_run(const Substep& substep, const CompiledCable& cable, Run run) {
  double heaviest = 0.0;
  const bool means = by_means(run);
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    Row& row = run_work_.rows[at(i)];
    row.clear();
    StretchedSpan& stretched = run_work_.stretched[at(i)];
    run_work_.spans[at(i)] = evaluate(substep, k, row, &stretched);
    stretched.damping = damping_of(substep, cable, means, k, row);
    damp_row(cable, nullptr, stretched.damping, row);
    for (const RowTerm& term : row.active_terms()) {
      RowTerm& sum = run_work_.gradient[at(term.body)];
      sum.linear += term.linear;
      sum.angular += term.angular;
    }
    double& weight = run_work_.weights[at(i)];
    weight = 0.0;
    if (i == 0) continue;
    const int link = spans_[at(k)].first;
    weight = run_work_.weights[at(i - 1)];
    if (!links_[at(link)].frictionless()) {
      weight += slip_[at(link)] * friction_exponent(substep, link, run_work_.spans[at(i - 1)],
                                                    run_work_.spans[at(i)]);
    }
    heaviest = std::max(heaviest, weight);
  }
  return heaviest;
}

double CableSystem::weigh_run(const Substep& substep, const CompiledCable& cable, Run run,
                              double heaviest) {
  const auto count = at(run.count);
  for (std::size_t i = 0; i < count; ++i) {
    run_work_.weights[i] = portable::exp(run_work_.weights[i] - heaviest);
  }
  const std::span<Row> rows = std::span<Row>(run_work_.rows).first(count);
  const std::span<const double> weights = std::span(run_work_.weights).first(count);
  if (strains_runs(cable)) strain_rows(substep, cable, run, weights, rows);
  double sum = 0.0;
  for (Row& row : rows) {
    if (cable.is_damped()) {
      const double own = row.compliance * row.damping / substep.h;
      row.value -= own / (1.0 + own) * row.past;
      row.compliance /= 1.0 + own;
    }
    sum += row.value;
  }
  return sum;
}

double CableSystem::solve_run(Substep& substep, const CompiledCable& cable, Run run) {
  const auto count = at(run.count);
  run_work_.rows.resize(std::max(run_work_.rows.size(), count));
  run_work_.spans.resize(std::max(run_work_.spans.size(), count));
  run_work_.stretched.resize(count);
  run_work_.weights.resize(std::max(run_work_.weights.size(), count));
  run_work_.gradient.resize(substep.moving.size());
  const double inverse_square = 1.0 / (substep.h * substep.h);

  const double heaviest = evaluate_run(substep, cable, run);
  double numerator = -weigh_run(substep, cable, run, heaviest);
  double denominator = 0.0;
  double parts = 0.0;  // the denominator without the terms that cancel between spans
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    const Row& row = run_work_.rows[at(i)];
    const double weight = run_work_.weights[at(i)];
    double yield = 0.0;  // w_j
    for (const RowTerm& term : row.active_terms()) {
      const MovingBody& body = substep.moving[at(term.body)];
      const RowTerm& sum = run_work_.gradient[at(term.body)];
      if (body.translates) {
        const Vector3 moved = times(body.inverse_mass, term.linear);
        yield += dot(sum.linear, moved);
        parts += weight * dot(term.linear, moved);
      }
      if (body.rotates) {
        const Vector3 moved = times(body.inverse_inertia, term.angular);
        yield += dot(sum.angular, moved);
        parts += weight * dot(term.angular, moved);
      }
    }
    numerator += yield * multipliers_[at(k)];
    denominator += weight * (yield + row.compliance * inverse_square);
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (const RowTerm& term : run_work_.rows[i].active_terms())
      run_work_.gradient[at(term.body)] = {};
  }
  // If the only movable bodies are wheels over which cable slides, w is rounding error and must not
  // count as an inverse mass.
  constexpr double cancelled = 64.0 * std::numeric_limits<double>::epsilon();
  const bool idle = !(denominator > cancelled * parts);
  const bool acts = idle && cable.has_friction && turns_wheel(substep, cable, run) &&
                    is_open(substep, cable, run);
  if (idle && !acts) return 0.0;
  if (acts) find_given(substep, cable);
  const double multiplier =
      acts ? substep.load_share * portable::exp(given_.pulls[at(run.first)] + heaviest)
           : std::max(numerator / denominator, 0.0);
  double largest = 0.0;
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    const double increment = run_work_.weights[at(i)] * multiplier - multipliers_[at(k)];
    if (increment == 0.0) continue;
    multipliers_[at(k)] += increment;
    RowResponse response;
    respond(run_work_.rows[at(i)], substep.moving, response);
    apply_multiplier(run_work_.rows[at(i)], response, increment, substep.moving);
    largest = std::max(largest, std::abs(increment));
  }
  return largest * (acts ? parts : denominator);
}

void CableSystem::linearise_run(Substep& substep, const CompiledCable& cable, Run run,
                                RowList& rows) {
  const std::size_t start = rows.size();
  // The logarithms of the weights, and their maximum.
  RunWeights weights;
  RunWeights heaviest;
  SpanGeometry last;
  // A multiplier has no effect if no body can move: the links around the run determine its
  // tensions.
  const bool open = cable.has_friction && is_open(substep, cable, run);
  // The strains at the start of the substep need not have been shared.
  const bool at_start = substep.time == substep.start.time;
  const bool stretches = run.count > 1 && strains_runs(cable);
  const bool strains = stretches && !at_start;
  if (stretches) run_work_.stretched.resize(at(run.count));
  const bool means = strains && by_means(run);
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    Row& row = rows.emplace_back();
    const SpanGeometry span =
        evaluate(substep, k, row, stretches ? &run_work_.stretched[at(i)] : nullptr);
    if (at_start) start_without_feed(k, row);
    row.index = k;
    row.idle = open;
    row.judged = row.judged || links_[at(spans_[at(k)].first)].rubs() ||
                 links_[at(spans_[at(k)].second)].rubs();
    if (open) row.upper = 0.0;
    row.active = start_tensions_[at(k)] > 0.0;
    row.tied = i > 0;
    if (at_start) start_values_[at(k)] = {row.value, row.compliance};
    if ((cable.is_damped() || means) && run.count > 1 && !at_start) {
      const SpanDamping damping = damping_of(substep, cable, means, k, row);
      if (strains) run_work_.stretched[at(i)].damping = damping;
      damp_row(cable, nullptr, damping, row);
    }
    const int link = spans_[at(k)].first;
    if (row.tied && !links_[at(link)].frictionless()) {
      const double exponent = friction_exponent(substep, link, last, span);
      const double before = knows_start_ ? start_exponents_[at(link)] : exponent;
      const double early = cable_parts::early_exponent(cable.is_rigid(), before, exponent);
      weights.now += slip_[at(link)] * exponent;
      weights.start += slip_[at(link)] * early;
      heaviest.now = std::max(heaviest.now, weights.now);
      heaviest.start = std::max(heaviest.start, weights.start);
    }
    row.weight = weights.now;
    row.start_weight = weights.start;
    if (cable.has_friction) last = start_spans_[at(k)] = span;
  }
  const bool acts = open && turns_wheel(substep, cable, run);
  const auto relative = [](double weight, double most) {
    return most == 0.0 && weight == 0.0 ? 1.0 : portable::exp(weight - most);
  };
  for (std::size_t i = start; i < rows.size(); ++i) {
    rows[i].weight = relative(rows[i].weight, heaviest.now);
    rows[i].start_weight = relative(rows[i].start_weight, heaviest.start);
  }
  if (acts) give(substep, cable, heaviest, rows[start]);
  if (stretches && rows.size() > start) {
    Row* const first = &*rows.begin() + start;
    strain_shared(substep, cable, run, {first, rows.size() - start});
  }
}

void CableSystem::strain_shared(const Substep& substep, const CompiledCable& cable, Run run,
                                std::span<Row> rows) {
  run_work_.weights.clear();
  for (const Row& row : rows) run_work_.weights.push_back(row.start_weight);
  if (substep.time == substep.start.time) {
    // Spans have their own strains at the start, and so does the cable stored on links. The strains
    // of damped spans do not follow from those of the arcs; their runs begin at Row::past, and a span
    // whose link holds from now on begins at its own strain.
    if (cable.is_damped()) return;
    find_arcs(substep, cable, run, run_work_.weights);
    add_arcs(substep, cable, run_work_.weights, 0.0, rows);
    return;
  }
  strain_rows(substep, cable, run, run_work_.weights, rows);
}

bool CableSystem::shorten_run(const Substep& substep, const CompiledCable& cable, Run run) {
  run_work_.tensions.clear();
  run_work_.dampings.clear();
  const double inverse_square = 1.0 / (substep.h * substep.h);
  bool taut = false;
  Row row;
  const bool means = by_means(run);
  const bool follows = cable.is_rigid() && !cable.frozen && !means;  // lengths are then known
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    run_work_.tensions.push_back(multipliers_[at(k)] * inverse_square);
    taut = taut || run_work_.tensions.back() > 0.0;
    if (const SpanGeometry* geometry = follows ? known_.find(k) : nullptr) {
      run_work_.spare.push_back(run_work_.rest_lengths[at(k)]);
      run_work_.lengths.push_back(geometry->length);
      run_work_.dampings.emplace_back();
      continue;
    }
    row.clear();
    const SpanGeometry span = evaluate(substep, k, row);
    run_work_.spare.push_back(rest_length_of(cable, row, span.length));
    run_work_.lengths.push_back(span.length);
    run_work_.dampings.push_back(damping_of(substep, cable, means, k, row));
  }
  if (taut) {
    taut = shorten_by_strain(cable, run_work_.spare, run_work_.tensions, run_work_.dampings,
                             run_work_.lengths);
  } else if (cable.is_damped()) {
    shorten_without_pull(cable, run_work_.dampings, run_work_.lengths);
  }
  return taut;
}

bool CableSystem::stretch_run(const Substep& substep, const CompiledCable& cable, Run run) {
  const std::optional<double> strain = end_strain(substep, cable, run);
  bool taut = false;
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    taut = taut || multipliers_[at(k)] > 0.0;
    StretchedSpan& span = run_work_.stretched[at(i)];
    const double own = span.damping.end(run_work_.weights[at(i)] * strain.value_or(0.0));
    const double slack = cable.memory ? cable.memory->slack(span.memory) : 0.0;
    run_work_.lengths.push_back(span.length / (1.0 + std::max(own, slack)));
    run_work_.spare.push_back(strain
                                  ? span.rest_length_at(own)
                                  : rest_length_under(span.value, span.spring_length, span.length));
    span.end_strain =
        strain ? std::max(own, 0.0) : strain_of(cable, span.length, run_work_.spare.back());
  }
  return taut && !(cable.has_friction && strain == 0.0);
}

const std::vector<double>& CableSystem::run_spare(const Substep& substep,
                                                  const CompiledCable& cable, Run run) {
  std::vector<double>& spare = run_work_.spare;
  std::vector<double>& lengths = run_work_.lengths;
  spare.clear();
  lengths.clear();
  if (!strains_runs(cable)) run_work_.clear_arcs(at(run.count));
  const bool taut =
      strains_runs(cable) ? stretch_run(substep, cable, run) : shorten_run(substep, cable, run);
  double total = 0.0;
  for (const SlidingArc& arc : run_work_.arcs) total -= arc.gain;
  if (taut) total -= MasslessWheels::kept(*this, run_work_.weights, run_work_.strain).length;
  double length = 0.0;
  for (std::size_t i = 0; i < spare.size(); ++i) {
    spare[i] -= lengths[i];
    total += spare[i];
    length += lengths[i];
  }
  if (!taut) {
    std::vector<double>& kept = lengths;
    count_arcs(1.0);
    kept = spare;
    pull_slack(kept);
    // The rope that wheels keep is a strain of the rope that passes, and so is the rest of each round.
    for (int round = 0; run_work_.has_wheels && round < 4; ++round) {
      MasslessWheels(*this).keep_slack(spare, kept);
      pull_slack(kept);
    }
    for (std::size_t i = 0; i < spare.size(); ++i) spare[i] -= kept[i];
    count_arcs(-1.0);
    return spare;
  }
  // The solver's residual is spread evenly over the spans that the solver can change.
  if (cable.has_friction) {
    length = 0.0;
    for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
      if (is_open(substep, cable, {k, 1})) lengths[at(i)] = 0.0;
      length += lengths[at(i)];
    }
  }
  for (std::size_t i = 0; i < spare.size() && length > 0.0; ++i) {
    spare[i] -= total * lengths[i] / length;
  }
  return spare;
}

void CableSystem::share_lengths(Substep& substep, const CompiledCable& cable, FeatureState& next) {
  std::vector<char>& rests = run_work_.rests;
  rests.assign(at(cable.link_count), 0);
  for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
    if (links_[at(i)].wheel >= 0) MasslessWheels::stop(substep, links_[at(i)].wheel);
  }
  for_each_run(cable, [&](Run run) {
    if (run.count > 1) share_run(substep, cable, run, next);
  });
  if (cable.has_friction) update_slip(substep, cable);
  for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
    const bool resting = rests[at(i - cable.first_link)] != 0;
    next.integers[slip_state_index(i)] = resting ? 0 : slip_[at(i)];
  }
}

void CableSystem::share_run(Substep& substep, const CompiledCable& cable, Run run,
                            FeatureState& next) {
  const bool weighs = weighs_now(substep, cable);
  if (weighs) HeavySpans(*this).find_spare(substep, cable, run, next);
  const std::vector<double>& spare = weighs ? run_work_.spare : run_spare(substep, cable, run);
  double passed = 0.0;         // length over the link behind span i
  double passed_before = 0.0;  // length moved over the link before span i
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    double& rest_length = next.reals[rest_length_index(k)];
    const bool arcs = run_work_.arcs[at(i)].link >= 0;
    if (i + 1 == run.count && !arcs) {
      rest_length += passed_before;
      break;
    }
    passed += spare[at(i)];
    // A multiple of the quantum, limited to the available cable.
    double moved = std::min(cable.quantised(passed), rest_length + passed_before);
    rest_length += passed_before - moved;
    passed_before = moved;
    const int link = spans_[at(k)].second;
    double over = passed;
    if (arcs) {
      const double slid = pass_arc(at(i), over);
      passed_before = lay_arc(cable, at(i), moved, passed, next);
      const double carried = run_work_.arcs[at(i)].carried;
      moved = 0.5 * (moved + passed_before) - cable.quantised(carried);
      over = slid;
    }
    // Cable that is at its bound without passing is examined again in the next substep: sticking is
    // decided starting from links that all hold.
    if (std::abs(over) <= cable_parts::length_rounding * substep.bodies.scale()) {
      run_work_.rests[at(link - cable.first_link)] = 1;
    }
    if (links_[at(link)].massless) {
      passed_before = MasslessWheels(*this).pass(substep, i, k, moved, next);
      passed += passed_before - moved;
    } else {
      next.reals[slip_index(link)] += moved;
    }
  }
}

}  // namespace sheave
