#pragma once
// Lengths of substeps that keep a tolerance (StepSettings::tolerance).
//
// A step of length dt is divided into substeps of dt / 2^level. `rattle` moves a body within a
// substep as if its acceleration were constant, so a jerk j adds an error of h^3 j / 6 to the
// position. The errors of all substeps of one second must not exceed the tolerance:
//
//   h^2 j / 6 <= tolerance / 1 s.
//
// Each error falls with h^3 and the number of substeps grows with 1/h, so the error at the end is
// proportional to the tolerance. The jerk is the difference of the mean accelerations of two
// substeps, which costs no further solution. After an event no acceleration of before is valid. A
// first half of the next substep is then done for comparison, and undone.
//
// At an event (a rope becomes taut, a body lands, a break, the onset of sliding) the acceleration
// or the velocity jumps, and no substep meets the condition. The substep is halved until the event
// lies in one that is short enough for the tolerance:
//
//   a jump of the acceleration by a   a wrong velocity h a, which moves bodies until the motion
//                                     turns: h a x 1 s <= tolerance / 4
//   a jump of the velocity by v       a place that is wrong by h v <= tolerance / 4. A velocity
//                                     that jumps does not change less in shorter substeps.
//   a velocity that is off by v in    the same place: h v <= tolerance / 4. A mechanism that passes a
//   this substep only                 singular position does so, where a motion is free for an instant
//                                     that constraints hold before and after. Shorter substeps meet
//                                     that position more closely, and increase v.
//
// If half the length has a larger jump, the cause is no event. Solvers leave residuals r of positions,
// which become velocities r / h. The longer of the two substeps is then the best one.
//
// After an event the search for a length begins anew at the length before.
//
// The number of halvings grows with log(1/tolerance), so events leave the order unchanged.
//
// Where a motion is smooth, h stays the same: `rattle` is reversible then, and its energy does not
// drift. The level falls only where the largest jerk of a while, longer than half a vibration, would
// allow twice the length with a margin.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

class BodySet;
struct State;
struct StepSettings;

/// The part of a state from which the length of the next substep follows. Empty without a
/// tolerance.
struct StepSizeMemory {
  /// Substeps have the length dt / 2^level.
  std::int64_t level = 0;
  /// Middle of the time for which `accelerations` are means [s].
  double middle = 0.0;
  /// Start of the present window [s].
  double window = 0.0;
  /// Largest jerks [m/s3] and accelerations [m/s2] in the last window and in the present one.
  double jerk_before = 0.0;
  double jerk = 0.0;
  double acceleration_before = 0.0;
  double acceleration = 0.0;
  /// Per body that constraints can move: mean acceleration of the centre of mass [m/s2], and angular
  /// acceleration times the body's size [m/s2], in the world frame. Empty: nothing is known.
  std::vector<double> accelerations;

  /// Whether nothing has been noted.
  [[nodiscard]] bool empty() const { return level == 0 && middle == 0.0 && accelerations.empty(); }
  /// Whether the numbers can be those of a world with so many bodies that constraints can move.
  [[nodiscard]] bool is_sound(std::size_t movable) const;
  [[nodiscard]] bool operator==(const StepSizeMemory&) const = default;
};

/// Why a substep must be shorter, or that it need not.
struct StepSizeVerdict {
  bool accepted = true;
  /// Whether velocity or acceleration has jumped.
  bool event = false;
  double error = 0.0;  ///< estimated error of the substep [m]
  int body = -1;       ///< with the largest error; -1: no body moves
  /// At an event: the change of the velocity beyond that of the acceleration before [m/s].
  double jump = 0.0;
  bool of_velocity = false;  ///< at an event: the velocity is known to jump
  bool is_placed = false;    ///< short enough for a jump of the velocity
  bool is_last = false;      ///< not accepted, and no other length is allowed
  /// If velocities are as before after one more such substep, both may be accepted as one.
  bool may_pass = false;
};

