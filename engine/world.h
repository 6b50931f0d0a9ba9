#pragma once
// The simulation of one model.
//
//   sheave::Model model;                          // bodies, joints, gravity, step settings
//   auto world = sheave::World::create(model);    // or with features: cables
//   if (!world) report(world.errors());
//   while (world->state().time < 2.0 && world->step().ok()) show(world->state());
//
// The time that a step takes depends on the scene. A program with a deadline passes a stop request.
// A step that the request ends leaves the world as it was before the step:
//
//   const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
//   const auto report = world->step([&] { return std::chrono::steady_clock::now() > deadline; });
//   if (report.stopped) show_the_last_state_again();

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/contacts/contact_report.h"
#include "engine/control_requests.h"
#include "engine/divergence.h"
#include "engine/model.h"
#include "engine/state.h"
#include "engine/step_statistics.h"
#include "engine/work_limit.h"

namespace sheave {

class BodySet;
class ConstraintBatch;
class StepActor;
struct Stage;

/// The outcome of one step.
struct StepReport {
  StepStatistics statistics;
  std::optional<Divergence> divergence;  ///< if set, the state is the last good one
  /// Whether the stop request ended the step. The state is then, bit for bit, the one before the
  /// step, and the statistics count work that was discarded.
  bool stopped = false;
  /// Whether the step is complete.
  [[nodiscard]] bool ok() const { return !divergence.has_value() && !stopped; }
};

/// The last substep, which led to the state of a world. Its members are views of the world, valid
/// until the world steps or is restored.
struct LastSubstep {
  const State& start;  ///< state at the start of the substep; World::state() is the one at its end
  double h = 0.0;      ///< length of the substep [s]
  /// The integrator that did the substep. `rattle` leaves some substeps to `xpbd`.
  IntegratorKind integrator = IntegratorKind::xpbd;
  /// Per feature: the part of each force in its state [N or N m] that acted in the second half of
  /// the substep, along the gradients of the end. The rest of each force acted in the first half,
  /// along the gradients of the start. Joints, ground and cables have one number per multiplier.
  /// Contacts have four numbers per point: the normal force, and the friction as a vector. Empty
  /// with `xpbd`, where all forces act along the gradients of the end.
  std::span<const std::vector<double>> late_forces;
};

/// Energy of all bodies and features [J].
struct Energy {
  double kinetic = 0.0;
  /// Potential energy of the present gravity and of the model's constant forces; zero at the
  /// world's origin. The work of forces that a program has set is in StepStatistics::external_work.
  double potential = 0.0;
  double elastic = 0.0;
  [[nodiscard]] double total() const { return kinetic + potential + elastic; }
};

/// A model, its features and their state. Movable, not copyable; to copy a run, copy its State.
class World {
 public:
  /// Builds the features that the model itself defines (joints, contacts, ground).
  static Result<World> create(Model model);
  /// Builds the model's features and appends `features`.
  static Result<World> create(Model model, std::vector<std::unique_ptr<ConstraintBatch>> features);
  /// As above, for bodies that are already compiled. Features of other libraries are built from the
  /// compiled bodies, before the world exists. `layout` becomes State::layout.
  static Result<World> create(Model model, std::shared_ptr<const BodySet> bodies,
                              std::vector<std::unique_ptr<ConstraintBatch>> features,
                              std::uint64_t layout);
  /// The errors that create(model) would report, found without building a world.
  static Errors check(const Model& model);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances the world by dt. After a divergence the state stays at the last good substep.
  ///
  /// The step asks `stop`, if given, before each substep or part of a substep, and before each
  /// factorisation or sweep over the constraints. Substeps that need neither a factorisation nor a
  /// sweep (engine/solvers/affine_motion.h) ask once. A step asks about ten times, and more often
  /// where the solver needs more rounds. Once `stop` returns true, the step ends as soon as the
  /// piece of work in progress is done. The world is then as it was before the step, except that
  /// last_substep() is empty. The next step() gives the same result as if no step had been stopped.
  [[nodiscard]] StepReport step(const StopRequest& stop = {});
  /// The same with `actor`, who may set controls before each substep and at instants within one
  /// (engine/instants.h); null: nobody.
  [[nodiscard]] StepReport step(const StopRequest& stop, StepActor* actor);
  /// The same with `before_substep`, which is called before each substep of the settings, not
  /// before the parts of one that is cut. The callback may set controls.
  [[nodiscard]] StepReport step(const StopRequest& stop,
                                const std::function<void()>& before_substep);

  /// Makes at most `count` steps, with the same bits as step(), and returns the number of steps
  /// made: mostly all of them or none. A leap goes on only while each step is a single affine
  /// substep (engine/solvers/affine_motion.h), which costs next to nothing, and no forces are set.
  /// A leap writes the state only: statistics, last_substep() and events are not available for its
  /// steps. Callers that look at the state only after many steps leap first, then call step().
  std::int64_t leap(std::int64_t count);

  // Controls. A control is set between steps or before substeps. The control acts from the next
  // substep on, until it is set anew or cleared, and is part of the state (engine/controls.h). If a
  // request cannot be met, nothing changes and the error says which values are allowed. Repeating a
  // control that is set does not allocate.

