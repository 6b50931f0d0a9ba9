// sheave validate: check scenes without running them.

#include <memory>

#include <CLI/CLI.hpp>

#include "tools/command.h"
#include "tools/run_summary.h"
#include "tools/scene_options.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

ExitCode validate(const std::vector<std::string>& paths) {
  ExitCode code = ExitCode::done;
  for (const std::string& path : paths) {
    const SceneResult result = load_file_or_stdin(path);
    if (result) {
      print(printable(path + ": ok\n"));
      for (const Warning& warning : scene_warnings(*result)) {
        print_warning(path + ": " + warning.message);
      }
      continue;
    }
    print_error(to_text(result));
    // Of several faults, what is wrong with a scene is what was asked for.
    if (code != ExitCode::bad_scene) code = exit_code(result);
  }
  return code;
}

}  // namespace

Action declare_validate(CLI::App& app) {
  auto paths = std::make_shared<std::vector<std::string>>();
  app.add_option("scenes", *paths, "Scene files; - reads standard input")
      ->required()
      ->option_text("SCENE...");
  app.footer(R"(Examples:
  sheave validate crane.json
  sheave validate scenes/*/*.json

Prints "ok" for each scene that can be run, with warnings on standard error, and all faults of every other one, each with file, line,
column and JSON pointer. Exit codes: 0 all are right, 65 a scene is wrong, 66 no such file, 74 a
file cannot be read.)");
  return [paths] { return validate(*paths); };
}

}  // namespace sheave::tools
