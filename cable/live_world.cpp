#include "cable/live_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cable/cable_system.h"
#include "cable/live_revision.h"
#include "cable/start_warnings.h"
#include "engine/constraint_batch.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Generation of the handles of initial objects; default handles have 0.
constexpr std::uint32_t first_generation = 1;

/// Slots of initial objects.
template <class Tag>
SlotTable<Tag> first_slots(std::size_t count) {
  SlotTable<Tag> slots;
  for (std::size_t i = 0; i < count; ++i) slots.add(static_cast<int>(i), first_generation);
  return slots;
}

/// The handle of the object with this name, or an error that lists the existing names.
template <class Tag, class NameOf>
Result<Handle<Tag>> find(const SlotTable<Tag>& slots, std::string_view kind, std::string_view name,
                         const NameOf& name_of) {
  std::string names;
  for (std::size_t i = 0; i < slots.slots().size(); ++i) {
    if (slots.slots()[i].generation == 0) continue;
    const std::string& own = name_of(i);
    if (own == name) return slots.handle(i);
    constexpr std::size_t enough = 200;
    if (names.size() > enough) continue;
    if (!names.empty()) names += ", ";
    names += own;
  }
  const std::string start =
      "there is no " + std::string(kind) + " \"" + std::string(name) + "\"; there ";
  return Error{"", start + (names.empty() ? "is none" : "are: " + names)};
}

template <class Tag>
std::vector<Handle<Tag>> all(const SlotTable<Tag>& slots) {
  std::vector<Handle<Tag>> handles;
  for (std::size_t i = 0; i < slots.slots().size(); ++i) {
    if (slots.slots()[i].generation != 0) handles.push_back(slots.handle(i));
  }
  return handles;
}

Error because(std::string fault) { return {"", std::move(fault)}; }

}  // namespace

LiveRevision::LiveRevision(Simulation made, SlotTable<BodyTag> body_slots,
                           SlotTable<JointTag> joint_slots, SlotTable<CableTag> cable_slots,
                           std::vector<CableRecord> cable_records)
    : simulation(std::move(made)),
      bodies(std::move(body_slots)),
      joints(std::move(joint_slots)),
      cables(std::move(cable_slots)),
      records(std::move(cable_records)),
      joint_places(number_joints(simulation.world.model(), simulation.world.features())) {
  const World& world = simulation.world;
  if (!joint_places.empty()) {
    view.emplace(world.bodies(), world.state(), world.model().step.dt, 1);
  }
  for (std::size_t j = 0; j < joint_places.size(); ++j) {
    const JointDef& joint = *simulation.world.model().joints[j];
    if (joint.breaking_force || joint.breaking_torque) {
      breakable_joints.push_back(static_cast<int>(j));
    }
  }
  joint_handles.resize(joint_places.size());
  for (const JointHandle joint : all(joints)) joint_handles[at(joints.index(joint))] = joint;
  cable_handles.resize(simulation.cable_definitions->size());
  for (const CableHandle cable : all(cables)) {
    const int place = records[at(cable.slot)].place;
    if (place >= 0) cable_handles[at(place)] = cable;
  }
}

CableSystem* LiveRevision::system() const {
  if (simulation.cables == nullptr) return nullptr;
  return static_cast<CableSystem*>(simulation.world.features().back().get());
}

LiveWorld::LiveWorld(Simulation simulation, std::vector<Warning> at_start)
    : at_start_(std::move(at_start)), identity_(std::make_shared<const int>(0)) {
  const Model& model = simulation.world.model();
  std::vector<CableRecord> records;
  for (const CableDef& cable : *simulation.cable_definitions) {
    CableRecord& record = records.emplace_back();
    record.definition = cable;
    record.place = static_cast<int>(records.size()) - 1;
  }
  const std::size_t bodies = model.bodies.size();
  const std::size_t joints = model.joints.size();
  const std::size_t cables = records.size();
  revision_ = std::make_shared<LiveRevision>(std::move(simulation), first_slots<BodyTag>(bodies),
                                             first_slots<JointTag>(joints),
                                             first_slots<CableTag>(cables), std::move(records));
}

