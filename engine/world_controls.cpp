// The setters of World: each checks, then writes one entry of the state's controls.

#include <cmath>

#include "engine/body_drive.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/joints/joint_effect.h"
#include "engine/joints/joint_hold.h"
#include "engine/world_content.h"

namespace sheave {
namespace {

std::string path_of(BodyId body, const char* key) {
  return "/bodies/" + std::to_string(body.index) + "/" + key;
}

std::string joint_path(int joint, const char* key = "/drive") {
  return "/joints/" + std::to_string(joint) + key;
}

DriveMeaning meaning_of(DriveKind kind) {
  if (kind == DriveKind::speed) return DriveMeaning::speed;
  return kind == DriveKind::angle ? DriveMeaning::position : DriveMeaning::force;
}

DriveMeaning meaning_of(JointEffect::Kind kind) {
  if (kind == JointEffect::Kind::speed) return DriveMeaning::speed;
  return kind == JointEffect::Kind::position ? DriveMeaning::position : DriveMeaning::force;
}

/// The rotation vector of the shorter turn from one orientation to another.
Vector3 turn_to(const Quaternion& from, const Quaternion& to) {
  Quaternion change = to * from.conjugate();
  if (change.w() < 0.0) change.coeffs() = -change.coeffs();
  const double sine = change.vec().norm();
  if (!(sine > 0.0)) return Vector3::Zero();
  return change.vec() * (2.0 * std::atan2(sine, change.w()) / sine);
}

/// A motion from `from` to `to`, turned by `turn`, within `over` seconds from `time` on; smooth or straight.
void set_way(const BodyState& from, const BodyState& to, const Vector3& turned_by, double time,
             double over, bool smooth, MotionControl& motion) {
  motion.moves = true;
  motion.start_orientation = from.orientation;
  RampOf<Vector3>& way = motion.position;
  RampOf<Vector3>& turn = motion.turn;
  way.from = turn.from = time;
  way.to = turn.to = time + over;
  way.start = from.position;
  way.end = to.position;
  turn.end = turned_by;
  if (smooth) {
    way.start_rate = from.velocity;
    way.end_rate = way.rate_after = to.velocity;
    turn.start_rate = from.angular_velocity;
    turn.end_rate =
        is_zero(turned_by) ? to.angular_velocity : turn_rate(turned_by, to.angular_velocity);
    turn.rate_after = to.angular_velocity;
  } else {
    way.start_rate = way.end_rate = (way.end - way.start) / over;
    turn.start_rate = turn.end_rate = turned_by / over;
  }
}

std::string fault_of(const MotionTarget& target, double over) {
  const auto finite = [](const std::optional<Vector3>& v) { return !v || v->allFinite(); };
  if (!target.position.allFinite() || !finite(target.velocity) ||
      !finite(target.angular_velocity)) {
    return "position and velocities of a motion must be finite";
  }
  constexpr double slop = 1e-6;
  if (target.orientation && !(std::abs(target.orientation->norm() - 1.0) < slop)) {
    return "an orientation must have length 1, not " + number_text(target.orientation->norm());
  }
  if (target.angular_velocity && !target.velocity) {
    return "an angular velocity needs a velocity beside it; give 0 if there is none";
  }
  if (over > 0.0 && std::isfinite(over)) return {};
  return "a motion takes a finite time above 0, not " + number_text(over) + " s";
}

}  // namespace

double World::control_interval() const { return content_->control_interval; }

Controls& World::controls_of_features() {
  content_->driver.note_controls();
  return content_->state.controls;
}

Errors World::set_gravity(const Vector3& gravity) {
  if (!gravity.allFinite()) return {{"/gravity", "gravity must be finite"}};
  Controls& controls = controls_of_features();
  controls.has_gravity = true;
  controls.gravity = gravity;
  return {};
}

std::vector<double>& World::memory() { return content_->state.memory; }

Errors World::release_joint(int joint) {
  Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  std::string fault = check.fault_of_joint(joint);
  if (!fault.empty()) return {{joint_path(joint, ""), std::move(fault)}};
  const JointPlace& place = c.joints[at(joint)];
  const std::size_t feature = c.feature_of(place);
  for (State* state : {&c.state, &c.substep.next}) {
    place.feature->release(place.index, c.state.time, state->features[feature]);
  }
  return {};
}

Errors World::lock_joint(int joint) {
  Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  std::string fault = check.fault_of_joint(joint);
  if (!fault.empty()) return {{joint_path(joint, ""), std::move(fault)}};
  const JointPlace& place = c.joints[at(joint)];
  const std::size_t feature = c.feature_of(place);
  const FeatureState& own = c.state.features[feature];
  if (!place.feature->is_broken(place.index, own)) return {};
  const Substep now(*c.bodies, c.state, c.substep.h, 1);
  const Result<JointHold> hold = place.feature->hold_here(place.index, now, own);
  if (!hold) return {{joint_path(joint, ""), hold.errors().front().message}};
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
  const ControlCheck check(content_->model, *content_->bodies, content_->joints);
  if (!check.is_body(body)) return {{path_of(body, "force"), check.fault_of(body)}};
  std::string fault = check.force_fault(body.index);
  if (fault.empty() && !(force.force.allFinite() && force.torque.allFinite() &&
                         (!force.point || force.point->allFinite()))) {
    fault = "body \"" + content_->bodies->name(body.index) +
            "\": force, torque and point must be finite";
  }
  if (!fault.empty()) return {{path_of(body, "force"), fault}};
  ForceControl control{true, force.frame, force.force, force.torque, Vector3::Zero()};
  if (force.point) {
    control.arm = *force.point - (*content_->bodies)[body.index].center_of_mass;
  }
  controls_of_features().forces.put(body.index, at(content_->bodies->count()), control);
  return {};
}

Errors World::clear_force(BodyId body) {
  const ControlCheck check(content_->model, *content_->bodies, content_->joints);
  std::string fault = check.fault_of(body);
  if (!fault.empty()) return {{path_of(body, "force"), std::move(fault)}};
  controls_of_features().forces.clear(body.index);
  return {};
}

Errors World::set_drive(BodyId body, const DriveTarget& target) {
  const Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  if (!check.is_body(body)) return {{path_of(body, "drive"), check.fault_of(body)}};
  const BodyProperties& own = (*c.bodies)[body.index];
  if (own.driven_by() == DriveKind::none) {
    return {{path_of(body, "drive"), check.drive_fault(body.index)}};
  }
  const BodyDrive drive(own, c.state.controls, body.index);
  DriveNow now{meaning_of(own.driven_by()), 0.0, 0.0, c.state.time, c.control_interval};
  if (now.meaning == DriveMeaning::position) {
    // An angle starts from where the body is, which counts from time 0; where it is asked to be may count from anywhere.
    now.value = c.state.bodies[at(body.index)].angle;
    now.rate = drive.rate(now.time);
  } else {
    now.value = drive.at(now.time);
  }
  DriveControl control;
  control.has_target = true;
  if (!make_ramp(now, target, control.target)) {
    return {{path_of(body, "drive"),
             "the drive of body \"" + c.bodies->name(body.index) + "\"" + ramp_fault(now, target)}};
  }
  controls_of_features().body_drives.put(body.index, at(c.bodies->count()), control);
  return {};
}

Errors World::clear_drive(BodyId body) {
  const ControlCheck check(content_->model, *content_->bodies, content_->joints);
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.drive_fault(body.index);
  if (!fault.empty()) return {{path_of(body, "drive"), fault}};
  controls_of_features().body_drives.clear(body.index);
  return {};
}

Errors World::set_motion(BodyId body, const MotionTarget& target) {
  const Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  const double over = target.over.value_or(c.control_interval);
  // Programs set motions every frame: texts are made for faults alone.
  const auto refuse = [&](std::string fault) -> Errors {
    return {{path_of(body, "position"), std::move(fault)}};
  };
  const auto name = [&] { return "body \"" + c.bodies->name(body.index) + "\""; };
  if (!check.is_body(body)) return refuse(check.fault_of(body));
  if ((*c.bodies)[body.index].mobility != Mobility::kinematic) {
    return refuse(check.motion_fault(body.index));
  }
  std::string fault = sheave::fault_of(target, over);
  if (!fault.empty()) return refuse(name() + ": " + fault);
  const BodyState& from = c.state.bodies[at(body.index)];
  BodyState to;
  to.position = target.position;
  Vector3 turn = Vector3::Zero();
  to.orientation = from.orientation;
  if (target.orientation) {
    to.orientation = target.orientation->normalized();
    turn = turn_to(from.orientation, to.orientation);
  }
  if (target.velocity) to.velocity = *target.velocity;
  if (target.angular_velocity) to.angular_velocity = *target.angular_velocity;
  if (check.keeps_to_a_way(body.index)) {
    fault = check.way_fault(body.index, to);
    if (!fault.empty()) return refuse(std::move(fault));
  }
  MotionControl motion;
  set_way(from, to, turn, c.state.time, over, target.velocity.has_value(), motion);
  if (!motion.position.start_rate.allFinite()) {
    return refuse(name() + " cannot get there in " + number_text(over) + " s");
  }
  controls_of_features().motions.put(body.index, at(c.bodies->count()), motion);
  return {};
}

Errors World::clear_motion(BodyId body, std::optional<double> over) {
  const Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  const double time = over.value_or(c.control_interval);
  std::string fault = check.fault_of(body);
  if (fault.empty()) fault = check.motion_fault(body.index);
  if (fault.empty() && !(time > 0.0 && std::isfinite(time))) {
    fault = "the way back takes a finite time above 0, not " + number_text(time) + " s";
  }
  if (!fault.empty()) return {{path_of(body, "position"), fault}};
  const MotionControl* set = c.state.controls.motions.find(body.index);
  if (set == nullptr || set->returns) return {};
  const BodyState to = c.bodies->kinematic_state(body.index, c.state.time + time);
  const BodyState& from = c.state.bodies[at(body.index)];
  MotionControl motion;
  set_way(from, to, turn_to(from.orientation, to.orientation), c.state.time, time, true, motion);
  motion.returns = true;
  controls_of_features().motions.put(body.index, at(c.bodies->count()), motion);
  return {};
}

Errors World::set_joint_drive(int joint, int coordinate, const DriveTarget& target) {
  const Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  std::string fault = check.joint_fault(joint, coordinate);
  if (!fault.empty()) return {{joint_path(joint), fault}};
  const JointEffect& effect = check.drive_of(joint, coordinate);
  const DriveDemand demand(effect, c.state.controls);
  const DriveControl* before = c.state.controls.joint_drives.find(effect.control);
  DriveControl control = before != nullptr ? *before : DriveControl{};
  const double time = c.state.time;
  const DriveNow now{meaning_of(effect.kind), demand.at(time), demand.rate(time), time,
                     c.control_interval};
  control.has_target = true;
  if (!make_ramp(now, target, control.target)) {
    return {{joint_path(joint), "the drive of joint \"" + c.model.joints[at(joint)]->name + "\"" +
                                    ramp_fault(now, target)}};
  }
  controls_of_features().joint_drives.put(effect.control, at(check.coordinate_count()), control);
  return {};
}

Errors World::set_joint_drive_limit(int joint, int coordinate, double limit) {
  const Content& c = *content_;
  const ControlCheck check(c.model, *c.bodies, c.joints);
  std::string fault = check.joint_fault(joint, coordinate);
  if (fault.empty()) fault = check.limit_fault(joint, coordinate, limit);
  if (!fault.empty()) return {{joint_path(joint, "/drive_limit"), fault}};
  const int place = check.drive_of(joint, coordinate).control;
  const DriveControl* before = c.state.controls.joint_drives.find(place);
  DriveControl control = before != nullptr ? *before : DriveControl{};
  control.limit = limit;
  controls_of_features().joint_drives.put(place, at(check.coordinate_count()), control);
  return {};
}

Errors World::clear_joint_drive(int joint, int coordinate) {
  const ControlCheck check(content_->model, *content_->bodies, content_->joints);
  std::string fault = check.joint_fault(joint, coordinate);
  if (!fault.empty()) return {{joint_path(joint), std::move(fault)}};
  controls_of_features().joint_drives.clear(check.drive_of(joint, coordinate).control);
  return {};
}

}  // namespace sheave
