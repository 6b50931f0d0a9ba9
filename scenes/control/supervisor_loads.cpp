// The loads of a scene at work (scenes/control/load.h).

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/motion_request.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave {

Errors SceneSupervisor::add_load(const Scene& scene, std::size_t index) {
  LoadAtWork load;
  load.definition = scene.loads[index];
  const LoadScope scope{scene.model, scene.cables, scene.loads};
  // validate_scene() tells the faults of loads; without a body there is nothing to prepare.
  const std::string path = fmt::format("/loads/{}", index);
  Errors errors = load.definition->validate(scope, path);
  if (!errors.empty()) return errors;
  const std::vector<int> bodies = load.definition->bodies(scope);
  const auto sets = [&](const ControlPoint& control) {
    return std::find(bodies.begin(), bodies.end(), control.entity) != bodies.end() &&
           (control.kind == ControlPoint::Kind::force ||
            control.kind == ControlPoint::Kind::torque);
  };
  const bool set = std::any_of(triggers_.begin(), triggers_.end(),
                               [&](const TriggerAtWork& own) { return sets(own.control); }) ||
                   std::any_of(controllers_.begin(), controllers_.end(),
                               [&](const ControllerAtWork& own) { return sets(own.control); });
  if (set && !load.definition->is_motion()) {
    const bool muscle = load.definition->is_muscle();
    return {{path + (muscle ? "/cable" : "/body"),
             fmt::format("load \"{}\": a trigger or a controller sets a force of {}, too; give one "
                         "of them another body, or let one of them do both",
                         load.definition->name, muscle ? "a body of its cable" : "this body")}};
  }
  load.acting = load.definition->prepare(scope);
  load.first = memory_size_;
  memory_size_ += load.acting->memory_size();
  loads_.push_back(std::move(load));
  return {};
}

void SceneSupervisor::place_excitations() {
  const auto place = [&](ControlPoint& control) {
    if (control.kind != ControlPoint::Kind::excitation) return;
    control.item = static_cast<int>(excitation_place(loads_[at(control.entity)]));
  };
  for (TriggerAtWork& trigger : triggers_) place(trigger.control);
  for (ControllerAtWork& controller : controllers_) place(controller.control);
}

const LoadDef* SceneSupervisor::muscle(std::size_t index) const {
  for (const LoadAtWork& load : loads_) {
    if (load.definition->is_muscle() && index-- == 0) return load.definition.get();
  }
  return nullptr;
}

std::vector<MuscleState> SceneSupervisor::muscles(const State& state) const {
  std::vector<MuscleState> list;
  for (const LoadAtWork& load : loads_) {
    if (!load.definition->is_muscle()) continue;
    const std::span<const double> memory(state.memory.data() + load.first,
                                         load.acting->memory_size());
    list.push_back(load.acting->muscle(memory, state.time));
    list.back().name = load.definition->name;
  }
  return list;
}

Result<ControlPoint> find_control(std::string_view name, const Simulation& simulation) {
  const auto* own = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
  Scene scene;
  if (own != nullptr) own->append_to(scene);
  Result<ControlPoint> point =
      find_control(name, simulation.world.model(), *simulation.cable_definitions, scene.loads);
  if (point && point->kind == ControlPoint::Kind::excitation) {
    point->item =
        static_cast<int>(SceneSupervisor::excitation_place(own->loads_[at(point->entity)]));
  }
  return point;
}

bool SceneSupervisor::acts_by_substeps() const {
  return !triggers_.empty() || !controllers_.empty();
}

namespace {

/// By how much a body without constraints is off after a substep in which loads act with their means.
/// The displacement of a force over the mass m is its integral of (end - t) F / m, and that of its
/// mean is (end - middle) times its integral over m: the difference is the first moment over m.
double distance_of(const LoadCourse& course, const BodyProperties& body,
                   const Quaternion& orientation) {
  double distance = course.distance;
  if (body.mass > 0.0) {
    const bool slides = body.mobility == Mobility::slider;
    const double force = slides ? std::abs(body.axis.dot(course.force)) : course.force.norm();
    distance += force / body.mass;
  }
  if (body.mobility == Mobility::free) {
    const Vector3 torque = rotated(orientation.conjugate(), course.torque);
    distance += body.size * (body.inverse_inertia * torque).norm();
  } else if (body.axis_inertia > 0.0) {
    const double torque =
        body.mount < 0 ? std::abs(body.axis.dot(course.torque)) : course.torque.norm();
    distance += body.size * torque / body.axis_inertia;
  }
  return distance;
}

}  // namespace

LoadDefect SceneSupervisor::load_defect(const Simulation& simulation, double length) const {
  const World& world = simulation.world;
  LoadDefect defect;
  for (const LoadAtWork& load : loads_) {
    const LoadCourse course = load.acting->course(world, length);
    const int body = load.definition->body.index;
    if (!load.definition->is_muscle()) {
      defect.distance +=
          distance_of(course, world.bodies()[body], world.state().bodies[at(body)].orientation);
    }
    defect.corner = std::min(defect.corner, course.corner);
  }
  return defect;
}

void SceneSupervisor::set_loads(Simulation& simulation, double length, bool jumped) const {
  if (loads_.empty()) return;
  const LoadSubstep substep{length, jumped};
  std::map<int, PointForce> forces;
  std::vector<CableReport> cables;
  for (const LoadAtWork& load : loads_) {
    const BodyId body = load.definition->body;
    if (load.definition->is_motion()) {
      note(simulation.world.set_motion(body, load.acting->motion(simulation.world, length)),
           simulation);
      continue;
    }
    const std::span<double> memory(simulation.world.memory().data() + load.first,
                                   load.acting->memory_size());
    if (load.definition->is_muscle()) {
      if (cables.empty()) cables = simulation.cable_reports();
      load.acting->pull(simulation.world, cables, substep, memory, forces);
      continue;
    }
    const PointForce force = load.acting->force(simulation.world, substep, memory);
    const auto [sum, first] = forces.emplace(body.index, force);
    if (first) continue;
    sum->second.force += force.force;
    sum->second.torque += force.torque;
  }
  for (const auto& [body, force] : forces) {
    note(simulation.world.set_force(BodyId{body}, force), simulation);
  }
}

void SceneSupervisor::set_loads_now(const Simulation& simulation, Controls& controls) const {
  // The force of an instant, from two means: it is exact where the force is linear.
  constexpr double share = 1e-3;
  const World& world = simulation.world;
  const double substep = world.model().step.dt / world.model().step.substeps;
  const double h = share * substep;
  std::vector<double> memory = world.state().memory;
  std::map<int, ForceControl> forces;
  for (const LoadAtWork& load : loads_) {
    if (load.definition->is_motion()) {
      // A motion is given until the end of its substep, and goes on without acceleration.
      const BodyId body = load.definition->body;
      controls.motions.put(
          body.index, static_cast<std::size_t>(world.bodies().count()),
          motion_to(world.state().bodies[at(body.index)], load.acting->motion(world, substep),
                    world.state().time, substep));
      continue;
    }
    if (load.definition->is_muscle()) continue;
    const std::span<double> own(memory.data() + load.first, load.acting->memory_size());
    const PointForce near = load.acting->force(world, {h}, own);
    const PointForce far = load.acting->force(world, {2.0 * h}, own);
    ForceControl& sum = forces[load.definition->body.index];
    sum.force += 2.0 * near.force - far.force;
    sum.torque += 2.0 * near.torque - far.torque;
  }
  // The forces of muscles are those of the last substep.
  const LoadScope scope{world.model(), *simulation.cable_definitions};
  for (const LoadAtWork& load : loads_) {
    if (!load.definition->is_muscle()) continue;
    for (const int body : load.definition->bodies(scope)) forces.erase(body);
  }
  for (const auto& [body, force] : forces) {
    const ForceControl* const set = controls.forces.find(body);
    if (set == nullptr) continue;
    ForceControl now = *set;
    now.force = force.force;
    now.torque = force.torque;
    controls.forces.put(body, static_cast<std::size_t>(world.bodies().count()), now);
  }
}

}  // namespace sheave
