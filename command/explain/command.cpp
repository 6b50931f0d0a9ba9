// sheave explain: the content of a scene, in sentences.

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/explain/explain.h"
#include "command/registry.h"
#include "command/run/player.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/table.h"

namespace sheave::command {
namespace {

std::string run_sentence(const Scene& scene) {
  const StepSettings& step = scene.model.step;
  const Vector3& gravity = scene.model.gravity;
  const double pull = gravity.norm();
  return fmt::format("A run takes {} s in steps of {} s with {} ({}, {}); {}.",
                     short_number(scene.duration), short_number(step.dt),
                     counted(static_cast<std::size_t>(step.substeps), "substep", "substeps"),
                     solver_names[static_cast<std::size_t>(step.solver)],
                     integrator_names[static_cast<std::size_t>(step.integrator)],
                     pull > 0.0 ? fmt::format("gravity is {} m/s2 along {}", short_number(pull),
                                              direction_text(gravity / pull))
                                : std::string("there is no gravity"));
}

std::string start_sentence(const Scene& scene) {
  if (scene.start_state != nullptr) return "The state below is the one that was loaded.";
  return scene.start == Start::rest
             ? "The machine starts at rest; the state below is that equilibrium."
             : "The machine starts in the pose of the scene, which is the state below.";
}

void append_part(std::string& text, const char* title, const Sentences& sentences) {
  if (sentences.empty()) return;
  text += fmt::format("\n{}\n", title);
  for (const std::string& sentence : sentences) text += "  " + printable_line(sentence) + "\n";
}

ExitCode explain(const SceneOptions& options) {
  const Scene scene = load(options);
  Simulation simulation = make_simulation(scene);
  std::string text = printable_line(scene.name.empty() ? options.path : scene.name) + "\n";
  Sentences head;
  if (!scene.description.empty()) head.push_back(scene.description);
  head.push_back(run_sentence(scene));
  head.push_back(start_sentence(scene));
  for (const std::string& sentence : head) text += "  " + printable_line(sentence) + "\n";
  append_part(text, "Parts", explain_parts(scene, simulation));
  append_part(text, "Freedom", explain_freedom(simulation));
  append_part(text, "Cables", explain_cables(scene, simulation));
  Sentences doubts = explain_suspicions(scene, simulation);
  if (doubts.empty()) doubts.emplace_back("Nothing looks like a mistake.");
  append_part(text, "To check", doubts);
  print(text);
  return ExitCode::done;
}

}  // namespace

Action declare_explain(CLI::App& app) {
  auto options = std::make_shared<SceneOptions>();
  add_scene_options(app, *options);
  app.footer(R"(Examples:
  sheave explain scenes/machines/crane.json
  sheave explain scenes/templates/tackle.jsonnet --param parts=6

Tells in sentences: the parts, the degrees of freedom, the way of each cable over its links, ratios
of tackles, and parts that look like a mistake. Nothing is run.

Exit codes: 0 done, 2 wrong usage, 65 bad scene, 66 no such file.)");
  return [options] { return explain(*options); };
}

}  // namespace sheave::command
