#include "scenes/control/scene_supervisor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "scenes/control/supervisor_memory.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

/// Whether the joint can break, or a trigger releases it.
bool may_let_go(const Scene& scene, int index) {
  const JointDef& joint = *scene.model.joints[static_cast<std::size_t>(index)];
  if (joint.breaking_force || joint.breaking_torque) return true;
  return std::any_of(scene.triggers.begin(), scene.triggers.end(), [&](const TriggerDef& trigger) {
    return trigger.action == TriggerAction::release && trigger.target == joint.name;
  });
}

Error over_fault(const TriggerDef& trigger, const std::string& path) {
  return {path + "/over", fmt::format("trigger \"{}\": \"{}\" is set at once; only a drive or a "
                                      "feed reaches its value over a time",
                                      trigger.name, trigger.target)};
}

/// Index of the element of `list` with this name.
template <class List, class Name>
Result<int> index_of(const List& list, const std::string& name, std::string_view what,
                     const Name& name_of) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (name_of(list[i]) == name) return static_cast<int>(i);
    names.push_back(name_of(list[i]));
  }
  const std::vector<std::string_view> near = nearest(name, names, 5);
  return Error{"", fmt::format("there is no {} \"{}\"{}", what, name,
                               near.empty() ? std::string()
                                            : fmt::format("; near it are \"{}\"",
                                                          fmt::join(near, "\", \"")))};
}

Error at_path(const Errors& errors, const std::string& path) {
  return {path, errors.front().message};
}

double substep_of(const Simulation& simulation) {
  const StepSettings& step = simulation.world.model().step;
  return step.dt / step.substeps;
}

}  // namespace

Result<std::shared_ptr<const SceneSupervisor>> SceneSupervisor::create(
    const Scene& scene, const Simulation& simulation) {
  Scene made_of = scene;
  made_of.model = simulation.world.model();
  made_of.cables = *simulation.cable_definitions;
  std::shared_ptr<SceneSupervisor> made(new SceneSupervisor(made_of));
  Errors errors;
  for (std::size_t i = 0; i < scene.triggers.size(); ++i) {
    for (Error& error : made->add_trigger(scene, i)) errors.push_back(std::move(error));
  }
  for (std::size_t i = 0; i < scene.controllers.size(); ++i) {
    for (Error& error : made->add_controller(scene, i)) errors.push_back(std::move(error));
  }
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    for (Error& error : made->add_load(scene, i)) errors.push_back(std::move(error));
  }
  if (!errors.empty()) return errors;
  made->place_excitations();
  made->first_course_ = made->memory_size_;
  made->memory_size_ += made->quantities_.course_count() * Course::size;
  return std::shared_ptr<const SceneSupervisor>(std::move(made));
}

Result<std::shared_ptr<const Supervisor>> SceneSupervisor::again(
    const Simulation& simulation) const {
  Scene scene;
  scene.model = simulation.world.model();
  scene.cables = *simulation.cable_definitions;
  append_to(scene);
  Result<std::shared_ptr<const SceneSupervisor>> made = create(scene, simulation);
  if (!made) return made.errors();
  return std::shared_ptr<const Supervisor>(std::move(*made));
}

void SceneSupervisor::append_to(Scene& scene) const {
  for (const TriggerAtWork& trigger : triggers_) scene.triggers.push_back(trigger.definition);
  for (const auto& controller : controllers_) scene.controllers.push_back(controller.definition);
  for (const LoadAtWork& load : loads_) scene.loads.push_back(load.definition);
}

Result<std::size_t> SceneSupervisor::sampled(const std::string& quantity, const std::string& path) {
  const std::size_t place = quantities_.size();
  const Errors faults = quantities_.add(quantity);
  if (!faults.empty()) return at_path(faults, path);
  if (!quantities_.follows_from_state(place)) {
    return Error{
        path, fmt::format("\"{}\" is known only for the last substep and is no part of the state, "
                          "so a run from a saved state would differ; take another quantity",
                          quantity)};
  }
  waits_for_step_ = waits_for_step_ || !quantities_.known_at_start(place);
  return place;
}

