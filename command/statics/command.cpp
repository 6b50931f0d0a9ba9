// sheave statics: the equilibrium of a scene.

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/input/load_cases.h"
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
  CaseOptions cases;
  std::vector<std::string> quantities;
  std::string save_state;
  bool json = false;
};

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
  for (const LoadCase& one : load_cases(options.cases)) {
    apply_case(one, cases.emplace_back(StaticsCase{one.name, options.scene}).scene);
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
  add_case_options(app, options->cases);
  add_scene_options(app, options->scene);
  app.add_option("--load-steps", options->settings.load_steps,
                 "let gravity and forces grow from 0 in N steps; default 1")
      ->check(CLI::Range(1, 10000))
      ->option_text("N");
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
