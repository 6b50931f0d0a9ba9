#include "live/edit_names.h"

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/observables.h"

namespace sheave::live {

EditReader::EditReader(PartReader& parts, const Names& names)
    : parts_(parts), next_number_(names.body_slots()) {
  for (const std::string& name : names.bodies()) {
    fields().declare_body(name, names.body(name)->slot);
  }
}

void EditReader::add_body(std::string_view name) { fields().declare_body(name, next_number_++); }
void EditReader::remove_body(std::string_view name) { fields().forget_body(name); }

EditNames::EditNames(const LiveWorld& world, const Names& names)
    : step(world.simulation().world.model().step), world_(world), names_(names) {}

Result<BodyHandle> EditNames::body(const std::string& name, const std::string& pointer) const {
  const auto found = bodies_.find(name);
  if (found != bodies_.end()) return found->second.handle;
  return names_.body(name, pointer);
}

Result<JointHandle> EditNames::joint(const std::string& name, const std::string& pointer) const {
  const auto found = joints_.find(name);
  if (found != joints_.end()) return found->second.handle;
  return names_.joint(name, pointer);
}

Result<CableHandle> EditNames::cable(const std::string& name, const std::string& pointer) const {
  const auto found = cables_.find(name);
  if (found != cables_.end()) return found->second;
  return names_.cable(name, pointer);
}

void EditNames::add(BodyHandle body, const BodyDef& definition) {
  added_bodies_.push_back(body);
  bodies_.insert_or_assign(definition.name, Body{body, definition});
  removed_bodies_.erase(definition.name);
}

void EditNames::add(JointHandle joint, std::shared_ptr<const JointDef> definition) {
  const std::string& name = definition->name;
  removed_joints_.erase(name);
  joints_.insert_or_assign(name, Joint{joint, std::move(definition)});
}

void EditNames::add(CableHandle cable, const std::string& name) {
  cables_.insert_or_assign(name, cable);
}

void EditNames::change(const BodyDef& definition) {
  const Result<BodyHandle> handle = body(definition.name);
  if (handle) bodies_.insert_or_assign(definition.name, Body{*handle, definition});
}

BodyId EditNames::id(Edit& edit, BodyId read) const {
  const int first = names_.body_slots();
  if (read.index < first) return read;
  const std::size_t added = at(read.index - first);
  return added < added_bodies_.size() ? edit.id(added_bodies_[added]) : read;
}

void EditNames::put_ids(Edit& edit, std::span<const Field> fields, void* object) const {
  for (const Field& field : fields) {
    const FieldSlot slot = field.slot(object);
    if (BodyId* const* one = std::get_if<BodyId*>(&slot)) **one = id(edit, **one);
    if (std::optional<BodyId>* const* one = std::get_if<std::optional<BodyId>*>(&slot)) {
      if (**one) **one = id(edit, ***one);
    }
  }
}

const BodyDef* EditNames::body_called(const std::string& name) const {
  if (removed_bodies_.contains(name)) return nullptr;
  const auto found = bodies_.find(name);
  if (found != bodies_.end()) return &found->second.definition;
  const Result<BodyHandle> handle = names_.body(name);
  return handle ? &world_.simulation().world.model().bodies[at(handle->slot)] : nullptr;
}

const JointDef* EditNames::joint_called(const std::string& name) const {
  if (removed_joints_.contains(name)) return nullptr;
  const auto found = joints_.find(name);
  if (found != joints_.end()) return found->second.definition.get();
  const Result<JointHandle> handle = names_.joint(name);
  return handle ? world_.definition(*handle) : nullptr;
}

Errors EditNames::shared_names() const {
  Errors errors;
  const auto check = [&](const std::string& name, const std::string& path) {
    const BodyDef* body = body_called(name);
    const JointDef* joint = joint_called(name);
    if (body == nullptr || joint == nullptr) return;
    const std::string shared = shared_quantity(*joint, *body);
    if (shared.empty()) return;
    errors.push_back({path + "/name",
                      fmt::format("a body and a joint are both called \"{0}\", so {0}.{1} could be "
                                  "that of either; choose another name",
                                  name, shared)});
  };
  for (const auto& [name, joint] : joints_) check(name, part_path("joints", joint.handle));
  for (const auto& [name, body] : bodies_) {
    if (!joints_.contains(name)) check(name, part_path("bodies", body.handle));
  }
  return errors;
}

void EditNames::tell_part(const std::string& path, const std::string& pointer, bool exact) {
  // A removed part may have had the same slot.
  parts_.insert_or_assign(path, Part{change_ + pointer, exact});
}

void EditNames::tell_change(const std::string& path, const std::string& pointer, bool exact) {
  parts_.emplace(path, Part{change_ + pointer, exact});
}

std::string EditNames::pointer_of(const std::string& path) const {
  // The path of a part has two steps, "/bodies/3", that of the step settings one.
  const std::size_t second = path.find('/', 1);
  const std::size_t third = second == std::string::npos ? second : path.find('/', second + 1);
  for (const std::size_t end : {third, second}) {
    const auto part = parts_.find(path.substr(0, end));
    if (part == parts_.end()) continue;
    const std::string rest = end == std::string::npos ? std::string() : path.substr(end);
    return part->second.pointer + (part->second.exact ? rest : std::string());
  }
  return {};
}

}  // namespace sheave::live
