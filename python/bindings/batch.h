#pragma once
// Many worlds of one scene, each with settings of its own, stepped on all cores.

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
#include "live/readings.h"
#include "python/bindings/thread_pool.h"
#include "scenes/control/control_point.h"
#include "scenes/scene.h"

namespace sheave::python {

/// What one world of a batch differs in.
struct Variation {
  std::string pointer;              ///< of a setting
  std::vector<std::string> values;  ///< JSON, one for each world
};

/// Knows nothing of Python.
class Batch {
 public:
  /// What is wrong with one of the worlds, or all of them.
  struct Faults {
    std::vector<SceneError> errors;
    std::size_t world = 0;
  };
  struct Source {
    std::string text;  ///< of the scene, or the path of a file
    std::string name;  ///< that errors call a text
    bool is_file = false;
  };

  /// Null, and `faults`, if a world cannot be made. Worlds must have the same observables.
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
  [[nodiscard]] bool has_stopped(std::size_t index) const { return worlds_[index].stopped; }
  [[nodiscard]] const live::QuantityIndex& quantities() const { return *quantities_; }
  [[nodiscard]] double duration() const { return duration_; }

  /// Makes `count` steps of each world that is chosen, has not diverged and has not been stopped by
  /// a trigger. `goes_on` is asked now and then by the calling thread; once it says false, steps
  /// end, and worlds may be at different ones.
  void step(std::int64_t count, std::span<const char> chosen, const std::function<bool()>& goes_on);
  /// The quantities at these indices, row by row of a world.
  void observe(const std::vector<int>& indices, std::span<double> values);
  /// Calls `action` with each world's index, on all threads.
  void for_each(const std::function<void(std::size_t)>& action) {
    pool_.for_each(worlds_.size(), action);
  }
  /// What is wrong with the name of a control; empty if nothing is.
  [[nodiscard]] Errors control_fault(const std::string& name) {
    const auto found = control(name);
    return found ? Errors() : found.errors();
  }
  /// Sets a control, or clears it if `values` is empty; the fault of the first world that has one,
  /// and then none has been set.
  [[nodiscard]] Errors set(const std::string& name, std::span<const double> values,
                           std::optional<double> over, std::span<const char> chosen);
  /// Back to the start, or to what mark_start() has made that.
  [[nodiscard]] Errors reset(std::span<const char> chosen);
  void mark_start(std::span<const char> chosen);
  [[nodiscard]] Errors restore(std::size_t index, const State& state);

 private:
  struct World {
    Simulation simulation;
    State start;
    std::string divergence;  // why it goes no further
    bool stopped = false;    // by a trigger
  };
  Batch(std::vector<World> worlds, double duration, std::size_t threads);
  [[nodiscard]] Result<const std::vector<ControlPoint>*> control(const std::string& name);
  /// Puts the controls of the first worlds that are chosen back.
  void take_back(std::span<const char> chosen, const std::vector<Controls>& before);

  std::vector<World> worlds_;
  double duration_ = 0.0;
  std::unique_ptr<live::QuantityIndex> quantities_;
  std::unordered_map<std::string, std::vector<ControlPoint>> controls_;
  ThreadPool pool_;
};

}  // namespace sheave::python
