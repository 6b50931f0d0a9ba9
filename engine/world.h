#pragma once
// The simulation of one model.
//
//   sheave::Model model;                          // bodies, joints, gravity, step settings
//   auto world = sheave::World::create(model);    // or with features: cables
//   if (!world) report(world.errors());
//   while (world->state().time < 2.0) world->step();
//
// A step takes as long as its scene is hard. A program that cannot wait sets it a limit; what it says ends the step, which then
// has not been:
//
//   const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
//   const auto report = world->step([&] { return std::chrono::steady_clock::now() > deadline; });
//   if (report.stopped) show_the_last_state_again();

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/contacts/contact_report.h"
#include "engine/divergence.h"
#include "engine/model.h"
#include "engine/step.h"
#include "engine/work_limit.h"

namespace sheave {

/// What one step did.
struct StepReport {
  StepStatistics statistics;
  std::optional<Divergence> divergence;  ///< if set, the state is the last good one
  /// The stop request has ended the step: the state is, bit for bit, that before it, and the statistics are of work in vain.
  bool stopped = false;
  /// Whether the step is complete.
  [[nodiscard]] bool ok() const { return !divergence.has_value() && !stopped; }
};

/// How the state of a world came about: its last substep. Views of the world, valid until it steps or is restored.
struct LastSubstep {
  const State& start;  ///< state at its beginning; World::state() is the one at its end
  double h = 0.0;      ///< its length [s]
  /// What it was done by. `rattle` leaves some substeps to `xpbd`.
  IntegratorKind integrator = IntegratorKind::xpbd;
  /// Per feature: of the forces in its state [N or N m] the parts that acted in the second half, along the gradients of the
  /// end; the rest of each acted in the first, along those of the start. Joints, ground and cables have one number per
  /// multiplier, contacts four per point: along the normal, and the friction as a vector. Empty with `xpbd`, where all
  /// forces act along the gradients of the end.
  std::span<const std::vector<double>> late_forces;
};

/// Energy of all bodies and features [J].
struct Energy {
  double kinetic = 0.0;
  double potential = 0.0;  ///< of gravity and of constant forces; zero at the world's origin
  double elastic = 0.0;
  [[nodiscard]] double total() const { return kinetic + potential + elastic; }
};

/// A model, its features and their state. Movable, not copyable; copy its State.
class World {
 public:
  /// Builds the features that the model itself asks for (joints, ground) and appends `features`.
  static Result<World> create(Model model,
                              std::vector<std::unique_ptr<ConstraintBatch>> features = {});
  /// The same for bodies that are already compiled (features of other libraries need them first).
  static Result<World> create(Model model, std::shared_ptr<const BodySet> bodies,
                              std::vector<std::unique_ptr<ConstraintBatch>> features);
  /// What is wrong with a model by itself, without building a world: what create(model) would report.
  static Errors check(const Model& model);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt. After a divergence the state stays at the last good substep.
  ///
  /// `stop`, if there is one, is asked at the start of each substep, or part of one, and before each factorisation or sweep over
  /// the constraints: mostly some ten times per step, more often where a step is hard. Once it says true the step ends, as
  /// soon as nothing but that one piece of work is done, and the world is as if the step had not been begun, but for
  /// last_substep(), of which there is nothing. Another step() then comes to the same end as one that was never stopped.
  StepReport step(const StopRequest& stop = {});

  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const BodySet& bodies() const;
  [[nodiscard]] const State& state() const;
  [[nodiscard]] const std::vector<Stage>& stages() const;  ///< of one substep
  [[nodiscard]] std::span<const std::unique_ptr<ConstraintBatch>> features() const;
  /// State of the feature at this index of features().
  [[nodiscard]] const FeatureState& feature_state(std::size_t index) const;

  /// Where colliders touch or are about to; empty without colliders, and before the first step.
  [[nodiscard]] std::vector<ContactReport> contacts() const;

  /// Goes back (or ahead) to a state of this world; an error if its shape does not fit.
  [[nodiscard]] Errors restore(const State& state);

  /// Nothing at time 0, after restore() and after a step that was stopped, until the next step.
  [[nodiscard]] std::optional<LastSubstep> last_substep() const;

  [[nodiscard]] Energy energy() const;
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
