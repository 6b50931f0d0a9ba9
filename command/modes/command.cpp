// sheave modes: vibration modes of a scene about its equilibrium.

#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/input/load_cases.h"
#include "command/modes/report.h"
#include "command/modes/video.h"
#include "command/registry.h"
#include "command/run/player.h"
#include "command/run/simulate.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "statics/equilibrium.h"

namespace sheave::command {
namespace {

struct ModesOptions {
  SceneOptions scene;
  CaseOptions cases;
  std::optional<double> at;
  bool as_is = false;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  std::string matrices;
  ModeVideo video;
  std::size_t count = 20;
  bool json = false;
};

int body_index(const Scene& scene, const std::string& name, const std::string& option) {
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    if (scene.model.bodies[i].name == name) return static_cast<int>(i);
  }
  throw Failure(ExitCode::usage, option + ": there is no body or joint \"" + name + "\"");
}

[[noreturn]] void fail_input(const std::string& option) {
  throw Failure(ExitCode::usage, option +
                                     ": must be force:BODY.x, torque:BODY.x (or y, z), drive:ROTOR "
                                     "of one on a fixed axle that is driven to a speed or an "
                                     "angle, or drive:JOINT of one that has a drive, with several "
                                     "coordinates drive:JOINT.COORDINATE");
}

/// The input of "drive:ram" or "drive:guide.travel"; nullopt if no joint has that name.
std::optional<ModeInput> joint_drive_input(const Scene& scene, const World& world,
                                           const std::string& name, const std::string& option) {
  const auto& joints = scene.model.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointDef& joint = *joints[j];
    if (name != joint.name && !name.starts_with(joint.name + ".")) continue;
    ModeInput input;
    input.kind = ModeInput::Kind::joint_drive;
    input.joint = static_cast<int>(j);
    int found = 0;
    std::string names;
    const auto coordinates = joint.coordinates();
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const std::string whole = joint.name + "." + std::string(coordinates[k].name);
      if (!has_joint_drive(world, input.joint, static_cast<int>(k))) continue;
      names += (names.empty() ? "" : ", ") + whole;
      if (name != joint.name && name != whole) continue;
      input.coordinate = static_cast<int>(k);
      ++found;
    }
    if (found == 1) return input;
    throw Failure(ExitCode::usage, option + ": joint \"" + joint.name + "\" has " +
                                       (names.empty() ? "no drive" : "drives of " + names));
  }
  return {};
}

/// Parses "force:load.x", "torque:hook.z", "drive:drum", "drive:ram".
ModeInput parse_input(const Scene& scene, const World& world, const std::string& text) {
  const std::string option = "--input " + text;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) fail_input(option);
  const std::string kind = text.substr(0, colon);
  std::string name = text.substr(colon + 1);
  ModeInput input;
  if (kind == "drive") {
    if (const auto joint = joint_drive_input(scene, world, name, option)) return *joint;
    input.kind = ModeInput::Kind::drive;
    input.body = body_index(scene, name, option);
    const BodyDef& body = scene.model.bodies[static_cast<std::size_t>(input.body)];
    if (body.mobility != Mobility::rotor || body.mount ||
        (body.drive != DriveKind::speed && body.drive != DriveKind::angle)) {
      fail_input(option);
    }
    return input;
  }
  if (kind != "force" && kind != "torque") fail_input(option);
  input.kind = kind == "force" ? ModeInput::Kind::force : ModeInput::Kind::torque;
  if (name.size() < 3 || name[name.size() - 2] != '.') fail_input(option);
  const char axis = name.back();
  if (axis < 'x' || axis > 'z') fail_input(option);
  input.axis = Vector3::Unit(axis - 'x');
  name.resize(name.size() - 2);
  input.body = body_index(scene, name, option);
  return input;
}

/// Moves the simulation to the state of linearisation.
void go_to_state(const ModesOptions& options, Simulation& simulation, ModesFound& found) {
  if (options.at) {
    while (simulation.world.state().time < *options.at - 1e-9) {
      const StepReport step = simulation.step();
      if (!step.ok()) throw Failure(ExitCode::diverged, step.divergence->message);
    }
  }
  if (options.as_is) return;
  found.rest = find_equilibrium(simulation);
  if (!found.rest->converged) throw Failure(ExitCode::diverged, found.rest->message);
}

