#pragma once
// Runs the controllers, triggers and loads of a scene.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "scenes/control/control_point.h"
#include "scenes/control/load.h"
#include "scenes/quantity_list.h"
#include "scenes/scene.h"

namespace sheave {

/// Acts before each substep and at the instants at which a trigger or a controller is due: triggers
/// first, then controllers, both in the order of the scene; and triggers once more as long as one
/// of them has acted, each at most once at an instant. Its memory is part of the state
/// (State::memory): whether the run stops, how often a control has refused a value; per trigger the
/// time of its last action and whether its condition holds; per controller whether it is on, how
/// many samples have been due, and the controller's own memory; the courses of statistics over time.
class SceneSupervisor final : public Supervisor {
 public:
  /// Faults have the paths of controllers and triggers in the scene.
  static Result<std::shared_ptr<const SceneSupervisor>> create(const Scene& scene,
                                                               const Simulation& simulation);

  [[nodiscard]] std::vector<double> initial_memory() const override;
  void supervise(Simulation& simulation) const override;
  [[nodiscard]] double next_time(const Simulation& simulation, double slop) const override;
  [[nodiscard]] bool watches() const override { return watches_; }
  [[nodiscard]] bool acts_by_substeps() const override;
  [[nodiscard]] bool has_loads() const override { return !loads_.empty(); }
  void set_loads(Simulation& simulation, double length, bool jumped) const override;
  [[nodiscard]] LoadDefect load_defect(const Simulation& simulation, double length) const override;
  void find_margins(const Simulation& simulation, std::vector<double>& margins) const override;
  void set_loads_now(const Simulation& simulation, Controls& controls) const override;
  [[nodiscard]] Result<std::shared_ptr<const Supervisor>> again(
      const Simulation& simulation) const override;
  [[nodiscard]] bool has_stopped(const State& state) const override;
  [[nodiscard]] std::string memory_fault(const State& state) const override;

  /// Time at which each trigger acted last [s], in the order of the scene.
  [[nodiscard]] std::vector<std::optional<double>> acted_at(const State& state) const;
  /// The trigger at this index of the scene.
  [[nodiscard]] const TriggerDef& trigger(std::size_t index) const {
    return triggers_[index].definition;
  }
  /// Adds the controllers, triggers and loads to a scene.
  void append_to(Scene& scene) const;
  /// The muscle at this index among the muscles, in the order of the scene; null if there are
  /// fewer.
  [[nodiscard]] const LoadDef* muscle(std::size_t index) const;
  /// All muscles, in the order of the scene, after the last substep.
  [[nodiscard]] std::vector<MuscleState> muscles(const State& state) const;
  /// Number of values that controls have refused.
  [[nodiscard]] std::int64_t refusals(const State& state) const;

 private:
  struct ControllerAtWork {
    std::shared_ptr<const ControllerDef> definition;
    TimeTable setpoint;
    ControlPoint control;
    std::size_t measured = 0;           // index among the quantities
    std::size_t setpoint_quantity = 0;  // the same, if the setpoint has a quantity
    double sample_time = 0.0;
    // start of its memory: on, samples, time of its last action, its own memory
    std::size_t first = 0;
  };
  struct TriggerAtWork {
    TriggerDef definition;
    ControlPoint control;      // for the actions set and clear
    int target = 0;            // index of the joint, cable or controller
    std::size_t quantity = 0;  // index among the quantities
    std::size_t first = 0;     // start of its memory: time of its last action, condition
  };

  struct LoadAtWork {
    std::shared_ptr<const LoadDef> definition;
    std::shared_ptr<const ActingLoad> acting;
    std::size_t first = 0;  // start of its memory
  };

  // The simulation has no supervisor yet, so the names of muscles come from the scene.
  explicit SceneSupervisor(const Scene& scene)
      : quantities_(std::make_shared<const QuantityIndex>(scene), Taken::along_run) {}
  Errors add_trigger(const Scene& scene, std::size_t index);
  Errors add_controller(const Scene& scene, std::size_t index);
  /// After all triggers and controllers, none of which may set a force of the same body.
  Errors add_load(const Scene& scene, std::size_t index);
  /// Tells controls of excitations their places in the memory, once all loads have theirs.
  void place_excitations();
  [[nodiscard]] static std::size_t excitation_place(const LoadAtWork& load) {
    return load.first + ActingLoad::set_excitation;
  }
  friend Result<ControlPoint> find_control(std::string_view name, const Simulation& simulation);
  /// Index among the quantities that this one will have.
  Result<std::size_t> sampled(const std::string& quantity, const std::string& path);
  /// How far the trigger's quantity is beyond its threshold.
  [[nodiscard]] static double margin_of(const TriggerAtWork& trigger,
                                        std::span<const double> values);
  /// Whether the quantity means something at this time.
  [[nodiscard]] bool is_known(std::size_t place, double time) const;
  /// Whether it acts at instants of its own, and not at the first substep after them.
  [[nodiscard]] static bool acts_in_time(const ControllerAtWork& controller,
                                         const Simulation& simulation);
  /// One look at all triggers; whether one of them has acted.
  bool look_at_triggers(Simulation& simulation, std::vector<double>& values) const;
  /// The courses of statistics over time in the memory.
  [[nodiscard]] std::vector<Course> courses_of(const State& state) const;
  /// Adds the values of this moment to the courses.
  void follow(Simulation& simulation) const;
  /// The values of the quantities, unless they are known.
  void look(const Simulation& simulation, std::vector<double>& values) const;
  void act(const TriggerAtWork& trigger, Simulation& simulation) const;
  void act(const ControllerAtWork& controller, std::span<const double> values,
           Simulation& simulation) const;
  static void note(const Errors& errors, Simulation& simulation);

  QuantityList quantities_;
  bool waits_for_step_ = false;
  bool watches_ = false;  // a trigger waits for a condition
  std::vector<TriggerAtWork> triggers_;
  std::vector<ControllerAtWork> controllers_;
  std::vector<LoadAtWork> loads_;
  std::size_t first_course_ = 0;  // in the memory
  std::size_t memory_size_ = 2;
};

/// The control point of a running simulation with this name, also of its muscles. The error suggests
/// similar names.
[[nodiscard]] Result<ControlPoint> find_control(std::string_view name,
                                                const Simulation& simulation);

/// Sets every control that controllers and triggers may set once, at its limits, at the start of a
/// separate simulation. Returns the faults of controls that cannot be set at all.
[[nodiscard]] Errors try_controls(const Scene& scene);

/// The simulation of a scene at its start (Scene::start, Scene::start_state), with its controllers
/// and triggers. An error at "/start" if the scene starts at rest and has no rest.
[[nodiscard]] Result<Simulation> create_simulation(const Scene& scene);
/// The same in the pose of the scene, wherever it starts.
[[nodiscard]] Result<Simulation> create_in_pose(const Scene& scene);

}  // namespace sheave
