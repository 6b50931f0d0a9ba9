// The loads of a scene at work (scenes/control/load.h).

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "scenes/control/scene_supervisor.h"

namespace sheave {

Errors SceneSupervisor::add_load(const Scene& scene, std::size_t index) {
  LoadAtWork load;
  load.definition = scene.loads[index];
  const int body = load.definition->body.index;
  // validate_scene() tells the faults of loads; without a body there is nothing to prepare.
  const std::string path = fmt::format("/loads/{}", index);
  Errors errors = load.definition->validate(scene.model, path);
  if (!errors.empty()) return errors;
  const auto sets = [&](const ControlPoint& control) {
    return control.entity == body && (control.kind == ControlPoint::Kind::force ||
                                      control.kind == ControlPoint::Kind::torque);
  };
  const bool set = std::any_of(triggers_.begin(), triggers_.end(),
                               [&](const TriggerAtWork& own) { return sets(own.control); }) ||
                   std::any_of(controllers_.begin(), controllers_.end(),
                               [&](const ControllerAtWork& own) { return sets(own.control); });
  if (set && !load.definition->is_motion()) {
    return {{path + "/body",
             fmt::format("load \"{}\": a trigger or a controller sets a force of this body, too; "
                         "give one of them another body, or let one of them do both",
                         load.definition->name)}};
  }
  load.acting = load.definition->prepare(scene.model);
  load.first = memory_size_;
  memory_size_ += load.acting->memory_size();
  loads_.push_back(std::move(load));
  return {};
}

void SceneSupervisor::act_loads(Simulation& simulation) const {
  if (loads_.empty()) return;
  const StepSettings& step = simulation.world.model().step;
  const double h = step.dt / step.substeps;
  std::map<int, PointForce> forces;
  for (const LoadAtWork& load : loads_) {
    const BodyId body = load.definition->body;
    if (load.definition->is_motion()) {
      note(simulation.world.set_motion(body, load.acting->motion(simulation.world, h)), simulation);
      continue;
    }
    const std::span<double> memory(simulation.world.memory().data() + load.first,
                                   load.acting->memory_size());
    const PointForce force = load.acting->force(simulation.world, h, memory);
    const auto [sum, first] = forces.emplace(body.index, force);
    if (first) continue;
    sum->second.force += force.force;
    sum->second.torque += force.torque;
  }
  for (const auto& [body, force] : forces) {
    note(simulation.world.set_force(BodyId{body}, force), simulation);
  }
}

}  // namespace sheave