Errors SceneSupervisor::add_trigger(const Scene& scene, std::size_t index) {
  const std::string path = fmt::format("/triggers/{}", index);
  const TriggerDef& definition = scene.triggers[index];
  TriggerAtWork trigger;
  trigger.definition = definition;
  trigger.first = memory_size_;
  memory_size_ += memory_at::trigger_size;
  Errors errors;
  if (!definition.quantity.empty()) {
    const Result<std::size_t> place = sampled(definition.quantity, path + "/quantity");
    if (!place) errors.push_back(place.errors().front());
    if (place) trigger.quantity = *place;
    watches_ = true;
  }
  if (definition.target.empty() && definition.action != TriggerAction::stop) {
    errors.push_back({path, fmt::format("trigger \"{}\": it needs a target", definition.name)});
    return errors;
  }
  Result<int> target = 0;
  switch (definition.action) {
    case TriggerAction::set:
    case TriggerAction::clear: {
      const auto point = find_control(definition.target, scene.model, scene.cables, scene.loads);
      if (!point) errors.push_back(at_path(point.errors(), path + "/target"));
      if (point) trigger.control = *point;
      if (point && definition.over > 0.0 && !point->can_take_time()) {
        errors.push_back(over_fault(definition, path));
      }
      break;
    }
    case TriggerAction::release:
    case TriggerAction::lock:
      target = index_of(scene.model.joints, definition.target, "joint",
                        [](const auto& joint) -> const std::string& { return joint->name; });
      break;
    case TriggerAction::cut:
      target = index_of(scene.cables, definition.target, "cable",
                        [](const CableDef& cable) -> const std::string& { return cable.name; });
      break;
    case TriggerAction::on:
    case TriggerAction::off:
      target = index_of(scene.controllers, definition.target, "controller",
                        [](const auto& own) -> const std::string& { return own->name; });
      break;
    case TriggerAction::stop:
      break;
  }
  if (!target) errors.push_back(at_path(target.errors(), path + "/target"));
  if (target) trigger.target = *target;
  if (target && definition.action == TriggerAction::lock && !may_let_go(scene, *target)) {
    errors.push_back(
        {path + "/target",
         fmt::format("trigger \"{0}\": joint \"{1}\" is never released and cannot break, so it "
                     "holds already; to hold its coordinate, give it a drive to the speed 0 and "
                     "let the trigger set \"{1}.drive_limit\"",
                     definition.name, definition.target)});
  }
  triggers_.push_back(std::move(trigger));
  return errors;
}

Errors SceneSupervisor::add_controller(const Scene& scene, std::size_t index) {
  const std::string path = fmt::format("/controllers/{}", index);
  ControllerAtWork controller;
  controller.definition = scene.controllers[index];
  const ControllerDef& definition = *controller.definition;
  controller.first = memory_size_;
  memory_size_ += memory_at::controller_size + definition.memory_size();
  controller.sample_time = definition.sample_time.value_or(scene.model.step.dt);
  Errors errors;
  const Result<std::size_t> measured = sampled(definition.measures, path + "/measures");
  if (!measured) errors.push_back(measured.errors().front());
  if (measured) controller.measured = *measured;
  controller.setpoint = definition.setpoint_table();
  if (!definition.setpoint_quantity.empty()) {
    const Result<std::size_t> place =
        sampled(definition.setpoint_quantity, path + "/setpoint_quantity");
    if (!place) errors.push_back(place.errors().front());
    if (place) controller.setpoint_quantity = *place;
  }
  const auto point = find_control(definition.control, scene.model, scene.cables, scene.loads);
  if (!point) errors.push_back(at_path(point.errors(), path + "/control"));
  if (point) controller.control = *point;
  controllers_.push_back(std::move(controller));
  return errors;
}

void SceneSupervisor::note(const Errors& errors, Simulation& simulation) {
  if (!errors.empty()) simulation.world.memory()[memory_at::refused] += 1.0;
}

void SceneSupervisor::look(const Simulation& simulation, std::vector<double>& values) const {
  // Reports of cables take time, and most substeps need none.
  if (!values.empty()) return;
  values.resize(quantities_.size());
  if (quantities_.course_count() == 0) return quantities_.sample(simulation, values);
  // In the course of the memory and of this moment, which may be a trial within a substep.
  std::vector<Course> courses = courses_of(simulation.world.state());
  quantities_.follow(simulation, courses, values);
}

bool SceneSupervisor::is_known(std::size_t place, double time) const {
  return time > 0.0 || !waits_for_step_ || quantities_.known_at_start(place);
}

double SceneSupervisor::margin_of(const TriggerAtWork& trigger, std::span<const double> values) {
  const TriggerDef& own = trigger.definition;
  const double value = values[trigger.quantity];
  return own.above ? value - *own.above : *own.below - value;
}

