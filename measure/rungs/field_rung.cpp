#include "measure/rungs/field_rung.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "scenes/format.h"

namespace sheave::measure {
namespace {

bool is_one_of(std::string_view field, const FieldNames& names) {
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    return field == name || field.ends_with("_" + std::string(name));
  });
}

void copy_field(const Field& field, const void* from, void* to) {
  const FieldSlot source = slot_of(field, from);
  FieldSlot target = field.slot(to);
  std::visit(
      [&](auto& slot) {
        using Slot = std::decay_t<decltype(slot)>;
        const Slot& old = std::get<Slot>(source);
        if constexpr (std::is_same_v<Slot, ChoiceSlot>) {
          slot.set(slot.object, old.get(old.object));
        } else {
          *slot = *old;
        }
      },
      target);
}

/// Copies the named fields, or all if `names` is null. Returns whether any value has changed.
bool copy_fields(std::span<const Field> table, const void* from, void* to,
                 const FieldNames* names = nullptr) {
  bool changed = false;
  for (const Field& field : table) {
    if (names != nullptr && !is_one_of(field.name, *names)) continue;
    changed = changed || !same_value(field, from, to);
    copy_field(field, from, to);
  }
  return changed;
}

template <class Def>
int reset_structs(std::vector<Def>& list, const FieldNames& names) {
  const Def defaults;
  int count = 0;
  for (Def& one : list) {
    count += copy_fields(Def::field_table(), &defaults, &one, &names) ? 1 : 0;
  }
  return count;
}

/// A copy of the definition with the named fields of its type at their defaults; null if nothing
/// changes.
template <class Def>
std::shared_ptr<const Def> reset_one(std::span<const TypeEntry<Def>> types, const Def& old,
                                     const FieldNames& names) {
  const auto entry = std::find_if(types.begin(), types.end(),
                                  [&](const auto& type) { return type.name == old.type(); });
  if (entry == types.end()) return nullptr;
  std::shared_ptr<Def> copy = entry->make();
  const std::unique_ptr<Def> defaults = entry->make();
  copy_fields(Def::common_field_table(), &old, copy.get());
  // settings() points to the object that was created here, as its derived type.
  void* const own = const_cast<void*>(copy->settings());
  copy_fields(entry->fields(), old.settings(), own);
  const bool changed = copy_fields(entry->fields(), defaults->settings(), own, &names);
  return changed ? copy : nullptr;
}

}  // namespace

int reset_bodies(Scene& scene, const FieldNames& fields) {
  return reset_structs(scene.model.bodies, fields);
}

int reset_joints(Scene& scene, const FieldNames& fields) {
  int count = 0;
  for (auto& joint : scene.model.joints) {
    auto changed = reset_one(joint_types(), *joint, fields);
    if (!changed) continue;
    joint = std::move(changed);
    ++count;
  }
  return count;
}

int reset_cables(Scene& scene, const FieldNames& fields) {
  return reset_structs(scene.cables, fields);
}

int reset_links(Scene& scene, std::string_view type, const FieldNames& fields) {
  int count = 0;
  for (CableDef& cable : scene.cables) {
    for (auto& link : cable.links) {
      if (link->type() != type) continue;
      auto changed = reset_one(link_types(), *link, fields);
      if (!changed) continue;
      link = std::move(changed);
      ++count;
    }
  }
  return count;
}

int reset_colliders(Scene& scene, const FieldNames& fields) {
  return reset_structs(scene.model.colliders, fields);
}

}  // namespace sheave::measure