/// The modes of one scene; writes its matrices, film and picture.
ModesFound modes_of(const ModesOptions& options, const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  ModesFound found;
  go_to_state(options, simulation, found);
  std::vector<ModeInput> inputs;
  for (const std::string& text : options.inputs) {
    inputs.push_back(parse_input(scene, simulation.world, text));
  }
  found.scene = scene.name.empty() ? options.scene.path : scene.name;
  found.modes = find_modes(simulation, inputs);
  found.freedoms = freedom_names(simulation);
  for (const Mode& mode : found.modes.modes) {
    found.motions.push_back(largest_motion(simulation, mode));
  }
  found.inputs = options.inputs;
  for (const BodyDef& body : scene.model.bodies) found.bodies.push_back(body.name);
  take_outputs(simulation, options.outputs, found);
  if (!options.matrices.empty()) write_matrices(options.matrices, found);
  if (!options.video.path.empty() || !options.video.still.empty()) {
    animate_mode(scene, simulation, found.modes, options.video);
  }
  return found;
}

ExitCode modes_of_cases(const ModesOptions& options) {
  std::vector<ModesFound> found;
  for (const LoadCase& one : load_cases(options.cases)) {
    ModesOptions own = options;
    apply_case(one, own.scene);
    try {
      const Scene scene = load(own.scene);
      if (found.empty()) warn_of_loads_left_out(scene);  // cases are one scene
      found.push_back(modes_of(own, scene));
    } catch (const Failure& failure) {
      throw Failure(failure.code(), fmt::format("case \"{}\": {}", one.name, failure.what()));
    }
    found.back().name = one.name;
  }
  print(options.json ? showable_json(modes_cases_json(options.scene.path, found))
                     : printable(modes_table(found, options.count)));
  return ExitCode::done;
}

ExitCode modes(const ModesOptions& options) {
  if (!options.cases.empty()) return modes_of_cases(options);
  const Scene scene = load(options.scene);
  warn_of_loads_left_out(scene);
  const ModesFound found = modes_of(options, scene);
  print(options.json ? showable_json(modes_json(options.scene.path, found))
                     : printable(modes_text(found, options.count)));
  return ExitCode::done;
}

void add_file_options(CLI::App& app, ModesOptions& options) {
  app.add_option("--matrices", options.matrices,
                 "write M, D, K, Z, A, B, C as NAME.M.npy and so on")
      ->option_text("NAME");
  app.add_option("--video", options.video.path, "write a mode as a film (.mp4; needs ffmpeg)")
      ->option_text("FILE");
  app.add_option("--mode", options.video.mode,
                 "number of the mode in film and picture, from 1; default 1")
      ->check(CLI::Range(1, 1000000))
      ->option_text("N");
  app.add_option("--amplitude", options.video.amplitude,
                 "largest displacement in the film, as a share of the scene's size; default 0.05")
      ->check(number_between(1e-6, 1.0))
      ->option_text("X");
  app.add_option("--still", options.video.still,
                 "write the mode at its largest displacement as a picture")
      ->option_text("FILE");
  app.add_option("--width", options.video.width,
                 "width of film and picture in pixels; default 1280")
      ->check(CLI::Range(least_mode_picture, most_mode_picture))
      ->option_text("N");
  app.add_option("--height", options.video.height,
                 "height of film and picture in pixels; default 720")
      ->check(CLI::Range(least_mode_picture, most_mode_picture))
      ->option_text("N");
}

}  // namespace

Action declare_modes(CLI::App& app) {
  auto options = std::make_shared<ModesOptions>();
  add_case_options(app, options->cases);
  add_scene_options(app, options->scene);
  app.add_option("--at", options->at, "simulate to this time first [s]")
      ->check(number_between(0.0, 1e9))
      ->option_text("T");
  app.add_flag("--as-is", options->as_is,
               "linearise at the present pose; default: at the equilibrium near it");
  app.add_option("--input", options->inputs,
                 "an input of B: force:BODY.x, torque:BODY.z, or the target of a drive (speed or "
                 "force), drive:ROTOR or drive:JOINT; may be repeated")
      ->option_text("INPUT")
      ->expected(1)
      ->take_all();
  app.add_option("--output", options->outputs,
                 "an output of C: a quantity, by its name in the files of sheave run, or an "
                 "expression; may be repeated")
      ->option_text("NAME")
      ->expected(1)
      ->take_all();
  add_file_options(app, *options);
  app.add_option("--count", options->count, "number of modes in the table; default 20")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 20))
      ->option_text("N");
  app.add_flag("--json", options->json, "print one JSON object, with all modes and shapes");
  for (const char* const one : {"--matrices", "--video", "--still"}) {
    app.get_option(one)->excludes(app.get_option("--case"))->excludes(app.get_option("--cases"));
  }
  app.footer(R"(Examples:
  sheave modes crane.json
  sheave modes crane.json --mode 2 --video sway.mp4
  sheave modes crane.json --case 'empty:/bodies/hook/mass=1' --case 'full:/bodies/hook/mass=5000'
  sheave modes crane.json --input 'drive:hoist winch' --output hook.y --matrices crane

Exit codes: 0 done, 2 wrong usage, 65 bad scene, 75 no equilibrium was found.)");
  return [options] { return modes(*options); };
}

}  // namespace sheave::command
