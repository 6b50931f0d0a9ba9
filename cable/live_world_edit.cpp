// Carries out an edit: builds a new world beside the old one and moves the state of everything that
// stays into it. Only if there is no fault does the new world replace the old one.

#include <algorithm>
#include <cmath>
#include <set>

#include "cable/cable_transfer.h"
#include "cable/edit_draft.h"
#include "cable/edit_references.h"
#include "cable/live_world.h"
#include "cable/machine_layout.h"
#include "cable/rope_inertia.h"
#include "engine/constraint_batch.h"
#include "engine/dynamics/motion_guess.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

class EditMaker {
 public:
  EditMaker(EditDraft& draft, State before)
      : draft_(draft), old_(draft.before.world()), then_(std::move(before)) {}

  Result<std::shared_ptr<LiveRevision>> make();

 private:
  struct Kept {  // a cable of the new world
    int slot = 0;
    CableStart start;
    double allowed = 0.0;
  };

  void list_joints();
  void place_rotors();
  [[nodiscard]] BodyState state_of(int body, const State& initial) const;
  void move_bodies();
  void list_cables();
  [[nodiscard]] std::unique_ptr<CableSystem> make_cables();
  void check_cables();
  [[nodiscard]] Controls controls() const;
  void map_cable_controls(Controls& controls) const;
  void map_joint_controls(Controls& controls, const World& world) const;
  [[nodiscard]] std::vector<CableRecord> records() const;
  void fail(std::string path, std::string message) {
    draft_.errors.push_back({std::move(path), std::move(message)});
  }
  /// Adds faults of the new model and its cables. In their paths indices of lists become slots of
  /// handles.
  void take(const Errors& found);

  EditDraft& draft_;
  const World& old_;
  State then_;
  std::shared_ptr<const BodySet> bodies_;
  State now_;                           // the state of the bodies
  std::optional<Substep> now_substep_;  // only if cables are changed
  BodyFrames frames_;
  std::vector<Kept> kept_;
  std::vector<CableDef> definitions_;
  CableSystem* system_ = nullptr;
  std::vector<BodyId> collider_bodies_;  // in the order of the new model
  SlotTable<JointTag> joints_;
};

void EditMaker::take(const Errors& found) {
  for (const Error& error : found) {
    const std::size_t begin = error.path.find('/', 1) + 1;
    const std::string list = error.path.substr(0, begin);
    const std::size_t end = std::min(error.path.find('/', begin), error.path.size());
    const bool known = list == "/joints/" || list == "/cables/" || list == "/colliders/";
    if (!known) {
      draft_.errors.push_back(error);
      continue;
    }
    const auto place = static_cast<std::size_t>(std::stoul(error.path.substr(begin, end - begin)));
    std::size_t slot = 0;
    if (list == "/joints/") slot = draft_.own_joints[place].slot;
    if (list == "/cables/") slot = at(kept_[place].slot);
    if (list == "/colliders/") {
      const BodyId body = collider_bodies_[place];
      slot = body.is_world() ? place : at(body.index);
    }
    fail(list + std::to_string(slot) + error.path.substr(end), error.message);
  }
}

void EditMaker::list_joints() {
  draft_.model.joints.clear();
  joints_ = draft_.joints;
  for (const DraftJoint& joint : draft_.own_joints) {
    joints_.set_index(joint.slot, static_cast<int>(draft_.model.joints.size()));
    draft_.model.joints.push_back(joint.definition);
  }
}

/// Edits give a mounted rotor's present pose. A model needs its pose with the carrier as at time 0.
void EditMaker::place_rotors() {
  for (std::size_t i = 0; i < draft_.model.bodies.size(); ++i) {
    BodyDef& body = draft_.model.bodies[i];
    if (draft_.is_new[i] == 0 || !body.mount || body.mount->is_world()) continue;
    const std::size_t carrier = at(body.mount->index);
    if (carrier >= draft_.is_new.size() || draft_.is_new[carrier] != 0) continue;
    const BodyDef& on = draft_.model.bodies[carrier];
    const Quaternion first = on.orientation.normalized();
    const Quaternion back = first * old_.orientation(*body.mount).conjugate();
    body.position = on.position + back * (body.position - old_.position(*body.mount));
    body.orientation = back * body.orientation;
    if (body.axis) body.axis = Vector3(back * *body.axis);
  }
}

