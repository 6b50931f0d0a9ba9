#include "scenes/saved_state.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "cable/machine_layout.h"
#include "engine/number_text.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

/// The definition of the simulation as a scene, without its step settings.
Scene scene_of(const Simulation& simulation) {
  Scene scene;
  scene.model = simulation.world.model();
  scene.model.step = {};
  scene.cables = *simulation.cable_definitions;
  if (const auto* own = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get())) {
    own->append_to(scene);
  }
  return scene;
}

/// A line for each object to which numbers of a state belong.
std::string layout_text(const Scene& scene) {
  std::string text = machine_layout_text(scene.model, scene.cables);
  const auto add = [&](std::string_view kind, std::string_view name) {
    text += fmt::format("{} {}:{}\n", kind, name.size(), name);
  };
  for (const auto& controller : scene.controllers) add(controller->type(), controller->name);
  for (const TriggerDef& trigger : scene.triggers) add("trigger", trigger.name);
  for (const auto& load : scene.loads) add(load->type(), load->name);
  return text;
}

StateOrigin origin_of_scene(const Scene& scene) {
  return {hash_of_text(write_scene(scene)), hash_of_text(layout_text(scene))};
}

}  // namespace

StateOrigin origin_of(const Simulation& simulation) {
  return origin_of_scene(scene_of(simulation));
}

std::string saved_state(const Simulation& simulation) {
  return to_bytes(simulation.world.state(), origin_of(simulation));
}

Result<std::vector<std::string>> check_saved_state(const Simulation& simulation,
                                                   const std::string& bytes, State& state) {
  Result<SavedState> saved = saved_state_from_bytes(bytes);
  if (!saved) return saved.errors();
  std::vector<std::string> warnings;
  if (!saved->checked) {
    warnings.emplace_back(
        "the state was saved by an earlier version, without a checksum, so changes in it cannot be "
        "detected; save it again");
  }
  if (saved->origin.layout != 0) {
    const StateOrigin own = origin_of(simulation);
    if (saved->origin.layout != own.layout) {
      return Error{
          "",
          "the state belongs to another machine: bodies, joints, cables, colliders, "
          "controllers, triggers and loads must have the same names and kinds, in the same order"};
    }
    if (saved->origin.scene != own.scene) {
      warnings.emplace_back(
          "the state was saved with other settings of this machine; the run continues with the "
          "settings of this scene and differs from the saved run");
    }
  }
  state = std::move(saved->state);
  const double dt = simulation.world.model().step.dt;
  constexpr std::int64_t most_steps = std::int64_t{1} << 53;
  const double time = static_cast<double>(state.steps) * dt;
  const bool counted = state.steps >= 0 && state.steps <= most_steps &&
                       std::abs(state.time - time) <= 1e-6 * dt + 1e-12 * time;
  if (!counted) {
    return Error{
        "",
        fmt::format(
            "the time {} s of the state is not that of {} steps of {} s: the state was saved with "
            "another dt, or in the middle of a step",
            number_text(state.time), state.steps, number_text(dt))};
  }
  return warnings;
}

Result<std::vector<std::string>> load_saved_state(Simulation& simulation,
                                                  const std::string& bytes) {
  State state;
  Result<std::vector<std::string>> warnings = check_saved_state(simulation, bytes, state);
  if (!warnings) return warnings;
  Errors errors = simulation.world.restore(state);
  if (!errors.empty()) return errors;
  return warnings;
}

}  // namespace sheave
