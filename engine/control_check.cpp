#include "engine/control_check.h"

#include <cmath>

#include "engine/body_check.h"
#include "engine/control_members.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/joints/joint_effect.h"

namespace sheave {
namespace {

bool all_finite(bool /*b*/) { return true; }
bool all_finite(ForceFrame /*frame*/) { return true; }
bool all_finite(const Vector3& v) { return v.allFinite(); }

bool is_drive(const DriveControl& control) {
  return control.target.is_sound() && (std::isnan(control.limit) || control.limit >= 0.0);
}

constexpr double unit_slop = 1e-6;

}  // namespace

std::vector<JointPlace> number_joints(const Model& model,
                                      std::span<const std::unique_ptr<ConstraintBatch>> features) {
  std::vector<JointPlace> places(model.joints.size());
  if (places.empty()) return places;
  int coordinate = 0;
  for (std::size_t j = 0; j < places.size(); ++j) {
    places[j].first_coordinate = coordinate;
    coordinate += static_cast<int>(model.joints[j]->coordinates().size());
  }
  for (const auto& feature : features) {
    auto* joints = dynamic_cast<JointFeature*>(feature.get());
    if (joints == nullptr) continue;
    std::vector<int> first;
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (model.joints[j]->type() != joints->type()) continue;
      places[j].feature = joints;
      places[j].index = static_cast<int>(first.size());
      first.push_back(places[j].first_coordinate);
    }
    joints->number_coordinates(first);
  }
  for (const auto& feature : features) {
    auto* joints = dynamic_cast<JointFeature*>(feature.get());
    if (joints != nullptr) joints->connect(model, places, features);
  }
  return places;
}

bool make_ramp(const DriveNow& now, const DriveTarget& target, Ramp& ramp) {
  const bool position = now.meaning == DriveMeaning::position;
  const double by_default = now.meaning == DriveMeaning::force ? 0.0 : now.interval;
  const double over = target.over.value_or(by_default);
  const double mean = over > 0.0 ? (target.value - now.value) / over : 0.0;
  const bool takes_time = over >= 0.0 && !(position && over == 0.0) && std::isfinite(over);
  const bool arrives = !target.rate || (position && std::isfinite(*target.rate));
  if (!takes_time || !arrives || !std::isfinite(target.value) || !std::isfinite(mean)) return false;
  ramp = {now.time, now.time + over, now.value, mean, target.value, mean, 0.0};
  if (target.rate) {
    ramp.start_rate = now.rate;
    ramp.end_rate = ramp.rate_after = *target.rate;
  }
  return ramp.is_sound();
}

std::string ramp_fault(const DriveNow& now, const DriveTarget& target) {
  const bool position = now.meaning == DriveMeaning::position;
  if (!std::isfinite(target.value)) {
    return " must go to a finite value, not to " + number_text(target.value);
  }
  const double over = target.over.value_or(now.interval);
  if (!std::isfinite(over) || over < 0.0 || (position && over == 0.0)) {
    return " must reach its target in a finite time " +
           std::string(position ? "above 0 s" : "of at least 0 s") + ", not " + number_text(over);
  }
  if (target.rate && !position)
    return " has no rate on arrival, because it prescribes no angle or position";
  if (target.rate && !std::isfinite(*target.rate)) {
    return " must arrive at a finite rate, not " + number_text(*target.rate);
  }
  return " cannot get from " + number_text(now.value) + " to " + number_text(target.value) +
         " in " + number_text(over) + " s";
}

std::string ControlCheck::body_name(int body) const {
  return "body \"" + bodies_.name(body) + "\"";
}

std::string ControlCheck::joint_name(int joint) const {
  return "joint \"" + model_.joints[at(joint)]->name + "\"";
}

std::string ControlCheck::fault_of(BodyId body) const {
  if (body.is_world()) return "the world cannot move; name a body";
  if (bodies_.contains(body)) return {};
  return "there is no body number " + std::to_string(body.index) + "; there are " +
         std::to_string(bodies_.count());
}

std::string ControlCheck::drive_fault(int body) const {
  if (has_drive(body)) return {};
  return body_name(body) + " has no drive; give it one in the model: speed, angle or torque";
}

std::string ControlCheck::force_fault(int body) const {
  if (takes_force(body)) return {};
  const BodyProperties& own = bodies_[body];
  const auto deny = [&](const char* why) {
    return body_name(body) + " " + why + ", so no force moves it";
  };
  if (own.mobility == Mobility::fixed) return deny("is static");
  if (own.mobility == Mobility::kinematic) return deny("is kinematic");
  if (own.mobility == Mobility::knot) return deny("is a knot without mass, which cables place");
  if (own.prescribed() && own.mount < 0) return deny("is turned by its drive");
  return deny("is a massless wheel, which its cable turns");
}

