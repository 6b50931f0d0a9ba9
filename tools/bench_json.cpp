// sheave bench: the table as JSON, and comparing with one that was kept.

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench_table.h"
#include "tools/failure.h"

namespace sheave::tools {
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

BenchJson baseline_from(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Failure(ExitCode::no_input, path + ": no such file");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  BenchJson json = BenchJson::parse(text, nullptr, false);
  const bool right = json.is_object() && json.value("format", BenchJson()) == baseline_format &&
                     json.contains("rows") && json["rows"].is_array();
  if (!right) {
    throw Failure(ExitCode::bad_scene,
                  fmt::format("{}: no baseline: it must be a file of `sheave bench --save`, an "
                              "object with \"format\": \"{}\"",
                              path, baseline_format));
  }
  return json;
}

/// A number at a JSON pointer of a row.
double number_at(const BenchJson& row, const std::string& pointer, const std::string& path) {
  const BenchJson::json_pointer place(pointer);
  if (row.contains(place) && row.at(place).is_number()) return row.at(place).get<double>();
  throw Failure(ExitCode::bad_scene, path + ": no baseline: a row has no number at " + pointer);
}

std::string cpu_of(const BenchJson& baseline) {
  const BenchJson::json_pointer place("/machine/cpu");
  const bool known = baseline.contains(place) && baseline.at(place).is_string();
  return known ? baseline.at(place).get<std::string>() : "unknown";
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
    const bool named = row.is_object() && row.contains("name") && row["name"].is_string();
    if (!named) throw Failure(ExitCode::bad_scene, path + ": no baseline: a row has no name");
    if (row.contains("seconds_per_frame")) before[row["name"].get<std::string>()] = &row;
  }
  BenchComparison comparison;
  comparison.path = path;
  if (cpu_of(baseline) != table.machine.cpu) comparison.other_machine = cpu_of(baseline);
  for (const BenchRow& row : table.rows) {
    if (!row.measured()) continue;
    const auto found = before.find(row.name());
    if (found == before.end()) {
      comparison.missing.push_back(row.name());
      continue;
    }
    const double median = number_at(*found->second, "/seconds_per_frame/median", path);
    const double upper = number_at(*found->second, "/seconds_per_frame/upper_quartile", path);
    BenchChange change{row.name(), median, row.seconds.median};
    change.slower = change.ratio() > allowed_ratio && row.seconds.lower > upper;
    comparison.changes.push_back(change);
    before.erase(found);
  }
  return comparison;
}

}  // namespace sheave::tools
