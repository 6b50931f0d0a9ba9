#pragma once
// The simulation of one model.
//
//   sheave::Model model;                          // bodies, joints, gravity, step settings
//   auto world = sheave::World::create(model);    // or with features: cables
//   if (!world) report(world.errors());
//   while (world->state().time < 2.0 && world->step().ok()) show(world->state());
//
// A step takes as long as its scene is hard. A program that cannot wait sets it a limit; what it
// says ends the step, which then has not been:
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
struct Stage;

/// What one step did.
struct StepReport {
  StepStatistics statistics;
  std::optional<Divergence> divergence;  ///< if set, the state is the last good one
  /// The stop request has ended the step: the state is, bit for bit, that before it, and the
  /// statistics are of work in vain.
  bool stopped = false;
  /// Whether the step is complete.
  [[nodiscard]] bool ok() const { return !divergence.has_value() && !stopped; }
};

/// How the state of a world came about: its last substep. Views of the world, valid until it steps
/// or is restored.
struct LastSubstep {
  const State& start;  ///< state at its beginning; World::state() is the one at its end
  double h = 0.0;      ///< its length [s]
  /// What it was done by. `rattle` leaves some substeps to `xpbd`.
  IntegratorKind integrator = IntegratorKind::xpbd;
  /// Per feature: of the forces in its state [N or N m] the parts that acted in the second half,
  /// along the gradients of the end; the rest of each acted in the first, along those of the start.
  /// Joints, ground and cables have one number per multiplier, contacts four per point: along the
  /// normal, and the friction as a vector. Empty with `xpbd`, where all forces act along the
  /// gradients of the end.
  std::span<const std::vector<double>> late_forces;
};

/// Energy of all bodies and features [J].
struct Energy {
  double kinetic = 0.0;
  /// Of gravity, as it is now, and of the model's constant forces; zero at the world's origin. What
  /// forces do that have been set is StepStatistics::external_work.
  double potential = 0.0;
  double elastic = 0.0;
  [[nodiscard]] double total() const { return kinetic + potential + elastic; }
};

/// A model, its features and their state. Movable, not copyable; copy its State.
class World {
 public:
  /// Builds the features that the model itself asks for (joints, ground).
  static Result<World> create(Model model);
  /// The same, and appends `features`.
  static Result<World> create(Model model, std::vector<std::unique_ptr<ConstraintBatch>> features);
  /// The same for bodies that are already compiled (features of other libraries need them first).
  static Result<World> create(Model model, std::shared_ptr<const BodySet> bodies,
                              std::vector<std::unique_ptr<ConstraintBatch>> features);
  /// What is wrong with a model by itself, without building a world: what create(model) would
  /// report.
  static Errors check(const Model& model);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt. After a divergence the state stays at the last good substep.
  ///
  /// `stop`, if there is one, is asked at the start of each substep, or part of one, and before
  /// each factorisation or sweep over the constraints (once for substeps that need neither,
  /// engine/solvers/affine_motion.h): mostly some ten times per step, more often where a step is
  /// hard. Once it says true the step ends, as soon as nothing but that one piece of work is done,
  /// and the world is as if the step had not been begun, but for last_substep(), of which there is
  /// nothing. Another step() then comes to the same end as one that was never stopped.
  [[nodiscard]] StepReport step(const StopRequest& stop = {});
  /// The same with `before_substep`, which is called before each substep of the settings, not
  /// before the parts of one that is cut. It may set controls.
  [[nodiscard]] StepReport step(const StopRequest& stop,
                                const std::function<void()>& before_substep);

  /// Makes at most `count` of the steps that step() would make, bit for bit, as long as they are of
  /// the kind that costs next to nothing (engine/solvers/affine_motion.h), one substep each, and no
  /// loads have been set; returns how many, mostly all or none. What a step tells besides the state
  /// is not there for these: statistics, last_substep(), events. For callers that look at the state
  /// only after many steps: leap, then step().
  std::int64_t leap(std::int64_t count);

  // Controls: set between steps or before substeps, in force from the next substep on until they
  // are set anew or cleared, and part of the state (engine/controls.h). Where a request cannot be
  // met nothing changes, and the error says what is allowed. None allocates when it repeats one
  // that is set.

