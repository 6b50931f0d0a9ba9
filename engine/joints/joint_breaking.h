#pragma once
// Joints that break; a part of engine/joints/joint_batch.h.
//
// The multipliers of a substep are means, and a joint breaks at the instant at which its force passes
// its bound. The force of an instant is that of a trial motion (engine/instant_forces.h). An impact has
// no force of an instant, but an impulse: it counts as its mean over a whole substep, if that is above
// twice the force that is left at the end. A smooth motion does not have such means: they lie between
// the forces at both ends of the substep, but for terms of second order.

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/index.h"
#include "engine/instant_feature.h"

namespace sheave {

/// The sizes of force and torque of the joints of a batch, and their bounds.
class JointBreaking {
 public:
  /// Adds a joint with these bounds [N, N m].
  void add(const std::optional<double>& force, const std::optional<double>& torque) {
    constexpr double never = std::numeric_limits<double>::infinity();
    loads_.push_back({force.value_or(never)});
    loads_.push_back({torque.value_or(never)});
    any_ = any_ || force || torque;
  }
  /// Whether a joint can break.
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool can_break(std::size_t joint) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    return loads_[2 * joint].bound < never || loads_[2 * joint + 1].bound < never;
  }
  /// Called before a part of the motion.
  void expect() {
    for (Load& load : loads_) load.mean = load.impulse = load.now = 0.0;
  }
  /// Called at the end of a substep of the length `h` [s] with the means of a joint [N, N m].
  void note(std::size_t joint, double h, double force, double torque) {
    loads_[2 * joint].note(h, force);
    loads_[2 * joint + 1].note(h, torque);
  }
  /// Whether the means break the joint.
  [[nodiscard]] bool breaks_by_means(std::size_t joint) const {
    const Load* own = &loads_[2 * joint];
    return own[0].mean > own[0].bound || own[1].mean > own[1].bound;
  }
  /// InstantFeature::append_forces().
  void append(std::vector<double>& forces) const {
    for (const Load& load : loads_) forces.push_back(load.mean);
  }
  /// InstantFeature::tell_forces().
  void tell(std::span<const double> forces, double length) {
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      Load& load = loads_[i];
      load.now = i < forces.size() ? forces[i] : load.mean;
      const double jerk = load.impulse / length;
      if (jerk > std::max(load.bound, 2.0 * load.now)) load.now = jerk;
    }
  }
  /// The largest force or torque beyond its bound, as a share of the bound.
  [[nodiscard]] double margin() const {
    double most = -1.0;
    for (const Load& load : loads_) most = std::max(most, load.now / load.bound - 1.0);
    return most;
  }
  /// Whether the forces of the present instant break the joint.
  [[nodiscard]] bool breaks_now(std::size_t joint) const {
    const Load* own = &loads_[2 * joint];
    return own[0].now > own[0].bound || own[1].now > own[1].bound;
  }

 private:
  /// A force [N] or a torque [N m].
  struct Load {
    double bound = 0.0;
    double mean = 0.0;     ///< in the last substep
    double impulse = 0.0;  ///< in the part of the motion, times s
    double now = 0.0;      ///< at the present instant
    void note(double h, double size) {
      mean = size;
      impulse += h * size;
    }
  };
  std::vector<Load> loads_;  // two per joint
  bool any_ = false;
};

}  // namespace sheave
