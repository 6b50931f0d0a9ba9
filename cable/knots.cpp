#include "cable/knots.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"

namespace sheave {

using cable_parts::KnotEnd;
using cable_parts::KnotWork;
using cable_parts::Run;

namespace {

/// Takes the knot out of a row and multiplies the row by the share of its rope. The gradients of a
/// slack rope stay above 0, so the row keeps its pattern.
void scale_row(int knot, double share_of_rope, Row& row) {
  constexpr double least = 1e-150;
  const double share = std::max(share_of_rope, least);
  int kept = 0;
  for (int i = 0; i < row.term_count; ++i) {
    if (row.terms[at(i)].body == knot) continue;
    RowTerm& term = row.terms[at(kept++)];
    term = row.terms[at(i)];
    term.linear *= share;
    term.angular *= share;
    term.reach *= share;
  }
  row.term_count = kept;
  row.rate *= share;
}

/// The arms whose cables are not cut beside the knot.
std::vector<KnotArm> present_arms(const KnotWork& knot) {
  std::vector<KnotArm> arms;
  for (std::size_t e = 0; e < knot.arms.size(); ++e) {
    if (knot.runs[e].count > 0) arms.push_back(knot.arms[e]);
  }
  return arms;
}

/// Leaves a knot whose cables are all cut where it is.
void lose_ropes(KnotWork& knot, const Vector3& point) {
  knot.place.point = point;
  knot.place.taut = true;
  knot.place.shares.assign(knot.ends.size(), 0.0);
}

/// Adds the terms of a row to the sums per body.
void add_terms(const Row& row, std::vector<RowTerm>& sums) {
  for (const RowTerm& term : row.active_terms()) {
    const auto same = std::find_if(sums.begin(), sums.end(),
                                   [&](const RowTerm& sum) { return sum.body == term.body; });
    if (same == sums.end()) {
      sums.push_back(term);
      continue;
    }
    same->linear += term.linear;
    same->angular += term.angular;
  }
}

}  // namespace

bool cable_parts::is_undetermined(const KnotWork& knot) {
  if (!knot.place.taut || knot.arms.size() < 3 || knot.arms.front().compliance > 0.0) return false;
  const std::vector<KnotArm> arms = present_arms(knot);
  if (arms.size() < 3) return false;
  KnotPlace place;
  find_knot_place(arms, place);
  return has_other_shares(arms, place);
}

std::string cable_parts::undetermined_text(const BodySet& bodies, const KnotWork& knot) {
  return "knot \"" + bodies.name(knot.body) +
         "\": the directions of its taut rigid cables do not determine their tensions, as those of "
         "three cables in one line or of four in one plane; let one of them end at another body, "
         "or give the knot mobility \"free\" and a mass of some grams";
}

void Knots::check_counts(const BodySet& bodies, std::span<const int> ropes, Errors& errors) {
  for (int i = 0; i < bodies.count(); ++i) {
    if (bodies[i].mobility != Mobility::knot) continue;
    const int count = ropes.empty() ? 0 : ropes[at(i)];
    if (count >= least_ropes && count <= most_ropes) continue;
    errors.push_back({"/bodies/" + std::to_string(i),
                      "knot \"" + bodies.name(i) + "\": " + std::to_string(count) +
                          (count == 1 ? " cable ends" : " cables end") +
                          " there, and a knot joins " + std::to_string(least_ropes) + " to " +
                          std::to_string(most_ropes) +
                          (count < least_ropes ? "; attach the ends of cables to it"
                                               : "; join more ropes by a body with mobility "
                                                 "\"free\" and a mass of some grams")});
  }
}

Run Knots::run_of(const KnotEnd& end) const {
  const CompiledCable& cable = s_.cables_[at(end.cable)];
  const int link = end.at_start ? cable.first_link : cable.last_listed_link();
  Run run{-1, 0};
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    const SpanSetup& span = s_.spans_[at(k)];
    if (span.active && (end.at_start ? span.first : span.second) == link) run = {k, 1};
  }
  if (run.count == 0) return run;  // the cable is cut there
  if (end.at_start) {
    for (int k = run.first; s_.shared(s_.spans_[at(k)].second); ++run.count) {
      k = s_.next_span(cable, k);
    }
    return run;
  }
  while (s_.shared(s_.spans_[at(run.first)].first)) {
    run.first = CableSystem::span_before(cable, s_.spans_[at(run.first)].first, s_.spans_);
    ++run.count;
  }
  return run;
}

