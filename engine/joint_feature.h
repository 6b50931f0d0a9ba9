#pragma once

#include <span>
#include <string_view>

#include "engine/constraint_batch.h"
#include "engine/joint_report.h"
#include "engine/result.h"
#include "engine/wrench.h"

namespace sheave {

struct JointEffect;
struct JointHold;
struct JointPlace;
struct Model;
struct Row;

/// A feature that consists of joints of one type. `index` is a joint's index within the feature.
class JointFeature : public ConstraintBatch {
 public:
  /// The type of its joints. The joints are in the order of the model.
  [[nodiscard]] virtual std::string_view type() const = 0;
  /// The report of a joint, for a substep with start `now` and the feature's state `own` at the
  /// end.
  [[nodiscard]] virtual JointReport report(int index, const Substep& now,
                                           const FeatureState& own) const = 0;
  /// The force and the torque of report() alone, without allocation. Of `now`, the poses of the
  /// joint's bodies must be valid.
  [[nodiscard]] virtual Wrench wrench_of(int index, const Substep& now,
                                         const FeatureState& own) const = 0;
  /// Whether the joint has broken or been released.
  [[nodiscard]] virtual bool is_broken(int index, const FeatureState& own) const = 0;
  /// Releases the joint at `time`, unless it has broken before.
  virtual void release(int index, double time, FeatureState& own) const = 0;
  /// The hold with which the joint would keep the bodies at their poses in `now`; an error if stops
  /// or drives of the joint would move them.
  [[nodiscard]] virtual Result<JointHold> hold_here(int index, const Substep& now,
                                                    const FeatureState& own) const = 0;
  /// Locks the joint with this hold.
  virtual void lock(int index, const JointHold& hold, FeatureState& own) const = 0;
  /// The hold of the joint, or its last hold before it was released.
  [[nodiscard]] virtual JointHold hold(int index, const FeatureState& own) const = 0;
  /// The value of a coordinate of JointDef::coordinates() [m or rad] for the poses of `now` and the
  /// feature's state `own` at its start. Adds the gradient to `gradient`, an empty row.
  [[nodiscard]] virtual double measure(int index, int coordinate, const Substep& now,
                                       const FeatureState& own, Row& gradient) const = 0;
  /// The drive of a coordinate; null if there is none.
  [[nodiscard]] virtual const JointEffect* drive(int index, int coordinate) const = 0;
  /// The index of the drive's force in multipliers(); -1 if there is no drive.
  [[nodiscard]] virtual int drive_row(int index, int coordinate) const = 0;
  /// Sets the index of each joint's first coordinate among those of all joints of the model, for
  /// Controls::joint_drives.
  virtual void number_coordinates(std::span<const int> first) = 0;
  /// Tells joints that couple coordinates of other joints where these are, in the order of the
  /// model, among the features of the world.
  virtual void connect(const Model& /*model*/, std::span<const JointPlace> /*places*/,
                       std::span<const std::unique_ptr<ConstraintBatch>> /*features*/) {}
};

}  // namespace sheave
