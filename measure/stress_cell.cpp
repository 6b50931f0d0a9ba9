#include "measure/stress_cell.h"

#include "engine/field_check.h"
#include "measure/stress_scenes.h"

namespace sheave::measure {
namespace {

/// Puts the text in single quotes unless a shell takes it as one word.
std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-./=_,:";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string_view name_of(SolverKind solver) {
  return solver_names[static_cast<std::size_t>(solver)];
}
std::string_view name_of(IntegratorKind integrator) {
  return integrator_names[static_cast<std::size_t>(integrator)];
}

}  // namespace

std::string stress_number(double value) { return number_text(value); }

void StressCell::replace(std::string pointer, std::string value) {
  std::string origin = "--set " + pointer;
  overrides.push_back({std::move(pointer), std::move(value), std::move(origin)});
}

SceneResult StressCell::scene(SolverKind solver, IntegratorKind integrator) const {
  std::vector<Override> all = overrides;
  all.push_back({"/step/solver", std::string(name_of(solver)), "--solver"});
  all.push_back({"/step/integrator", std::string(name_of(integrator)), "--integrator"});
  if (!built_in.empty()) return load_scene_text(*stress_scene(built_in), built_in, all);
  if (kind.empty()) return load_scene(path, all);
  SceneResult generated = generate_scene(kind, settings);
  if (!generated) return generated;
  if (!overrides.empty()) return load_scene_text(write_scene(*generated), kind, all);
  // Loading the text would give exactly this scene, but large scenes take longer to read than to
  // run.
  generated.scene->model.step.solver = solver;
  generated.scene->model.step.integrator = integrator;
  return generated;
}

SceneResult StressCell::original(SolverKind solver, IntegratorKind integrator) const {
  StressCell other = *this;
  other.overrides = similar_to;
  return other.scene(solver, integrator);
}

std::string StressCell::command(SolverKind solver, IntegratorKind integrator) const {
  std::string text;
  if (!kind.empty()) {
    text = "sheave generate " + kind;
    for (const GeneratorSetting& setting : settings) {
      text += " " + generator_option(setting.option) + " " + shell_word(setting.value);
    }
    text += " | ";
  }
  if (!built_in.empty()) text += "sheave stress --print " + shell_word(built_in) + " | ";
  text += "sheave run " + (!kind.empty()       ? "- --check"
                           : !built_in.empty() ? "-"
                                               : shell_word(path));
  text += " --solver " + std::string(name_of(solver));
  text += " --integrator " + std::string(name_of(integrator));
  for (const Override& change : overrides) {
    text += " --set " + shell_word(change.pointer + "=" + change.value);
  }
  if (!load_state.empty()) text += " --load-state " + shell_word(load_state);
  return text;
}

}  // namespace sheave::measure
