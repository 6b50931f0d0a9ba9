// Ropes with a material that run through sheaths.
//
// A sheath holds a length of rope whose tension has a profile (cable/sheath_profile.h). A span beside
// it and the part of the sheath in which rope slides are one spring. With the unstretched length B
// that the span would have if nothing passed the end of the sheath, the span's length l, and the
// unstretched length M(T) that slides into the sheath, the law of a span is
//
//   l / (1 + x) + M(T) = B,   x = T / EA,
//
// which falls with T, since a tighter rope holds less unstretched length. While a part of the rope is
// stuck in the sheath, each side has its own equation. If the ratio of the tensions would exceed e^X,
// the whole rope slides: the ratio is e^X, and only the sum of both equations holds.
//
// The positions alone determine these tensions T*, by Newton's method within bounds. The row of a
// span is the spring c (T - T*) = 0 with the compliance c = dl / dT* of the law, so a round of the
// solver is a step of Newton's method. Rows of spans between which the whole rope slides share one
// unknown with the weights of their tensions. `rattle` takes the mean of the tensions at both ends
// of the substep, as for any spring.
//
// Fronts from both ends of a sheath can meet: both sides pull in rope, or both let go. The place
// where they meet divides the rope that has slid; it is that at the end of the substep.

#include "cable/sheaths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Largest number of changes between sticking and sliding of one sheath in a substep.
constexpr int most_sheath_flips = 8;

/// Rounding error of the logarithm of a ratio of tensions.
constexpr double pull_rounding = 1e-11;

/// A change of the logarithm of a tension below this is rounding of lengths.
constexpr double least_pull_change = 1e-10;

double pull_of(double tension) {
  return tension > 0.0 ? portable::log(tension) : SheathProfile::slack;
}

/// The pull at the other end, as far as the friction of the sheath allows it.
double held_pull(double other, double pull, double exponent) {
  return std::clamp(other, pull - exponent, pull + exponent);
}

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

void Sheaths::gather(const Substep& substep, int span, Row& row, std::vector<Part>& parts) const {
  Part& part = parts.emplace_back();
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
                         std::vector<Part>& parts) const {
  rows.reserve(at(cable.span_count));
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!s_.spans_[at(k)].active) continue;
    gather(substep, k, rows.emplace_back(), parts);
  }
}

std::vector<Sheaths::Group> Sheaths::groups_of(std::vector<Part>& parts) const {
  std::vector<Group> groups;
  std::vector<double> pulls(parts.size(), 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int before = parts[i].sheath_before;
    const int slides = before >= 0 && i > 0 ? s_.sheaths_[at(before)].slides : 0;
    if (slides == 0) {
      groups.push_back({i, 1});
      continue;
    }
    ++groups.back().count;
    pulls[i] = pulls[i - 1] + slides * s_.sheaths_[at(before)].law.exponent;
  }
  for (const Group& group : groups) {
    const auto first = pulls.begin() + static_cast<std::ptrdiff_t>(group.first);
    const double most = *std::max_element(first, first + static_cast<std::ptrdiff_t>(group.count));
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      parts[i].weight = portable::exp(pulls[i] - most);
    }
  }
  return groups;
}

Sheaths::Gain Sheaths::boundary_gain(const std::vector<Part>& parts, std::size_t part, bool behind,
                                     double tension) const {
  const int place = behind ? parts[part].sheath_behind : parts[part].sheath_before;
  if (place < 0) return {};
  const cable_parts::SheathWork& sheath = s_.sheaths_[at(place)];
  const SheathLaw& law = sheath.law;
  if (!(tension > 0.0)) return {sheath.start.stretch(law), 0.0};
  const double pull = portable::log(tension);
  const double other =
      held_pull(pull_of(parts[behind ? part + 1 : part - 1].tension), pull, law.exponent);
  SheathProfile profile = sheath.start;
  double from = 0.0;
  double to = 1.0;
  if (behind) {
    to = profile.limit_from_entry(pull, law.exponent);
    to = std::min(to, profile.limit_from_exit(other, law.exponent));
  } else {
    from = profile.limit_from_exit(pull, law.exponent);
    from = std::max(from, profile.limit_from_entry(other, law.exponent));
  }
  const double before = sheath.start.stretch(law, from, to);
  const double old = behind ? sheath.start.entry() : sheath.start.exit();
  const double rise = pull > old ? -law.exponent : law.exponent;
  const FrontStretch front = front_stretch(law, tension, rise, to - from);
  // The rope holds against a change below rounding.
  const bool holds = std::abs(pull - old) < least_pull_change;
  return {before - front.stretch, holds ? 0.0 : front.slope};
}

