#pragma once
// Reports of joints: forces, coordinates, drives.

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
  bool angle = false;     ///< units have rad in place of m
  /// Change since time 0 [m], with whole turns for angles. The swing of a ball joint is the angle
  /// to the other body's axis.
  double value = 0.0;
  double rate = 0.0;  ///< [m/s]
  double friction_force =
      0.0;  ///< mean dry friction force in the last substep, along the coordinate [N]
  double drive_force = 0.0;  ///< mean drive force in the last substep, along the coordinate [N]
  double drive_target =
      0.0;  ///< present target of the drive: a position [m], a speed [m/s] or a force [N]
  /// Deviation from the target of a drive without compliance: of the value [m] for a drive to a
  /// position, of the rate [m/s] for a drive to a speed. 0 for a drive at its limit and for a drive
  /// of a force.
  double drive_error = 0.0;
};

struct JointReport {
  std::string name;
  std::string_view type;  ///< key in the registry, e.g. "hinge"
  /// Mean action of the joint on body_b in the last substep, in the world frame: the force, and its
  /// torque about body_b's anchor. Drives, springs, stops and friction are included. The opposite
  /// acts on body_a.
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m]
  /// The part of force and torque that is dry friction in several directions (ball and plane
  /// joints).
  Vector3 friction_force = Vector3::Zero();        ///< [N]
  Vector3 friction_torque = Vector3::Zero();       ///< [N m]
  std::vector<JointCoordinateReport> coordinates;  ///< JointDef::coordinates()
  std::optional<double> broken_at;                 ///< time at which the joint broke [s]
  /// The largest residuals of the rigid constraints: distance of anchors that coincide, deviation
  /// of axes, overrun of stops, gears out of mesh. 0 for a broken joint.
  double error = 0.0;        ///< of lengths [m]
  double angle_error = 0.0;  ///< of angles [rad]
};

/// Reads single joints of one state of a world. The world must outlive the reader and not step
/// meanwhile.
class JointReader {
 public:
  explicit JointReader(const World& world);
  ~JointReader();
  JointReader(JointReader&&) noexcept;
  JointReader& operator=(JointReader&&) noexcept;

  /// The report of the joint with this index in Model::joints.
  [[nodiscard]] JointReport report(int joint) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// The reports of all joints, in the order of the model.
[[nodiscard]] std::vector<JointReport> joint_reports(const World& world);

}  // namespace sheave