BodyState EditMaker::state_of(int body, const State& initial) const {
  const BodyProperties& own = (*bodies_)[body];
  const bool is_new = draft_.is_new[at(body)] != 0;
  if (is_new && own.mobility == Mobility::kinematic) {
    return bodies_->kinematic_state(body, then_.time);
  }
  if (is_new) return initial.bodies[at(body)];
  BodyState state = then_.bodies[at(body)];
  const Vector3& before = old_.bodies()[body].center_of_mass;
  if (own.center_of_mass == before) return state;
  // The body's frame stays in place if its centre of mass changes.
  const Vector3 way = state.orientation * (own.center_of_mass - before);
  state.position += way;
  state.velocity += state.angular_velocity.cross(way);
  return state;
}

void EditMaker::move_bodies() {
  const bool any_new = std::any_of(draft_.is_new.begin(), draft_.is_new.end(),
                                   [](char is_new) { return is_new != 0; });
  const State initial = any_new ? bodies_->initial_state() : State{};
  now_.steps = then_.steps;
  now_.time = then_.time;
  now_.memory = then_.memory;
  now_.bodies.reserve(at(bodies_->count()));
  std::vector<int> origins;
  for (int i = 0; i < bodies_->count(); ++i) {
    now_.bodies.push_back(state_of(i, initial));
    origins.push_back(draft_.is_new[at(i)] != 0 ? -1 : i);
  }
  now_.history =
      adopted_history(then_.history, old_.bodies().coordinates(), bodies_->coordinates(), origins);
  for (int i = 0; i < bodies_->count(); ++i) {
    const BodyProperties& rotor = (*bodies_)[i];
    if (rotor.mount < 0 || draft_.is_new[at(i)] == 0 || draft_.is_new[at(rotor.mount)] != 0)
      continue;
    const BodyState& carrier = now_.bodies[at(rotor.mount)];
    BodyState& state = now_.bodies[at(i)];
    const Vector3 axis = carrier.orientation * rotor.axis;
    const Vector3 offset = carrier.orientation * rotor.mount_position;
    const Vector3 spin = draft_.model.bodies[at(i)].angular_velocity - carrier.angular_velocity;
    state.position = carrier.position + offset;
    state.orientation = carrier.orientation * rotor.start_orientation;
    state.velocity = carrier.velocity + carrier.angular_velocity.cross(offset);
    state.angular_velocity = carrier.angular_velocity + axis * axis.dot(spin);
  }
  auto frames = std::make_shared<std::vector<BodyFrame>>();
  frames->reserve(at(bodies_->count()));
  for (int i = 0; i < bodies_->count(); ++i) {
    const BodyState& state = now_.bodies[at(i)];
    frames->push_back(
        {state.position - state.orientation * (*bodies_)[i].center_of_mass, state.orientation});
  }
  frames_ = frames;
}

void EditMaker::list_cables() {
  const auto& slots = draft_.cables.slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].generation == 0) continue;
    const auto slot = static_cast<int>(i);
    const auto own = draft_.own_cables.find(slot);
    Kept kept;
    kept.slot = slot;
    if (own == draft_.own_cables.end()) {
      const CableRecord& record = draft_.before.records[i];
      if (record.place < 0) continue;
      kept.start.same_as = record.place;
      kept.start.defined_in = draft_.before.system()->cables()[at(record.place)].defined_in;
      definitions_.push_back(record.definition);
    } else if (!own->second.runs) {
      definitions_.push_back(own->second.definition);
    } else {
      DraftCable& cable = own->second;
      std::string fault = run_off(cable);
      if (!fault.empty()) fail(edit_path("cables", i), std::move(fault));
      cable.definition.links.clear();
      for (const RunningLink& link : cable.running.links) {
        if (link.is_listed()) cable.definition.links.push_back(link.link);
      }
      if (cable.definition.links.size() < 2) continue;
      kept.start.running = &cable.running;
      kept.allowed = cable.excess;
      definitions_.push_back(cable.definition);
    }
    kept_.push_back(kept);
  }
}

std::unique_ptr<CableSystem> EditMaker::make_cables() {
  std::vector<CableStart> starts;
  for (Kept& kept : kept_) {
    if (kept.start.same_as < 0) kept.start.defined_in = frames_;
    starts.push_back(kept.start);
  }
  Result<std::unique_ptr<CableSystem>> made = CableSystem::create(
      definitions_, *bodies_, starts, draft_.has_other_bodies ? nullptr : draft_.before.system());
  if (!made) {
    take(made.errors());
    return nullptr;
  }
  TransferFrom from;
  from.system = draft_.before.system();
  if (from.system != nullptr) from.state = &then_.features.back();
  const bool any_changed = std::any_of(starts.begin(), starts.end(), [](const CableStart& start) {
    return start.running != nullptr;
  });
  if (any_changed) now_substep_.emplace(*bodies_, now_, draft_.model.step.dt, 1);
  take(CableTransfer(**made).continue_from(from, now_substep_ ? &*now_substep_ : nullptr, starts));
  return std::move(*made);
}

