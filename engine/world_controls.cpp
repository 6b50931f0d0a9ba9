// The setters of World: each checks its arguments, then writes one entry of the state's controls.

#include <cmath>

#include "engine/body_check.h"
#include "engine/body_drive.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/joints/joint_effect.h"
#include "engine/joints/joint_hold.h"
#include "engine/motion_request.h"
#include "engine/world_content.h"

namespace sheave {
namespace {

DriveMeaning meaning_of(DriveKind kind) {
  if (kind == DriveKind::speed) return DriveMeaning::speed;
  return kind == DriveKind::angle ? DriveMeaning::position : DriveMeaning::force;
}

DriveMeaning meaning_of(JointEffect::Kind kind) {
  if (kind == JointEffect::Kind::speed) return DriveMeaning::speed;
  return kind == JointEffect::Kind::position ? DriveMeaning::position : DriveMeaning::force;
}

bool has_unit_length(const Quaternion& orientation) {
  constexpr double slop = 1e-6;
  return std::abs(orientation.squaredNorm() - 1.0) < 2.0 * slop;  // (1 + s)^2 = 1 + 2 s + ...
}

bool absent_or_finite(const std::optional<Vector3>& v) { return !v || is_finite(*v); }

bool is_sound(const MotionTarget& target, double over) {
  return is_finite(target.position) && absent_or_finite(target.velocity) &&
         absent_or_finite(target.angular_velocity) &&
         (!target.orientation || has_unit_length(*target.orientation)) &&
         (!target.angular_velocity || target.velocity) && over > 0.0 && std::isfinite(over);
}

/// The reason why is_sound() is false.
std::string fault_of(const MotionTarget& target, double over) {
  if (!is_finite(target.position) || !absent_or_finite(target.velocity) ||
      !absent_or_finite(target.angular_velocity)) {
    return "position and velocities of a motion must be finite";
  }
  if (target.orientation && !has_unit_length(*target.orientation)) {
    return "an orientation must have length 1, not " + number_text(target.orientation->norm());
  }
  if (target.angular_velocity && !target.velocity) {
    return "an angular velocity needs a velocity beside it; give 0 if there is none";
  }
  return "a motion takes a finite time above 0, not " + number_text(over) + " s";
}

/// The state at the end of the motion.
BodyState end_of(const MotionTarget& target, const BodyState& from) {
  BodyState end;
  end.position = target.position;
  end.orientation = from.orientation;
  if (target.orientation) end.orientation = target.orientation->normalized();
  if (target.velocity) end.velocity = *target.velocity;
  if (target.angular_velocity) end.angular_velocity = *target.angular_velocity;
  return end;
}

// Programs set hundreds of controls in every step. The checks of the fast path therefore make no
// texts. On failure, functions of their own repeat the checks and make the texts.

Errors refuse_body(BodyId body, const char* key, std::string fault) {
  return {{"/bodies/" + std::to_string(body.index) + "/" + key, std::move(fault)}};
}

Errors refuse_joint(int joint, const char* key, std::string fault) {
  return {{"/joints/" + std::to_string(joint) + key, std::move(fault)}};
}

[[gnu::cold, gnu::noinline]] Errors refuse_gravity() {
  return {{"/gravity", "gravity must be finite and at most 1e+100 m/s2 in each direction"}};
}

[[gnu::cold, gnu::noinline]] Errors refuse_force(ControlCheck check, BodyId body) {
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.force_fault(body.index);
  if (fault.empty())
    fault = check.body_name(body.index) + ": force, torque and point must be finite";
  return refuse_body(body, "force", std::move(fault));
}

[[gnu::cold, gnu::noinline]] Errors refuse_drive(ControlCheck check, BodyId body) {
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.drive_fault(body.index);
  return refuse_body(body, "drive", std::move(fault));
}

[[gnu::cold, gnu::noinline]] Errors refuse_ramp(ControlCheck check, BodyId body,
                                                const DriveNow& now, const DriveTarget& target) {
  return refuse_body(body, "drive",
                     "the drive of " + check.body_name(body.index) + ramp_fault(now, target));
}

[[gnu::cold, gnu::noinline]] Errors refuse_motion(ControlCheck check, BodyId body,
                                                  const MotionTarget& target, double over,
                                                  const State& state) {
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.motion_fault(body.index);
  if (!fault.empty()) return refuse_body(body, "position", std::move(fault));
  const std::string name = check.body_name(body.index);
  if (!is_sound(target, over)) {
    return refuse_body(body, "position", name + ": " + fault_of(target, over));
  }
  fault = check.way_fault(body.index, end_of(target, state.bodies[at(body.index)]));
  if (fault.empty()) fault = name + " cannot reach the target in " + number_text(over) + " s";
  return refuse_body(body, "position", std::move(fault));
}

[[gnu::cold, gnu::noinline]] Errors refuse_joint_drive(ControlCheck check, int joint,
                                                       int coordinate, const char* key) {
  return refuse_joint(joint, key, check.joint_fault(joint, coordinate));
}

[[gnu::cold, gnu::noinline]] Errors refuse_limit(ControlCheck check, int joint, int coordinate,
                                                 double limit) {
  return refuse_joint(joint, "/drive_limit", check.limit_fault(joint, coordinate, limit));
}

[[gnu::cold, gnu::noinline]] Errors refuse_joint_ramp(ControlCheck check, int joint,
                                                      const DriveNow& now,
                                                      const DriveTarget& target) {
  return refuse_joint(joint, "/drive",
                      "the drive of " + check.joint_name(joint) + ramp_fault(now, target));
}

}  // namespace

double World::control_interval() const { return content_->control_interval; }

Controls& World::controls_of_features() {
  content_->driver.note_controls();
  return content_->state.controls;
}

Errors World::set_gravity(const Vector3& gravity) {
  if (!is_good_gravity(gravity)) return refuse_gravity();
  Controls& controls = controls_of_features();
  controls.has_gravity = true;
  controls.gravity = gravity;
  return {};
}

std::vector<double>& World::memory() { return content_->state.memory; }

void World::check_memory_by(MemoryFault fault) { content_->memory_fault = std::move(fault); }

Errors World::release_joint(int joint) {
  Content& c = *content_;
  const ControlCheck check = c.check();
  std::string fault = check.fault_of_joint(joint);
  if (!fault.empty()) return refuse_joint(joint, "", std::move(fault));
  const JointPlace& place = c.joints[at(joint)];
  const std::size_t feature = c.feature_of(place);
  for (State* state : {&c.state, &c.substep.next}) {
    place.feature->release(place.index, c.state.time, state->features[feature]);
  }
  return {};
}

Errors World::lock_joint(int joint) {
  Content& c = *content_;
  const ControlCheck check = c.check();
  std::string fault = check.fault_of_joint(joint);
  if (!fault.empty()) return refuse_joint(joint, "", std::move(fault));
  const JointPlace& place = c.joints[at(joint)];
  const std::size_t feature = c.feature_of(place);
  const FeatureState& own = c.state.features[feature];
  if (!place.feature->is_broken(place.index, own)) return {};
  const Substep now(*c.bodies, c.state, c.substep.h, 1);
  const Result<JointHold> hold = place.feature->hold_here(place.index, now, own);
  if (!hold) return refuse_joint(joint, "", hold.errors().front().message);
  for (State* state : {&c.state, &c.substep.next}) {
    place.feature->lock(place.index, *hold, state->features[feature]);
  }
  return {};
}

void World::clear_gravity() {
  Controls& controls = controls_of_features();
  controls.has_gravity = false;
  controls.gravity.setZero();
}

Errors World::set_force(BodyId body, const PointForce& force) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  if (!check.is_body(body) || !check.takes_force(body.index)) return refuse_force(check, body);
  ForceControl set;
  set.acts = true;
  set.frame = force.frame;
  set.force = force.force;
  set.torque = force.torque;
  if (force.point) set.arm = *force.point - (*c.bodies)[body.index].center_of_mass;
  if (!ControlCheck::is_sound(set)) return refuse_force(check, body);
  controls_of_features().forces.put(body.index, at(c.bodies->count()), set);
  return {};
}

