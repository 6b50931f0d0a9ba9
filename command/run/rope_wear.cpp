#include "command/run/rope_wear.h"

#include <cmath>

#include <fmt/format.h>

#include "command/text/table.h"

namespace sheave::command {
namespace {

bool is_more_worn(double damage, double than) {
  if (std::isnan(than)) return false;
  return std::isnan(damage) || damage > than;
}

}  // namespace

std::vector<RopeWear> most_worn(const std::vector<measure::CableHistory>& cables) {
  std::vector<RopeWear> worn;
  for (const measure::CableHistory& cable : cables) {
    const measure::SectionHistory* worst = nullptr;
    for (const measure::SectionHistory& section : cable.sections) {
      if (worst == nullptr || is_more_worn(section.damage(), worst->damage())) worst = &section;
    }
    if (worst == nullptr) continue;
    const measure::SectionBends all = worst->all_bends();
    const double damage = worst->damage();
    worn.push_back({cable.cable, worst->from, worst->to, all.bends - all.reverse, all.reverse,
                    damage, 1.0 / damage});
  }
  return worn;
}

std::vector<Warning> wear_warnings(const std::vector<measure::CableHistory>& cables) {
  std::vector<Warning> warnings;
  for (const measure::CableHistory& cable : cables) {
    std::string message;
    if (!cable.followed) {
      message =
          "the cable is closed, cut or has touched a wrappable body, so it has no sections "
          "and no damage";
    } else if (!cable.returned) {
      message =
          "the rope does not end where it began, so the run cannot be repeated from its end; "
          "let the scene return to its start for a number of repetitions";
    }
    for (const measure::SectionHistory& section : cable.sections) {
      if (!std::isnan(section.damage()) || !message.empty()) continue;
      message = fmt::format(
          "the formulas of --rope-life have no positive number for a bend of the "
          "section from {} m to {} m; check them for its tension and diameter",
          short_number(section.from), short_number(section.to));
    }
    if (message.empty()) continue;
    warnings.push_back(
        {"rope_life", cable.cable, fmt::format("cable \"{}\": {}", cable.cable, message)});
  }
  return warnings;
}

std::string wear_text(const std::vector<RopeWear>& ropes) {
  TextTable table(
      {"rope", "most worn section [m]", "simple bends", "reverse bends", "damage", "repetitions"},
      2);
  for (const RopeWear& rope : ropes) {
    const bool known = !std::isnan(rope.damage);
    table.add(
        {rope.cable, short_number(rope.from) + " ... " + short_number(rope.to),
         fmt::format("{}", rope.simple_bends), fmt::format("{}", rope.reverse_bends),
         known ? short_number(rope.damage) : "unknown",
         !known ? "unknown" : (rope.damage > 0.0 ? short_number(rope.repetitions) : "no limit")});
  }
  return table.text();
}

}  // namespace sheave::command