  /// Replaces the model's gravity [m/s2].
  [[nodiscard]] Errors set_gravity(const Vector3& gravity);
  void clear_gravity();
  /// Sets a force on a body that forces can move: not a static, kinematic or driven one.
  [[nodiscard]] Errors set_force(BodyId body, const PointForce& force);
  [[nodiscard]] Errors clear_force(BodyId body);
  /// Sets the target of a rotor's drive, in place of the drive's table. A target angle counts from
  /// the body's angle at time 0 (BodyState::angle).
  [[nodiscard]] Errors set_drive(BodyId body, const DriveTarget& target);
  /// Gives the drive back to its table.
  [[nodiscard]] Errors clear_drive(BodyId body);
  /// Sets the motion of a kinematic body, in place of the motion in its definition. A body whose
  /// definition has a motion keeps to the directions of that motion. A body whose definition has an
  /// axis keeps to the plane normal to the axis. Cables and joints may have been built for these
  /// restrictions.
  [[nodiscard]] Errors set_motion(BodyId body, const MotionTarget& target);
  /// Leads a kinematic body back to the motion in its definition within `over` seconds, > 0;
  /// default: the next step.
  [[nodiscard]] Errors clear_motion(BodyId body, std::optional<double> over = {});
  /// Sets the target of a joint's drive, in place of the drive's table and sine. `joint` is an
  /// index into Model::joints, `coordinate` one into JointDef::coordinates().
  [[nodiscard]] Errors set_joint_drive(int joint, int coordinate, const DriveTarget& target);
  /// Sets the largest force or torque of a joint's drive [N or N m], >= 0. Drives that prescribe a
  /// force have no limit.
  [[nodiscard]] Errors set_joint_drive_limit(int joint, int coordinate, double limit);
  /// Restores the target and the limit of the definition. A drive to a position jumps to the
  /// present value of its table.
  [[nodiscard]] Errors clear_joint_drive(int joint, int coordinate);
  /// The time until the caller can next set a control [s]: a step, or a substep while
  /// `before_substep` is being called.
  [[nodiscard]] double control_interval() const;
  /// Releases a joint, as if it had broken now: from now on the joint constrains nothing.
  [[nodiscard]] Errors release_joint(int joint);
  /// Locks a joint that was released or has broken. The joint holds the degrees of freedom of its
  /// type, starting from the present pose of its bodies: no position jumps, and the coordinates of
  /// the joint continue (engine/joints/joint_hold.h). Relative velocity along the locked directions
  /// vanishes as in an inelastic impact, which conserves momentum. An error if a rigid stop, or a
  /// drive to a position without a limit, would move the bodies suddenly. Locking a joint that is
  /// not released changes nothing. (A brake on a coordinate is a drive to the speed 0 with a
  /// limit.)
  [[nodiscard]] Errors lock_joint(int joint);
  /// State::memory, which the program that sets controls reads and writes. A state whose memory has
  /// another size does not belong to this world.
  [[nodiscard]] std::vector<double>& memory();
  /// Returns why a state's memory is invalid, or an empty text. restore() calls the function that
  /// check_memory_by() has set; without one, any numbers are accepted.
  using MemoryFault = std::function<std::string(const State&)>;
  void check_memory_by(MemoryFault fault);
  /// The controls, without checks; for checked setters of features (Simulation::set_...()).
  [[nodiscard]] Controls& controls_of_features();

  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const BodySet& bodies() const;
  /// The compiled bodies, to be shared with another world.
  [[nodiscard]] std::shared_ptr<const BodySet> shared_bodies() const;
  [[nodiscard]] const State& state() const;
  [[nodiscard]] const std::vector<Stage>& stages() const;  ///< the stages of one substep
  [[nodiscard]] std::span<const std::unique_ptr<ConstraintBatch>> features() const;
  /// State of the feature at this index of features().
  [[nodiscard]] const FeatureState& feature_state(std::size_t index) const;

  /// The points where colliders touch or are about to touch; empty without colliders, and before
  /// the first step.
  [[nodiscard]] std::vector<ContactReport> contacts() const;

  /// From now on the bodies of state() keep their addresses between steps, for readers that hold
  /// pointers to them. So do the numbers of the last feature (cables) if their count is fixed.
  /// Without this call a step exchanges the memory of the state with the memory of the state
  /// before.
  void keep_in_place();

  /// Makes `state`, one of this world, the present state. An error, without any change, if the
  /// sizes of the state do not fit, if its controls or its memory are invalid, or if a number is
  /// not finite.
  [[nodiscard]] Errors restore(const State& state);

  /// Empty at time 0, after restore() and after a stopped step, until the next step.
  [[nodiscard]] std::optional<LastSubstep> last_substep() const;

  [[nodiscard]] Energy energy() const { return energy_of(state()); }
  /// The energy of another state of this world.
  [[nodiscard]] Energy energy_of(const State& state) const;
  /// Position of the body frame's origin [m]; the centre of mass may be elsewhere.
  [[nodiscard]] Vector3 position(BodyId body) const;
  [[nodiscard]] Quaternion orientation(BodyId body) const;
  /// Velocity of the body frame's origin [m/s].
  [[nodiscard]] Vector3 velocity(BodyId body) const;
  [[nodiscard]] Vector3 angular_velocity(BodyId body) const;
  /// World position of the body-frame point `local` [m].
  [[nodiscard]] Vector3 point(BodyId body, const Vector3& local) const;

 private:
  class Course;
  class AdaptiveCourse;
  class InstantForces;
  struct Content;
  explicit World(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
