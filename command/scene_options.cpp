#include "command/scene_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/input/file.h"
#include "command/input/load_cases.h"
#include "command/input/state_file.h"
#include "command/interrupt.h"
#include "command/share.h"
#include "command/terminal.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/json/document.h"
#include "scenes/start_warnings.h"

namespace sheave::command {
namespace {

/// A dedicated option for a frequently changed setting.
struct Shortcut {
  const char* option;
  const char* pointer;
  const char* meaning;
  bool number;
  std::string SceneOptions::*value;
};

constexpr std::array<Shortcut, 6> shortcuts{{
    {"--dt", "/step/dt", "time per step [s]", true, &SceneOptions::dt},
    {"--substeps", "/step/substeps", "substeps per step", true, &SceneOptions::substeps},
    {"--iterations", "/step/iterations", "solver iterations per substep", true,
     &SceneOptions::iterations},
    {"--solver", "/step/solver", "how constraint rows are solved", false, &SceneOptions::solver},
    {"--integrator", "/step/integrator", "how the motion is integrated over time", false,
     &SceneOptions::integrator},
    {"--duration", "/duration", "time to simulate [s]", true, &SceneOptions::duration},
}};

std::string choices(const Shortcut& shortcut) {
  std::string text;
  for (const Field& field : StepSettings::field_table()) {
    if (!std::string_view(shortcut.pointer).ends_with("/" + std::string(field.name))) continue;
    for (const std::string_view choice : field.choices) {
      text += (text.empty() ? ": " : ", ") + std::string(choice);
    }
  }
  return text;
}

/// A number in JSON notation: ".5" and "+5" are allowed on a command line, but not in JSON.
std::string json_number_text(const std::string& text) {
  return number_text(std::strtod(text.c_str(), nullptr));
}

/// Parses the override "/json/pointer=value".
Override parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || text.front() != '/') {
    throw Failure(ExitCode::usage, fmt::format("--set {}: must be /json/pointer=value, for example "
                                               "--set /bodies/drum/mass=2",
                                               text));
  }
  const std::string pointer = text.substr(0, equals);
  return {pointer, text.substr(equals + 1), "--set " + pointer};
}

/// The size of the scene's machine [m].
double size_of_machine(const Scene& scene) {
  const Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) throw Failure(ExitCode::bad_scene, to_text(simulation.errors()));
  return simulation->world.bodies().scale();
}

}  // namespace

GivenTolerance parse_tolerance(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}}};
  if (text.ends_with('%')) return {positive_share("--tolerance", text), true};
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  const std::string_view unit(end);
  bool known = unit.empty();
  for (const auto& [name, metres] : units) {
    if (unit != name) continue;
    value *= metres;
    known = true;
  }
  if (!known || !(value > 0.0) || !std::isfinite(value)) {
    throw Failure(ExitCode::usage,
                  fmt::format("--tolerance {}: must be a length above 0 in um, mm, cm or m, or a "
                              "share of the machine's size, for example --tolerance 0.1mm or "
                              "--tolerance 0.01%",
                              text));
  }
  return {value, false};
}

double tolerance_of(const GivenTolerance& given, const Scene& scene) {
  return given.share ? given.value * size_of_machine(scene) : given.value;
}

