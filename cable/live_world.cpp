#include "cable/live_world.h"

#include <algorithm>

#include "engine/index.h"
#include "engine/joints/gear.h"
#include "engine/joints/rack.h"

namespace sheave {
namespace {

/// What handles of things that are there from the start have; default ones have 0.
constexpr std::uint32_t first_generation = 1;

/// The handle of the thing with this name among `count`, or an error that tells the names there are.
template <class Tag, class NameOf>
Result<Handle<Tag>> find(std::string_view kind, std::string_view name, std::size_t count,
                         const NameOf& name_of) {
  std::string names;
  for (std::size_t i = 0; i < count; ++i) {
    if (name_of(i) == name) return Handle<Tag>{static_cast<std::int32_t>(i), first_generation};
    constexpr std::size_t enough = 200;
    if (names.size() > enough) continue;
    if (!names.empty()) names += ", ";
    names += name_of(i);
  }
  const std::string start =
      "there is no " + std::string(kind) + " \"" + std::string(name) + "\"; there ";
  return Error{"", start + (names.empty() ? "is none" : "are: " + names)};
}

template <class Tag>
std::string handle_fault(Handle<Tag> handle, std::string_view kind, std::size_t count) {
  const bool there = handle.slot >= 0 && handle.slot < static_cast<std::int32_t>(count) &&
                     handle.generation == first_generation;
  if (there) return {};
  if (handle.generation == 0) return "this handle refers to no " + std::string(kind);
  return "handle " + std::to_string(handle.slot) + " refers to no " + std::string(kind) +
         " of this world";
}

template <class Tag>
std::vector<Handle<Tag>> all(std::size_t count) {
  std::vector<Handle<Tag>> handles;
  for (std::size_t i = 0; i < count; ++i) {
    handles.push_back({static_cast<std::int32_t>(i), first_generation});
  }
  return handles;
}

Error because(std::string fault) { return {"", std::move(fault)}; }

}  // namespace

LiveWorld::LiveWorld(Simulation simulation)
    : simulation_(std::make_unique<Simulation>(std::move(simulation))) {
  const World& world = simulation_->world;
  view_ = std::make_unique<Substep>(world.bodies(), world.state(), world.model().step.dt, 1);
  joints_ = number_joints(world.model(), world.features());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointDef& joint = *world.model().joints[j];
    if (joint.breaking_force || joint.breaking_torque) {
      breakable_joints_.push_back(static_cast<int>(j));
    }
  }
}

Result<LiveWorld> LiveWorld::create(const Model& model, const std::vector<CableDef>& cables) {
  Result<Simulation> simulation = Simulation::create(model, cables);
  if (!simulation) return simulation.errors();
  return LiveWorld(std::move(*simulation));
}

Result<BodyHandle> LiveWorld::body(std::string_view name) const {
  const auto& bodies = simulation_->world.model().bodies;
  return find<BodyTag>("body", name, bodies.size(),
                       [&](std::size_t i) -> std::string_view { return bodies[i].name; });
}

Result<JointHandle> LiveWorld::joint(std::string_view name) const {
  const auto& joints = simulation_->world.model().joints;
  return find<JointTag>("joint", name, joints.size(),
                        [&](std::size_t i) -> std::string_view { return joints[i]->name; });
}

Result<CableHandle> LiveWorld::cable(std::string_view name) const {
  const auto& cables = *simulation_->cable_definitions;
  return find<CableTag>("cable", name, cables.size(),
                        [&](std::size_t i) -> std::string_view { return cables[i].name; });
}

std::vector<BodyHandle> LiveWorld::bodies() const {
  return all<BodyTag>(simulation_->world.model().bodies.size());
}
std::vector<JointHandle> LiveWorld::joints() const { return all<JointTag>(joints_.size()); }
std::vector<CableHandle> LiveWorld::cables() const {
  return all<CableTag>(simulation_->cable_definitions->size());
}

Result<std::string> LiveWorld::name(BodyHandle body) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  return simulation_->world.model().bodies[at(body.slot)].name;
}

Result<std::string> LiveWorld::name(JointHandle joint) const {
  std::string fault = fault_of(joint);
  if (!fault.empty()) return because(std::move(fault));
  return simulation_->world.model().joints[at(joint.slot)]->name;
}

Result<std::string> LiveWorld::name(CableHandle cable) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return because(std::move(fault));
  return (*simulation_->cable_definitions)[at(cable.slot)].name;
}

std::string LiveWorld::fault_of(BodyHandle body) const {
  return handle_fault(body, "body", simulation_->world.model().bodies.size());
}
std::string LiveWorld::fault_of(JointHandle joint) const {
  return handle_fault(joint, "joint", joints_.size());
}
std::string LiveWorld::fault_of(CableHandle cable) const {
  return handle_fault(cable, "cable", simulation_->cable_definitions->size());
}

