#pragma once
// Checks of controls; internal to the engine, but for make_ramp(). Errors are texts, empty if there
// is none. Setters check a control as restore() checks a state, so a world never has a state that
// restore() would reject.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/body_set.h"
#include "engine/control_requests.h"
#include "engine/joint_feature.h"
#include "engine/joint_report.h"
#include "engine/model.h"

namespace sheave {

/// The location of a joint of a model.
struct JointPlace {
  const JointFeature* feature = nullptr;
  int index = 0;             ///< index within the feature
  int first_coordinate = 0;  ///< index of the joint's first coordinate among those of all joints
};

/// The locations of all joints. Also tells features the indices of their joints' coordinates, and
/// the locations themselves.
[[nodiscard]] std::vector<JointPlace> number_joints(
    const Model& model, std::span<const std::unique_ptr<ConstraintBatch>> features);

/// The quantity that a drive's value prescribes.
enum class DriveMeaning { speed, position, force };

/// The present target of a drive.
struct DriveNow {
  DriveMeaning meaning = DriveMeaning::speed;
  double value = 0.0;
  double rate = 0.0;      ///< rate of a position
  double time = 0.0;      ///< [s]
  double interval = 0.0;  ///< time until the caller can next set it [s]
};

/// Makes the ramp from `now` to `target`; false if there is none.
[[nodiscard]] bool make_ramp(const DriveNow& now, const DriveTarget& target, Ramp& ramp);
/// The reason why there is no ramp, as the rest of a sentence whose subject is the driven object.
[[nodiscard]] std::string ramp_fault(const DriveNow& now, const DriveTarget& target);

class ControlCheck {
 public:
  /// All arguments must outlive this object.
  ControlCheck(const Model& model, const BodySet& bodies, std::span<const JointPlace> joints)
      : model_(model), bodies_(bodies), joints_(joints) {}

  /// The fault of controls that come from a file or a program; empty if there is none.
  [[nodiscard]] std::string fault_of(
      const Controls& controls, std::span<const std::unique_ptr<ConstraintBatch>> features) const;
  /// Whether the body exists and is not the world.
  [[nodiscard]] bool is_body(BodyId body) const {
    return body.index >= 0 && body.index < bodies_.count();
  }
  /// The fault of a body for which is_body() is false.
  [[nodiscard]] std::string fault_of(BodyId body) const;
  // Whether this kind of control exists for the body, and why not. The body must exist.
  [[nodiscard]] bool has_drive(int body) const {
    return bodies_[body].driven_by() != DriveKind::none;
  }
  [[nodiscard]] bool is_kinematic(int body) const {
    return bodies_[body].mobility == Mobility::kinematic;
  }
  [[nodiscard]] bool takes_force(int body) const {
    const BodyProperties& own = bodies_[body];
    return yields(own.mobility) && !(own.prescribed() && own.mount < 0) && !own.massless();
  }
  [[nodiscard]] std::string drive_fault(int body) const;
  [[nodiscard]] std::string force_fault(int body) const;
  [[nodiscard]] std::string motion_fault(int body) const;
  /// Whether all numbers of the force are finite.
  [[nodiscard]] static bool is_sound(const ForceControl& force);
  /// Whether the motion's numbers are valid, and whether both ends are allowed by way_fault().
  [[nodiscard]] bool takes_motion(int body, const MotionControl& motion) const;
  /// Whether the definition of the kinematic body restricts its motion.
  [[nodiscard]] bool keeps_to_a_way(int body) const;
  /// The restriction that this pose or velocity violates; empty if there is none.
  [[nodiscard]] std::string way_fault(int body, const BodyState& state) const;
  /// The fault of a joint index; empty if the joint exists.
  [[nodiscard]] std::string fault_of_joint(int joint) const;
  [[nodiscard]] std::string joint_fault(int joint, int coordinate) const;
  /// The drive of a coordinate; null if joint_fault() is not empty.
  [[nodiscard]] const JointEffect* find_drive(int joint, int coordinate) const;
  [[nodiscard]] bool takes_limit(const JointEffect& drive, double limit) const;
  [[nodiscard]] std::string limit_fault(int joint, int coordinate, double limit) const;
  [[nodiscard]] int coordinate_count() const;
  /// The names of objects in messages.
  [[nodiscard]] std::string joint_name(int joint) const;
  [[nodiscard]] std::string body_name(int body) const;

 private:
  [[nodiscard]] std::string joints_fault(const ControlTable<DriveControl>& drives) const;
  [[nodiscard]] std::string bodies_fault(const Controls& controls) const;

  const Model& model_;
  const BodySet& bodies_;
  std::span<const JointPlace> joints_;
};

}  // namespace sheave
