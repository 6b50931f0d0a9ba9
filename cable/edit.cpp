// Changes of bodies, joints and colliders.

#include "cable/edit.h"

#include <algorithm>

#include "cable/edit_draft.h"
#include "engine/index.h"

namespace sheave {

BodyDef no_body(std::size_t slot) {
  BodyDef body;
  body.name = "(no body " + std::to_string(slot) + ")";
  body.mobility = Mobility::fixed;
  return body;
}

EditDraft::EditDraft(LiveRevision& from, std::uint32_t& generation)
    : before(from),
      next_generation(generation),
      model(from.world().model()),
      bodies(from.bodies),
      joints(from.joints),
      cables(from.cables),
      is_new(model.bodies.size(), 0) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    own_joints.push_back({model.joints[j], nullptr, at(from.joint_handles[j].slot)});
  }
}

const Errors& Edit::errors() const { return draft_.errors; }
void Edit::fail(std::string message) { draft_.fail(std::move(message)); }

BodyId Edit::id(BodyHandle body) {
  if (body == BodyHandle{}) return BodyId::world();
  static_cast<void>(draft_.check(draft_.bodies, body, "body"));
  return {body.slot};
}

BodyHandle Edit::add(BodyDef body) {
  // Not in the slot of a body that this edit removes: references to that body must not refer to
  // this one.
  const BodyHandle handle = draft_.bodies.add(-1, draft_.next_generation++, draft_.is_new);
  const std::size_t slot = at(handle.slot);
  draft_.has_other_bodies = true;
  draft_.bodies.set_index(slot, handle.slot);
  if (slot >= draft_.model.bodies.size()) {
    draft_.model.bodies.resize(slot + 1);
    draft_.is_new.resize(slot + 1, 0);
  }
  draft_.model.bodies[slot] = std::move(body);
  draft_.is_new[slot] = 1;
  return handle;
}

JointHandle Edit::add(const std::shared_ptr<JointDef>& joint) {
  if (joint == nullptr) {
    draft_.fail("a joint that is added must not be null");
    return {};
  }
  const JointHandle handle = draft_.joints.add(-1, draft_.next_generation++);
  draft_.own_joints.push_back({joint, joint, at(handle.slot)});
  return handle;
}

CableHandle Edit::add(CableDef cable) {
  const CableHandle handle = draft_.cables.add(-1, draft_.next_generation++);
  draft_.cables.set_index(at(handle.slot), handle.slot);
  DraftCable& own = draft_.own_cables[handle.slot];
  own = {};
  own.definition = std::move(cable);
  return handle;
}

void Edit::add(const ColliderDef& collider) { draft_.model.colliders.push_back(collider); }

void Edit::remove(BodyHandle body) {
  if (!draft_.check(draft_.bodies, body, "body")) return;
  draft_.has_other_bodies = true;
  BodyDef& definition = draft_.model.bodies[at(body.slot)];
  draft_.bodies.remove(body, definition.name);
  definition = no_body(at(body.slot));
  draft_.is_new[at(body.slot)] = 1;
  std::erase_if(draft_.model.colliders,
                [&](const ColliderDef& own) { return own.body.index == body.slot; });
}

void Edit::remove(JointHandle joint) {
  if (!draft_.check(draft_.joints, joint, "joint")) return;
  const auto own = std::find_if(draft_.own_joints.begin(), draft_.own_joints.end(),
                                [&](const DraftJoint& j) { return j.slot == at(joint.slot); });
  draft_.joints.remove(joint, own->definition->name);
  draft_.own_joints.erase(own);
}

void Edit::remove(CableHandle cable) {
  if (!draft_.check(draft_.cables, cable, "cable")) return;
  draft_.cables.remove(cable, draft_.cable_name(cable));
  draft_.own_cables.erase(cable.slot);
}

void Edit::remove_collider(BodyHandle body) {
  if (!draft_.check(draft_.bodies, body, "body")) return;
  const auto removed = std::erase_if(
      draft_.model.colliders, [&](const ColliderDef& own) { return own.body.index == body.slot; });
  if (removed == 0) {
    draft_.fail("body \"" + draft_.model.bodies[at(body.slot)].name + "\" has no collider");
  }
}

void Edit::change(BodyHandle body, const std::function<void(BodyDef&)>& change) {
  if (!draft_.check(draft_.bodies, body, "body")) return;
  BodyDef& definition = draft_.model.bodies[at(body.slot)];
  BodyDef changed = definition;
  change(changed);
  const bool stays = changed.mobility == definition.mobility && changed.axis == definition.axis &&
                     changed.mount == definition.mount && changed.position == definition.position &&
                     changed.orientation.coeffs() == definition.orientation.coeffs() &&
                     changed.velocity == definition.velocity &&
                     changed.angular_velocity == definition.angular_velocity;
  if (!stays) {
    draft_.fail("body \"" + definition.name +
                "\": mobility, axis, mount, position, orientation and velocities cannot be "
                "changed; move it with place(), or add another body");
    return;
  }
  definition = std::move(changed);
  draft_.has_other_bodies = true;
}

void Edit::set_step(const StepSettings& step) {
  if (step.dt != draft_.model.step.dt) {
    draft_.fail("dt cannot be changed in a running world, which counts its time in steps of dt");
    return;
  }
  draft_.model.step = step;
}

}  // namespace sheave
