// Ropes with a material that run through sheaths: rows, sweeps and the state. The law of the tensions
// is that of cable/sheath_tensions.cpp.

#include "cable/sheaths.h"

#include <algorithm>
#include <cmath>

#include "cable/slack_curve.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Largest number of changes between sticking and sliding of one sheath in a substep.
constexpr int most_sheath_flips = 8;

}  // namespace

void Sheaths::begin(const Substep& substep, const FeatureState& state) {
  for (std::size_t i = 0; i < s_.sheaths_.size(); ++i) {
    cable_parts::SheathWork& sheath = s_.sheaths_[i];
    sheath.start = SheathProfile(
        std::span(state.reals).subspan(s_.sheath_index(i), SheathProfile::real_count));
    // At rest the rope is stuck until a search shows that it slides.
    const std::int64_t slides =
        substep.at_rest ? 0 : state.integers[CableSystem::slip_state_index(sheath.link)];
    sheath.slides = sheath.law.exponent > 0.0 ? static_cast<int>(slides) : 1;
    sheath.flips = 0;
  }
}

void Sheaths::gather(const Substep& substep, int span, Row& row,
                     std::vector<SheathPart>& parts) const {
  SheathPart& part = parts.emplace_back();
  part.span = span;
  s_.evaluate(substep, span, row, &part.stretched);
  row.told = false;
  row.index = span;
  row.active = s_.start_tensions_[at(span)] > 0.0;
  part.sheath_before = s_.sheath_places_[at(s_.spans_[at(span)].first)];
  part.sheath_behind = s_.sheath_places_[at(s_.spans_[at(span)].second)];
  part.tension =
      s_.strains_[at(span)] / s_.cables_[at(s_.spans_[at(span)].cable)].inverse_stiffness;
}

void Sheaths::gather_all(const Substep& substep, const CompiledCable& cable, std::vector<Row>& rows,
                         std::vector<SheathPart>& parts) const {
  rows.reserve(at(cable.span_count));
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!s_.spans_[at(k)].active) continue;
    gather(substep, k, rows.emplace_back(), parts);
  }
}

void Sheaths::set_row(const SheathPart& part, double yield, bool tied, Row& row) const {
  row.tied = tied;
  row.weight = row.start_weight = part.weight;
  if (part.tension > 0.0) {
    row.compliance = part.compliance;
    row.value = -part.compliance * part.tension;
  } else {
    row.value = part.gap;
    row.compliance = yield * part.stretched.length;
  }
}

void Sheaths::linearise(const Substep& substep, const CompiledCable& cable, RowList& rows) {
  const std::size_t start = rows.size();
  std::vector<SheathPart> parts;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (s_.spans_[at(k)].active) gather(substep, k, rows.emplace_back(), parts);
  }
  // Only `rattle` linearises before bodies have moved.
  const bool at_start = substep.time == substep.start.time;
  if (!at_start) tensions(cable).solve(parts);
  for (const SheathGroup& group : tensions(cable).groups_of(parts)) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      Row& row = rows[start + i];
      if (!at_start) set_row(parts[i], cable.inverse_stiffness, i > group.first, row);
      row.tied = i > group.first;
      row.weight = row.start_weight = parts[i].weight;
    }
  }
}

