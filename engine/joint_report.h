#pragma once
// What joints do: forces, angles, drives.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/vector.h"

namespace sheave {

class World;

/// A free coordinate of a joint.
struct JointCoordinateReport {
  std::string_view name;  ///< "angle", "travel", ...
  bool angle = false;     ///< its units have rad for m
  /// Since time 0 [m], angles with all turns; the swing of a ball joint: against the other axis
  double value = 0.0;
  double rate = 0.0;  ///< [m/s]
  double friction_force =
      0.0;                   ///< of its dry friction in the last substep, along the coordinate [N]
  double drive_force = 0.0;  ///< of its drive in the last substep, along the coordinate [N]
  double drive_target =
      0.0;  ///< what that asks for now: a position [m], a speed [m/s], a force [N]
  /// By how much it is off what a drive without compliance asks for: of one to a position the value
  /// [m], of one to a speed the rate [m/s]. Drives that have reached their limit, and those to a
  /// force, ask for nothing.
  double drive_error = 0.0;
};

struct JointReport {
  std::string name;
  std::string_view type;  ///< key in the registry, e.g. "hinge"
  /// What the joint did to body_b in the last substep, in the world frame: the mean force, and its
  /// torque about body_b's anchor. Drives, springs, stops and friction are part of it. The opposite
  /// acts on body_a.
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m]
  /// Of that, what dry friction in several directions did (ball and plane joints).
  Vector3 friction_force = Vector3::Zero();        ///< [N]
  Vector3 friction_torque = Vector3::Zero();       ///< [N m]
  std::vector<JointCoordinateReport> coordinates;  ///< JointDef::coordinates()
  std::optional<double> broken_at;                 ///< when it broke [s]
  /// The largest errors of what holds rigidly: how far anchors are apart that coincide, axes from
  /// where they ought to be, stops overrun, gears out of mesh. 0 of a broken joint.
  double error = 0.0;        ///< of lengths [m]
  double angle_error = 0.0;  ///< of angles [rad]
};

/// Reads single joints of one state of a world, which must outlive it and not step meanwhile.
class JointReader {
 public:
  explicit JointReader(const World& world);
  ~JointReader();
  JointReader(JointReader&&) noexcept;
  JointReader& operator=(JointReader&&) noexcept;

  /// Of the joint at this index of Model::joints.
  [[nodiscard]] JointReport report(int joint) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// The reports of all joints, in the order of the model.
[[nodiscard]] std::vector<JointReport> joint_reports(const World& world);

}  // namespace sheave
