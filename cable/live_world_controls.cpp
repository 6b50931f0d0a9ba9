// The setters of LiveWorld: those of World and Simulation, by handle.

#include "cable/live_world.h"
#include "engine/index.h"

namespace sheave {
namespace {

Errors as_errors(std::string fault) { return {{"", std::move(fault)}}; }

}  // namespace

Errors LiveWorld::set_together(const std::function<Errors()>& set) {
  Controls before = state().controls;
  Errors errors = set();
  if (!errors.empty()) running().world.controls_of_features() = std::move(before);
  return errors;
}

Errors LiveWorld::set_gravity(const Vector3& gravity) {
  return running().world.set_gravity(gravity);
}

void LiveWorld::clear_gravity() { running().world.clear_gravity(); }

Errors LiveWorld::set_drive_of(BodyHandle body, DriveKind kind, const DriveTarget& target) {
  std::string fault = fault_of(body);
  if (!fault.empty()) return as_errors(std::move(fault));
  const BodyDef& definition = running().world.model().bodies[at(body.slot)];
  if (definition.drive != kind && definition.drive != DriveKind::none) {
    return as_errors("the drive of body \"" + definition.name + "\" has a" +
                     (definition.drive == DriveKind::angle ? "n " : " ") +
                     std::string(drive_names[static_cast<std::size_t>(definition.drive)]) +
                     ", and no " + std::string(drive_names[static_cast<std::size_t>(kind)]));
  }
  return running().world.set_drive({body.slot}, target);
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
  std::string fault = fault_of(body);
  return fault.empty() ? running().world.clear_drive({body.slot}) : as_errors(std::move(fault));
}

Errors LiveWorld::set_force(BodyHandle body, const PointForce& force) {
  std::string fault = fault_of(body);
  return fault.empty() ? running().world.set_force({body.slot}, force)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_force(BodyHandle body) {
  std::string fault = fault_of(body);
  return fault.empty() ? running().world.clear_force({body.slot}) : as_errors(std::move(fault));
}

Errors LiveWorld::set_motion(BodyHandle body, const MotionTarget& target) {
  std::string fault = fault_of(body);
  return fault.empty() ? running().world.set_motion({body.slot}, target)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_motion(BodyHandle body, std::optional<double> over) {
  std::string fault = fault_of(body);
  return fault.empty() ? running().world.clear_motion({body.slot}, over)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::set_drive(JointHandle joint, const DriveTarget& target, int coordinate) {
  std::string fault = fault_of(joint);
  return fault.empty() ? running().world.set_joint_drive(index_of(joint), coordinate, target)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::set_drive_limit(JointHandle joint, double limit, int coordinate) {
  std::string fault = fault_of(joint);
  return fault.empty() ? running().world.set_joint_drive_limit(index_of(joint), coordinate, limit)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_drive(JointHandle joint, int coordinate) {
  std::string fault = fault_of(joint);
  return fault.empty() ? running().world.clear_joint_drive(index_of(joint), coordinate)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::release_joint(JointHandle joint) {
  std::string fault = fault_of(joint);
  return fault.empty() ? running().world.release_joint(index_of(joint))
                       : as_errors(std::move(fault));
}

Errors LiveWorld::lock_joint(JointHandle joint) {
  std::string fault = fault_of(joint);
  return fault.empty() ? running().world.lock_joint(index_of(joint)) : as_errors(std::move(fault));
}

Errors LiveWorld::set_compliance(CableHandle cable, double compliance) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().set_compliance(index_of(cable), compliance)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_compliance(CableHandle cable) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().clear_compliance(index_of(cable)) : as_errors(std::move(fault));
}

Errors LiveWorld::set_breaking_tension(CableHandle cable, double tension) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().set_breaking_tension(index_of(cable), tension)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_breaking_tension(CableHandle cable) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().clear_breaking_tension(index_of(cable))
                       : as_errors(std::move(fault));
}

Errors LiveWorld::set_wrap_friction(CableHandle cable, double friction) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().set_wrap_friction(index_of(cable), friction)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_wrap_friction(CableHandle cable) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().clear_wrap_friction(index_of(cable))
                       : as_errors(std::move(fault));
}

Errors LiveWorld::set_friction(CableHandle cable, int link, double friction) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().set_friction(index_of(cable), link, friction)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_friction(CableHandle cable, int link) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().clear_friction(index_of(cable), link)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::set_feed_speed(CableHandle cable, int link, const DriveTarget& target) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().set_feed_speed(index_of(cable), link, target)
                       : as_errors(std::move(fault));
}

Errors LiveWorld::clear_feed_speed(CableHandle cable, int link) {
  std::string fault = pull_fault(cable);
  return fault.empty() ? running().clear_feed_speed(index_of(cable), link)
                       : as_errors(std::move(fault));
}

}  // namespace sheave