std::string LiveWorld::span_fault(CableHandle cable, int span) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return fault;
  const CompiledCable& own = simulation_->cables->cables()[at(cable.slot)];
  if (span >= 0 && span < own.listed_spans) return {};
  return "cable \"" + own.name + "\" has no span number " + std::to_string(span) + "; it has " +
         std::to_string(own.listed_spans);
}

CableSystem* LiveWorld::cable_system() const {
  if (simulation_->cables == nullptr) return nullptr;
  return static_cast<CableSystem*>(simulation_->world.features().back().get());
}

bool LiveWorld::is_broken(int joint) const {
  const World& world = simulation_->world;
  const JointPlace& place = joints_[at(joint)];
  for (std::size_t f = 0; f < world.features().size(); ++f) {
    if (world.features()[f].get() != place.feature) continue;
    return place.feature->is_broken(place.index, world.feature_state(f));
  }
  return false;
}

void LiveWorld::note_events(LiveReport& report) const {
  CableSystem* cables = cable_system();
  if (cables == nullptr) return;
  report.events = cables->take_events();
  if (report.events.size() <= LiveReport::most_events) return;
  report.omitted = report.events.size() - LiveReport::most_events;
  report.events.resize(LiveReport::most_events);
}

LiveReport LiveWorld::step(const StopRequest& stop, const std::function<void()>& before_substep) {
  std::vector<int> intact;
  for (const int joint : breakable_joints_) {
    if (!is_broken(joint)) intact.push_back(joint);
  }
  LiveReport report;
  Simulation& own = *simulation_;
  // Without anything to do before substeps the world may take them together.
  const auto supervise = [&] {
    own.supervisor->supervise(own);
    if (before_substep) before_substep();
  };
  static_cast<StepReport&>(report) =
      own.world.step(stop, own.supervisor != nullptr ? supervise : before_substep);
  note_events(report);
  for (const int joint : intact) {
    if (is_broken(joint)) report.broken_joints.push_back({joint, first_generation});
  }
  return report;
}

Result<BodyPose> LiveWorld::pose(BodyHandle body) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  const World& world = simulation_->world;
  const BodyId id{body.slot};
  return BodyPose{world.position(id), world.orientation(id), world.velocity(id),
                  world.angular_velocity(id)};
}

Result<Vector3> LiveWorld::point(BodyHandle body, const Vector3& local) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  return simulation_->world.point({body.slot}, local);
}

Result<double> LiveWorld::tension(CableHandle cable, int span) const {
  std::string fault = span_fault(cable, span);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation_->cables;
  const CompiledCable& own = system.cables()[at(cable.slot)];
  return state().features.back().reals[system.tension_index(own.first_span + span)];
}

Result<double> LiveWorld::rest_length(CableHandle cable, int span) const {
  std::string fault = span_fault(cable, span);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation_->cables;
  const CompiledCable& own = system.cables()[at(cable.slot)];
  return state().features.back().reals[system.rest_length_index(own.first_span + span)];
}

Result<double> LiveWorld::stored_length(CableHandle cable, int link) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation_->cables;
  const CompiledCable& own = system.cables()[at(cable.slot)];
  if (link < 0 || link >= own.listed_links) {
    return because("cable \"" + own.name + "\" has no link number " + std::to_string(link) +
                   "; it has " + std::to_string(own.listed_links));
  }
  return state().features.back().reals[system.stored_length_index(own.first_link + link)];
}

Result<Wrench> LiveWorld::force(JointHandle joint) const {
  std::string fault = fault_of(joint);
  if (!fault.empty()) return because(std::move(fault));
  const World& world = simulation_->world;
  const JointPlace& place = joints_[at(joint.slot)];
  const JointDef& definition = *world.model().joints[at(joint.slot)];
  const auto look_at = [&](BodyId id) {
    if (id.is_world()) return;
    for (const int body : {id.index, world.bodies()[id.index].mount}) {
      if (body < 0) continue;
      const BodyState& now = state().bodies[at(body)];
      MovingBody& moving = view_->moving[at(body)];
      moving.position = now.position;
      moving.orientation = now.orientation;
    }
  };
  look_at(definition.body_a);
  look_at(definition.body_b);
  if (const auto* gear = dynamic_cast<const GearJoint*>(&definition)) look_at(gear->carrier);
  if (const auto* rack = dynamic_cast<const RackJoint*>(&definition)) look_at(rack->carrier);
  for (std::size_t f = 0; f < world.features().size(); ++f) {
    if (world.features()[f].get() != place.feature) continue;
    return place.feature->wrench_of(place.index, *view_, world.feature_state(f));
  }
  return because("joint \"" + definition.name + "\" does nothing");
}

Errors LiveWorld::restore(const State& state) {
  Errors errors = simulation_->world.restore(state);
  if (errors.empty() && cable_system() != nullptr) static_cast<void>(cable_system()->take_events());
  return errors;
}

}  // namespace sheave