Errors World::clear_force(BodyId body) {
  const ControlCheck check = content_->check();
  if (!check.is_body(body)) return refuse_force(check, body);
  controls_of_features().forces.clear(body.index);
  return {};
}

Errors World::set_drive(BodyId body, const DriveTarget& target) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  if (!check.is_body(body) || !check.has_drive(body.index)) return refuse_drive(check, body);
  const BodyProperties& own = (*c.bodies)[body.index];
  const BodyDrive drive(own, c.state.controls, body.index);
  DriveNow now{meaning_of(own.driven_by()), 0.0, 0.0, c.state.time, c.control_interval};
  if (now.meaning == DriveMeaning::position) {
    // The ramp of an angle starts from the body's present angle, which counts from time 0. The
    // table's angles may count from any value.
    now.value = c.state.bodies[at(body.index)].angle;
    now.rate = drive.rate(now.time);
  } else {
    now.value = drive.at(now.time);
  }
  Ramp ramp;
  if (!make_ramp(now, target, ramp)) return refuse_ramp(check, body, now, target);
  controls_of_features().body_drives.change(body.index, at(c.bodies->count()),
                                            [&](DriveControl& set) {
                                              set.has_target = true;
                                              set.target = ramp;
                                              set.limit = not_set;
                                            });
  return {};
}

