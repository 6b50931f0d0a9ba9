// sheave bench: the table as JSON, and the comparison with a stored one.

#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/bench/table.h"
#include "command/failure.h"
#include "command/input/file.h"
#include "command/input/json_check.h"

namespace sheave::command {
namespace {

using BenchJson = nlohmann::ordered_json;

constexpr const char* baseline_format = "sheave-bench/1";

BenchJson error_json(const measure::RunError& error) {
  return {{"position", error.position},
          {"position_end", error.position_end},
          {"tension", error.tension},
          {"energy", error.energy}};
}

BenchJson settings_json(const StepSettings& step) {
  return {{"dt", step.dt},
          {"substeps", step.substeps},
          {"iterations", step.iterations},
          {"solver", solver_names[static_cast<std::size_t>(step.solver)]},
          {"integrator", integrator_names[static_cast<std::size_t>(step.integrator)]}};
}

BenchJson row_json(const BenchRow& row) {
  BenchJson json{
      {"name", row.name()},
      {"scene", row.scene},
      {"file", row.file},
      {"settings", settings_json(row.settings)},
      {"paper",
       {{"joints", row.paper_joints > 0 ? BenchJson(row.paper_joints) : BenchJson()},
        {"seconds_per_frame", row.paper_seconds ? BenchJson(*row.paper_seconds) : BenchJson()},
        {"source", row.paper_source}}}};
  if (!row.measured()) {
    json["fault"] = row.fault;
    return json;
  }
  json["joints"] = row.joints;
  json["seconds_per_frame"] = {{"median", row.seconds.median},
                               {"lower_quartile", row.seconds.lower},
                               {"upper_quartile", row.seconds.upper},
                               {"minimum", row.seconds.minimum},
                               {"samples", row.seconds.count}};
  json["paper_ratio"] =
      row.paper_seconds ? BenchJson(*row.paper_seconds / row.seconds.median) : BenchJson();
  json["error"] = error_json(row.error);
  json["reference_error"] = error_json(row.reference_error);
  json["stretch"] = row.stretch;
  json["length_error"] = row.length_error;
  json["row_solves_per_frame"] = row.row_solves;
  json["rounds_per_frame"] = row.rounds;
  json["seconds_per_row_solve"] = row.seconds_per_solve();
  json["instructions_per_frame"] = row.instructions ? BenchJson(*row.instructions) : BenchJson();
  json["fallbacks"] = row.fallbacks;
  return json;
}

JsonRule baseline_row() {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr std::int64_t most = std::int64_t{1} << 53U;
  // Non-finite numbers were written as null.
  const JsonRule number = json_optional(json_number(-largest, largest));
  const JsonRule time = json_number(0.0, largest);
  const JsonRule error = json_object(
      {{"position", number}, {"position_end", number}, {"tension", number}, {"energy", number}});
  const JsonRule settings = json_object({{"dt", time},
                                         {"substeps", json_integer(1, most)},
                                         {"iterations", json_integer(1, most)},
                                         {"solver", json_text()},
                                         {"integrator", json_text()}});
  const JsonRule paper =
      json_object({{"joints", number}, {"seconds_per_frame", number}, {"source", json_text()}});
  const JsonRule seconds = json_object({{"median", time},
                                        {"lower_quartile", time},
                                        {"upper_quartile", time},
                                        {"minimum", time},
                                        {"samples", json_integer(0, most)}});
  return json_object({{"name", json_text()},
                      {"scene", json_text()},
                      {"file", json_text()},
                      {"settings", settings},
                      {"paper", paper},
                      {"fault", json_text(), false},
                      {"joints", json_integer(0, most), false},
                      {"seconds_per_frame", seconds, false},
                      {"paper_ratio", number, false},
                      {"error", error, false},
                      {"reference_error", error, false},
                      {"stretch", number, false},
                      {"length_error", number, false},
                      {"row_solves_per_frame", number, false},
                      {"rounds_per_frame", number, false},
                      {"seconds_per_row_solve", number, false},
                      {"instructions_per_frame", number, false},
                      {"fallbacks", json_integer(0, most), false}});
}

JsonRule baseline() {
  constexpr std::int64_t most = std::int64_t{1} << 53U;
  const JsonRule anything = [](const JsonCheck&, json::NodeId) {};
  const JsonRule machine = json_object({{"cpu", json_text()},
                                        {"cores", json_integer(0, most)},
                                        {"compiler", json_text()},
                                        {"assertions", json_boolean()}});
  return json_object({{"format", json_text()},
                      {"version", json_text()},
                      {"machine", machine},
                      {"repetitions", json_integer(0, most)},
                      {"rows", json_list(baseline_row())},
                      {"references", json_list(anything)},
                      {"no_instructions", json_text(), false}});
}

BenchJson baseline_from(const std::string& path) {
  constexpr std::size_t most_bytes = std::size_t{64} << 20U;
  const std::string text = read_input(path, most_bytes);
  check_json(text, path, baseline_format, baseline());
  return BenchJson::parse(text, nullptr, false, true);
}

}  // namespace

std::string bench_json(const BenchTable& table) {
  BenchJson json{{"format", baseline_format},
                 {"version", table.version},
                 {"machine",
                  {{"cpu", table.machine.cpu},
                   {"cores", table.machine.cores},
                   {"compiler", table.machine.compiler},
                   {"assertions", table.machine.assertions}}},
                 {"repetitions", table.repetitions},
                 {"rows", BenchJson::array()},
                 {"references", BenchJson::array()}};
  for (const BenchRow& row : table.rows) json["rows"].push_back(row_json(row));
  for (const BenchReference& reference : table.references) {
    json["references"].push_back(
        {{"scene", reference.scene},
         {"substeps", reference.substeps},
         {"integrator", integrator_names[static_cast<std::size_t>(reference.integrator)]},
         {"order", reference.order},
         {"error", error_json(reference.estimate)},
         {"good", reference.good}});
  }
  if (!table.no_instructions.empty()) json["no_instructions"] = table.no_instructions;
  return json.dump(2) + "\n";
}

BenchComparison compare_with_baseline(const BenchTable& table, const std::string& path,
                                      double allowed_ratio) {
  const BenchJson baseline = baseline_from(path);
  std::map<std::string, const BenchJson*> before;
  for (const BenchJson& row : baseline["rows"]) {
    if (row.contains("seconds_per_frame")) before[row["name"].get<std::string>()] = &row;
  }
  BenchComparison comparison;
  comparison.path = path;
  const std::string cpu = baseline["machine"]["cpu"];
  if (cpu != table.machine.cpu) comparison.other_machine = cpu;
  for (const BenchRow& row : table.rows) {
    if (!row.measured()) continue;
    const auto found = before.find(row.name());
    if (found == before.end()) {
      comparison.missing.push_back(row.name());
      continue;
    }
    const BenchJson& seconds = found->second->at("seconds_per_frame");
    const double median = seconds.at("median");
    const double upper = seconds.at("upper_quartile");
    BenchChange change{row.name(), median, row.seconds.median};
    change.slower = change.ratio() > allowed_ratio && row.seconds.lower > upper;
    comparison.changes.push_back(change);
    before.erase(found);
  }
  return comparison;
}

}  // namespace sheave::command
