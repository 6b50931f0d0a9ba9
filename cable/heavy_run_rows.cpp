// The rows of ropes with weight that pass pinholes and massless wheels, and the rope that they share:
// cable/heavy_runs.cpp has the derivation.

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/floor_friction.h"
#include "cable/heavy_spans.h"
#include "engine/index.h"

namespace sheave {

HeavyShape HeavySpans::shape_of(const Substep& substep, int k, const SpanGeometry& span) const {
  const SpanSetup& setup = s_.spans_[at(k)];
  const CompiledCable& cable = s_.cables_[at(setup.cable)];
  const FloorGrip grip = FloorFriction::grip(s_, substep.gravity, k);
  return {wheel_plane_of(substep, cable, setup, s_.links_[at(setup.first)],
                         s_.links_[at(setup.second)], span, grip),
          hanging_rope(cable, substep.gravity, span, grip), span.length};
}

void HeavySpans::find_shared_tension(const Substep& substep, int k, const SpanGeometry& span) {
  cable_parts::HangingStart& start = s_.hanging_[at(k)];
  const int link = s_.spans_[at(k)].first;
  if (!run_.begun) {
    const double multiplier = s_.multipliers_[at(k)];
    double tension = start.now.tension;
    // The law of a rope that only just hangs is linear over small changes only.
    constexpr double least_share = 0.25;
    if (multiplier != 0.0) {
      tension = std::max(multiplier / (substep.load_share * substep.h * substep.h),
                         least_share * tension);
    }
    run_.now = run_.then = RunTensions(tension);
  }
  const bool on_wheel = run_.begun && s_.links_[at(link)].wraps();
  const double share = on_wheel ? stored_share(link) : 0.0;
  const auto find = [&](const HeavyShape& shape, RunTensions& tensions, const Vector3& in,
                        const Vector3& out, cable_parts::HangingStart::Shared& shared) {
    const double lift = on_wheel ? lift_over(shape.wheels, share, in, out) : 0.0;
    const RunTensions::Span found = tensions.next(shape, lift, shared.tension);
    shared = {found.tension, found.weight};
  };
  find(shape_of(substep, k, span), run_.now, run_.arrives, span.direction, start.now);
  if (substep.load_share != 1.0) {
    find({start.wheels, start.rope, start.rope.chord()}, run_.then, run_.arrived, start.began,
         start.then);
  }
  start.unknown = run_.now.unknown();
  run_.arrives = span.direction;
  run_.arrived = start.began;
  run_.begun = true;
}

double HeavySpans::stored_share(int link) const {
  const double arc = s_.stored_arcs_[at(link)];
  const int place = s_.strain_places_[at(link)];
  if (place < 0 || !(arc > 0.0)) return 1.0;
  return (arc - s_.stored_[at(place)].total().stretch) / arc;
}

std::vector<cable_parts::Run> HeavySpans::runs_of(const CompiledCable& cable) const {
  std::vector<cable_parts::Run> runs;
  if (cable.shares) {
    s_.for_each_run(cable, [&](cable_parts::Run run) { runs.push_back(run); });
    return runs;
  }
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (s_.spans_[at(k)].active) runs.push_back({k, 1});
  }
  return runs;
}

double HeavySpans::sweep(Substep& substep, const CompiledCable& cable) {
  double correction = 0.0;
  for (const cable_parts::Run run : runs_of(cable)) {
    if (run.count == 1) s_.hanging_[at(run.first)].now = {};
    const double own =
        run.count == 1 ? sweep_span(substep, run.first) : sweep_run(substep, cable, run);
    correction = std::max(correction, own);
  }
  return correction;
}

