// Setters of LiveWorld: those of World and Simulation, by handle.

#include "cable/live_revision.h"
#include "cable/live_world.h"
#include "engine/constraint_batch.h"
#include "engine/index.h"

namespace sheave {
namespace {

// Error texts are composed in cold functions, away from the hot path.

template <class Tag>
[[gnu::cold, gnu::noinline]] Errors refuse(const SlotTable<Tag>& slots, Handle<Tag> handle,
                                           const char* kind) {
  return {{"", slots.fault_of(handle, kind)}};
}

[[gnu::cold, gnu::noinline]] Errors refuse(std::string fault) { return {{"", std::move(fault)}}; }

/// Index in the simulation of a cable that exists and lies between two holds; otherwise -1.
int place_of(const LiveRevision& revision, CableHandle cable) {
  return revision.cables.has(cable) ? revision.records[at(cable.slot)].place : -1;
}

[[gnu::cold, gnu::noinline]] Errors refuse_drive(const BodyDef& body, DriveKind kind) {
  const auto name = [](DriveKind drive) {
    return std::string(drive_names[static_cast<std::size_t>(drive)]);
  };
  return {{"", "the drive of body \"" + body.name + "\" has a" +
                   (body.drive == DriveKind::angle ? "n " : " ") + name(body.drive) + ", and no " +
                   name(kind)}};
}

}  // namespace

Errors LiveWorld::set_together(const std::function<Errors()>& set) {
  Controls before = state().controls;
  Errors errors = set();
  if (!errors.empty()) revision_->simulation.world.controls_of_features() = std::move(before);
  return errors;
}

Errors LiveWorld::set_in_simulation(const std::function<Errors(Simulation&)>& set) {
  return set_together([&] { return set(revision_->simulation); });
}

Errors LiveWorld::set_gravity(const Vector3& gravity) {
  return revision_->simulation.world.set_gravity(gravity);
}

void LiveWorld::clear_gravity() { revision_->simulation.world.clear_gravity(); }

Errors LiveWorld::set_drive_of(BodyHandle body, DriveKind kind, const DriveTarget& target) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  const World& world = revision_->simulation.world;
  const DriveKind own = world.bodies()[body.slot].driven_by();
  if (own != kind && own != DriveKind::none) {
    return refuse_drive(world.model().bodies[at(body.slot)], kind);
  }
  return revision_->simulation.world.set_drive({body.slot}, target);
}

Errors LiveWorld::set_speed(BodyHandle body, const DriveTarget& target) {
  return set_drive_of(body, DriveKind::speed, target);
}
Errors LiveWorld::set_angle(BodyHandle body, const DriveTarget& target) {
  return set_drive_of(body, DriveKind::angle, target);
}
Errors LiveWorld::set_torque(BodyHandle body, const DriveTarget& target) {
  return set_drive_of(body, DriveKind::torque, target);
}

Errors LiveWorld::clear_drive(BodyHandle body) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  return revision_->simulation.world.clear_drive({body.slot});
}

Errors LiveWorld::set_force(BodyHandle body, const PointForce& force) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  return revision_->simulation.world.set_force({body.slot}, force);
}

Errors LiveWorld::clear_force(BodyHandle body) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  return revision_->simulation.world.clear_force({body.slot});
}

Errors LiveWorld::set_motion(BodyHandle body, const MotionTarget& target) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  return revision_->simulation.world.set_motion({body.slot}, target);
}

Errors LiveWorld::clear_motion(BodyHandle body, std::optional<double> over) {
  if (!revision_->bodies.has(body)) return refuse(revision_->bodies, body, "body");
  return revision_->simulation.world.clear_motion({body.slot}, over);
}

Errors LiveWorld::set_drive(JointHandle joint, const DriveTarget& target, int coordinate) {
  if (!revision_->joints.has(joint)) return refuse(revision_->joints, joint, "joint");
  return revision_->simulation.world.set_joint_drive(revision_->joints.index(joint), coordinate,
                                                     target);
}

Errors LiveWorld::set_drive_limit(JointHandle joint, double limit, int coordinate) {
  if (!revision_->joints.has(joint)) return refuse(revision_->joints, joint, "joint");
  return revision_->simulation.world.set_joint_drive_limit(revision_->joints.index(joint),
                                                           coordinate, limit);
}

Errors LiveWorld::clear_drive(JointHandle joint, int coordinate) {
  if (!revision_->joints.has(joint)) return refuse(revision_->joints, joint, "joint");
  return revision_->simulation.world.clear_joint_drive(revision_->joints.index(joint), coordinate);
}

Errors LiveWorld::release_joint(JointHandle joint) {
  if (!revision_->joints.has(joint)) return refuse(revision_->joints, joint, "joint");
  return revision_->simulation.world.release_joint(revision_->joints.index(joint));
}

Errors LiveWorld::lock_joint(JointHandle joint) {
  if (!revision_->joints.has(joint)) return refuse(revision_->joints, joint, "joint");
  return revision_->simulation.world.lock_joint(revision_->joints.index(joint));
}

Errors LiveWorld::set_compliance(CableHandle cable, double compliance) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.set_compliance(place, compliance);
}

Errors LiveWorld::clear_compliance(CableHandle cable) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.clear_compliance(place);
}

Errors LiveWorld::set_breaking_tension(CableHandle cable, double tension) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.set_breaking_tension(place, tension);
}

Errors LiveWorld::clear_breaking_tension(CableHandle cable) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.clear_breaking_tension(place);
}

Errors LiveWorld::cut(CableHandle cable) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.cut_cable(place);
}

Errors LiveWorld::cut(CableHandle cable, double place) {
  const int index = place_of(*revision_, cable);
  if (index < 0) return refuse(pull_fault(cable));
  return revision_->simulation.cut_cable(index, place);
}

Errors LiveWorld::set_wrap_friction(CableHandle cable, double friction) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.set_wrap_friction(place, friction);
}

Errors LiveWorld::clear_wrap_friction(CableHandle cable) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.clear_wrap_friction(place);
}

Errors LiveWorld::set_friction(CableHandle cable, int link, double friction) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.set_friction(place, link, friction);
}

Errors LiveWorld::clear_friction(CableHandle cable, int link) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.clear_friction(place, link);
}

Errors LiveWorld::set_feed_speed(CableHandle cable, int link, const DriveTarget& target) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.set_feed_speed(place, link, target);
}

Errors LiveWorld::clear_feed_speed(CableHandle cable, int link) {
  const int place = place_of(*revision_, cable);
  if (place < 0) return refuse(pull_fault(cable));
  return revision_->simulation.clear_feed_speed(place, link);
}

}  // namespace sheave
