#include "command/input/load_cases.h"

#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/failure.h"

namespace sheave::command {

void add_case_options(CLI::App& app, CaseOptions& options) {
  app.add_option("--case", options.cases,
                 "a load case: the scene with other settings or parameters, "
                 "NAME:/pointer=value;parameter=value;...; may be repeated, and makes a table")
      ->option_text("CASE")
      ->expected(1)
      ->take_all();
  app.add_option("--cases", options.table,
                 "a table of load cases, .csv or .json: the column \"case\" has their names, the "
                 "others are settings or parameters")
      ->option_text("FILE");
}

LoadCase parse_case(const std::string& text) {
  const auto refuse = [&] {
    throw Failure(
        ExitCode::usage,
        fmt::format("--case {}: must be NAME:/json/pointer=value, or NAME:parameter=value "
                    "of a scene in Jsonnet, for example --case "
                    "'full:/bodies/load/mass=500', with ; between several",
                    text));
  };
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos || colon + 1 == text.size()) refuse();
  LoadCase one{text.substr(0, colon), {}};
  std::string rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    const std::string setting = rest.substr(0, end);
    const std::size_t equals = setting.find('=');
    if (equals == 0 || equals == std::string::npos) refuse();
    one.values.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  return one;
}

std::vector<LoadCase> load_cases(const CaseOptions& options) {
  std::vector<LoadCase> cases;
  for (const std::string& text : options.cases) cases.push_back(parse_case(text));
  if (!options.table.empty()) {
    for (LoadCase& one : read_cases(options.table)) cases.push_back(std::move(one));
  }
  std::set<std::string> names;
  for (const LoadCase& one : cases) {
    if (names.insert(one.name).second) continue;
    throw Failure(ExitCode::usage, fmt::format("--case {}: two cases have this name", one.name));
  }
  return cases;
}

void apply_case(const LoadCase& one, SceneOptions& scene) {
  scene.warns = false;  // other settings than those of the state are the purpose of a case
  for (const auto& [name, value] : one.values) {
    (name.starts_with('/') ? scene.settings : scene.parameters).push_back(name + "=" + value);
  }
}

}  // namespace sheave::command