void EditMaker::check_cables() {
  for (std::size_t c = 0; c < kept_.size(); ++c) {
    if (kept_[c].start.running == nullptr) continue;
    std::string fault =
        CableTransfer(*system_).start_fault(*now_substep_, static_cast<int>(c), kept_[c].allowed);
    if (!fault.empty()) fail(edit_path("cables", at(kept_[c].slot)), std::move(fault));
  }
}

void EditMaker::map_cable_controls(Controls& controls) const {
  for (std::size_t c = 0; c < kept_.size(); ++c) {
    const CableStart& start = kept_[c].start;
    const CompiledCable& own = system_->cables()[c];
    const auto put_link = [&](int link, const LinkControl& control) {
      if (control.is_set()) {
        controls.links.put(own.first_link + link, at(system_->link_count()), control);
      }
    };
    CableControl whole;
    if (start.running != nullptr) {
      whole = start.running->control;
      int listed = 0;
      for (const RunningLink& link : start.running->links) {
        if (link.is_listed()) put_link(listed++, link.control);
      }
    } else if (start.same_as >= 0) {
      if (const CableControl* set = then_.controls.cables.find(start.same_as)) whole = *set;
      const int first = draft_.before.system()->cables()[at(start.same_as)].first_link;
      for (int i = 0; i < own.listed_links; ++i) {
        if (const LinkControl* set = then_.controls.links.find(first + i)) put_link(i, *set);
      }
    }
    if (whole.is_set()) controls.cables.put(static_cast<int>(c), kept_.size(), whole);
  }
}

void EditMaker::map_joint_controls(Controls& controls, const World& world) const {
  if (!then_.controls.joint_drives.any()) return;
  std::map<const JointDef*, int> first;
  for (std::size_t j = 0; j < old_.model().joints.size(); ++j) {
    first[old_.model().joints[j].get()] = draft_.before.joint_places[j].first_coordinate;
  }
  std::size_t count = 0;
  const auto& joints = world.model().joints;
  const std::vector<JointPlace> places = number_joints(world.model(), world.features());
  for (const auto& joint : joints) count += joint->coordinates().size();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointDef& joint = *joints[j];
    const auto found = first.find(&joint);
    if (found == first.end()) continue;
    for (int k = 0; k < static_cast<int>(joint.coordinates().size()); ++k) {
      const DriveControl* set = then_.controls.joint_drives.find(found->second + k);
      if (set != nullptr) controls.joint_drives.put(places[j].first_coordinate + k, count, *set);
    }
  }
}

Controls EditMaker::controls() const {
  Controls controls;
  controls.has_gravity = then_.controls.has_gravity;
  controls.gravity = then_.controls.gravity;
  const std::size_t count = at(bodies_->count());
  for (int i = 0; i < bodies_->count(); ++i) {
    if (draft_.is_new[at(i)] != 0) continue;
    if (const auto* set = then_.controls.body_drives.find(i)) {
      controls.body_drives.put(i, count, *set);
    }
    if (const auto* set = then_.controls.forces.find(i)) controls.forces.put(i, count, *set);
    if (const auto* set = then_.controls.motions.find(i)) controls.motions.put(i, count, *set);
  }
  if (system_ != nullptr) map_cable_controls(controls);
  return controls;
}

std::vector<CableRecord> EditMaker::records() const {
  const auto& slots = draft_.cables.slots();
  std::vector<CableRecord> records(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].generation == 0) continue;
    const auto own = draft_.own_cables.find(static_cast<int>(i));
    if (own == draft_.own_cables.end()) {
      records[i] = draft_.before.records[i];
      records[i].place = -1;
      continue;
    }
    records[i].definition = own->second.definition;
    records[i].loose = own->second.loose;
    if (own->second.definition.links.size() < 2) records[i].running = own->second.running;
  }
  for (std::size_t c = 0; c < kept_.size(); ++c) {
    records[at(kept_[c].slot)].place = static_cast<int>(c);
  }
  return records;
}