namespace {

/// Sets a share of the machine's size; a length is set by an override.
void set_tolerance(const GivenTolerance& given, Scene& scene) {
  if (!given.share) return;
  scene.model.step.tolerance = tolerance_of(given, scene);
  const Errors errors = Simulation::check(scene.model, scene.cables);
  if (!errors.empty()) throw Failure(ExitCode::usage, "--tolerance: " + errors.front().message);
}

std::vector<Override> overrides(const SceneOptions& options) {
  std::vector<Override> list;
  for (const std::string& setting : options.settings) list.push_back(parse_setting(setting));
  for (const Shortcut& shortcut : shortcuts) {
    const std::string& value = options.*shortcut.value;
    if (value.empty()) continue;
    list.push_back(
        {shortcut.pointer, shortcut.number ? json_number_text(value) : value, shortcut.option});
  }
  if (!options.tolerance.empty()) {
    const GivenTolerance given = parse_tolerance(options.tolerance);
    // load() multiplies a share by the size.
    list.push_back(
        {"/step/tolerance", number_text(given.share ? 1.0 : given.value), "--tolerance"});
  }
  if (options.from_rest) list.push_back({"/start", "rest", "--from-rest"});
  return list;
}

std::vector<SceneParameter> parameters(const SceneOptions& options) {
  std::vector<SceneParameter> list;
  for (const std::string& text : options.parameters) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Failure(ExitCode::usage, fmt::format("--param {}: must be NAME=VALUE, for example "
                                                 "--param load=200",
                                                 text));
    }
    list.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return list;
}

}  // namespace

void add_scene_options(CLI::App& app, SceneOptions& options) {
  app.add_option(
         "scene", options.path,
         "Scene file (JSON, .jsonnet, or a model as import reads it); - reads standard input")
      ->required()
      ->option_text("SCENE");
  add_scene_changes(app, options);
}

void add_scene_changes(CLI::App& app, SceneOptions& options) {
  for (const Shortcut& shortcut : shortcuts) {
    const char* group = "In place of the scene's settings";
    CLI::Option* option = app.add_option(shortcut.option, options.*shortcut.value,
                                         shortcut.meaning + choices(shortcut));
    option->group(group)->option_text(shortcut.number ? "X" : "NAME");
    if (shortcut.number) option->check(finite_number());
  }
  // `tune` has an option of this name of its own; there --set /step/tolerance=1e-4 sets this one.
  if (app.get_option_no_throw("--tolerance") == nullptr) {
    app.add_option("--tolerance", options.tolerance,
                   "in place of substeps: the error of positions that one second may add, as a "
                   "length (0.1mm) or a share of the machine's size (0.01%)")
        ->group("In place of the scene's settings")
        ->option_text("LENGTH");
  }
  app.add_option("--set", options.settings,
                 "any setting, by its JSON pointer, with names or numbers "
                 "(/bodies/drum/mass, /joints/0/drive); may be "
                 "repeated")
      ->group("In place of the scene's settings")
      ->option_text("/POINTER=VALUE")
      ->expected(1)
      ->take_all();
  add_start_options(app, options);
  add_jsonnet_options(app, options);
  add_case_option(app, options);
}

void add_case_option(CLI::App& app, SceneOptions& options) {
  if (app.get_option_no_throw("--case") != nullptr) return;
  // CLI11 takes options in this order, so the settings of the case replace the other ones.
  app.add_option_function<std::string>(
         "--case", [&options](const std::string& text) { apply_case(parse_case(text), options); },
         "a load case: the scene with other settings or parameters, "
         "NAME:/pointer=value;parameter=value;...")
      ->group("In place of the scene's settings")
      ->option_text("CASE");
}

void add_start_options(CLI::App& app, SceneOptions& options) {
  const char* const group = "In place of the scene's start";
  CLI::Option* const rest =
      app.add_flag("--from-rest", options.from_rest,
                   "start at rest, in the equilibrium near the pose of the scene");
  rest->group(group);
  app.add_option("--load-state", options.load_state,
                 "start from a saved state (--save-state of run and statics)")
      ->group(group)
      ->option_text("FILE")
      ->excludes(rest);
}

void add_jsonnet_options(CLI::App& app, SceneOptions& options) {
  const char* const group = "For a scene in Jsonnet";
  app.add_option("--param", options.parameters,
                 "a parameter of the scene: a number, a text or JSON; may be repeated")
      ->group(group)
      ->option_text("NAME=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--import-from", options.import_folders,
                 "another folder for its imports; may be repeated")
      ->group(group)
      ->option_text("FOLDER")
      ->expected(1)
      ->take_all();
}

std::string read_standard_input() {
  // The loader refuses longer texts; one byte more than the limit lets it notice.
  return read_standard_input(json::Limits{}.bytes);
}

