#pragma once
// What joints do: forces, angles, drives.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/constraint_batch.h"

namespace sheave {

class World;

/// A free coordinate of a joint.
struct JointCoordinateReport {
  std::string_view name;  ///< "angle", "travel", ...
  bool angle = false;     ///< its units have rad for m
  double value = 0.0;  ///< since time 0 [m], angles with all turns; of a distance joint its length
  double rate = 0.0;   ///< [m/s]
  double drive_force = 0.0;  ///< of its drive in the last substep, along the coordinate [N]
};

struct JointReport {
  std::string name;
  /// What the joint did to body_b in the last substep, in the world frame: the mean force, and its torque about body_b's
  /// anchor. Drives, springs, stops and friction are part of it. The opposite acts on body_a.
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< [N m]
  std::vector<JointCoordinateReport>
      coordinates;                  ///< empty for joints that leave none, or do not count them
  std::optional<double> broken_at;  ///< when it broke [s]
};

/// A feature that consists of joints.
class JointFeature : public ConstraintBatch {
 public:
  /// Appends the reports of its joints, for a state of the world and `own` of the feature.
  virtual void append_reports(const BodySet& bodies, const State& state, const FeatureState& own,
                              std::vector<JointReport>& reports) const = 0;
};

/// The reports of all joints, in the order of the model.
[[nodiscard]] std::vector<JointReport> joint_reports(const World& world);

}  // namespace sheave