double Sheaths::sweep_group(Substep& substep, const std::vector<SheathPart>& parts,
                            const SheathGroup& group, std::vector<Row>& rows) {
  if (group.count == 1) {
    Row& row = rows[group.first];
    double& multiplier = s_.multipliers_[at(parts[group.first].span)];
    if (row.value >= 0.0 && multiplier == 0.0) return 0.0;  // slack
    return solve_row(row, substep.h, multiplier, substep.moving);
  }
  // C of the group = sum of C_i; the multiplier of row i is its weight times that of the group.
  const double inverse_square = 1.0 / (substep.h * substep.h);
  const std::size_t end = group.first + group.count;
  std::vector<RowTerm> gradient(substep.moving.size());
  for (std::size_t i = group.first; i < end; ++i) {
    for (const RowTerm& term : rows[i].active_terms()) {
      gradient[at(term.body)].linear += term.linear;
      gradient[at(term.body)].angular += term.angular;
    }
  }
  double numerator = 0.0;
  double denominator = 0.0;
  for (std::size_t i = group.first; i < end; ++i) {
    double yield = 0.0;
    for (const RowTerm& term : rows[i].active_terms()) {
      const MovingBody& body = substep.moving[at(term.body)];
      const RowTerm& sum = gradient[at(term.body)];
      if (body.translates) yield += dot(sum.linear, times(body.inverse_mass, term.linear));
      if (body.rotates) yield += dot(sum.angular, times(body.inverse_inertia, term.angular));
    }
    numerator += yield * s_.multipliers_[at(parts[i].span)] - rows[i].value;
    denominator += parts[i].weight * (yield + rows[i].compliance * inverse_square);
  }
  if (!(denominator > 0.0)) return 0.0;
  const double multiplier = std::max(numerator / denominator, 0.0);
  double largest = 0.0;
  for (std::size_t i = group.first; i < end; ++i) {
    double& own = s_.multipliers_[at(parts[i].span)];
    const double increment = parts[i].weight * multiplier - own;
    if (increment == 0.0) continue;
    own += increment;
    RowResponse response;
    respond(rows[i], substep.moving, response);
    apply_multiplier(rows[i], response, increment, substep.moving);
    largest = std::max(largest, std::abs(increment));
  }
  return largest * denominator;
}

double Sheaths::sweep(Substep& substep, const CompiledCable& cable) {
  std::vector<Row> rows;
  std::vector<SheathPart> parts;
  gather_all(substep, cable, rows, parts);
  tensions(cable).solve_freely(parts);
  double correction = 0.0;
  for (const SheathGroup& group : tensions(cable).groups_of(parts)) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      set_row(parts[i], cable.inverse_stiffness, i > group.first, rows[i]);
    }
    correction = std::max(correction, sweep_group(substep, parts, group, rows));
  }
  return correction;
}

bool Sheaths::revise(const Substep& substep, const CompiledCable& cable) {
  std::vector<Row> rows;
  std::vector<SheathPart> parts;
  gather_all(substep, cable, rows, parts);
  std::vector<int> before;
  for (const cable_parts::SheathWork& sheath : s_.sheaths_) before.push_back(sheath.slides);
  tensions(cable).solve_freely(parts);
  bool changed = false;
  for (std::size_t i = 0; i < before.size(); ++i) {
    cable_parts::SheathWork& sheath = s_.sheaths_[i];
    if (sheath.slides == before[i]) continue;
    if (sheath.flips >= most_sheath_flips) {
      sheath.slides = before[i];
      continue;
    }
    ++sheath.flips;
    changed = true;
  }
  return changed;
}

void Sheaths::keep_end_strains(const Substep& substep, const CompiledCable& cable) {
  std::vector<Row> rows;
  std::vector<SheathPart> parts;
  gather_all(substep, cable, rows, parts);
  tensions(cable).solve_freely(parts);
  for (const SheathPart& part : parts) {
    s_.end_strains_[at(part.span)] = part.tension * cable.inverse_stiffness;
  }
  tensions(cable).settle(parts);
}

double Sheaths::loss_in(const cable_parts::SheathWork& sheath) {
  const SheathLaw& law = sheath.law;
  const double released = sheath.start.energy(law) - sheath.end.energy(law);
  const bool known = sheath.slides == 0 && sheath.start.piece_count() > 0;
  SheathProfile profile = sheath.start;
  const double entry_front =
      known ? profile.limit_from_entry(sheath.end.entry(), law.exponent) : 0.0;
  profile = sheath.start;
  const double exit_front = known ? profile.limit_from_exit(sheath.end.exit(), law.exponent) : 0.0;
  if (known && entry_front <= exit_front) {
    return released - sheath.start.work_at_entry(law, sheath.end.entry()) -
           sheath.start.work_at_exit(law, sheath.end.exit());
  }
  const auto brought = [&](double before, double now) {
    const double first = portable::exp(before);
    const double last = portable::exp(now);
    return 0.5 * (first + last) + 0.25 * law.yield * (first * first + last * last);
  };
  return released - brought(sheath.start.entry(), sheath.end.entry()) * sheath.from_entry -
         brought(sheath.start.exit(), sheath.end.exit()) * sheath.from_exit;
}

