#pragma once
// Instants within a substep at which something acts: a cable is cut, a trigger sets a control.
//
// The substep ends there, and another one begins (engine/substep_driver.h). A time that is known in
// advance moves the boundary between two substeps that is nearest to it, so that it costs nothing
// and leaves no short part; beside the end of a step, which does not move, the substep is parted. A
// condition is seen at the end of the substep in which it comes to be so. The substep is then done
// again from its start up to an instant that a search of the root chooses, until the instant is
// known; nobody acts in these attempts, and nothing is left of them.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/step_settings.h"

namespace sheave {

/// There is none.
inline constexpr double no_instant = std::numeric_limits<double>::infinity();

/// So near to an end of its substep [s] an instant counts as there. Parts are no shorter: what rows
/// are off by at the start of a part becomes a speed of so much over its length. Rounds of Newton's
/// method leave rounding of that, sweeps of Gauss-Seidel much more.
[[nodiscard]] double instant_slop(const StepSettings& step);
/// Whether what is due at `instant` [s] is done at `time` [s].
[[nodiscard]] inline bool is_due(double instant, double time, double slop) {
  return time > instant - slop;
}

/// Who sets controls in the course of a step. What it does must follow from the state alone.
class StepActor {
 public:
  StepActor() = default;
  virtual ~StepActor() = default;
  StepActor(const StepActor&) = delete;
  StepActor& operator=(const StepActor&) = delete;

  /// Called at the start of each substep, and at each instant within one; `begins` is true once per
  /// substep of the settings. It may set controls.
  virtual void act(bool begins) = 0;
  /// The next time at which it wants to act [s], beyond the state's by more than `slop`, as far as
  /// it is known in advance.
  [[nodiscard]] virtual double next_time(double /*slop*/) { return no_instant; }
  /// Whether it ever waits for conditions.
  [[nodiscard]] virtual bool watches() const { return false; }
  /// For the state as it is: how far each condition that it waits for is beyond where it acts, at
  /// most 0 as long as the condition does not hold. They are looked at at the end of each substep.
  [[nodiscard]] virtual std::span<const double> margins() { return {}; }
};

/// Looks for the first instant of a substep at which a margin is above 0: by secants with the rule
/// of Illinois, and by halves where these get nowhere (a margin that jumps).
class InstantSearch {
 public:
  /// Beyond so many attempts it makes do with what is known.
  static constexpr int most_attempts = 64;
  /// How well the instant is known in the end, as a share of the substep.
  static constexpr double tolerance = 1e-9;

  /// From `begin` to `end` [s] a margin comes to be above 0, which none is at `begin`; those at
  /// `begin` may be unknown (an empty list). No part is shorter than `shortest` [s].
  InstantSearch(double begin, double end, double shortest, std::span<const double> at_begin,
                std::span<const double> at_end);
  /// The next instant to be tried [s]; none: found() is known.
  [[nodiscard]] std::optional<double> next();
  /// The margins there.
  void tell(double instant, std::span<const double> margins);
  /// The first instant at which something holds, as far as is known [s].
  [[nodiscard]] double found() const { return high_; }

 private:
  [[nodiscard]] double guess() const;

  double earliest_, latest_;  // of attempts
  double enough_;
  double low_, high_;  // nothing holds at one, something at the other
  std::vector<double> at_low_, at_high_;
  double low_weight_ = 1.0;
  double high_weight_ = 1.0;
  std::optional<bool> held_;  // whether something held at the last attempt
  int attempts_ = 0;
  double width_ = 0.0;   // before the last attempt
  bool halves_ = false;  // the last attempt does
};

}  // namespace sheave
