// sheave stress: maps as JSON.

#include <cmath>

#include <sheave_version.h>

#include <nlohmann/json.hpp>

#include "command/stress/table.h"

namespace sheave::command {
namespace {

using StressJson = nlohmann::ordered_json;

StressJson cell_json(const StressResult& result, std::size_t i) {
  const measure::StressCell& cell = result.map.cells[i];
  const StressOutcome& outcome = result.outcomes[i];
  return {{"x", cell.x},
          {"y", cell.y},
          {"outcome", measure::stress_kind_names[static_cast<std::size_t>(outcome.verdict.kind)]},
          // JSON cannot express infinity.
          {"error",
           std::isfinite(outcome.verdict.error) ? StressJson(outcome.verdict.error) : StressJson()},
          {"detail", outcome.verdict.detail},
          {"warnings", outcome.warnings},
          {"doubt", outcome.doubt},
          {"silent", outcome.silent()},
          {"command", cell.command(result.settings.solver, result.settings.integrator)}};
}

}  // namespace

std::string stress_json(const std::vector<StressResult>& results) {
  StressJson maps = StressJson::array();
  for (const StressResult& result : results) {
    StressJson cells = StressJson::array();
    for (std::size_t i = 0; i < result.outcomes.size(); ++i) cells.push_back(cell_json(result, i));
    maps.push_back(
        {{"name", result.map.name},
         {"meaning", result.map.meaning},
         {"solver", solver_names[static_cast<std::size_t>(result.settings.solver)]},
         {"integrator", integrator_names[static_cast<std::size_t>(result.settings.integrator)]},
         {"x", {{"name", result.map.x.name}, {"values", result.map.x.values}}},
         {"y", {{"name", result.map.y.name}, {"values", result.map.y.values}}},
         {"cells", std::move(cells)}});
  }
  const StressJson object{
      {"format", "sheave-stress/1"}, {"version", version_string}, {"maps", std::move(maps)}};
  // Names of scenes may contain invalid UTF-8, which must not end the program.
  return object.dump(-1, ' ', false, StressJson::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
