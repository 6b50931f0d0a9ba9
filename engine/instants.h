#pragma once
// Instants of actions within a substep: a cable is cut, a trigger sets a control.
//
// The substep ends at the instant, and another one begins (engine/substep_driver.h). A time that is
// known in advance moves the nearest boundary between two substeps, so that the instant costs nothing
// and leaves no short part. The end of a step does not move; a substep beside it is divided. A
// condition is seen at the end of the substep in which it comes to hold. The substep is then done
// again from its start up to an instant that a search of the root chooses, until the instant is
// known; no action happens in these attempts, and nothing is left of them.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/step_settings.h"

namespace sheave {

struct Controls;

/// The time of no instant.
inline constexpr double no_instant = std::numeric_limits<double>::infinity();

/// The distance from an end of its substep within which an instant counts as that end [s]. Parts are
/// no shorter: the residual of rows at the start of a part becomes a speed, residual over length of
/// the part. Rounds of Newton's method leave a residual of rounding, sweeps of Gauss-Seidel more.
[[nodiscard]] double instant_slop(const StepSettings& step);
/// Whether an action that is due at `instant` [s] happens at `time` [s].
[[nodiscard]] inline bool is_due(double instant, double time, double slop) {
  return time > instant - slop;
}

/// How well loads that act with their means over a substep represent those of the scene.
struct LoadDefect {
  /// By how much the end of the substep is off, for bodies that nothing holds [m].
  double distance = 0.0;
  /// The first corner of a load within the substep [s]; if none, later than its end.
  double corner = no_instant;
};

/// Sets controls in the course of a step. Its actions must follow from the state alone.
class StepActor {
 public:
  StepActor() = default;
  virtual ~StepActor() = default;
  StepActor(const StepActor&) = delete;
  StepActor& operator=(const StepActor&) = delete;

  /// Called at the start of each substep, and at each instant within one; `begins` is true once per
  /// substep of the settings. The call may set controls.
  virtual void act(bool begins) = 0;
  /// With a tolerance: called in place of act() at the start of each other substep.
  virtual void look_on() {}
  /// Whether act() must be called `substeps` times per step even with a tolerance.
  [[nodiscard]] virtual bool acts_by_substeps() const { return true; }
  /// Whether there are loads: forces and motions that change with time.
  [[nodiscard]] virtual bool has_loads() const { return false; }
  /// With a tolerance: sets the loads for a substep of this length [s] from the present state on.
  /// `jumped`: velocities may have jumped at its start, so those of before say nothing.
  virtual void set_loads(double /*length*/, bool /*jumped*/) {}
  /// With a tolerance: of the loads of a substep of this length [s] from the present state on.
  [[nodiscard]] virtual LoadDefect load_defect(double /*length*/) { return {}; }
  /// The next known time of an action [s], later than the state's by more than `slop`.
  [[nodiscard]] virtual double next_time(double /*slop*/) { return no_instant; }
  /// Whether the actor ever waits for conditions.
  [[nodiscard]] virtual bool watches() const { return false; }
  /// Replaces forces in `controls`, a copy of those of the present state, that are means over a
  /// substep by the forces of the present instant, and lets motions that end now go on.
  virtual void set_loads_now(Controls& /*controls*/) {}
  /// Per condition that the actor waits for: the distance of the quantity beyond its threshold in the
  /// present state, at most 0 while the condition does not hold. Read at the end of each substep.
  [[nodiscard]] virtual std::span<const double> margins() { return {}; }
};

/// Finds the first instant of a substep at which a margin is above 0: by secants with the rule of
/// Illinois, and by bisection where secants do not converge (a margin that jumps).
class InstantSearch {
 public:
  /// The search ends after so many attempts with the best instant found.
  static constexpr int most_attempts = 64;
  /// Accuracy of the instant, as a share of the substep.
  static constexpr double tolerance = 1e-9;

  /// No margin is above 0 at `begin` [s], and one is at `end` [s]. The margins at `begin` may be
  /// unknown (an empty list). No part is shorter than `shortest` [s].
  InstantSearch(double begin, double end, double shortest, std::span<const double> at_begin,
                std::span<const double> at_end);
  /// The next instant to be tried [s]; nothing once found() is known.
  [[nodiscard]] std::optional<double> next();
  /// Takes the margins at an instant that was tried.
  void tell(double instant, std::span<const double> margins);
  /// The first instant at which a condition is known to hold [s].
  [[nodiscard]] double found() const { return high_; }
  /// So much earlier no condition holds [s].
  [[nodiscard]] double bracket() const { return high_ - low_; }

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