void Knots::begin() {
  std::fill(s_.knotted_.begin(), s_.knotted_.end(), 0);
  for (KnotWork& knot : s_.knots_) {
    knot.bends = knot.pulls = false;
    knot.start_shares.clear();
    knot.runs.clear();
    for (const KnotEnd& end : knot.ends) {
      const CompiledCable& cable = s_.cables_[at(end.cable)];
      const Run run = knot.runs.emplace_back(run_of(end));
      for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
        s_.knotted_[at(k)] = 1;
        knot.pulls = knot.pulls || s_.start_tensions_[at(k)] > 0.0;
        knot.bends = knot.bends || s_.spans_[at(k)].kind != SpanKind::straight;
      }
    }
    knot.arms.assign(knot.ends.size(), {});
  }
}

void Knots::evaluate(const Substep& substep, KnotWork& knot) {
  const bool at_start = substep.time == substep.start.time;
  const Vector3& point = substep.moving[at(knot.body)].position;
  knot.rows.clear();
  knot.row_ends.clear();
  for (std::size_t e = 0; e < knot.ends.size(); ++e) {
    const KnotEnd& end = knot.ends[e];
    const Run run = knot.runs[e];
    const CompiledCable& cable = s_.cables_[at(end.cable)];
    KnotArm& arm = knot.arms[e];
    arm.reach = arm.compliance = 0.0;
    for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
      Row& row = knot.rows.emplace_back();
      row.clear();
      const SpanGeometry span = s_.evaluate(substep, k, row);
      if (at_start) s_.start_without_feed(k, row);
      knot.row_ends.push_back(static_cast<int>(e));
      arm.reach += row.value;
      arm.compliance += row.compliance;
      if (end.at_start && i == 0) arm.end = span.end;
      if (!end.at_start && i + 1 == run.count) arm.end = span.start;
    }
    arm.reach += (arm.end - point).norm();
  }
}

double Knots::compliance_of(const KnotWork& knot) const {
  double sum = 0.0;
  for (std::size_t e = 0; e < knot.ends.size(); ++e) {
    const CompiledCable& cable = s_.cables_[at(knot.ends[e].cable)];
    for (int i = 0, k = knot.runs[e].first; i < knot.runs[e].count;
         ++i, k = s_.next_span(cable, k)) {
      sum += s_.compliance_of(cable, s_.references_[at(k)].rest_length);
    }
  }
  return sum;
}

void Knots::find_place(KnotWork& knot) const {
  const bool whole =
      std::all_of(knot.runs.begin(), knot.runs.end(), [](Run run) { return run.count > 0; });
  find_knot_place(whole ? knot.arms : present_arms(knot), knot.place);
  std::vector<double>& shares = knot.place.shares;
  if (!whole) {
    std::vector<double> all(knot.runs.size(), 0.0);
    for (std::size_t e = 0, i = 0; e < all.size(); ++e) {
      if (knot.runs[e].count > 0) all[e] = shares[i++];
    }
    shares = all;
  }
  if (!knot.bends) return;
  // Wheels give and take rope with the compliance of its length. The row keeps that of the start.
  double now = 0.0;
  for (const KnotArm& arm : knot.arms) now += arm.compliance;
  if (!(now > 0.0)) return;
  const double scale = std::sqrt(compliance_of(knot) / now);
  for (double& share : shares) share *= scale;
}

void Knots::settle(Substep& substep, KnotWork& knot) {
  constexpr int most_rounds = 50;
  // The row is exact to second order in the distance from the balance.
  const double enough = 1e-13 * substep.bodies.scale();
  Vector3& point = substep.moving[at(knot.body)].position;
  evaluate(substep, knot);
  knot.value = 0.0;
  if (knot.rows.empty()) return lose_ropes(knot, point);
  for (int round = 0; round < most_rounds; ++round) {
    find_place(knot);
    const bool settled = (knot.place.point - point).norm() <= enough;
    if (settled && knot.bends) break;
    point = knot.place.point;
    evaluate(substep, knot);
    if (!knot.bends) break;
  }
  for (std::size_t r = 0; r < knot.rows.size(); ++r) {
    knot.value += knot.place.shares[at(knot.row_ends[r])] * knot.rows[r].value;
  }
}

template <class Visit>
void Knots::for_each_free_run(const CompiledCable& cable, Visit visit) {
  s_.for_each_run(cable, [&](Run run) {
    if (s_.knotted_[at(run.first)] == 0) visit(run);
  });
}

