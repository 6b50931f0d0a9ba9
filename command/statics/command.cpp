// sheave statics: the equilibrium of a scene.

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/input/case_table.h"
#include "command/output/file.h"
#include "command/registry.h"
#include "command/statics/report.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "scenes/saved_state.h"

namespace sheave::command {
namespace {

struct StaticsOptions {
  SceneOptions scene;
  EquilibriumSettings settings;
  std::vector<std::string> cases;
  std::string case_table;
  std::vector<std::string> quantities;
  std::string save_state;
  bool json = false;
};

/// The scene with an additional setting or parameter, "/pointer=value" or "name=value".
void add_setting(StaticsCase& one, const std::string& text) {
  (text.starts_with('/') ? one.scene.settings : one.scene.parameters).push_back(text);
}

/// Parses "NAME:/pointer=value;parameter=value": the scene with these additional settings.
StaticsCase make_case(const StaticsOptions& options, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos || colon + 1 == text.size()) {
    throw Failure(
        ExitCode::usage,
        fmt::format("--case {}: must be NAME:/json/pointer=value, or NAME:parameter=value "
                    "of a scene in Jsonnet, for example --case "
                    "'full:/bodies/load/mass=500', with ; between several",
                    text));
  }
  StaticsCase one{text.substr(0, colon), options.scene};
  one.scene.warns = false;  // other settings than those of the state are the purpose of a case
  std::string rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    add_setting(one, rest.substr(0, end));
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  return one;
}

StaticsResult rest_of(const StaticsCase& one, const StaticsOptions& options) {
  try {
    return find_rest(one, options.settings, options.quantities);
  } catch (const Failure& failure) {
    if (one.name.empty()) throw;
    throw Failure(failure.code(), fmt::format("case \"{}\": {}", one.name, failure.what()));
  }
}

ExitCode statics(const StaticsOptions& options) {
  std::vector<StaticsCase> cases;
  for (const std::string& text : options.cases) cases.push_back(make_case(options, text));
  if (!options.case_table.empty()) {
    for (const LoadCase& row : read_cases(options.case_table)) {
      StaticsCase& one = cases.emplace_back(StaticsCase{row.name, options.scene});
      one.scene.warns = false;
      for (const auto& [name, value] : row.values) add_setting(one, name + "=" + value);
    }
  }
  if (cases.empty()) cases.push_back({"", options.scene});
  std::vector<StaticsResult> results;
  for (StaticsCase& one : cases) {
    // Cases are one scene, so one of them warns.
    one.tells_loads = results.empty();
    results.push_back(rest_of(one, options));
  }
  // A pose that is not at rest is no start of a run.
  if (!options.save_state.empty() && results.front().rest.converged) {
    const std::string bytes = saved_state(*results.front().simulation);
    OutputFile file(options.save_state);
    file.write(bytes);
    file.commit();
  }
  print(options.json ? showable_json(statics_json(options.scene.path, results))
                     : printable(statics_text(results, !options.quantities.empty())));
  ExitCode code = ExitCode::done;
  for (const StaticsResult& result : results) {
    if (result.rest.converged) continue;
    print_error((result.name.empty() ? "" : result.name + ": ") + result.rest.message);
    code = ExitCode::diverged;
  }
  return code;
}

}  // namespace

Action declare_statics(CLI::App& app) {
  auto options = std::make_shared<StaticsOptions>();
  add_scene_options(app, options->scene);
  app.add_option("--load-steps", options->settings.load_steps,
                 "let gravity and forces grow from 0 in N steps; default 1")
      ->check(CLI::Range(1, 10000))
      ->option_text("N");
  app.add_option("--case", options->cases,
                 "a load case: the scene with other settings or parameters, "
                 "NAME:/pointer=value;parameter=value;...; may be repeated, and makes a table")
      ->option_text("CASE")
      ->expected(1)
      ->take_all();
  app.add_option("--cases", options->case_table,
                 "a table of load cases, .csv or .json: the column \"case\" has their names, the "
                 "others are settings or parameters")
      ->option_text("FILE");
  app.add_option(
         "--quantity", options->quantities,
         "a quantity to print, by its name in the files of sheave run, or an expression; may be "
         "repeated; "
         "default in the table of cases: the largest tension of each cable")
      ->option_text("NAME")
      ->expected(1)
      ->take_all();
  CLI::Option* save = app.add_option("--save-state", options->save_state,
                                     "write the state at rest, for --load-state of run and render");
  save->option_text("FILE")
      ->excludes(app.get_option("--case"))
      ->excludes(app.get_option("--cases"));
  app.add_flag("--json", options->json, "print one JSON object");
  app.footer(R"(Examples:
  sheave statics crane.json
  sheave statics crane.json --case 'empty:/bodies/hook/mass=1' --case 'full:/bodies/hook/mass=5000'
  sheave statics net.json --json | jq .cases[0].cables[0].spans[0].tension

Drives hold their positions, and controllers do nothing. Slack cables are found. Statics does not
determine the forces of dry friction within its bounds; the output says where friction acts. Exit
codes: 0 at rest, 2 wrong usage, 65 bad scene, 75 no equilibrium was found.)");
  return [options] { return statics(*options); };
}

}  // namespace sheave::command
