#pragma once
// What is set while a world runs: drives, forces, gravity, motions, cables.
//
// Controls are part of the state: they are hashed, saved and restored with it, and a run that is
// given the same ones at the same times is the same run to the last bit. A world that sets none has
// none; a control, once set, holds until it is set again or cleared. One that stands for something
// in the model (a drive's table, a body's motion, gravity, a cable's friction) replaces it until
// then.
//
// They are set with checked functions, World::set_...() for bodies and joints and
// Simulation::set_...() for cables, and not here. Whoever computes something from a state asks here
// first, at the index of the body, joint coordinate, cable or link:
//
//   if (const DriveControl* set = state.controls.body_drives.find(body)) ... set->target.at(time) ...

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

/// The number of a control that has not been set.
inline constexpr double not_set = std::numeric_limits<double>::quiet_NaN();

/// Of a body's drive or that of a joint's coordinate.
struct DriveControl {
  bool has_target = false;
  /// What the drive asks for instead of its table: speed [rad/s or m/s], angle or position [rad or
  /// m], torque or force [N m or N], as its kind says. Of a body's angle only the change counts, as
  /// of its table.
  Ramp target;
  double limit =
      not_set;  ///< of a joint's drive: the largest force or torque it has [N or N m], >= 0

  [[nodiscard]] bool is_set() const { return has_target || !std::isnan(limit); }
};

/// What the components of a force are along.
enum class ForceFrame : std::int64_t {
  world,  ///< it keeps its direction
  body,   ///< it turns with the body: a thruster
};

/// A force and a torque on a body, besides those of its definition.
struct ForceControl {
  bool acts = false;
  ForceFrame frame = ForceFrame::world;  ///< of `force` and `torque`
  Vector3 force = Vector3::Zero();       ///< [N]
  Vector3 torque = Vector3::Zero();      ///< besides that of the force [N m]
  /// Where the force acts, from the centre of mass, own frame [m]: a point that moves with the
  /// body.
  Vector3 arm = Vector3::Zero();

  [[nodiscard]] bool is_set() const { return acts; }
  /// Whether it is a force at the centre of mass alone.
  [[nodiscard]] bool is_central() const { return is_zero(torque) && is_zero(arm); }
  /// In the world frame for a body with this orientation.
  [[nodiscard]] Vector3 force_in_world(const Quaternion& orientation) const {
    return frame == ForceFrame::world ? force : rotated(orientation, force);
  }
  /// About the centre of mass, with that of the force.
  [[nodiscard]] Vector3 torque_in_world(const Quaternion& orientation) const {
    if (is_central()) return Vector3::Zero();
    const Vector3 own = frame == ForceFrame::world ? torque : rotated(orientation, torque);
    return own + cross(rotated(orientation, arm), force_in_world(orientation));
  }
};

/// How a kinematic body moves instead of as its definition says.
struct MotionControl {
  bool moves = false;
  bool returns = false;      ///< from `position.to` on it moves as defined
  RampOf<Vector3> position;  ///< of the origin [m]
  RampOf<Vector3> turn;      ///< rotation since `from` [rad]; after `to` it turns with rate_after
  Quaternion start_orientation = Quaternion::Identity();  ///< at `from`

  [[nodiscard]] bool is_set() const { return moves; }
  /// Pose and velocity of kinematic body `body` at `time`.
  [[nodiscard]] BodyState state_at(const BodySet& bodies, int body, double time) const;
  /// By how much it turns from one time to another [rad], world frame.
  [[nodiscard]] Vector3 turn_between(const BodySet& bodies, int body, double begin,
                                     double finish) const;
};

/// Settings of a cable.
struct CableControl {
  double compliance = not_set;        ///< [m/N], > 0; of a cable that has one
  double breaking_tension = not_set;  ///< [N], > 0
  double wrap_friction = not_set;     ///< > 0; of a cable that has one
  double added_length = 0.0;          ///< that placements have put in since time 0 [m]

  [[nodiscard]] bool is_set() const {
    return !std::isnan(compliance) || !std::isnan(breaking_tension) || !std::isnan(wrap_friction) ||
           added_length != 0.0;
  }
};

/// Settings of a link of a cable.
struct LinkControl {
  double friction = not_set;  ///< > 0; of a link that has friction
  bool has_feed = false;
  Ramp feed_speed;  ///< [m/s]; of an attachment with a feed speed

  [[nodiscard]] bool is_set() const { return has_feed || !std::isnan(friction); }
};

/// Controls of one kind, at the indices of what they control.
template <class Control>
class ControlTable {
 public:
  /// That at `index`, or null if it has not been set.
  [[nodiscard]] const Control* find(int index) const {
    const auto i = static_cast<std::size_t>(index);
    return i < entries_.size() && entries_[i].is_set() ? &entries_[i] : nullptr;
  }
  [[nodiscard]] bool any() const { return count_ > 0; }
  /// Sets that at `index` of `size`. Allocates when it is the first one of the table.
  void put(int index, std::size_t size, const Control& control) {
    change(index, size, [&](Control& entry) { entry = control; });
  }
  /// The same, where `change(entry)` makes of what is there what is to be.
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
  /// All entries, those that are not set among them.
  [[nodiscard]] const std::vector<Control>& entries() const { return entries_; }
  /// Entries that come from elsewhere.
  void assign(std::vector<Control> entries) {
    entries_ = std::move(entries);
    count_ = 0;
    for (const Control& entry : entries_) count_ += entry.is_set() ? 1 : 0;
  }

 private:
  std::vector<Control> entries_;
  int count_ = 0;  // of those that are set
};

/// Everything that has been set.
struct Controls {
  bool has_gravity = false;
  Vector3 gravity = Vector3::Zero();       ///< instead of the model's [m/s2], if has_gravity
  ControlTable<DriveControl> body_drives;  ///< per body
  ControlTable<ForceControl> forces;       ///< per body
  ControlTable<MotionControl> motions;     ///< per body
  ControlTable<DriveControl>
      joint_drives;                   ///< per coordinate, joint by joint: World::coordinate_index()
  ControlTable<CableControl> cables;  ///< per cable
  ControlTable<LinkControl> links;    ///< per link, cable by cable, places for wraps among them

  [[nodiscard]] bool empty() const {
    return !has_gravity && !body_drives.any() && !forces.any() && !motions.any() &&
           !joint_drives.any() && !cables_any();
  }
  /// Whether anything of cables is set.
  [[nodiscard]] bool cables_any() const { return cables.any() || links.any(); }
};

}  // namespace sheave
