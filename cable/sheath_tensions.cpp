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

#include "cable/sheath_tensions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Largest number of changes between sticking and sliding per sheath while a solution is sought.
constexpr int most_changes = 4;

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

std::vector<SheathGroup> SheathTensions::groups_of(std::vector<SheathPart>& parts) const {
  std::vector<SheathGroup> groups;
  std::vector<double> pulls(parts.size(), 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int before = parts[i].sheath_before;
    const int slides = before >= 0 && i > 0 ? sheaths_[at(before)].slides : 0;
    if (slides == 0) {
      groups.push_back({i, 1});
      continue;
    }
    ++groups.back().count;
    pulls[i] = pulls[i - 1] + slides * sheaths_[at(before)].law.exponent;
  }
  for (const SheathGroup& group : groups) {
    const auto first = pulls.begin() + static_cast<std::ptrdiff_t>(group.first);
    const double most = *std::max_element(first, first + static_cast<std::ptrdiff_t>(group.count));
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      parts[i].weight = portable::exp(pulls[i] - most);
    }
  }
  return groups;
}

SheathTensions::Gain SheathTensions::boundary_gain(const std::vector<SheathPart>& parts,
                                                   std::size_t part, bool behind,
                                                   double tension) const {
  const int place = behind ? parts[part].sheath_behind : parts[part].sheath_before;
  if (place < 0) return {};
  const cable_parts::SheathWork& sheath = sheaths_[at(place)];
  const SheathLaw& law = sheath.law;
  if (!(tension > 0.0)) return {sheath.start.stretch(law), 0.0};
  const double pull = portable::log(tension);
  const double beyond = pull_of(parts[behind ? part + 1 : part - 1].tension);
  const double other = held_pull(beyond, pull, law.exponent);
  const double old = behind ? sheath.start.entry() : sheath.start.exit();
  const double other_old = behind ? sheath.start.exit() : sheath.start.entry();
  // Fronts meet where both ends pull rope out, or both let rope in. If one end pulls and the other
  // one gives way, rope moves the same way in both fronts, and the stuck rope between them ends where
  // all of it slides.
  const bool meets = (pull > old) == (beyond > other_old);
  SheathProfile profile = sheath.start;
  double from = 0.0;
  double to = 1.0;
  if (behind) {
    to = profile.limit_from_entry(pull, law.exponent);
    if (meets) to = std::min(to, profile.limit_from_exit(other, law.exponent));
  } else {
    from = profile.limit_from_exit(pull, law.exponent);
    if (meets) from = std::max(from, profile.limit_from_entry(other, law.exponent));
  }
  const double before = sheath.start.stretch(law, from, to);
  const double rise = pull > old ? -law.exponent : law.exponent;
  const FrontStretch front = front_stretch(law, tension, rise, to - from);
  // The rope holds against a change below rounding.
  const bool holds = std::abs(pull - old) < least_pull_change;
  return {before - front.stretch, holds ? 0.0 : front.slope};
}

SheathTensions::Gain SheathTensions::missing(const std::vector<SheathPart>& parts,
                                             const SheathGroup& group, double tension) const {
  const std::size_t last = group.first + group.count - 1;
  Gain sum;
  for (std::size_t i = group.first; i <= last; ++i) {
    const SheathPart& part = parts[i];
    const double yield = yield_ * part.weight;
    const double strain = tension * yield;
    const cable_parts::StretchedSpan& span = part.stretched;
    const double rest_length = span.length / (1.0 + strain);
    const double mean = 1.0 + 0.5 * (span.start_strain + strain);
    sum.length += rest_length - span.rest_length_at(strain);
    sum.slope += yield * (rest_length / (1.0 + strain) + 0.5 * span.on / (mean * mean));
    if (i == last) continue;
    const cable_parts::SheathWork& sheath = sheaths_[at(part.sheath_behind)];
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

void SheathTensions::solve_group(std::vector<SheathPart>& parts, const SheathGroup& group) const {
  const auto finish = [&](double tension) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      parts[i].tension = parts[i].weight * tension;
    }
  };
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  const SheathPart& heaviest = *std::max_element(
      parts.begin() + static_cast<std::ptrdiff_t>(group.first),
      parts.begin() + static_cast<std::ptrdiff_t>(group.first + group.count),
      [](const SheathPart& a, const SheathPart& b) { return a.weight < b.weight; });
  double tension = heaviest.tension;
  if (!(tension > 0.0)) tension = 1e-6 / yield_;
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

void SheathTensions::solve(std::vector<SheathPart>& parts) const {
  const std::vector<SheathGroup> groups = groups_of(parts);
  for (SheathPart& part : parts) part.gap = 0.0;
  // Groups are independent unless fronts meet in a sheath between them.
  constexpr int most_rounds = 60;
  constexpr double rounding = 1e-14;
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0.0;
    for (const SheathGroup& group : groups) {
      const double before = parts[group.first].tension;
      solve_group(parts, group);
      const double now = parts[group.first].tension;
      change = std::max(change, std::abs(now - before) / std::max(std::max(now, before), 1e-300));
    }
    if (groups.size() == 1 || !(change > rounding)) break;
  }
  for (const SheathGroup& group : groups) {
    const std::size_t last = group.first + group.count - 1;
    double weights = 0.0;
    for (std::size_t i = group.first; i <= last; ++i) weights += parts[i].weight;
    for (std::size_t i = group.first; i <= last; ++i) {
      SheathPart& part = parts[i];
      const double strain = part.tension * yield_;
      const cable_parts::StretchedSpan& span = part.stretched;
      const double mean = 1.0 + 0.5 * (span.start_strain + strain);
      double slope = yield_ * (span.length / ((1.0 + strain) * (1.0 + strain)) +
                               0.5 * span.on / (mean * mean));
      if (i == group.first) slope += boundary_gain(parts, i, false, part.tension).slope;
      if (i == last) slope += boundary_gain(parts, i, true, part.tension).slope;
      // The rope in a sheath that slides counts with the spans of its group in equal parts.
      for (std::size_t k = group.first; k < last; ++k) {
        const cable_parts::SheathWork& sheath = sheaths_[at(parts[k].sheath_behind)];
        slope +=
            parts[k].weight / weights *
            front_stretch(sheath.law, parts[k].tension, sheath.slides * sheath.law.exponent, 1.0)
                .slope;
      }
      part.compliance = (1.0 + strain) * slope;
    }
  }
}

