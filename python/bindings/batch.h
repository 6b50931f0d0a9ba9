#pragma once
// Many worlds of one scene, each with its own settings, stepped on all cores.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "cable/simulation.h"
#include "cable/step_warnings.h"
#include "python/bindings/thread_pool.h"
#include "scenes/control/control_point.h"
#include "scenes/quantity_list.h"
#include "scenes/scene.h"

namespace sheave::python {

/// A setting that differs between the worlds of a batch.
struct Variation {
  std::string pointer;              ///< pointer of the setting
  std::vector<std::string> values;  ///< JSON values, one for each world
};

/// Independent of Python.
class Batch {
 public:
  /// The faults of one world, or of all of them.
  struct Faults {
    std::vector<SceneError> errors;
    std::size_t world = 0;
  };
  struct Source {
    std::string text;  ///< text of the scene, or path of a file
    std::string name;  ///< the name of a text in errors
    bool is_file = false;
  };

  /// Null, with `faults`, if a world cannot be made. All worlds must have the same observables.
  static std::unique_ptr<Batch> create(const Source& source, std::size_t count,
                                       const std::vector<Override>& overrides,
                                       const std::vector<Variation>& variations,
                                       std::size_t threads, Faults& faults);

  [[nodiscard]] std::size_t size() const { return worlds_.size(); }
  [[nodiscard]] std::size_t threads() const { return pool_.threads(); }
  [[nodiscard]] const Simulation& world(std::size_t index) const {
    return worlds_[index].simulation;
  }
  [[nodiscard]] bool has_diverged(std::size_t index) const {
    return !worlds_[index].divergence.empty();
  }
  [[nodiscard]] const std::string& divergence(std::size_t index) const {
    return worlds_[index].divergence;
  }
  /// The warnings of a world, of its start (found by a search) and of its run since then.
  [[nodiscard]] std::vector<Warning> warnings(std::size_t index) const;
  [[nodiscard]] bool has_stopped(std::size_t index) const { return worlds_[index].stopped; }
  [[nodiscard]] const std::shared_ptr<const QuantityIndex>& quantities() const {
    return quantities_;
  }
  [[nodiscard]] double duration() const { return duration_; }

  /// Makes `count` steps of each selected world that has neither diverged nor been stopped by a
  /// trigger. The calling thread polls `goes_on` regularly; once it returns false, stepping ends,
  /// and the worlds may have done different numbers of steps.
  void step(std::int64_t count, std::span<const char> chosen, const std::function<bool()>& goes_on);
  /// The values of a list that was made with quantities(), one row per world.
  void observe(const QuantityList& list, std::span<double> values);
  /// Calls `action` with each world's index, on all threads.
  void for_each(const std::function<void(std::size_t)>& action) {
    pool_.for_each(worlds_.size(), action);
  }
  /// The fault in the name of a control; empty if the name is valid.
  [[nodiscard]] Errors control_fault(const std::string& name) {
    const auto found = control(name);
    return found ? Errors() : found.errors();
  }
  /// Sets a control, or clears it if `values` is empty. Returns the fault of the first failing
  /// world; then no control has been set.
  [[nodiscard]] Errors set(const std::string& name, std::span<const double> values,
                           std::optional<double> over, std::span<const char> chosen);
  /// Resets to the start, or to the state that mark_start() has stored.
  [[nodiscard]] Errors reset(std::span<const char> chosen);
  void mark_start(std::span<const char> chosen);
  [[nodiscard]] Errors restore(std::size_t index, const State& state);

 private:
  struct World {
    Simulation simulation;
    std::shared_ptr<const Scene> scene;
    State start;
    std::string divergence;     // why the world has stopped
    bool stopped = false;       // by a trigger
    StepStatistics troubles{};  // sum of the steps since the start
  };
  Batch(std::vector<World> worlds, std::string notice, std::size_t threads);
  [[nodiscard]] Result<const std::vector<ControlPoint>*> control(const std::string& name);
  /// Restores the controls of the first selected worlds.
  void take_back(std::span<const char> chosen, const std::vector<Controls>& before);

  std::vector<World> worlds_;
  std::string notice_;  // SceneResult::notice
  double duration_ = 0.0;
  std::shared_ptr<const QuantityIndex> quantities_;  // of the first world
  std::unordered_map<std::string, std::vector<ControlPoint>> controls_;
  ThreadPool pool_;
};

}  // namespace sheave::python
