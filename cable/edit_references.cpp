#include "cable/edit_references.h"

#include <set>
#include <unordered_set>

#include "engine/index.h"

namespace sheave {
namespace {

void fail(EditDraft& draft, std::string path, std::string message) {
  draft.errors.push_back({std::move(path), std::move(message)});
}

/// Checks the reference of `who` at `path` to a body. `is_new`: the reference was added by this
/// edit.
void refer(EditDraft& draft, BodyId body, bool is_new, const std::string& who,
           const std::string& path) {
  if (body.is_world()) return;
  const auto& slots = draft.bodies.slots();
  const bool known = body.index >= 0 && at(body.index) < slots.size();
  if (known && !is_new && draft.is_new[at(body.index)] != 0) {
    // Another body may have been added in the slot.
    fail(draft, path,
         who + " is on body \"" + slots[at(body.index)].last_name + "\", which is removed");
  } else if (!known || slots[at(body.index)].generation == 0) {
    fail(draft, path,
         who + " is on a body that does not exist, number " + std::to_string(body.index));
  }
}

void check_cable_references(EditDraft& draft) {
  std::set<const LinkDef*> known;
  if (draft.has_other_bodies) {
    for (const CableRecord& record : draft.before.records) {
      for (const auto& link : record.definition.links) known.insert(link.get());
    }
  }
  std::unordered_set<std::string_view> names;
  const auto& slots = draft.cables.slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].generation == 0) continue;
    const auto own = draft.own_cables.find(static_cast<int>(i));
    const CableDef& cable =
        own != draft.own_cables.end() ? own->second.definition : draft.before.records[i].definition;
    if (cable.name.empty())
      fail(draft, edit_path("cables", i) + "/name", "a cable needs a name that is not empty");
    const auto who = [&] { return "cable \"" + cable.name + "\""; };
    if (!names.insert(cable.name).second) {
      fail(draft, edit_path("cables", i) + "/name",
           who() + ": two cables have this name; names must differ");
    }
    if (!draft.has_other_bodies && own == draft.own_cables.end()) continue;
    for (const auto& link : cable.links) {
      if (link == nullptr) continue;
      for (const BodyId body : {link->body, link->exit_body()}) {
        refer(draft, body, !known.contains(link.get()), who(), edit_path("cables", i));
      }
    }
  }
}

}  // namespace

std::string edit_path(std::string_view list, std::size_t slot) {
  return "/" + std::string(list) + "/" + std::to_string(slot);
}

void check_references(EditDraft& draft) {
  for (std::size_t i = 0; i < draft.model.bodies.size(); ++i) {
    const BodyDef& body = draft.model.bodies[i];
    if (!body.mount) continue;
    refer(draft, *body.mount, draft.is_new[i] != 0, "body \"" + body.name + "\"",
          edit_path("bodies", i));
  }
  for (const DraftJoint& joint : draft.own_joints) {
    const std::string who = "joint \"" + joint.definition->name + "\"";
    const JointDef& own = *joint.definition;
    for (const BodyId body : {own.body_a, own.body_b, own.carrier_body()}) {
      refer(draft, body, joint.added != nullptr, who, edit_path("joints", joint.slot));
    }
  }
  for (const ColliderDef& collider : draft.model.colliders) {
    const std::size_t body = collider.body.is_world() ? 0 : at(collider.body.index);
    refer(draft, collider.body, true, "a collider", edit_path("colliders", body));
  }
  check_cable_references(draft);
}

}  // namespace sheave
