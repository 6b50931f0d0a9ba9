// The history of ropes as JSON.

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "command/output/file.h"
#include "command/run/rope_files.h"

namespace sheave::command {
namespace {

using RopeJson = nlohmann::ordered_json;

constexpr int range_bins = 16;

/// Null for a damage without a value.
RopeJson damage_json(double damage) {
  return std::isfinite(damage) ? RopeJson(damage) : RopeJson();
}

RopeJson rope_json(const measure::SectionHistory& section, const RopeOptions& options) {
  const std::optional<double>& diameter = options.diameter;
  RopeJson bends = RopeJson::array();
  for (const measure::SectionBends& one : section.bends) {
    bends.push_back({{"link", one.link},
                     {"bends", one.bends},
                     {"reverse", one.reverse},
                     {"diameter", one.diameter},
                     {"diameter_ratio", diameter ? RopeJson(one.diameter / *diameter) : RopeJson()},
                     {"most_tension", one.most_tension},
                     {"mean_tension", one.mean_tension}});
    if (options.life.empty()) continue;
    bends.back()["simple_damage"] = damage_json(one.simple_damage);
    bends.back()["reverse_damage"] = damage_json(one.reverse_damage);
  }
  double largest = 0.0;
  double count = 0.0;
  for (const measure::LoadCycle& cycle : section.cycles) {
    largest = std::max(largest, cycle.range);
    count += cycle.count;
  }
  RopeJson object{{"from", section.from},
                  {"to", section.to},
                  {"most_tension", section.most_tension},
                  {"least_tension", section.least_tension},
                  {"mean_tension", section.mean_tension},
                  {"bends", std::move(bends)},
                  {"cycles",
                   {{"count", count},
                    {"largest_range", largest},
                    {"histogram", measure::range_histogram(section.cycles, range_bins)}}}};
  if (!options.life.empty()) object["damage"] = damage_json(section.damage());
  return object;
}

RopeJson rope_json(const measure::CableHistory& cable, const RopeOptions& options) {
  RopeJson sections = RopeJson::array();
  for (const measure::SectionHistory& section : cable.sections) {
    sections.push_back(rope_json(section, options));
  }
  RopeJson slack = RopeJson::array();
  for (const measure::SpanSlack& one : cable.slack) {
    slack.push_back({{"span", one.span}, {"longest", one.longest}, {"deepest", one.deepest}});
  }
  RopeJson layers = RopeJson::array();
  for (const measure::LayerTravel& one : cable.layers) {
    layers.push_back({{"link", one.link}, {"turns", one.turns}, {"travel", one.travel}});
  }
  return {{"name", cable.cable},        {"followed", cable.followed},
          {"returned", cable.returned}, {"sections", std::move(sections)},
          {"slack", std::move(slack)},  {"drum_travel", std::move(layers)}};
}

}  // namespace

void write_rope_json(const std::string& path, const RopeOptions& options,
                     const std::vector<measure::CableHistory>& histories) {
  RopeJson cables = RopeJson::array();
  for (const measure::CableHistory& cable : histories) cables.push_back(rope_json(cable, options));
  const RopeJson object{
      {"format", "sheave-rope-history/1"},
      {"rope_diameter", options.diameter ? RopeJson(*options.diameter) : RopeJson()},
      {"cables", std::move(cables)}};
  OutputFile file(path);
  file.write(object.dump(-1, ' ', false, RopeJson::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace sheave::command