std::string ControlCheck::motion_fault(int body) const {
  if (is_kinematic(body)) return {};
  return body_name(body) + " is " +
         std::string(mobility_names[static_cast<std::size_t>(bodies_[body].mobility)]) +
         "; only a kinematic body can have a motion";
}

bool ControlCheck::is_sound(const ForceControl& force) {
  bool finite = true;
  ControlMembers<ForceControl>::visit(
      force, [&](const auto& member) { finite = finite && all_finite(member); });
  return finite;
}

bool ControlCheck::takes_motion(int body, const MotionControl& motion) const {
  const double length = motion.start_orientation.norm();
  if (!motion.position.is_sound() || !motion.turn.is_sound() ||
      !(std::abs(length - 1.0) < unit_slop) || !(motion.position.to > motion.position.from)) {
    return false;
  }
  if (!keeps_to_a_way(body)) return true;
  return way_fault(body, motion.state_at(bodies_, body, motion.position.from)).empty() &&
         way_fault(body, motion.state_at(bodies_, body, motion.position.to)).empty();
}

bool ControlCheck::keeps_to_a_way(int body) const {
  const BodyDef& def = bodies_.definition(body);
  return def.axis.has_value() || !is_zero(def.velocity) || !is_zero(def.oscillation) ||
         !is_zero(def.angular_velocity);
}

std::string ControlCheck::way_fault(int body, const BodyState& state) const {
  const BodyDef& def = bodies_.definition(body);
  const Quaternion& start = bodies_[body].start_orientation;
  Quaternion change = state.orientation * start.conjugate();
  const Vector3 moved = state.position - def.position;
  // Allows for rounding in the caller's computation.
  const double slop = 1e-9 * bodies_.scale();
  const double turn_slop = 1e-9;
  const auto along = [](const Vector3& v, const Vector3& axis) {
    return v.cross(axis.normalized()).norm();
  };
  if (def.axis) {
    const Vector3 axis = def.axis->normalized();
    const double speed_slop = 1e-9 * (state.velocity.norm() + bodies_.scale());
    if (std::abs(moved.dot(axis)) > slop || std::abs(state.velocity.dot(axis)) > speed_slop) {
      return body_name(body) + " stays in the plane across its axis";
    }
    if (along(change.vec(), axis) > turn_slop ||
        along(state.angular_velocity, axis) > 1e-9 * (1.0 + state.angular_velocity.norm())) {
      return body_name(body) + " turns about its axis alone";
    }
    return {};
  }
  const bool slides = !is_zero(def.velocity) || !is_zero(def.oscillation);
  const bool turns = !is_zero(def.angular_velocity);
  if (!slides && !turns) return {};
  // Length of the part of v across the directions of the motion that the definition has.
  const auto off = [&](Vector3 v) {
    Vector3 first = def.velocity;
    Vector3 second = def.oscillation;
    if (first.norm() > 0.0) {
      first.normalize();
      v -= first * first.dot(v);
      second -= first * first.dot(second);
    }
    if (second.norm() > 1e-9 * def.oscillation.norm()) {
      second.normalize();
      v -= second * second.dot(v);
    }
    return v.norm();
  };
  if (off(moved) > slop || off(state.velocity) > 1e-9 * (state.velocity.norm() + bodies_.scale())) {
    return body_name(body) +
           " has a motion in its definition and moves in the directions of that motion alone; give "
           "it an axis in place of the motion, or neither";
  }
  const Vector3 axis = turns ? def.angular_velocity : Vector3(Vector3::Zero());
  const double off_axis = turns ? along(change.vec(), axis) : change.vec().norm();
  const double spin_off =
      turns ? along(state.angular_velocity, axis) : state.angular_velocity.norm();
  if (off_axis > turn_slop || spin_off > 1e-9 * (1.0 + state.angular_velocity.norm())) {
    return body_name(body) +
           (turns ? " turns about the direction of its angular_velocity alone"
                  : " has a motion without rotation in its definition and cannot turn");
  }
  return {};
}

std::string ControlCheck::fault_of_joint(int joint) const {
  if (joint >= 0 && joint < static_cast<int>(joints_.size())) return {};
  return "there is no joint number " + std::to_string(joint) + "; there are " +
         std::to_string(joints_.size());
}