/// Decides on the lengths of the substeps of one step.
class StepSizeControl {
 public:
  /// Substeps end on a grid of dt / 2^finest.
  static constexpr std::int64_t finest = 20;
  /// Most attempts in a step. When they are used up, the rest is done at `last_resort_level`,
  /// whatever its error.
  static constexpr std::int64_t most_attempts = std::int64_t{1} << 16;
  static constexpr std::int64_t last_resort_level = 6;

  /// `memory` belongs to the state of the step and changes with it. All must outlive the object.
  StepSizeControl(const StepSettings& step, const BodySet& bodies, StepSizeMemory& memory);

  [[nodiscard]] std::int64_t level() const { return memory_.level; }
  /// Whether no shorter substep is allowed.
  [[nodiscard]] bool is_shortest() const;
  /// Whether an acceleration is known to which that of the next substep can be compared.
  [[nodiscard]] bool knows() const { return memory_.accelerations.size() == accelerations_.size(); }
  /// Notes the accelerations of a motion from `from` to `to` that will be undone.
  void note(const State& from, const State& to);
  /// Judges a substep. If it is refused, the level has changed. If it is accepted, its accelerations
  /// are noted.
  StepSizeVerdict judge(const State& from, const State& to);
  /// The change of the velocity in a substep beyond that of the acceleration `before` it [m/s].
  double jump_after(const StepSizeMemory& before, const State& from, const State& to);
  /// The largest change of the velocity of a body, of its surface where it turns [m/s].
  [[nodiscard]] double change_of_velocity(const State& from, const State& to);
  /// In a substep of so many times the length, a jump of the velocity is no larger.
  static constexpr double length_of_proof = 256.0;
  /// Whether `jump` is one of the velocity, by that of a longer substep.
  [[nodiscard]] static bool is_jump(double jump, double in_longer) {
    return jump > 0.5 * in_longer;
  }
  /// After a substep at whose end velocities or forces jump, nothing is known.
  void restart(double time);
  /// Whether a substep of `length` [s] may have this error, in addition to that of judge() [m].
  [[nodiscard]] bool allows(double error, double length) const;
  /// Takes a shorter length because the substep has diverged; false if there is none.
  bool shorten();
  /// Takes twice the length if the motion allows it. The next substep must begin at a multiple of
  /// that length.
  void lengthen();

 private:
  struct Change {
    double largest = 0.0;  // change of acceleration [m/s2]
    double size = 0.0;     // largest acceleration [m/s2]
    int body = -1;
  };
  [[nodiscard]] Change change_of(const State& from, const State& to);
  /// Whether `jump` is so small that a substep may contain it.
  [[nodiscard]] bool may_contain(double jump) const;
  /// Whether `jump` is one of the velocity, by that of longer substeps, and so is its place.
  [[nodiscard]] bool is_jump_of_velocity(double h, double jump) const;
  /// Takes another length for the substep from `time` on, in place of `h` with this jump; false if
  /// there is none.
  bool seek(double time, double h, double jump);
  void follow(double time, double jerk, double acceleration);
  [[nodiscard]] double held_jerk() const;

  double tolerance_;
  double dt_;
  std::int64_t coarsest_;  // level
  const BodySet& bodies_;
  StepSizeMemory& memory_;
  std::int64_t attempts_ = 0;
  std::vector<double> accelerations_;  // of the substep in question
  std::vector<double> jumps_;          // of refused substeps by level, since the last event [m/s]
  struct Refusal {
    double time = -1.0;  // start of the substep [s]
    std::int64_t level = 0;
    double jump = 0.0;  // [m/s]
  };
  Refusal refused_;                // the last one
  double settled_ = -1.0;          // for the substep from this time on the length is chosen [s]
  std::int64_t search_from_ = -1;  // level at which the search for an event has begun; -1: none
};

}  // namespace sheave