bool SceneSupervisor::look_at_triggers(Simulation& simulation, std::vector<double>& values) const {
  const double time = simulation.world.state().time;
  const double slop = instant_slop(simulation.world.model().step);
  bool acts = false;
  for (const TriggerAtWork& trigger : triggers_) {
    const TriggerDef& own = trigger.definition;
    double& acted_last = simulation.world.memory()[trigger.first + memory_at::acted];
    double& held = simulation.world.memory()[trigger.first + memory_at::holds];
    bool now = false;
    if (own.at) {
      now = is_due(*own.at, time, slop);
    } else if (is_known(trigger.quantity, time)) {
      look(simulation, values);
      now = margin_of(trigger, values) > 0.0;
    }
    const bool comes = now && held == 0.0;
    held = now ? 1.0 : 0.0;
    const bool again = own.repeats && acted_last < time;
    if (!comes || (acted_last >= 0.0 && !again)) continue;
    acted_last = time;
    act(trigger, simulation);
    acts = true;
  }
  return acts;
}

void SceneSupervisor::supervise(Simulation& simulation) const {
  const double time = simulation.world.state().time;
  const double slop = instant_slop(simulation.world.model().step);
  std::vector<double> values;
  follow(simulation);
  // The action of one trigger may be the event that another one waits for. Each acts once at an
  // instant.
  while (look_at_triggers(simulation, values) && watches_) values.clear();
  for (const ControllerAtWork& controller : controllers_) {
    const std::vector<double>& memory = simulation.world.memory();
    if (memory[controller.first + memory_at::is_on] == 0.0) continue;
    if (!is_known(controller.measured, time)) continue;
    const double due = memory[controller.first + memory_at::samples] * controller.sample_time;
    if (!is_due(due, time, slop)) continue;
    look(simulation, values);
    act(controller, values, simulation);
  }
  // With a tolerance the world asks for loads before each attempt at a substep.
  if (simulation.world.model().step.tolerance > 0.0) return;
  set_loads(simulation, substep_of(simulation), false);
}

bool SceneSupervisor::acts_in_time(const ControllerAtWork& controller,
                                   const Simulation& simulation) {
  // One that samples more often than there are substeps acts at each of them.
  return controller.sample_time >=
         substep_of(simulation) - instant_slop(simulation.world.model().step);
}

double SceneSupervisor::next_time(const Simulation& simulation, double slop) const {
  const State& state = simulation.world.state();
  double next = no_instant;
  const auto wait_for = [&](double time) {
    if (!is_due(time, state.time, slop)) next = std::min(next, time);
  };
  for (const TriggerAtWork& trigger : triggers_) {
    if (trigger.definition.at) wait_for(*trigger.definition.at);
  }
  for (const ControllerAtWork& controller : controllers_) {
    if (state.memory[controller.first + memory_at::is_on] == 0.0 ||
        !acts_in_time(controller, simulation)) {
      continue;
    }
    wait_for(state.memory[controller.first + memory_at::samples] * controller.sample_time);
  }
  return next;
}

void SceneSupervisor::find_margins(const Simulation& simulation,
                                   std::vector<double>& margins) const {
  margins.clear();
  const State& state = simulation.world.state();
  std::vector<double> values;
  for (const TriggerAtWork& trigger : triggers_) {
    const TriggerDef& own = trigger.definition;
    const bool acts = state.memory[trigger.first + memory_at::holds] == 0.0 &&
                      (own.repeats || state.memory[trigger.first + memory_at::acted] < 0.0);
    // A trigger that waits for no quantity is never beyond its threshold.
    double margin = -std::numeric_limits<double>::infinity();
    if (!own.at && acts && is_known(trigger.quantity, state.time)) {
      look(simulation, values);
      margin = margin_of(trigger, values);
    }
    margins.push_back(margin);
  }
}