LiveWorld::~LiveWorld() = default;
LiveWorld::LiveWorld(LiveWorld&&) noexcept = default;
LiveWorld& LiveWorld::operator=(LiveWorld&&) noexcept = default;

Result<LiveWorld> LiveWorld::create(const Model& model, const std::vector<CableDef>& cables) {
  Result<Simulation> simulation = Simulation::create(model, cables);
  if (!simulation) return simulation.errors();
  std::vector<Warning> warnings;
  if (simulation->cables != nullptr) {
    append_winding_warnings(*simulation->cables, warnings);
    append_uneven_warnings(*simulation, warnings);
    append_strain_warnings(*simulation, warnings);
  }
  return LiveWorld(std::move(*simulation), std::move(warnings));
}

const Simulation& LiveWorld::simulation() const { return revision_->simulation; }
Simulation& LiveWorld::running() { return revision_->simulation; }

std::vector<BodyHandle> LiveWorld::bodies() const { return all(revision_->bodies); }
std::vector<JointHandle> LiveWorld::joints() const { return all(revision_->joints); }
std::vector<CableHandle> LiveWorld::cables() const { return all(revision_->cables); }

Result<BodyHandle> LiveWorld::body(std::string_view name) const {
  const auto& bodies = simulation().world.model().bodies;
  return find(revision_->bodies, "body", name,
              [&](std::size_t slot) -> const std::string& { return bodies[slot].name; });
}

Result<JointHandle> LiveWorld::joint(std::string_view name) const {
  const auto& joints = simulation().world.model().joints;
  const auto& slots = revision_->joints.slots();
  return find(revision_->joints, "joint", name, [&](std::size_t slot) -> const std::string& {
    return joints[at(slots[slot].index)]->name;
  });
}

Result<CableHandle> LiveWorld::cable(std::string_view name) const {
  return find(revision_->cables, "cable", name, [&](std::size_t slot) -> const std::string& {
    return revision_->records[slot].definition.name;
  });
}

const JointDef* LiveWorld::definition(JointHandle joint) const {
  if (!revision_->joints.has(joint)) return nullptr;
  return simulation().world.model().joints[at(index_of(joint))].get();
}

Result<std::string> LiveWorld::name(BodyHandle body) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  return simulation().world.model().bodies[at(body.slot)].name;
}

Result<std::string> LiveWorld::name(JointHandle joint) const {
  std::string fault = fault_of(joint);
  if (!fault.empty()) return because(std::move(fault));
  return simulation().world.model().joints[at(index_of(joint))]->name;
}

Result<std::string> LiveWorld::name(CableHandle cable) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return because(std::move(fault));
  return revision_->records[at(cable.slot)].definition.name;
}

BodyHandle LiveWorld::body_at(int index) const { return revision_->bodies.handle(at(index)); }
JointHandle LiveWorld::joint_at(int index) const { return revision_->joint_handles[at(index)]; }
CableHandle LiveWorld::cable_at(int index) const { return revision_->cable_handles[at(index)]; }

std::string LiveWorld::fault_of(BodyHandle body) const {
  return revision_->bodies.fault_of(body, "body");
}
std::string LiveWorld::fault_of(JointHandle joint) const {
  return revision_->joints.fault_of(joint, "joint");
}
std::string LiveWorld::fault_of(CableHandle cable) const {
  return revision_->cables.fault_of(cable, "cable");
}
int LiveWorld::index_of(JointHandle joint) const { return revision_->joints.index(joint); }
int LiveWorld::index_of(CableHandle cable) const {
  return revision_->records[at(cable.slot)].place;
}

bool LiveWorld::pulls(CableHandle cable) const {
  return revision_->cables.has(cable) && index_of(cable) >= 0;
}

bool LiveWorld::is_cut(CableHandle cable) const {
  if (!pulls(cable)) return false;
  const CableSystem& system = *simulation().cables;
  const FeatureState& own = simulation().world.state().features.back();
  return own.integers[system.cut_index(index_of(cable))] != 0;
}

std::string LiveWorld::pull_fault(CableHandle cable) const {
  std::string fault = fault_of(cable);
  if (!fault.empty() || index_of(cable) >= 0) return fault;
  return "cable \"" + revision_->records[at(cable.slot)].definition.name +
         "\" hangs loose and has no tension; attach it first";
}