double SheathTensions::excess_of(const std::vector<SheathPart>& parts, std::size_t part) const {
  const cable_parts::SheathWork& sheath = sheaths_[at(parts[part].sheath_behind)];
  const double before = parts[part].tension;
  const double behind = parts[part + 1].tension;
  // An end without tension holds nothing.
  if (!(before > 0.0 && behind > 0.0)) return sheath.slides == 0 ? 1.0 : 0.0;
  if (sheath.law.exponent == 0.0) return 0.0;
  if (sheath.slides == 0) {
    return std::abs(pull_of(behind) - pull_of(before)) - sheath.law.exponent - pull_rounding;
  }
  // Rope that slides as a whole comes in at one end and goes out at the other one.
  constexpr double rounding = 1e-13;  // of the length
  const double back = sheath.slides > 0 ? std::max(-sheath.from_entry, sheath.from_exit)
                                        : std::max(sheath.from_entry, -sheath.from_exit);
  return back / sheath.law.length - rounding;
}

void SheathTensions::solve_freely(std::vector<SheathPart>& parts) {
  int sheaths = 0;
  for (const SheathPart& part : parts) {
    if (part.sheath_behind < 0) continue;
    cable_parts::SheathWork& sheath = sheaths_[at(part.sheath_behind)];
    sheath.slides = sheath.law.exponent > 0.0 ? 0 : 1;
    ++sheaths;
  }
  // One change at a time, since a sheath whose rope slides changes the tensions beside the others.
  for (int change = 0; change <= most_changes * sheaths; ++change) {
    solve(parts);
    find_flows(parts);
    double most = 0.0;
    std::size_t worst = parts.size();
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      if (parts[i].sheath_behind < 0) continue;
      const double excess = excess_of(parts, i);
      if (!(excess > most)) continue;
      most = excess;
      worst = i;
    }
    if (worst == parts.size()) return;
    cable_parts::SheathWork& sheath = sheaths_[at(parts[worst].sheath_behind)];
    const double rise = parts[worst + 1].tension - parts[worst].tension;
    sheath.slides = sheath.slides != 0 ? 0 : rise > 0.0 ? 1 : -1;
  }
}

void SheathTensions::find_flows(const std::vector<SheathPart>& parts) {
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (parts[i].sheath_behind < 0) continue;
    cable_parts::SheathWork& sheath = sheaths_[at(parts[i].sheath_behind)];
    if (sheath.slides != 0) continue;
    sheath.from_entry = boundary_gain(parts, i, true, parts[i].tension).length;
    sheath.from_exit = boundary_gain(parts, i + 1, false, parts[i + 1].tension).length;
  }
  // Where the whole rope slides, the length that passes one end of a sheath follows from that of
  // the other end and the spans between them.
  std::vector<SheathPart> weighted = parts;
  for (const SheathGroup& group : groups_of(weighted)) {
    double length = 0.0;
    const bool taut = parts[group.first].tension > 0.0;
    const double spare = taut ? 0.0 : parts[group.first].gap;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      length += parts[i].stretched.length;
    }
    for (std::size_t i = group.first; i + 1 < group.first + group.count; ++i) {
      const SheathPart& part = parts[i];
      cable_parts::SheathWork& sheath = sheaths_[at(part.sheath_behind)];
      const double strain = part.tension * yield_;
      double rest_length = part.stretched.length / (1.0 + strain);
      if (!taut && length > 0.0) rest_length += spare * (part.stretched.length / length);
      double came = rest_length - part.stretched.rest_length_at(strain);
      if (part.sheath_before >= 0) came += sheaths_[at(part.sheath_before)].from_exit;
      sheath.from_entry = -came;
      const SheathProfile end(part.tension, parts[i + 1].tension);
      const double gain = sheath.start.stretch(sheath.law) - end.stretch(sheath.law);
      sheath.from_exit = gain - sheath.from_entry;
    }
  }
}

void SheathTensions::settle(const std::vector<SheathPart>& parts) {
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (parts[i].sheath_behind < 0) continue;
    cable_parts::SheathWork& sheath = sheaths_[at(parts[i].sheath_behind)];
    sheath.end = sheath.start;
    if (sheath.slides != 0 || !(parts[i].tension > 0.0)) {
      sheath.end = SheathProfile(parts[i].tension, parts[i + 1].tension);
    } else {
      sheath.end.limit_from_entry(pull_of(parts[i].tension), sheath.law.exponent);
      sheath.end.limit_from_exit(pull_of(parts[i + 1].tension), sheath.law.exponent);
      sheath.end.shorten(sheath.law);
    }
  }
  find_flows(parts);
}

}  // namespace sheave