double HeavySpans::sweep_run(Substep& substep, const CompiledCable& cable, cable_parts::Run run) {
  cable_parts::RunWork& work = s_.run_work_;
  const auto count = at(run.count);
  work.rows.resize(std::max(work.rows.size(), count));
  work.gradient.resize(substep.moving.size());
  std::vector<std::pair<int, HangingSpan>> spans;
  run_ = {};
  run_.shares = true;
  double error = 0.0;
  double compliance = 0.0;
  for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
    Row& row = work.rows[at(i)];
    row.clear();
    spans.emplace_back(k, evaluate(substep, k, row));
    error += row.value;
    compliance += row.compliance / (substep.h * substep.h);
    for (const RowTerm& term : row.active_terms()) {
      work.gradient[at(term.body)].linear += term.linear;
      work.gradient[at(term.body)].angular += term.angular;
    }
  }
  run_ = {};
  double yield = compliance;
  for (std::size_t body = 0; body < work.gradient.size(); ++body) {
    RowTerm& sum = work.gradient[body];
    const MovingBody& moving = substep.moving[body];
    if (moving.translates) yield += dot(sum.linear, times(moving.inverse_mass, sum.linear));
    if (moving.rotates) yield += dot(sum.angular, times(moving.inverse_inertia, sum.angular));
    sum = {};
  }
  error += compliance * s_.multipliers_[at(run.first)];
  if (yield > 0.0) {
    for (std::size_t i = 0; i < count; ++i) {
      s_.multipliers_[at(spans[i].first)] -= error / yield;
      RowResponse response;
      respond(work.rows[i], substep.moving, response);
      apply_multiplier(work.rows[i], response, -error / yield, substep.moving);
    }
  }
  double residual = std::abs(error);
  for (auto& [k, hanging] : spans) {
    Row& row = s_.row_;
    row.clear();
    load(substep, k, hanging, row);
    residual += solve_row(row, substep.h, s_.multipliers_[at(row.index)], substep.moving);
  }
  return residual;
}

double HeavySpans::settle_tension(const Substep& substep, int k) {
  cable_parts::HangingStart& start = s_.hanging_[at(k)];
  const double multiplier = s_.multipliers_[at(k)];
  if (start.now.tension > 0.0 && multiplier != 0.0) {
    // The last round has changed the unknown by a residual.
    const double change = multiplier / (substep.h * substep.h) - start.unknown;
    constexpr double least_share = 0.25;
    for (auto* shared : {&start.now, &start.then}) {
      shared->tension =
          std::max(shared->tension + shared->weight * change, least_share * shared->tension);
    }
    start.unknown += change;
  }
  if (substep.load_share == 1.0) return start.now.tension;
  return 0.5 * (start.now.tension + start.then.tension);
}

std::vector<SharedSpan> HeavySpans::shared_spans(const Substep& now, const CompiledCable& cable,
                                                 cable_parts::Run run,
                                                 const FeatureState& own) const {
  std::vector<SharedSpan> spans;
  Vector3 arrives = Vector3::Zero();
  for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
    const SpanGeometry geometry = s_.geometry_of(now, k);
    SharedSpan& span = spans.emplace_back();
    span.shape = shape_of(now, k, geometry);
    span.rest = own.reals[s_.rest_length_index(k)] + own.reals[s_.remainder_index(k, 0)] +
                own.reals[s_.remainder_index(k, 1)];
    const int link = s_.spans_[at(k)].first;
    if (i > 0 && s_.links_[at(link)].wraps()) {
      const double arc = s_.stored_arc(own, link);
      const double share = arc > 0.0 ? own.reals[s_.stored_length_index(link)] / arc : 1.0;
      span.lift = lift_over(span.shape.wheels, share, arrives, geometry.direction);
    }
    arrives = geometry.direction;
  }
  return spans;
}

void HeavySpans::find_spare(const Substep& substep, const CompiledCable& cable,
                            cable_parts::Run run, const FeatureState& own) {
  std::vector<SharedSpan> spans = shared_spans(substep, cable, run, own);
  for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
    spans[at(i)].tension = s_.hanging_[at(k)].now.tension;
  }
  const bool found = share_rope(spans);
  std::vector<double>& spare = s_.run_work_.spare;
  s_.run_work_.clear_arcs(at(run.count));
  spare.assign(at(run.count), 0.0);
  double total = 0.0;
  double whole = 0.0;
  for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
    s_.hanging_[at(k)].most = spans[at(i)].most;
    s_.hanging_[at(k)].runs_out = !found && !substep.at_rest;
    if (!found) continue;
    spare[at(i)] = spans[at(i)].rest - spans[at(i)].length;
    total += spare[at(i)];
    whole += spans[at(i)].rest;
  }
  // The residual is spread over the spans.
  for (int i = 0; found && i < run.count; ++i) {
    spare[at(i)] -= total * spans[at(i)].rest / whole;
  }
}

}  // namespace sheave
