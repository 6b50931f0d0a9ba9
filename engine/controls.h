#pragma once
// Controls: settings that a program changes while a world runs, for drives, forces, gravity,
// motions and cables.
//
// Controls are part of the state: they are hashed, saved and restored with the state. Two runs with
// the same controls at the same times are equal to the last bit. The tables are empty until a
// control is set. A control holds until it is set anew or cleared. Meanwhile the control replaces
// the corresponding setting of the model: a drive's table, a body's motion, gravity, a cable's
// friction.
//
// Checked functions set controls: World::set_...() for bodies and joints, Simulation::set_...() for
// cables. Code that evaluates a setting looks for a control first, at the index of the body, joint
// coordinate, cable or link:
//
//   const DriveControl* set = state.controls.body_drives.find(body);
//   if (set != nullptr) ... set->target.at(time) ...

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/ramp.h"
#include "engine/vector.h"

namespace sheave {

class BodySet;
struct BodyState;

/// The value of a control that is not set.
inline constexpr double not_set = std::numeric_limits<double>::quiet_NaN();

/// The drive of a body, or of a coordinate of a joint.
struct DriveControl {
  bool has_target = false;
  /// The target of the drive in place of its table: speed [rad/s or m/s], angle or position [rad or
  /// m], torque or force [N m or N], according to the drive's kind. Only changes of a body's angle
  /// count, as with its table.
  Ramp target;
  double limit = not_set;  ///< largest force or torque of a joint's drive [N or N m], >= 0

  [[nodiscard]] bool is_set() const { return has_target || !std::isnan(limit); }
};

/// The frame of a force's components.
enum class ForceFrame : std::int64_t {
  world,  ///< the force keeps its direction
  body,   ///< the force turns with the body: a thruster
};

/// A force and a torque on a body, in addition to those of its definition.
struct ForceControl {
  bool acts = false;
  ForceFrame frame = ForceFrame::world;  ///< of `force` and `torque`
  Vector3 force = Vector3::Zero();       ///< [N]
  Vector3 torque = Vector3::Zero();      ///< in addition to the moment of the force [N m]
  /// Point of application relative to the centre of mass, in the body's own frame [m]. The point
  /// moves with the body.
  Vector3 arm = Vector3::Zero();

  [[nodiscard]] bool is_set() const { return acts; }
  /// Whether this is a force at the centre of mass without a torque.
  [[nodiscard]] bool is_central() const { return is_zero(torque) && is_zero(arm); }
  /// The force in the world frame, for a body with this orientation.
  [[nodiscard]] Vector3 force_in_world(const Quaternion& orientation) const {
    return frame == ForceFrame::world ? force : rotated(orientation, force);
  }
  /// The torque about the centre of mass in the world frame, including the moment of the force.
  [[nodiscard]] Vector3 torque_in_world(const Quaternion& orientation) const {
    if (is_central()) return Vector3::Zero();
    const Vector3 own = frame == ForceFrame::world ? torque : rotated(orientation, torque);
    return own + cross(rotated(orientation, arm), force_in_world(orientation));
  }
};

/// The motion of a kinematic body in place of the one in its definition.
struct MotionControl {
  bool moves = false;
  bool returns = false;      ///< after `position.to` the body moves as its definition says
  RampOf<Vector3> position;  ///< of the origin [m]
  /// Rotation vector since `from` [rad]; after `to` the body turns with rate_after
  RampOf<Vector3> turn;
  Quaternion start_orientation = Quaternion::Identity();  ///< orientation at `from`

  [[nodiscard]] bool is_set() const { return moves; }
  /// Pose and velocity of the kinematic body with index `body` at `time`.
  [[nodiscard]] BodyState state_at(const BodySet& bodies, int body, double time) const;
  /// The rotation vector from its orientation at `begin` to that at `finish` [rad], world frame.
  [[nodiscard]] Vector3 turn_between(const BodySet& bodies, int body, double begin,
                                     double finish) const;
};

/// Controls of one cable.
struct CableControl {
  double compliance = not_set;        ///< [m/N], > 0; only for a cable with compliance
  double breaking_tension = not_set;  ///< [N], > 0
  /// Friction coefficient, > 0; only for a cable with wrap friction
  double wrap_friction = not_set;
  double added_length = 0.0;  ///< length that placements have added to the cable since time 0 [m]

  [[nodiscard]] bool is_set() const {
    return !std::isnan(compliance) || !std::isnan(breaking_tension) || !std::isnan(wrap_friction) ||
           added_length != 0.0;
  }
};

/// Controls of one link of a cable.
struct LinkControl {
  double friction = not_set;  ///< friction coefficient, > 0; only for a link with friction
  bool has_feed = false;
  Ramp feed_speed;  ///< [m/s]; only for an attachment with a feed speed

  [[nodiscard]] bool is_set() const { return has_feed || !std::isnan(friction); }
};

/// Controls of one kind, indexed by the thing that each controls.
template <class Control>
class ControlTable {
 public:
  /// The control at `index`, or null if none is set.
  [[nodiscard]] const Control* find(int index) const {
    const auto i = static_cast<std::size_t>(index);
    return i < entries_.size() && entries_[i].is_set() ? &entries_[i] : nullptr;
  }
  [[nodiscard]] bool any() const { return count_ > 0; }
  /// Sets the control at `index` of `size`. Allocates if it is the first one of the table.
  void put(int index, std::size_t size, const Control& control) {
    change(index, size, [&](Control& entry) { entry = control; });
  }
  /// Changes the control at `index` of `size` by `change(entry)`.
  template <class Change>
  void change(int index, std::size_t size, const Change& change) {
    if (entries_.size() < size) entries_.resize(size);
    Control& entry = entries_[static_cast<std::size_t>(index)];
    const int before = entry.is_set() ? 1 : 0;
    change(entry);
    count_ += (entry.is_set() ? 1 : 0) - before;
  }
  void clear(int index) {
    if (find(index) != nullptr) put(index, entries_.size(), Control{});
  }
  /// All entries, including those that are not set.
  [[nodiscard]] const std::vector<Control>& entries() const { return entries_; }
  /// Replaces all entries, with those of a file for instance.
  void assign(std::vector<Control> entries) {
    entries_ = std::move(entries);
    count_ = 0;
    for (const Control& entry : entries_) count_ += entry.is_set() ? 1 : 0;
  }

 private:
  std::vector<Control> entries_;
  int count_ = 0;  // number of entries that are set
};

/// All controls of a world.
struct Controls {
  bool has_gravity = false;
  Vector3 gravity = Vector3::Zero();       ///< replaces the model's gravity [m/s2] if has_gravity
  ControlTable<DriveControl> body_drives;  ///< per body
  ControlTable<ForceControl> forces;       ///< per body
  ControlTable<MotionControl> motions;     ///< per body
  ControlTable<DriveControl>
      joint_drives;                   ///< per coordinate, joint by joint, at JointEffect::control
  ControlTable<CableControl> cables;  ///< per cable
  /// Per link, cable by cable, including the places kept for wraps
  ControlTable<LinkControl> links;

  [[nodiscard]] bool empty() const {
    return !has_gravity && !body_drives.any() && !forces.any() && !motions.any() &&
           !joint_drives.any() && !cables_any();
  }
  /// Whether a control of a cable or a link is set.
  [[nodiscard]] bool cables_any() const { return cables.any() || links.any(); }
};

}  // namespace sheave
