#pragma once
// The course of one step with an actor, with features that act, or with a tolerance; internal to the
// engine.

#include "engine/instant_forces.h"
#include "engine/step_size.h"
#include "engine/world_content.h"

namespace sheave {

/// A step of fixed substeps.
class World::Course {
 public:
  Course(Content& content, StepActor* actor)
      : c_(content),
        actor_(actor),
        slop_(instant_slop(content.model.step)),
        whole_(content.model.step.dt / content.model.step.substeps) {}
  void run(StepReport& report);

 protected:
  /// Conditions of which so many have been located in a substep act at its end: drives that two of
  /// them switch to and fro would otherwise take ever shorter parts.
  static constexpr int most_located = 4;

  /// The motion between two calls of the actor.
  struct Stretch {
    double end = 0.0;          // [s]
    bool ends_substep = true;  // or another one ends the substep
    bool on_grid = true;       // it is a substep of the settings
  };
  [[nodiscard]] Stretch next_stretch();
  /// The next known time of an action [s].
  [[nodiscard]] double next_instant() const;
  /// Tells features and loads the end of the next part, which begins with the present state.
  void expect(double end);
  /// Null if all went well.
  std::optional<Divergence> go(const Stretch& stretch);
  std::optional<Divergence> redo(double end);
  [[nodiscard]] bool actor_watches() const;
  /// Whether a condition holds now that did not at the start of the stretch.
  bool look();
  /// Velocities belong to poses so long before the present ones [s].
  [[nodiscard]] double velocity_lag() const;
  /// Of bodies with `xpbd`, by the velocities of the last two parts; else empty.
  [[nodiscard]] std::vector<Acceleration> mean_accelerations() const;
  /// Tells features the forces of the present instant, if they ask for them.
  void tell_forces();
  /// Performs the conditions of these forces that hold; whether a feature has changed.
  bool arise();
  /// Goes back to where a condition has come to hold.
  std::optional<Divergence> locate(Stretch& stretch);
  void act(bool begins);
  /// Whether a feature has acted.
  bool act_features();
  /// Marks the place to which go_back() returns.
  void mark();

  Content& c_;
  StepActor* actor_;
  double slop_;
  int index_ = 0;             // of the substep
  bool shifted_ = false;      // it has begun elsewhere than on the grid
  int located_ = 0;           // conditions in it
  bool locates_ = false;      // conditions of features
  double whole_;              // length of a substep that nothing cuts [s]
  double part_ = 0.0;         // of the last part [s]
  double part_began_ = 0.0;   // when the last part began [s]
  double part_before_ = 0.0;  // length of the part before it [s]
  bool has_run_ = false;      // a part has been done
  bool told_ = false;         // features know the forces of the present state
  /// With a tolerance and loads: the memory at the start of the substep in question. Attempts at it
  /// begin with this memory.
  const std::vector<double>* load_memory_ = nullptr;
  NoteMark mark_ = NoteMark::instant;  // of the substep in question
  bool jumped_ = false;                // velocities may have jumped at that start
  StepStatistics before_;
  double bracket_ = 0.0;  // of the instant that locate() has found [s]
};

/// A step whose substeps keep a tolerance. Their ends lie on a grid of dt / 2^finest, except at
/// instants of actions.
///
/// Some events are decided at the end of a substep: a cable breaks, a box that stuck begins to
/// slide. Such an event acts late by as much as the substep, and only the next substep shows the
/// jump. The course then returns to the start of the substep before, and does it in shorter ones.
/// After the last substep of a step it looks at the next one for this purpose, if that substep may
/// have decided anything.
class World::AdaptiveCourse : Course {
 public:
  AdaptiveCourse(Content& content, StepActor* actor);
  void run(StepReport& report);

 private:
  static constexpr std::int64_t ticks = std::int64_t{1} << StepSizeControl::finest;
  /// Most returns in a step. Each halves a substep, and an event takes less than `finest` of them.
  static constexpr int most_returns = 4096;

  /// Where a substep begins.
  struct Place {
    std::int64_t tick = 0;  // reached, or the last one before
    bool off_grid = false;  // the time is later than that of the tick
    int index = 0;          // of the substep of the settings
    NoteMark mark = NoteMark::instant;
    StepStatistics statistics;
  };
  enum class Outcome { kept, undone, returned };

  void begin_substep();
  /// One substep that is kept, after those that are not, or a return.
  std::optional<Divergence> advance();
  /// The next substep of the present level, up to an instant within it.
  void plan();
  /// The same, with loads that act with their means over it.
  void plan_with_loads();
  /// Does the planned substep, or the first half of it.
  std::optional<Divergence> attempt(bool half);
  void go_back();
  /// Decides on the substep just done.
  Outcome judge();
  /// Whether the velocity jumps in the substep just done, by `jump` [m/s]: a search for the jump
  /// that has begun in the step before does not know. Asks a longer substep, which is undone.
  /// `before`: the memory at its start.
  bool jumps(const StepSizeMemory& before, double jump);
  /// Does one more substep after a refused one, and whether both can be kept as one: the velocities
  /// were off in between only. `memory`: that at the start of the refused one.
  bool passes(const StepSizeMemory& memory);
  /// Whether an event was decided too late in the substep before, which is longer than allowed. Then
  /// returns to its start, with another level.
  bool returns(const StepSizeVerdict& verdict, double h, std::int64_t level);
  /// Whether the last substep that was kept may have decided anything at its end. Such an event
  /// changes one of the integers in which features keep their branches (sticks or slides, touches or
  /// not). Bodies that may touch decide at the start of the next substep, too.
  [[nodiscard]] bool may_have_decided() const;
  /// The same as returns() after the last substep of the step, by a look at the next one.
  bool returns_from_the_end();
  /// Does the planned substep, which has not diverged before, again from its start: features report
  /// from their data of the last substep done. `done`: statistics with that substep.
  void repeat_plan(std::int64_t tick, const StepStatistics& done);
  /// The same for the last substep of a step.
  void repeat_last_substep(const StepStatistics& done);
  void arrive();
  /// `jumped`: the velocity has jumped, so the place alone is off.
  void note_miss(const StepSizeVerdict& verdict, bool jumped);
  /// Notes how well an event within a substep of `length` [s], or within a bracket, is known.
  void note_event(double length, double jump, bool of_velocity);
  /// The end of a part of the grid [s].
  [[nodiscard]] double time_of(std::int64_t tick) const;
  [[nodiscard]] bool over() const { return c_.substep.work.stopped(); }

  StepSizeControl sizes_;
  State start_;  // of the substep in question
  Place place_;
  State last_start_;  // of the last substep that was kept
  Place last_place_;
  double last_length_ = 0.0;  // of that substep [s]
  bool can_return_ = false;   // last_start_ is known, and nothing has acted since
  double held_until_ = 0.0;   // substeps do not become longer before [s]
  int returns_ = 0;
  std::int64_t next_ = 0;    // end of the planned substep
  double instant_ = 0.0;     // of the next known action [s]
  bool is_instant_ = false;  // something acts now
  bool is_pair_ = false;     // the substep in question is one of two that are kept as one
  bool watched_ = false;     // conditions are looked at after the substep in question
  bool has_loads_ = false;
  StepSizeMemory judged_;   // before the last judgement
  bool to_corner_ = false;  // the planned substep ends at the corner of a load
  Stretch plan_;
};

}  // namespace sheave