Sheaths::Gain Sheaths::missing(const std::vector<Part>& parts, const Group& group,
                               double tension) const {
  const std::size_t last = group.first + group.count - 1;
  Gain sum;
  for (std::size_t i = group.first; i <= last; ++i) {
    const Part& part = parts[i];
    const double yield =
        s_.cables_[at(s_.spans_[at(part.span)].cable)].inverse_stiffness * part.weight;
    const double strain = tension * yield;
    const cable_parts::StretchedSpan& span = part.stretched;
    const double rest_length = span.length / (1.0 + strain);
    const double mean = 1.0 + 0.5 * (span.start_strain + strain);
    sum.length += rest_length - CableSystem::rest_length_at(span, strain);
    sum.slope += yield * (rest_length / (1.0 + strain) + 0.5 * span.on / (mean * mean));
    if (i == last) continue;
    const cable_parts::SheathWork& sheath = s_.sheaths_[at(part.sheath_behind)];
    const FrontStretch slid =
        front_stretch(sheath.law, part.weight * tension, sheath.slides * sheath.law.exponent, 1.0);
    sum.length += sheath.start.stretch(sheath.law) - slid.stretch;
    sum.slope += part.weight * slid.slope;
  }
  const Gain before = boundary_gain(parts, group.first, false, parts[group.first].weight * tension);
  const Gain behind = boundary_gain(parts, last, true, parts[last].weight * tension);
  sum.length += before.length + behind.length;
  sum.slope += parts[group.first].weight * before.slope + parts[last].weight * behind.slope;
  return sum;
}

void Sheaths::solve_group(std::vector<Part>& parts, const Group& group) const {
  const auto finish = [&](double tension) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      parts[i].tension = parts[i].weight * tension;
    }
  };
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  const Part& heaviest =
      *std::max_element(parts.begin() + static_cast<std::ptrdiff_t>(group.first),
                        parts.begin() + static_cast<std::ptrdiff_t>(group.first + group.count),
                        [](const Part& a, const Part& b) { return a.weight < b.weight; });
  double tension = heaviest.tension;
  const double yield = s_.cables_[at(s_.spans_[at(heaviest.span)].cable)].inverse_stiffness;
  if (!(tension > 0.0)) tension = 1e-6 / yield;
  const Gain slack = missing(parts, group, 0.0);
  if (!(slack.length > 0.0)) {
    parts[group.first].gap = -slack.length;
    return finish(0.0);
  }
  constexpr int most_rounds = 200;
  constexpr double rounding = 4e-16;
  for (int round = 0; round < most_rounds; ++round) {
    const Gain lack = missing(parts, group, tension);
    (lack.length > 0.0 ? low : high) = tension;
    double next = lack.slope > 0.0 ? tension + lack.length / lack.slope : high;
    const bool inside = next > low && next < high;
    if (!inside) next = std::isfinite(high) ? 0.5 * (low + high) : 2.0 * tension;
    if (!(std::abs(next - tension) > rounding * tension)) break;
    tension = next;
    if (high - low <= rounding * low) break;
  }
  finish(tension);
}

void Sheaths::solve(std::vector<Part>& parts) const {
  const std::vector<Group> groups = groups_of(parts);
  for (Part& part : parts) part.gap = 0.0;
  // Groups are independent unless fronts meet in a sheath between them.
  constexpr int most_rounds = 60;
  constexpr double rounding = 1e-14;
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0.0;
    for (const Group& group : groups) {
      const double before = parts[group.first].tension;
      solve_group(parts, group);
      const double now = parts[group.first].tension;
      change = std::max(change, std::abs(now - before) / std::max(std::max(now, before), 1e-300));
    }
    if (groups.size() == 1 || !(change > rounding)) break;
  }
  for (const Group& group : groups) {
    const std::size_t last = group.first + group.count - 1;
    double weights = 0.0;
    for (std::size_t i = group.first; i <= last; ++i) weights += parts[i].weight;
    for (std::size_t i = group.first; i <= last; ++i) {
      Part& part = parts[i];
      const double yield = s_.cables_[at(s_.spans_[at(part.span)].cable)].inverse_stiffness;
      const double strain = part.tension * yield;
      const cable_parts::StretchedSpan& span = part.stretched;
      const double mean = 1.0 + 0.5 * (span.start_strain + strain);
      double slope =
          yield * (span.length / ((1.0 + strain) * (1.0 + strain)) + 0.5 * span.on / (mean * mean));
      if (i == group.first) slope += boundary_gain(parts, i, false, part.tension).slope;
      if (i == last) slope += boundary_gain(parts, i, true, part.tension).slope;
      // The rope in a sheath that slides counts with the spans of its group in equal parts.
      for (std::size_t k = group.first; k < last; ++k) {
        const cable_parts::SheathWork& sheath = s_.sheaths_[at(parts[k].sheath_behind)];
        slope +=
            parts[k].weight / weights *
            front_stretch(sheath.law, parts[k].tension, sheath.slides * sheath.law.exponent, 1.0)
                .slope;
      }
      part.compliance = (1.0 + strain) * slope;
    }
  }
}