std::string ControlCheck::joint_fault(int joint, int coordinate) const {
  std::string fault = fault_of_joint(joint);
  if (!fault.empty()) return fault;
  const auto coordinates = model_.joints[at(joint)]->coordinates();
  if (coordinate < 0 || coordinate >= static_cast<int>(coordinates.size())) {
    return joint_name(joint) + " has no coordinate number " + std::to_string(coordinate) +
           "; it has " + std::to_string(coordinates.size());
  }
  if (find_drive(joint, coordinate) != nullptr) return {};
  return joint_name(joint) + " has no drive of its " +
         std::string(coordinates[at(coordinate)].name) + "; give it one in the model";
}

const JointEffect* ControlCheck::find_drive(int joint, int coordinate) const {
  if (joint < 0 || joint >= static_cast<int>(joints_.size())) return nullptr;
  const JointPlace& place = joints_[at(joint)];
  return place.feature->drive(place.index, coordinate);
}

bool ControlCheck::takes_limit(const JointEffect& drive, double limit) const {
  return drive.kind != JointEffect::Kind::force && limit >= 0.0 && std::isfinite(limit);
}

std::string ControlCheck::limit_fault(int joint, int coordinate, double limit) const {
  const JointEffect& drive = *find_drive(joint, coordinate);
  if (takes_limit(drive, limit)) return {};
  if (drive.kind == JointEffect::Kind::force) {
    return joint_name(joint) +
           ": the target prescribes the drive's force, so the drive has no limit";
  }
  return joint_name(joint) + ": the limit of a drive must be finite and at least 0, not " +
         number_text(limit);
}

int ControlCheck::coordinate_count() const {
  if (joints_.empty()) return 0;
  return joints_.back().first_coordinate +
         static_cast<int>(model_.joints.back()->coordinates().size());
}

std::string ControlCheck::bodies_fault(const Controls& controls) const {
  const auto count = at(bodies_.count());
  if (controls.body_drives.entries().size() > count || controls.forces.entries().size() > count ||
      controls.motions.entries().size() > count) {
    return "it has controls of more bodies than there are";
  }
  for (int i = 0; i < bodies_.count(); ++i) {
    std::string fault;
    if (const DriveControl* drive = controls.body_drives.find(i)) {
      fault = drive_fault(i);
      if (!drive->has_target || !is_drive(*drive))
        fault = body_name(i) + " has an invalid control of its drive";
    }
    if (const ForceControl* force = controls.forces.find(i); force != nullptr && fault.empty()) {
      fault = force_fault(i);
      if (!is_sound(*force)) fault = body_name(i) + " has a force that is not finite";
    }
    if (const MotionControl* set = controls.motions.find(i); set != nullptr && fault.empty()) {
      fault = motion_fault(i);
      if (fault.empty() && !takes_motion(i, *set))
        fault = body_name(i) + " has an invalid control of its motion";
    }
    if (!fault.empty()) return fault;
  }
  return {};
}

std::string ControlCheck::joints_fault(const ControlTable<DriveControl>& drives) const {
  if (static_cast<int>(drives.entries().size()) > coordinate_count()) {
    return "it has controls of more joints than there are";
  }
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
    const int first = joints_[at(j)].first_coordinate;
    const auto count = static_cast<int>(model_.joints[at(j)]->coordinates().size());
    for (int k = 0; k < count; ++k) {
      const DriveControl* drive = drives.find(first + k);
      if (drive == nullptr) continue;
      std::string fault = joint_fault(j, k);
      if (fault.empty() && !std::isnan(drive->limit)) fault = limit_fault(j, k, drive->limit);
      if (fault.empty() && !is_drive(*drive))
        fault = joint_name(j) + " has an invalid control of its drive";
      if (!fault.empty()) return fault;
    }
  }
  return {};
}

std::string ControlCheck::fault_of(
    const Controls& controls, std::span<const std::unique_ptr<ConstraintBatch>> features) const {
  if (controls.empty()) return {};
  if (controls.has_gravity && !is_good_gravity(controls.gravity)) {
    return "its gravity is not finite, or above 1e+100 m/s2";
  }
  std::string fault = bodies_fault(controls);
  if (fault.empty()) fault = joints_fault(controls.joint_drives);
  if (!fault.empty()) return fault;
  bool cables = false;
  for (const auto& feature : features) {
    cables = cables || feature->takes_cables();
    if (!feature->accepts_controls(controls)) {
      return "it has invalid controls of " + std::string(feature->name());
    }
  }
  return controls.cables_any() && !cables ? "it has controls of cables, and there are none" : "";
}

}  // namespace sheave
