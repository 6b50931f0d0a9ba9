#pragma once
// The controllers and triggers of a scene, at work.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "scenes/control/control_point.h"
#include "scenes/observables.h"
#include "scenes/scene.h"

namespace sheave {

/// Acts before each substep: triggers first, then controllers, both in the order of the scene. What
/// it remembers is part of the state (State::memory): whether the run stops, how often a control
/// has refused a value; per trigger when it has acted last and whether its condition holds; per
/// controller whether it is on, how many samples have been due, and what the controller itself
/// remembers.
class SceneSupervisor final : public Supervisor {
 public:
  /// Faults have the paths of controllers and triggers in the scene.
  static Result<std::shared_ptr<const SceneSupervisor>> create(const Scene& scene,
                                                               const Simulation& simulation);

  [[nodiscard]] std::vector<double> initial_memory() const override;
  void supervise(Simulation& simulation) const override;
  [[nodiscard]] Result<std::shared_ptr<const Supervisor>> again(
      const Simulation& simulation) const override;
  [[nodiscard]] bool has_stopped(const State& state) const override;
  [[nodiscard]] std::string memory_fault(const State& state) const override;

  /// When each trigger has acted last [s], in the order of the scene.
  [[nodiscard]] std::vector<std::optional<double>> acted_at(const State& state) const;
  /// The trigger at this place of the scene.
  [[nodiscard]] const TriggerDef& trigger(std::size_t index) const {
    return triggers_[index].definition;
  }
  /// Gives a scene the controllers and triggers.
  void append_to(Scene& scene) const;
  /// How often a control has not taken what it was given.
  [[nodiscard]] std::int64_t refusals(const State& state) const;

 private:
  struct ControllerAtWork {
    std::shared_ptr<const ControllerDef> definition;
    TimeTable setpoint;
    ControlPoint control;
    std::size_t measured = 0;           // among the sampled
    std::size_t setpoint_quantity = 0;  // likewise, if there is one
    double sample_time = 0.0;
    std::size_t first = 0;  // of its memory: on, samples, acted at, its own
  };
  struct TriggerAtWork {
    TriggerDef definition;
    ControlPoint control;      // of set and clear
    int target = 0;            // index of the joint, cable or controller
    std::size_t quantity = 0;  // among the sampled
    std::size_t first = 0;     // of its memory: acted at, holds
  };

  explicit SceneSupervisor(const Simulation& simulation) : observables_(simulation) {}
  Errors add_trigger(const Scene& scene, std::size_t index);
  Errors add_controller(const Scene& scene, std::size_t index);
  /// Where the observable will be among the sampled.
  Result<std::size_t> sampled(const std::string& quantity, const std::string& path);
  void act(const TriggerAtWork& trigger, Simulation& simulation) const;
  void act(const ControllerAtWork& controller, std::span<const double> values,
           Simulation& simulation) const;
  static void note(const Errors& errors, Simulation& simulation);

  ObservableSet observables_;
  std::vector<int> indices_;  // of the sampled
  bool waits_for_step_ = false;
  std::vector<TriggerAtWork> triggers_;
  std::vector<ControllerAtWork> controllers_;
  std::size_t memory_size_ = 2;
};

/// Sets what controllers and triggers may set once, at their limits, at the start of a simulation
/// of its own: what of it cannot be set at all.
[[nodiscard]] Errors try_controls(const Scene& scene);

/// The simulation of a scene, with its controllers and triggers.
[[nodiscard]] Result<Simulation> create_simulation(const Scene& scene);

}  // namespace sheave