std::string LiveWorld::span_fault(CableHandle cable, int span) const {
  std::string fault = pull_fault(cable);
  if (!fault.empty()) return fault;
  const CompiledCable& own = simulation().cables->cables()[at(index_of(cable))];
  if (span >= 0 && span < own.listed_spans) return {};
  return "cable \"" + own.name + "\" has no span number " + std::to_string(span) + "; it has " +
         std::to_string(own.listed_spans);
}

bool LiveWorld::is_broken(int joint) const {
  const World& world = simulation().world;
  const JointPlace& place = revision_->joint_places[at(joint)];
  for (std::size_t f = 0; f < world.features().size(); ++f) {
    if (world.features()[f].get() != place.feature) continue;
    return place.feature->is_broken(place.index, world.feature_state(f));
  }
  return false;
}

void LiveWorld::note_events(LiveReport& report) const {
  CableSystem* cables = revision_->system();
  if (cables == nullptr) return;
  report.events = cables->take_events();
  if (report.events.size() <= LiveReport::most_events) return;
  report.omitted = report.events.size() - LiveReport::most_events;
  report.events.resize(LiveReport::most_events);
}

LiveReport LiveWorld::step(const StopRequest& stop, const std::function<void()>& before_substep) {
  LiveReport report;
  report.stopped = is_busy_;
  if (is_busy_) return report;
  std::vector<int> intact;
  for (const int joint : revision_->breakable_joints) {
    if (!is_broken(joint)) intact.push_back(joint);
  }
  const Busy busy(is_busy_);
  const CableSystem* cables = running().cables;
  const double begin = time();
  const std::uint64_t edition = cables != nullptr ? cables->warnings_edition() : 0;
  const bool follows = simulation().world.last_substep().has_value();
  if (check_ && !follows) check_->restart(simulation());
  static_cast<StepReport&>(report) = running().step(
      stop, check_ ? check_->within(simulation()) : std::function<void()>(), before_substep);
  if (check_ && report.ok()) check_->observe(simulation(), report.statistics);
  note_events(report);
  if (!report.stopped) report.warnings = std::exchange(at_start_, {});
  if (!report.stopped) append_solver_warnings(report.statistics, report.warnings);
  if (!report.stopped && cables != nullptr && cables->warnings_edition() != edition) {
    append_cable_warnings(*cables, running().world.bodies(), begin, report.warnings);
  }
  for (const int joint : intact) {
    if (is_broken(joint)) {
      report.broken_joints.push_back(revision_->joint_handles[at(joint)]);
    }
  }
  return report;
}

void LiveWorld::check_run() { check_.emplace(simulation()); }

Certificate LiveWorld::run_certificate() const {
  return check_ ? check_->certificate() : Certificate();
}

Result<BodyPose> LiveWorld::pose(BodyHandle body) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  const World& world = simulation().world;
  const BodyId id{body.slot};
  return BodyPose{world.position(id), world.orientation(id), world.velocity(id),
                  world.angular_velocity(id)};
}

Result<Vector3> LiveWorld::point(BodyHandle body, const Vector3& local) const {
  std::string fault = fault_of(body);
  if (!fault.empty()) return because(std::move(fault));
  return simulation().world.point({body.slot}, local);
}

Result<double> LiveWorld::tension(CableHandle cable, int span) const {
  std::string fault = span_fault(cable, span);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation().cables;
  const CompiledCable& own = system.cables()[at(index_of(cable))];
  return state().features.back().reals[system.tension_index(own.first_span + span)];
}

Result<double> LiveWorld::rest_length(CableHandle cable, int span) const {
  std::string fault = span_fault(cable, span);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation().cables;
  const CompiledCable& own = system.cables()[at(index_of(cable))];
  return state().features.back().reals[system.rest_length_index(own.first_span + span)];
}

