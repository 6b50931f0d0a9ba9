#pragma once
// What is wrong with controls; internal to the engine, but for make_ramp(). Faults are texts, empty
// where there is none. Setters ask of what they are about to set what restore() asks of a state, so
// a world never has what it could not go back to.

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

/// Where a joint of a model is to be found.
struct JointPlace {
  const JointFeature* feature = nullptr;
  int index = 0;             ///< within it
  int first_coordinate = 0;  ///< of its coordinates among those of all joints
};

/// The places of all joints; tells features where their joints' coordinates are.
[[nodiscard]] std::vector<JointPlace> number_joints(
    const Model& model, std::span<const std::unique_ptr<ConstraintBatch>> features);

/// What the value of a drive is.
enum class DriveMeaning { speed, position, force };

/// What a drive asks for now.
struct DriveNow {
  DriveMeaning meaning = DriveMeaning::speed;
  double value = 0.0;
  double rate = 0.0;      ///< of positions
  double time = 0.0;      ///< [s]
  double interval = 0.0;  ///< until the caller can set it anew [s]
};

/// Makes the ramp from there to `target`; false if there is none.
[[nodiscard]] bool make_ramp(const DriveNow& now, const DriveTarget& target, Ramp& ramp);
/// Why there is none, as the rest of a sentence that begins with what is driven.
[[nodiscard]] std::string ramp_fault(const DriveNow& now, const DriveTarget& target);

class ControlCheck {
 public:
  /// All must outlive this.
  ControlCheck(const Model& model, const BodySet& bodies, std::span<const JointPlace> joints)
      : model_(model), bodies_(bodies), joints_(joints) {}

  /// Of controls from elsewhere.
  [[nodiscard]] std::string fault_of(
      const Controls& controls, std::span<const std::unique_ptr<ConstraintBatch>> features) const;
  /// Whether there is such a body, and it is not the world.
  [[nodiscard]] bool is_body(BodyId body) const {
    return body.index >= 0 && body.index < bodies_.count();
  }
  /// The fault of one that is not.
  [[nodiscard]] std::string fault_of(BodyId body) const;
  // Whether the body can have such a control at all, and why not. It must be one of the model's.
  [[nodiscard]] bool has_drive(int body) const {
    return bodies_[body].driven_by() != DriveKind::none;
  }
  [[nodiscard]] bool is_kinematic(int body) const {
    return bodies_[body].mobility == Mobility::kinematic;
  }
  [[nodiscard]] bool takes_force(int body) const {
    const BodyProperties& own = bodies_[body];
    return own.mobility != Mobility::fixed && own.mobility != Mobility::kinematic &&
           !(own.prescribed() && own.mount < 0) && !own.massless();
  }
  [[nodiscard]] std::string drive_fault(int body) const;
  [[nodiscard]] std::string force_fault(int body) const;
  [[nodiscard]] std::string motion_fault(int body) const;
  /// Whether a state can have such a force.
  [[nodiscard]] static bool is_sound(const ForceControl& force);
  /// Whether a state can have such a motion of a kinematic body.
  [[nodiscard]] bool takes_motion(int body, const MotionControl& motion) const;
  /// Whether a kinematic body cannot be in any pose and move anyhow.
  [[nodiscard]] bool keeps_to_a_way(int body) const;
  /// Whether it may be in this pose and move so.
  [[nodiscard]] std::string way_fault(int body, const BodyState& state) const;
  /// Whether there is such a joint.
  [[nodiscard]] std::string fault_of_joint(int joint) const;
  [[nodiscard]] std::string joint_fault(int joint, int coordinate) const;
  /// The drive of a coordinate; null if there is such a fault.
  [[nodiscard]] const JointEffect* find_drive(int joint, int coordinate) const;
  [[nodiscard]] bool takes_limit(const JointEffect& drive, double limit) const;
  [[nodiscard]] std::string limit_fault(int joint, int coordinate, double limit) const;
  [[nodiscard]] int coordinate_count() const;
  /// What texts call them.
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