void SceneSupervisor::act(const TriggerAtWork& trigger, Simulation& simulation) const {
  std::vector<double>& memory = simulation.world.memory();
  const TriggerDef& own = trigger.definition;
  switch (own.action) {
    case TriggerAction::set: {
      // A speed jumps at its instant. A ramp over a substep h would be short of v h / 2.
      const bool jumps = trigger.control.can_take_time() && !trigger.control.takes_time;
      const std::optional<double> over =
          own.over > 0.0 || jumps ? std::optional<double>(own.over) : std::nullopt;
      note(trigger.control.set(simulation, *own.value, substep_of(simulation), over), simulation);
      break;
    }
    case TriggerAction::clear:
      note(trigger.control.clear(simulation), simulation);
      break;
    case TriggerAction::release:
      note(simulation.world.release_joint(trigger.target), simulation);
      break;
    case TriggerAction::lock:
      note(simulation.world.lock_joint(trigger.target), simulation);
      break;
    case TriggerAction::cut:
      note(own.place ? simulation.cut_cable(trigger.target, *own.place)
                     : simulation.cut_cable(trigger.target),
           simulation);
      break;
    case TriggerAction::on: {
      const ControllerAtWork& controller = controllers_[static_cast<std::size_t>(trigger.target)];
      if (memory[controller.first + memory_at::is_on] != 0.0) break;
      memory[controller.first + memory_at::is_on] = 1.0;
      memory[controller.first + memory_at::sampled_at] = memory_at::never;
      const auto own_memory = memory.begin() + static_cast<std::ptrdiff_t>(
                                                   controller.first + memory_at::controller_size);
      std::fill_n(own_memory, controller.definition->memory_size(), 0.0);
      break;
    }
    case TriggerAction::off:
      memory[controllers_[static_cast<std::size_t>(trigger.target)].first + memory_at::is_on] = 0.0;
      break;
    case TriggerAction::stop:
      memory[memory_at::stopped] = 1.0;
      break;
  }
}

void SceneSupervisor::act(const ControllerAtWork& controller, std::span<const double> values,
                          Simulation& simulation) const {
  const ControllerDef& definition = *controller.definition;
  const double time = simulation.world.state().time;
  std::vector<double>& memory = simulation.world.memory();
  double* const own = memory.data() + controller.first;
  ControllerInput input;
  input.first = own[memory_at::sampled_at] < 0.0;
  input.interval = input.first ? std::max(controller.sample_time, substep_of(simulation))
                               : time - own[memory_at::sampled_at];
  input.measured = values[controller.measured];
  input.setpoint = controller.setpoint.at(time);
  const double ahead = std::max(controller.sample_time, substep_of(simulation));
  input.setpoint_rate = (controller.setpoint.at(time + ahead) - input.setpoint) / ahead;
  if (!definition.setpoint_quantity.empty()) {
    input.setpoint += values[controller.setpoint_quantity];
  }
  // The next multiple of the sample time that has not come yet.
  const double slop = instant_slop(simulation.world.model().step);
  own[memory_at::samples] = std::floor((time + slop) / controller.sample_time) + 1.0;
  own[memory_at::sampled_at] = time;
  // A value that is not finite leaves the control unchanged.
  if (!std::isfinite(input.measured) || !std::isfinite(input.setpoint)) {
    memory[memory_at::refused] += 1.0;
    return;
  }
  const std::span<double> its(own + memory_at::controller_size, definition.memory_size());
  const double output = definition.output(input, its);
  // A controller whose sums have overflowed starts them again at 0.
  for (double& number : its) {
    if (std::isfinite(number)) continue;
    number = 0.0;
    memory[memory_at::refused] += 1.0;
  }
  note(controller.control.set(simulation, output, controller.sample_time), simulation);
}

Errors try_controls(const Scene& scene) {
  Errors errors;
  Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation) return simulation.errors();
  const auto attempt = [&](const std::string& control, double value, double over,
                           const std::string& path) {
    const auto point = find_control(control, scene.model, scene.cables, scene.loads);
    if (!point) return;
    const Errors found = point->set(*simulation, value, over);
    if (!found.empty()) errors.push_back(at_path(found, path));
  };
  for (std::size_t i = 0; i < scene.controllers.size(); ++i) {
    const ControllerDef& controller = *scene.controllers[i];
    const std::string path = fmt::format("/controllers/{}/control", i);
    const auto [lower, upper] = controller.range();
    const double time = controller.sample_time.value_or(scene.model.step.dt);
    const std::size_t before = errors.size();
    attempt(controller.control, lower.value_or(upper.value_or(0.0)), time, path);
    if (upper && errors.size() == before) attempt(controller.control, *upper, time, path);
  }
  for (std::size_t i = 0; i < scene.triggers.size(); ++i) {
    const TriggerDef& trigger = scene.triggers[i];
    if (trigger.action != TriggerAction::set) continue;
    attempt(trigger.target, *trigger.value, std::max(trigger.over, scene.model.step.dt),
            fmt::format("/triggers/{}/value", i));
  }
  return errors;
}

}  // namespace sheave