  /// Instead of the model's [m/s2].
  [[nodiscard]] Errors set_gravity(const Vector3& gravity);
  void clear_gravity();
  /// On a body that forces can move: not on static, kinematic and driven ones.
  [[nodiscard]] Errors set_force(BodyId body, const PointForce& force);
  [[nodiscard]] Errors clear_force(BodyId body);
  /// Of a rotor with a drive, in place of its table. An angle is the one that the body has turned
  /// since time 0 (BodyState::angle).
  [[nodiscard]] Errors set_drive(BodyId body, const DriveTarget& target);
  /// From now on the table drives it again.
  [[nodiscard]] Errors clear_drive(BodyId body);
  /// Of a kinematic body, in place of the motion that its definition gives it. One that has such a
  /// motion keeps to its directions, one with an axis to the plane across it, since cables and
  /// joints may have been built for that.
  [[nodiscard]] Errors set_motion(BodyId body, const MotionTarget& target);
  /// Leads it back to where its definition has it after `over` seconds, > 0; default: the next
  /// step.
  [[nodiscard]] Errors clear_motion(BodyId body, std::optional<double> over = {});
  /// Of the drive along a coordinate of a joint, by their indices in Model::joints and
  /// JointDef::coordinates(), in place of its table and sine.
  [[nodiscard]] Errors set_joint_drive(int joint, int coordinate, const DriveTarget& target);
  /// The largest force or torque that it has [N or N m], >= 0; not of drives of a force.
  [[nodiscard]] Errors set_joint_drive_limit(int joint, int coordinate, double limit);
  /// Target and limit are those of the definition again. (A drive to a position then asks for where
  /// its table is, at once.)
  [[nodiscard]] Errors clear_joint_drive(int joint, int coordinate);
  /// How long what is set now has until the caller can set it anew [s]: a step, or before a substep
  /// that.
  [[nodiscard]] double control_interval() const;
  /// The joint holds nothing any more, as if it had broken now.
  [[nodiscard]] Errors release_joint(int joint);
  /// A joint that was released or has broken holds again what its type holds, from where its bodies
  /// are now: no position jumps and its coordinates go on (engine/joints/joint_hold.h). What speed
  /// the bodies have against it ends as in an inelastic impact, which keeps momentum. An error if a
  /// rigid stop or a drive to a position without a limit would move them by a blow. One that holds
  /// goes on to do so. (To hold a coordinate of such a joint is what a brake does: a drive to the
  /// speed 0 with a limit.)
  [[nodiscard]] Errors lock_joint(int joint);
  /// State::memory, to be read and written by whoever sets controls. States with another size do
  /// not belong to this world.
  [[nodiscard]] std::vector<double>& memory();
  /// Why a state cannot have the memory that it has; empty if it can. restore() asks; as long as
  /// nobody has said so, any numbers will do.
  using MemoryFault = std::function<std::string(const State&)>;
  void check_memory_by(MemoryFault fault);
  /// Unchecked: for functions that check what they set for a feature (Simulation::set_...()).
  [[nodiscard]] Controls& controls_of_features();

  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const BodySet& bodies() const;
  /// The same, for another world of the same bodies.
  [[nodiscard]] std::shared_ptr<const BodySet> shared_bodies() const;
  [[nodiscard]] const State& state() const;
  [[nodiscard]] const std::vector<Stage>& stages() const;  ///< of one substep
  [[nodiscard]] std::span<const std::unique_ptr<ConstraintBatch>> features() const;
  /// State of the feature at this index of features().
  [[nodiscard]] const FeatureState& feature_state(std::size_t index) const;

  /// Where colliders touch or are about to; empty without colliders, and before the first step.
  [[nodiscard]] std::vector<ContactReport> contacts() const;

  /// From now on the bodies of state(), and the numbers of its last feature if their count is fixed
  /// (cables), are at the same addresses between all steps, for those who look at them there. A
  /// world that is not told so exchanges them with those of the substep before.
  void keep_in_place();

  /// Goes back (or ahead) to a state of this world; an error, and nothing has changed, if its shape
  /// does not fit, or its controls or its memory, or if a number is not finite.
  [[nodiscard]] Errors restore(const State& state);

  /// Nothing at time 0, after restore() and after a step that was stopped, until the next step.
  [[nodiscard]] std::optional<LastSubstep> last_substep() const;

  [[nodiscard]] Energy energy() const { return energy_of(state()); }
  /// The same in another state of this world.
  [[nodiscard]] Energy energy_of(const State& state) const;
  /// Pose of the body frame's origin [m] (not of the centre of mass).
  [[nodiscard]] Vector3 position(BodyId body) const;
  [[nodiscard]] Quaternion orientation(BodyId body) const;
  /// Velocity of the body frame's origin [m/s].
  [[nodiscard]] Vector3 velocity(BodyId body) const;
  [[nodiscard]] Vector3 angular_velocity(BodyId body) const;
  /// World position of the body-frame point `local` [m].
  [[nodiscard]] Vector3 point(BodyId body, const Vector3& local) const;

 private:
  struct Content;
  explicit World(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