Result<std::shared_ptr<LiveRevision>> EditMaker::make() {
  list_cables();
  list_joints();
  check_references(draft_);
  if (!draft_.errors.empty()) return draft_.errors;
  if (draft_.has_other_bodies) {
    place_rotors();
    Result<BodySet> bodies = BodySet::create(draft_.model);
    if (!bodies) return bodies.errors();
    bodies_ = std::make_shared<const BodySet>(std::move(*bodies));
  } else {
    bodies_ = old_.shared_bodies();
  }
  move_bodies();
  for (const DraftJoint& joint : draft_.own_joints) {
    if (joint.added != nullptr) joint.added->defined_in = frames_;
  }
  std::vector<std::unique_ptr<ConstraintBatch>> features;
  if (!definitions_.empty()) {
    std::unique_ptr<CableSystem> made = make_cables();
    system_ = made.get();
    if (made != nullptr) {
      if (auto inertia = RopeInertia::create(*made)) features.push_back(std::move(inertia));
      features.push_back(std::move(made));
    }
  }
  if (draft_.errors.empty() && system_ != nullptr) check_cables();
  for (const ColliderDef& collider : draft_.model.colliders)
    collider_bodies_.push_back(collider.body);
  const std::uint64_t layout = draft_.errors.empty() ? layout_of(draft_.model, definitions_) : 0;
  Result<World> world =
      World::create(std::move(draft_.model), bodies_, std::move(features), layout);
  if (!world) take(world.errors());
  if (!draft_.errors.empty()) return draft_.errors;
  now_.features = world->state().features;
  for (std::size_t f = 0; f < world->features().size(); ++f) {
    const ConstraintBatch& feature = *world->features()[f];
    if (&feature == system_) continue;
    for (std::size_t k = 0; k < old_.features().size(); ++k) {
      if (old_.features()[k]->name() != feature.name()) continue;
      feature.adopt(*old_.features()[k], then_.features[k], now_.features[f]);
    }
  }
  now_.controls = controls();
  world->memory().assign(now_.memory.size(), 0.0);
  map_joint_controls(now_.controls, *world);
  Errors errors = world->restore(now_);
  if (!errors.empty()) return errors;
  Simulation simulation(std::move(*world), system_,
                        std::make_shared<const std::vector<CableDef>>(definitions_));
  if (const auto& supervisor = draft_.before.simulation.supervisor) {
    auto again = supervisor->again(simulation);
    if (!again) return again.errors();
    simulation.set_supervisor(std::move(*again));
  }
  return std::make_shared<LiveRevision>(std::move(simulation), draft_.bodies, joints_,
                                        draft_.cables, records());
}

/// Length of the cable of a handle [m].
double length_of(const LiveRevision& revision, std::size_t slot) {
  const CableRecord& record = revision.records[slot];
  double length = record.loose[0].value_or(0.0) + record.loose[1].value_or(0.0);
  if (record.place < 0) return length + record.running.length();
  const State& state = revision.world().state();
  return length +
         CableTransfer(*revision.system())
             .running_cable(record.place, record.definition, state.features.back(), state.controls)
             .length();
}

double length_of(const LiveRevision& revision, CableHandle handle) {
  return revision.cables.has(handle) ? length_of(revision, at(handle.slot)) : 0.0;
}

}  // namespace

Result<double> LiveWorld::length(CableHandle cable) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return Error{"", std::move(fault)};
  return length_of(*revision_, cable);
}

Result<EditReport> LiveWorld::edit(const std::function<void(Edit&)>& changes) {
  if (is_busy_) return Error{"", busy_fault()};
  EditDraft draft(*revision_, next_generation_);
  Edit edit(draft);
  {
    const Busy busy(is_busy_);
    changes(edit);
  }
  if (!draft.errors.empty()) return draft.errors;
  Result<std::shared_ptr<LiveRevision>> made = EditMaker(draft, state()).make();
  if (!made) return made.errors();
  const Energy after = (*made)->world().energy();
  if (!std::isfinite(after.total())) return Error{"", std::string(energy_fault)};
  EditReport report;
  const Energy before = energy();
  std::set<std::pair<std::int32_t, std::uint32_t>> changed;
  for (const LiveRevision* revision : {revision_.get(), made->get()}) {
    const auto& slots = revision->cables.slots();
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const bool same = !draft.own_cables.contains(static_cast<int>(i)) &&
                        made->get()->cables.has(revision->cables.handle(i));
      if (slots[i].generation == 0 || same) continue;
      changed.emplace(static_cast<std::int32_t>(i), slots[i].generation);
    }
  }
  for (const auto& [slot, generation] : changed) {
    const CableHandle handle{slot, generation};
    const double added = length_of(**made, handle) - length_of(*revision_, handle);
    if (added != 0.0) report.cables.push_back({handle, added});
  }
  revision_ = std::move(*made);
  report.energy = {after.kinetic - before.kinetic, after.potential - before.potential,
                   after.elastic - before.elastic};
  return report;
}

}  // namespace sheave