void Sheaths::solve_freely(std::vector<Part>& parts) {
  for (const Part& part : parts) {
    if (part.sheath_behind < 0) continue;
    cable_parts::SheathWork& sheath = s_.sheaths_[at(part.sheath_behind)];
    sheath.slides = sheath.law.exponent > 0.0 ? 0 : 1;
  }
  bool found = true;
  while (found) {
    found = false;
    solve(parts);
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      if (parts[i].sheath_behind < 0) continue;
      cable_parts::SheathWork& sheath = s_.sheaths_[at(parts[i].sheath_behind)];
      const double before = parts[i].tension;
      const double behind = parts[i + 1].tension;
      if (sheath.slides != 0) continue;
      // An end without tension holds nothing.
      const bool holds = before > 0.0 && behind > 0.0;
      const double rise = holds ? pull_of(behind) - pull_of(before) : behind - before;
      if (holds && !(std::abs(rise) > sheath.law.exponent + pull_rounding)) continue;
      sheath.slides = rise > 0.0 ? 1 : -1;
      found = true;
    }
  }
}

void Sheaths::set_row(const Part& part, double yield, bool tied, Row& row) const {
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
  std::vector<Part> parts;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (s_.spans_[at(k)].active) gather(substep, k, rows.emplace_back(), parts);
  }
  // Only `rattle` linearises before bodies have moved.
  const bool at_start = substep.time == substep.start.time;
  if (!at_start) solve(parts);
  for (const Group& group : groups_of(parts)) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      Row& row = rows[start + i];
      if (!at_start) set_row(parts[i], cable.inverse_stiffness, i > group.first, row);
      row.tied = i > group.first;
      row.weight = row.start_weight = parts[i].weight;
    }
  }
}

double Sheaths::sweep_group(Substep& substep, const std::vector<Part>& parts, const Group& group,
                            std::vector<Row>& rows) {
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
  std::vector<Part> parts;
  gather_all(substep, cable, rows, parts);
  solve_freely(parts);
  double correction = 0.0;
  for (const Group& group : groups_of(parts)) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      set_row(parts[i], cable.inverse_stiffness, i > group.first, rows[i]);
    }
    correction = std::max(correction, sweep_group(substep, parts, group, rows));
  }
  return correction;
}

bool Sheaths::revise(const Substep& substep, const CompiledCable& cable) {
  std::vector<Row> rows;
  std::vector<Part> parts;
  gather_all(substep, cable, rows, parts);
  std::vector<int> before;
  for (const cable_parts::SheathWork& sheath : s_.sheaths_) before.push_back(sheath.slides);
  solve_freely(parts);
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
  std::vector<Part> parts;
  gather_all(substep, cable, rows, parts);
  solve_freely(parts);
  for (const Part& part : parts) {
    s_.end_strains_[at(part.span)] = part.tension * cable.inverse_stiffness;
  }
  settle(parts);
}

void Sheaths::settle(std::vector<Part>& parts) {
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (parts[i].sheath_behind < 0) continue;
    cable_parts::SheathWork& sheath = s_.sheaths_[at(parts[i].sheath_behind)];
    sheath.end = sheath.start;
    if (sheath.slides != 0 || !(parts[i].tension > 0.0)) {
      sheath.end = SheathProfile(parts[i].tension, parts[i + 1].tension);
    } else {
      sheath.from_entry = boundary_gain(parts, i, true, parts[i].tension).length;
      sheath.from_exit = boundary_gain(parts, i + 1, false, parts[i + 1].tension).length;
      sheath.end.limit_from_entry(pull_of(parts[i].tension), sheath.law.exponent);
      sheath.end.limit_from_exit(pull_of(parts[i + 1].tension), sheath.law.exponent);
      sheath.end.shorten(sheath.law);
    }
  }
  // Where the whole rope slides, the length that passes one end of a sheath follows from that of
  // the other end and the spans between them.
  for (const Group& group : groups_of(parts)) {
    double spare = 0.0;
    double length = 0.0;
    const bool taut = parts[group.first].tension > 0.0;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      length += parts[i].stretched.length;
    }
    if (!taut) spare = parts[group.first].gap;
    for (std::size_t i = group.first; i + 1 < group.first + group.count; ++i) {
      const Part& part = parts[i];
      cable_parts::SheathWork& sheath = s_.sheaths_[at(part.sheath_behind)];
      const double strain = s_.end_strains_[at(part.span)];
      double rest_length = part.stretched.length / (1.0 + strain);
      if (!taut && length > 0.0) rest_length += spare * (part.stretched.length / length);
      double came = rest_length - CableSystem::rest_length_at(part.stretched, strain);
      if (part.sheath_before >= 0) came += s_.sheaths_[at(part.sheath_before)].from_exit;
      sheath.from_entry = -came;
      const double gain = sheath.start.stretch(sheath.law) - sheath.end.stretch(sheath.law);
      sheath.from_exit = gain - sheath.from_entry;
    }
  }
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

void Sheaths::finish(const CompiledCable& cable, FeatureState& next) {
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
  }
}

}  // namespace sheave