Result<double> LiveWorld::stored_length(CableHandle cable, int link) const {
  std::string fault = pull_fault(cable);
  if (!fault.empty()) return because(std::move(fault));
  const CableSystem& system = *simulation().cables;
  const CompiledCable& own = system.cables()[at(index_of(cable))];
  if (link < 0 || link >= own.listed_links) {
    return because("cable \"" + own.name + "\" has no link number " + std::to_string(link) +
                   "; it has " + std::to_string(own.listed_links));
  }
  return state().features.back().reals[system.stored_length_index(own.first_link + link)];
}

Result<std::optional<double>> LiveWorld::loose_length(CableHandle cable, CableEnd end) const {
  std::string fault = fault_of(cable);
  if (!fault.empty()) return because(std::move(fault));
  return revision_->records[at(cable.slot)].loose[end == CableEnd::first ? 0 : 1];
}

Result<std::size_t> LiveWorld::cable_polyline(CableHandle cable, int span,
                                              const CableReports& cables,
                                              const PolylineOptions& options,
                                              std::span<Vector3> points) const {
  std::string fault = pull_fault(cable);
  if (!fault.empty()) return because(std::move(fault));
  const auto place = at(index_of(cable));
  const std::string& name = simulation().cables->cables()[place].name;
  if (place >= cables.all().size() || cables.all()[place].name != name) {
    return because("these reports are not of cable \"" + name +
                   "\"; call CableReports::read() with this world after each step and edit");
  }
  if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
    return because("tolerance: must be a number above 0 [m]");
  }
  const CableReport& report = cables.all()[place];
  if (report.cut && (span == 0 || span == 1)) {
    return piece_polyline(report, at(span), options, points);
  }
  if (report.cut) {
    return because("cable \"" + name + "\" is cut and has no piece number " + std::to_string(span) +
                   "; its pieces are 0 and 1");
  }
  fault = span_fault(cable, span);
  if (!fault.empty()) return because(std::move(fault));
  return sheave::cable_polyline(report, at(span), options, points);
}

Result<Wrench> LiveWorld::force(JointHandle joint) const {
  std::string fault = fault_of(joint);
  if (!fault.empty()) return because(std::move(fault));
  const World& world = simulation().world;
  const JointPlace& place = revision_->joint_places[at(index_of(joint))];
  const JointDef& definition = *world.model().joints[at(index_of(joint))];
  const auto look_at = [&](BodyId id) {
    if (id.is_world()) return;
    for (const int body : {id.index, world.bodies()[id.index].mount}) {
      if (body < 0) continue;
      const BodyState& now = state().bodies[at(body)];
      MovingBody& moving = revision_->view->moving[at(body)];
      moving.position = now.position;
      moving.orientation = now.orientation;
    }
  };
  look_at(definition.body_a);
  look_at(definition.body_b);
  look_at(definition.carrier_body());
  for (std::size_t f = 0; f < world.features().size(); ++f) {
    if (world.features()[f].get() != place.feature) continue;
    return place.feature->wrench_of(place.index, *revision_->view, world.feature_state(f));
  }
  return because("joint \"" + definition.name + "\" does nothing");
}

std::string LiveWorld::busy_fault() const {
  return is_busy_ ? "this cannot be done from within a step or an edit; do it afterwards" : "";
}

Errors LiveWorld::restore(const State& state) { return restore(revision_, state); }

/// Restores the state in the world of `revision`; on an error that world is unchanged. Only then
/// `revision` becomes the current one, which cannot fail.
Errors LiveWorld::restore(std::shared_ptr<LiveRevision> revision, const State& state) {
  if (is_busy_) return {because(busy_fault())};
  Errors errors = revision->simulation.world.restore(state);
  if (!errors.empty()) return errors;
  if (CableSystem* cables = revision->system()) static_cast<void>(cables->take_events());
  revision_ = std::move(revision);
  return {};
}

std::shared_ptr<const void> LiveWorld::keep_in_place() {
  running().world.keep_in_place();
  return revision_;
}

LiveSnapshot LiveWorld::snapshot() const { return {state(), revision_, identity_}; }

Errors LiveWorld::restore(const LiveSnapshot& snapshot) {
  if (snapshot.identity_ != identity_) {
    return {{"", "the snapshot belongs to another world"}};
  }
  return restore(snapshot.revision_, snapshot.state_);
}

}  // namespace sheave