Errors World::clear_drive(BodyId body) {
  const ControlCheck check = content_->check();
  if (!check.is_body(body) || !check.has_drive(body.index)) return refuse_drive(check, body);
  controls_of_features().body_drives.clear(body.index);
  return {};
}

Errors World::set_motion(BodyId body, const MotionTarget& target) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  const double over = target.over.value_or(c.control_interval);
  if (!check.is_body(body) || !check.is_kinematic(body.index) || !is_sound(target, over)) {
    return refuse_motion(check, body, target, over, c.state);
  }
  const BodyState& from = c.state.bodies[at(body.index)];
  if (check.keeps_to_a_way(body.index) &&
      !check.way_fault(body.index, end_of(target, from)).empty()) {
    return refuse_motion(check, body, target, over, c.state);
  }
  const MotionControl motion = motion_to(from, target, c.state.time, over);
  if (!check.takes_motion(body.index, motion)) {
    return refuse_motion(check, body, target, over, c.state);
  }
  controls_of_features().motions.put(body.index, at(c.bodies->count()), motion);
  return {};
}

Errors World::clear_motion(BodyId body, std::optional<double> over) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  const double time = over.value_or(c.control_interval);
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.motion_fault(body.index);
  if (fault.empty() && !(time > 0.0 && std::isfinite(time))) {
    fault = "the return takes a finite time above 0, not " + number_text(time) + " s";
  }
  if (!fault.empty()) return refuse_body(body, "position", std::move(fault));
  const MotionControl* set = c.state.controls.motions.find(body.index);
  if (set == nullptr || set->returns) return {};
  const BodyState to = c.bodies->kinematic_state(body.index, c.state.time + time);
  const BodyState& from = c.state.bodies[at(body.index)];
  MotionTarget target{to.position, to.orientation, to.velocity, to.angular_velocity};
  MotionControl motion = motion_to(from, target, c.state.time, time);
  motion.returns = true;
  if (!check.takes_motion(body.index, motion)) {
    return refuse_body(
        body, "position",
        check.body_name(body.index) + " cannot return in " + number_text(time) + " s");
  }
  controls_of_features().motions.put(body.index, at(c.bodies->count()), motion);
  return {};
}

Errors World::set_joint_drive(int joint, int coordinate, const DriveTarget& target) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  const JointEffect* effect = check.find_drive(joint, coordinate);
  if (effect == nullptr) return refuse_joint_drive(check, joint, coordinate, "/drive");
  const DriveDemand demand(*effect, c.state.controls);
  const double time = c.state.time;
  DriveNow now{meaning_of(effect->kind), demand.at(time), 0.0, time, c.control_interval};
  if (target.rate) now.rate = demand.rate(time);
  Ramp ramp;
  if (!make_ramp(now, target, ramp)) return refuse_joint_ramp(check, joint, now, target);
  controls_of_features().joint_drives.change(effect->control, c.coordinate_count,
                                             [&](DriveControl& set) {
                                               set.has_target = true;
                                               set.target = ramp;
                                             });
  return {};
}

Errors World::set_joint_drive_limit(int joint, int coordinate, double limit) {
  const Content& c = *content_;
  const ControlCheck check = c.check();
  const JointEffect* effect = check.find_drive(joint, coordinate);
  if (effect == nullptr) return refuse_joint_drive(check, joint, coordinate, "/drive_limit");
  if (!check.takes_limit(*effect, limit)) return refuse_limit(check, joint, coordinate, limit);
  controls_of_features().joint_drives.change(effect->control, c.coordinate_count,
                                             [&](DriveControl& set) { set.limit = limit; });
  return {};
}

Errors World::clear_joint_drive(int joint, int coordinate) {
  const ControlCheck check = content_->check();
  const JointEffect* effect = check.find_drive(joint, coordinate);
  if (effect == nullptr) return refuse_joint_drive(check, joint, coordinate, "/drive");
  controls_of_features().joint_drives.clear(effect->control);
  return {};
}

}  // namespace sheave
