// sheave import: models of other programs become scenes.

#include "scenes/import/import.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "command/input/file.h"
#include "command/output/file.h"
#include "command/registry.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/one_line.h"

namespace sheave::command {
namespace {

struct ImportOptions {
  std::string path;
  std::string out = "-";
  import::Options choices;
  bool report = false;
};

ExitCode import_file(const ImportOptions& options) {
  const bool piped = options.path == "-";
  const std::string text =
      piped ? read_standard_input() : read_input(options.path, import::Limits{}.bytes);
  const std::string name = piped ? "standard input" : options.path;
  if (!import::is_model(text)) {
    throw Failure(ExitCode::bad_scene,
                  name +
                      ": is no model in XML; the first character must be \"<\". A scene in JSON "
                      "needs no import");
  }
  const import::Outcome made = import::import_model(text, name, options.choices);
  if (!made.errors.empty()) {
    std::string faults = to_text(SceneResult{{}, made.errors, SceneStatus::invalid});
    if (made.errors.size() > 1) {
      faults = std::to_string(made.errors.size()) + " faults\n" + faults;
    }
    throw Failure(ExitCode::bad_scene, faults);
  }
  SceneResult scene = load_scene_text(made.json, name);
  import::locate(scene.errors, name, made);
  if (!scene) throw Failure(ExitCode::bad_scene, to_text(scene));
  const bool to_stdout = options.out == "-";
  if (to_stdout) {
    print(showable_json(made.json));
  } else {
    write_file(options.out, made.json);
  }
  const std::string told =
      options.report ? import::report(made) : name + ": " + import::summary(made) + "\n";
  if (to_stdout) {
    print_note(told.substr(0, told.size() - 1));
  } else {
    print(printable(told));
  }
  return ExitCode::done;
}

}  // namespace

Action declare_import(CLI::App& app) {
  auto options = std::make_shared<ImportOptions>();
  app.add_option("model", options->path,
                 "Model in MJCF, URDF, OpenSim or CASPR; - reads standard input")
      ->required()
      ->option_text("MODEL");
  app.add_option("-o,--out", options->out, "file to write; default: standard output")
      ->option_text("FILE");
  app.add_option("--key", options->choices.keyframe,
                 "keyframe in which the scene starts: its name, or its number from 0; default: the "
                 "pose of the text")
      ->option_text("NAME");
  app.add_option("--folder", options->choices.folder,
                 "folder in which the files must lie that the model names, itself or below; "
                 "default: the folder of the model")
      ->option_text("DIR");
  app.add_option("--least-mass", options->choices.least_mass,
                 "mass of bodies that move and have none [kg], with a radius of gyration of 1 cm; "
                 "default: such a body is an error")
      ->check(CLI::PositiveNumber)
      ->option_text("KG");
  app.add_flag("--balance-inertia", options->choices.balances,
               "replace moments of inertia that no body has, each by the mean of the three");
  app.add_flag("--report", options->report,
               "list how each element was taken, and each one that was not");
  app.footer(R"(Examples:
  sheave import arm.xml --out arm.json --report
  sheave import arm.xml | sheave run -
  sheave import panda_description/urdf/panda.urdf --folder panda_description --out panda.json
  sheave run arm.xml

All commands that take a scene take a model, too. The last line tells how many elements were
skipped; docs/how-to/import.md has the table of elements. Exit codes: 0 done, 65 the model has
faults or no counterpart, 66 no such file, 74 a file cannot be read or written.)");
  return [options] { return import_file(*options); };
}

}  // namespace sheave::command