SceneResult load_file_or_stdin(const std::string& path, const std::vector<Override>& overrides,
                               const JsonnetOptions& jsonnet) {
  std::error_code code;
  // A pipe may wait for its writer, and a signal must end the wait.
  if (path != "-" && std::filesystem::is_fifo(path, code)) {
    const std::string text = read_input(path, json::Limits{}.bytes);
    return load_scene_text(text, path, overrides, jsonnet);
  }
  if (path != "-") return load_scene(path, overrides, jsonnet);
  return load_scene_text(read_standard_input(), "standard input", overrides, jsonnet);
}

JsonnetOptions jsonnet_options(const SceneOptions& options) {
  return {parameters(options), options.import_folders};
}

Scene load(const SceneOptions& options) {
  const JsonnetOptions jsonnet = jsonnet_options(options);
  SceneResult result =
      options.text ? load_scene_text(*options.text, options.path, overrides(options), jsonnet)
                   : load_file_or_stdin(options.path, overrides(options), jsonnet);
  if (result) {
    Scene& scene = *result.scene;
    if (!result.notice.empty()) print_warning(printable_line(options.path + ": " + result.notice));
    if (!options.tolerance.empty()) set_tolerance(parse_tolerance(options.tolerance), scene);
    if (!options.load_state.empty()) {
      scene.start_state = read_state(scene, options.load_state, options.warns);
    }
    if (options.tells_strains) {
      for (const Warning& warning : strain_warnings(scene)) print_warning(warning.message);
    }
    return std::move(scene);
  }
  if (result.status == SceneStatus::unreadable && interrupted()) {
    throw Failure(ExitCode::interrupted, printable_line(options.path) + ": not read: interrupted");
  }
  const ExitCode code = exit_code(result);
  // A single error is printed in the same line; a list begins in a new line.
  std::string text = to_text(result);
  if (result.errors.size() > 1) text = fmt::format("{} faults\n{}", result.errors.size(), text);
  throw Failure(code, text);
}

void warn_of_loads_left_out(const Scene& scene) {
  if (scene.loads.empty()) return;
  std::string names;
  for (const auto& load : scene.loads) {
    names += (names.empty() ? "\"" : ", \"") + load->name + "\"";
  }
  print_warning(printable_line("the loads " + names +
                               " act in runs alone and are left out; a constant force belongs "
                               "into \"force\" or \"torque\" of its body"));
}

ExitCode exit_code(const SceneResult& result) {
  switch (result.status) {
    case SceneStatus::ok:
      return ExitCode::done;
    case SceneStatus::not_found:
      return ExitCode::no_input;
    case SceneStatus::unreadable:
      return ExitCode::io;
    case SceneStatus::invalid:
      break;
  }
  const bool all_from_options =
      std::all_of(result.errors.begin(), result.errors.end(),
                  [](const SceneError& error) { return error.file.starts_with("--"); });
  return all_from_options ? ExitCode::usage : ExitCode::bad_scene;
}

std::string to_text(const SceneResult& result) {
  std::string text;
  for (SceneError error : result.errors) {
    // The option itself is the position of an error in its value.
    if (error.file.starts_with("--")) {
      error.line = 0;
      if (error.file.ends_with(error.pointer) || !error.file.starts_with("--set")) {
        error.pointer.clear();
      }
    }
    if (!text.empty()) text += '\n';
    // Names of files and keys of scenes may have line breaks.
    error.file = printable_line(error.file);
    error.pointer = printable_line(error.pointer);
    text += to_string(error);
  }
  return text;
}

double start_time(const Scene& scene) {
  return scene.start_state == nullptr ? 0.0 : scene.start_state->time;
}

std::int64_t step_count(const Scene& scene) {
  // Above this bound a double cannot count single steps, and no run would end.
  constexpr double most = 9e15;
  const double steps = std::round(scene.duration / scene.model.step.dt);
  return static_cast<std::int64_t>(std::clamp(steps, 1.0, most));
}

}  // namespace sheave::command
