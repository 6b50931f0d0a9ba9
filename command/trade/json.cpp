// sheave trade: the numbers for programs, as JSON and CSV.

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/trade/table.h"

namespace sheave::command {
namespace {

using TradeJson = nlohmann::ordered_json;

TradeJson trade_error_json(const measure::RunError& error) {
  return {{"position", error.position},
          {"position_end", error.position_end},
          {"tension", error.tension},
          {"energy", error.energy}};
}

TradeJson trade_setting_json(const TradeSetting& setting) {
  const StepSettings& step = setting.step;
  TradeJson object{{"dt", step.dt},
                   {"substeps", step.substeps},
                   {"iterations", step.iterations},
                   {"solver", solver_names[static_cast<std::size_t>(step.solver)]},
                   {"integrator", integrator_names[static_cast<std::size_t>(step.integrator)]}};
  if (step.tolerance > 0.0) object["tolerance"] = step.tolerance;
  if (setting.tangents) {
    object["tangent_update"] = tangent_update_names[static_cast<std::size_t>(*setting.tangents)];
  }
  return object;
}

TradeJson trade_spread_json(const measure::Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lower},
          {"upper_quartile", spread.upper},
          {"minimum", spread.minimum},
          {"samples", spread.count}};
}

TradeJson trade_row_json(const TradeRow& row) {
  TradeJson object{{"name", row.setting.name()}, {"settings", trade_setting_json(row.setting)}};
  object["expected_seconds"] = row.expected_seconds;
  if (!row.measured()) {
    object[row.skipped.empty() ? "fault" : "skipped"] =
        row.skipped.empty() ? row.fault : row.skipped;
    return object;
  }
  object["timed_alone"] = row.timed_alone;
  object["seconds_per_simulated_second"] = trade_spread_json(row.seconds);
  object["row_solves_per_simulated_second"] = row.row_solves;
  object["error"] = trade_error_json(row.error);
  object["stretch"] = row.stretch;
  object["length_error"] = row.length_error;
  object["fallbacks"] = row.fallbacks;
  object["on_front"] = row.on_front;
  return object;
}

TradeJson reference_json(const TradeTable& table) {
  const measure::Reference& reference = table.reference;
  return {{"solver", "direct"},
          {"integrator", integrator_names[static_cast<std::size_t>(reference.integrator)]},
          {"substeps", reference.substeps},
          {"tolerance", reference.tolerance},
          {"order", reference.order},
          {"good", reference.good},
          {"error", trade_error_json(reference.estimate)},
          {"error_compared", trade_error_json(table.doubt)},
          {"chaos_rate", table.chaos_rate ? TradeJson(*table.chaos_rate) : TradeJson()}};
}

TradeJson trade_rung_json(const LadderRow& row) {
  TradeJson object{
      {"name", row.name}, {"change", row.change}, {"changed", row.changed}, {"things", row.things}};
  if (!row.fault.empty()) {
    object["fault"] = row.fault;
    return object;
  }
  object["difference"] = {{"position", row.difference.position},
                          {"tension", row.difference.tension}};
  object["seconds_per_simulated_second"] = trade_spread_json(row.seconds);
  object["row_solves_per_simulated_second"] = row.row_solves;
  return object;
}

TradeJson ladder_json(const TradeTable& table) {
  if (!table.ladder) return {};
  const TradeLadder& ladder = *table.ladder;
  if (!ladder.skipped.empty()) return {{"skipped", ladder.skipped}};
  TradeJson object{{"setting", ladder.setting.name()},
                   {"settings", trade_setting_json(ladder.setting)},
                   {"setting_error", ladder.setting_error},
                   {"seconds_per_simulated_second", trade_spread_json(ladder.seconds)},
                   {"row_solves_per_simulated_second", ladder.row_solves},
                   {"rungs", TradeJson::array()},
                   {"absent", ladder.absent}};
  for (const LadderRow& row : ladder.rows) object["rungs"].push_back(trade_rung_json(row));
  return object;
}

/// A cell in CSV notation, quoted if it contains a comma or a quote.
std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace

std::string trade_json(const TradeTable& table) {
  TradeJson object{{"format", "sheave-trade/1"},
                   {"version", table.version},
                   {"machine",
                    {{"cpu", table.machine.cpu},
                     {"cores", table.machine.cores},
                     {"compiler", table.machine.compiler},
                     {"assertions", table.machine.assertions}}},
                   {"scene", table.scene},
                   {"repetitions", table.repetitions},
                   {"simulated_seconds", table.simulated_seconds},
                   {"compared_seconds", table.compared_seconds},
                   {"motion", table.motion},
                   {"reference", reference_json(table)},
                   {"rows", TradeJson::array()},
                   {"orders", TradeJson::array()},
                   {"cheapest", TradeJson::array()},
                   {"minutes", table.most_minutes},
                   {"limits", table.limits},
                   {"ladder", ladder_json(table)}};
  for (const TradeRow& row : table.rows) object["rows"].push_back(trade_row_json(row));
  for (const TradeFamily& family : table.families) {
    object["orders"].push_back({{"family", family.name},
                                {"order", family.fit ? TradeJson(family.fit->order) : TradeJson()},
                                {"steps", family.fit ? family.fit->points : 0}});
  }
  for (const double level : trade_levels) {
    const auto choice = answer(table, {.error = level});
    object["cheapest"].push_back(
        {{"error", level},
         {"row", choice ? TradeJson(table.rows[*choice].setting.name()) : TradeJson()}});
  }
  return object.dump(2) + "\n";
}

std::string trade_csv(const TradeTable& table) {
  std::string text =
      "solver,integrator,substeps,iterations,tangent_update,seconds_per_simulated_second,"
      "lower_quartile,upper_quartile,row_solves_per_simulated_second,position_error,"
      "reference_error,tension_error,energy_error,stretch,length_error,on_front,fault,skipped,"
      "samples,tolerance\n";
  for (const TradeRow& row : table.rows) {
    const StepSettings& step = row.setting.step;
    const auto tangents = row.setting.tangents;
    text += fmt::format("{},{},{},{},{},", solver_names[static_cast<std::size_t>(step.solver)],
                        integrator_names[static_cast<std::size_t>(step.integrator)], step.substeps,
                        step.iterations,
                        tangents ? tangent_update_names[static_cast<std::size_t>(*tangents)] : "");
    if (row.measured()) {
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},,,{},{}\n", row.seconds.median,
                      row.seconds.lower, row.seconds.upper, row.row_solves, row.error.position,
                      table.doubt.position, row.error.tension, row.error.energy, row.stretch,
                      row.length_error, row.on_front ? 1 : 0, row.seconds.count, step.tolerance);
    } else {
      text += ",,,,,,,,,,," + quoted_cell(row.fault) + "," + quoted_cell(row.skipped) +
              fmt::format(",,{}\n", step.tolerance);
    }
  }
  return text;
}

}  // namespace sheave::command