void Knots::linearise_rest(Substep& substep, const CompiledCable& cable, RowList& rows) {
  for_each_free_run(cable, [&](Run run) { s_.linearise_run(substep, cable, run, rows); });
}

void Knots::linearise(Substep& substep, RowList& rows) {
  const bool at_start = substep.time == substep.start.time;
  for (KnotWork& knot : s_.knots_) {
    settle(substep, knot);
    if (at_start) knot.start_shares = knot.place.shares;
    for (std::size_t r = 0; r < knot.rows.size(); ++r) {
      Row& row = rows.emplace_back();
      row = knot.rows[r];
      scale_row(knot.body, knot.place.shares[at(knot.row_ends[r])], row);
      row.value = r == 0 ? knot.value : 0.0;
      row.compliance = r == 0 ? compliance_of(knot) : 0.0;
      row.curved = row.told = row.has_past = false;
      row.turning = row.past = 0.0;
      row.index = knot.index + static_cast<int>(r);
      row.tied = r > 0;
      row.active = knot.pulls;
    }
  }
}

double Knots::sweep_rest(Substep& substep, const CompiledCable& cable) {
  double correction = 0.0;
  for_each_free_run(cable, [&](Run run) {
    correction = std::max(correction, run.count == 1 ? s_.solve_span(substep, run.first)
                                                     : s_.solve_run(substep, cable, run));
  });
  return correction;
}

double Knots::sweep(Substep& substep) {
  double largest = 0.0;
  std::vector<RowTerm> sums;
  for (KnotWork& knot : s_.knots_) {
    settle(substep, knot);
    sums.clear();
    for (std::size_t r = 0; r < knot.rows.size(); ++r) {
      scale_row(knot.body, knot.place.shares[at(knot.row_ends[r])], knot.rows[r]);
      add_terms(knot.rows[r], sums);
    }
    double yield = 0.0;
    for (const RowTerm& term : sums) {
      const MovingBody& body = substep.moving[at(term.body)];
      if (body.translates) yield += dot(term.linear, times(body.inverse_mass, term.linear));
      if (body.rotates) yield += dot(term.angular, times(body.inverse_inertia, term.angular));
    }
    const double softness = compliance_of(knot) / (substep.h * substep.h);
    if (!(yield + softness > 0.0)) continue;
    double& multiplier = s_.multipliers_[at(knot.index)];
    const double wanted = multiplier - (knot.value + softness * multiplier) / (yield + softness);
    const double change = std::max(wanted, 0.0) - multiplier;
    std::fill_n(&multiplier, knot.rows.size(), multiplier + change);
    for (const RowTerm& term : sums) {
      MovingBody& body = substep.moving[at(term.body)];
      if (body.translates) body.position += change * times(body.inverse_mass, term.linear);
      if (body.rotates) body.rotate(change * times(body.inverse_inertia, term.angular));
    }
    largest = std::max(largest, std::abs(change) * (yield + softness));
  }
  return largest;
}

void Knots::finish(Substep& substep, const FeatureState& next) {
  const double square = substep.h * substep.h;
  std::vector<double>* late = nullptr;
  for (std::size_t f = 0; f < substep.late_forces.size(); ++f) {
    if (&substep.next.features[f] != &next || substep.late_forces[f].empty()) continue;
    late = &substep.late_forces[f];
  }
  for (KnotWork& knot : s_.knots_) {
    settle(substep, knot);
    const double whole = s_.multipliers_[at(knot.index)];
    const bool halves = late != nullptr && !knot.start_shares.empty();
    const double second = halves ? square * (*late)[at(knot.index)] : whole;
    for (std::size_t e = 0; e < knot.ends.size(); ++e) {
      const CompiledCable& cable = s_.cables_[at(knot.ends[e].cable)];
      const double now = knot.place.shares[e] * second;
      const double first = halves ? knot.start_shares[e] * (whole - second) : 0.0;
      for (int i = 0, k = knot.runs[e].first; i < knot.runs[e].count;
           ++i, k = s_.next_span(cable, k)) {
        s_.multipliers_[at(k)] = first + now;
        if (halves) (*late)[at(k)] = now / square;
      }
    }
    BodyState& body = substep.next.bodies[at(knot.body)];
    const MovingBody& moving = substep.moving[at(knot.body)];
    body.position = moving.position;
    body.velocity = (moving.position - moving.start_position) / substep.h;
  }
}

}  // namespace sheave
