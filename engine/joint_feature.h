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

/// A feature that consists of joints.
class JointFeature : public ConstraintBatch {
 public:
  /// Of all its joints, which it has in the order of the model.
  [[nodiscard]] virtual std::string_view type() const = 0;
  /// What its joint at `index` did, for a substep that begins `now` and with the feature's state
  /// `own`.
  [[nodiscard]] virtual JointReport report(int index, const Substep& now,
                                           const FeatureState& own) const = 0;
  /// The force and the torque of that report alone, without allocation; of `now` it needs the poses
  /// of the joint's bodies.
  [[nodiscard]] virtual Wrench wrench_of(int index, const Substep& now,
                                         const FeatureState& own) const = 0;
  /// Whether it has broken.
  [[nodiscard]] virtual bool is_broken(int index, const FeatureState& own) const = 0;
  /// Makes it one that broke at `time`, if it has not broken before.
  virtual void release(int index, double time, FeatureState& own) const = 0;
  /// What its joint at `index` must hold so that it holds its bodies where they are `now`; an error
  /// if there are stops or drives that would not let it.
  [[nodiscard]] virtual Result<JointHold> hold_here(int index, const Substep& now,
                                                    const FeatureState& own) const = 0;
  /// Makes it one that has not broken and holds that.
  virtual void lock(int index, const JointHold& hold, FeatureState& own) const = 0;
  /// What it holds, or did before it was released.
  [[nodiscard]] virtual JointHold hold(int index, const FeatureState& own) const = 0;
  /// What drives a coordinate of its joint at `index`; null if nothing does.
  [[nodiscard]] virtual const JointEffect* drive(int index, int coordinate) const = 0;
  /// Where the force of that drive is among multipliers(); -1 if nothing drives it.
  [[nodiscard]] virtual int drive_row(int index, int coordinate) const = 0;
  /// Tells where the coordinates of its joints begin among those of all joints of the model, for
  /// Controls::joint_drives.
  virtual void number_coordinates(std::span<const int> first) = 0;
};

}  // namespace sheave
