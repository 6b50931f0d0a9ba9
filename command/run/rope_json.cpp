#include "command/run/rope_history_file.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "command/output/file.h"

namespace sheave::command {
namespace {

using RopeJson = nlohmann::ordered_json;

constexpr int range_bins = 16;

RopeJson rope_json(const measure::SectionHistory& section, const std::optional<double>& diameter) {
  RopeJson bends = RopeJson::array();
  for (const measure::SectionBends& one : section.bends) {
    bends.push_back({{"link", one.link},
                     {"bends", one.bends},
                     {"reverse", one.reverse},
                     {"diameter", one.diameter},
                     {"diameter_ratio", diameter ? RopeJson(one.diameter / *diameter) : RopeJson()},
                     {"most_tension", one.most_tension},
                     {"mean_tension", one.mean_tension}});
  }
  double largest = 0.0;
  double count = 0.0;
  for (const measure::LoadCycle& cycle : section.cycles) {
    largest = std::max(largest, cycle.range);
    count += cycle.count;
  }
  return {{"from", section.from},
          {"to", section.to},
          {"most_tension", section.most_tension},
          {"bends", std::move(bends)},
          {"cycles",
           {{"count", count},
            {"largest_range", largest},
            {"histogram", measure::range_histogram(section.cycles, range_bins)}}}};
}

RopeJson rope_json(const measure::CableHistory& cable, const std::optional<double>& diameter) {
  RopeJson sections = RopeJson::array();
  for (const measure::SectionHistory& section : cable.sections) {
    sections.push_back(rope_json(section, diameter));
  }
  RopeJson slack = RopeJson::array();
  for (const measure::SpanSlack& one : cable.slack) {
    slack.push_back({{"span", one.span}, {"longest", one.longest}, {"deepest", one.deepest}});
  }
  RopeJson layers = RopeJson::array();
  for (const measure::LayerTravel& one : cable.layers) {
    layers.push_back({{"link", one.link}, {"turns", one.turns}, {"travel", one.travel}});
  }
  return {{"name", cable.cable},
          {"followed", cable.followed},
          {"sections", std::move(sections)},
          {"slack", std::move(slack)},
          {"drum_travel", std::move(layers)}};
}

}  // namespace

void write_rope_history(const RopeHistoryOptions& options, const measure::RopeHistory& history) {
  RopeJson cables = RopeJson::array();
  for (const measure::CableHistory& cable : history.history()) {
    cables.push_back(rope_json(cable, options.diameter));
  }
  const RopeJson object{
      {"format", "sheave-rope-history/1"},
      {"rope_diameter", options.diameter ? RopeJson(*options.diameter) : RopeJson()},
      {"cables", std::move(cables)}};
  OutputFile file(options.path);
  file.write(object.dump(-1, ' ', false, RopeJson::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace sheave::command