void Sheaths::finish(const Substep& substep, const CompiledCable& cable, FeatureState& next) {
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!s_.spans_[at(k)].active) continue;
    const int second = s_.spans_[at(k)].second;
    const int place = s_.sheath_places_[at(second)];
    if (place < 0) continue;
    const cable_parts::SheathWork& sheath = s_.sheaths_[at(place)];
    const auto pass = [&](int span, int end, double amount) {
      double& remainder = next.reals[s_.remainder_index(span, end)];
      const double moved = cable.quantised(amount - remainder);
      // The span keeps the part below the quantum.
      remainder -= amount - moved;
      next.reals[s_.rest_length_index(span)] -= moved;
      next.reals[s_.stored_length_index(second)] += moved;
      return moved;
    };
    const double in = pass(k, 1, sheath.from_entry);
    const double back = pass(CableSystem::span_after(cable, second), 0, sheath.from_exit);
    next.reals[s_.slip_index(second)] += 0.5 * (in - back);
    next.integers[CableSystem::slip_state_index(second)] =
        sheath.law.exponent > 0.0 ? sheath.slides : 0;
    next.reals[s_.sheath_loss_index(at(place))] += loss_in(sheath);
    sheath.end.save(
        std::span(next.reals).subspan(s_.sheath_index(at(place)), SheathProfile::real_count));
    if (!substep.at_rest) note_reach(substep, sheath);
  }
}

double Sheaths::reach(const Substep& now, const LinkGeometry& link) {
  const SheathCurve& sheath = *link.sheath;
  return (now.point(sheath.exit_body, sheath.points.back()) -
          now.point(link.carrier, sheath.points.front()))
      .norm();
}

void Sheaths::note_reach(const Substep& substep, const cable_parts::SheathWork& sheath) {
  const LinkGeometry& link = s_.links_[at(sheath.link)];
  if (link.exit_body() == link.body) return;
  const double apart = reach(substep, link);
  constexpr double rounding = 1e-9;
  if (!(apart > sheath.law.length * (1.0 + rounding))) return;
  ++s_.notes_.edition;
  s_.notes_.torn_sheaths[at(s_.sheath_places_[at(sheath.link)])].note(substep.next.time, apart,
                                                                      link.body);
}

std::vector<cable_parts::SheathWarning> Sheaths::warnings(const CableSystem& system) {
  std::vector<cable_parts::SheathWarning> warnings;
  for (const CompiledCable& cable : system.cables_) {
    for (int i = 0; i < cable.listed_links; ++i) {
      const int place = system.sheath_places_[at(cable.first_link + i)];
      if (place < 0) continue;
      const cable_parts::Departure& most = system.notes_.torn_sheaths[at(place)];
      if (most.observed.substeps == 0) continue;
      warnings.push_back(
          {{cable.name, i, most.body, most.observed.substeps, most.observed.first_time},
           most.most,
           system.sheaths_[at(place)].law.length});
    }
  }
  return warnings;
}

void Sheaths::draw(const Substep& now, const LinkGeometry& link, std::vector<Vector3>& path) {
  const SheathCurve& sheath = *link.sheath;
  if (sheath.exit_body == link.body) {
    for (const Vector3& point : sheath.points) path.push_back(now.point(link.carrier, point));
    return;
  }
  constexpr int pieces = 24;
  const SlackCurve curve(now.point(link.carrier, sheath.points.front()),
                         now.point(sheath.exit_body, sheath.points.back()), sheath.length,
                         now.gravity);
  for (int i = 0; i <= pieces; ++i) path.push_back(curve.point(curve.length() * i / pieces));
}

}  // namespace sheave
