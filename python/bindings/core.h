#pragma once
// What a simulation in Python holds: a world that lives, and what is remembered beside it.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "live/session.h"
#include "scenes/scene.h"

namespace sheave::python {

namespace py = pybind11;

/// Something that happened in a step.
struct Event {
  double time = 0.0;  ///< [s]
  std::string kind;   ///< as events of cables are called, or "break" of a joint
  std::string name;   ///< of the cable or joint
  int link = -1;      ///< of a cable: the link; -1 for a body that no list names, and for joints
  std::string body;   ///< of the link; empty: the world, or a joint
};

/// NumPy arrays over the state, for as long as what the world is made of stays the same.
struct Views {
  std::shared_ptr<const void> revision;
  py::array positions, orientations, velocities, angular_velocities, angles;
  py::array tensions, rest_lengths;
};

class Core : public std::enable_shared_from_this<Core> {
 public:
  /// The most events that are kept; older ones are dropped.
  static constexpr std::size_t most_events = 10'000;

  Core(Scene scene, Simulation simulation);
  /// Loads a scene; raises SceneError. Without the lock of the interpreter meanwhile.
  static std::shared_ptr<Core> load(const std::string& source, const std::string& name,
                                    bool is_file, const std::vector<Override>& overrides);

  // All of these raise if another thread steps the world now.
  [[nodiscard]] LiveWorld& world();
  [[nodiscard]] live::SessionState& session();
  [[nodiscard]] const Simulation& simulation() { return world().simulation(); }
  /// The answer to a request of the protocol of live sessions.
  [[nodiscard]] std::string answer(const std::string& request);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Steps without the lock of the interpreter. False if a trigger has stopped the run. Callables
  /// may be None; they get `self`.
  bool step(std::int64_t count, py::handle self, py::handle before_step, py::handle before_substep);
  /// Whether a trigger has stopped the run.
  [[nodiscard]] bool has_stopped();
  /// How many steps are left of the scene's duration, or until `end` [s].
  [[nodiscard]] std::int64_t steps_until(std::optional<double> end);

  /// Those of the world as it is made now.
  [[nodiscard]] Views& views();
  std::deque<Event> events;
  std::int64_t dropped_events = 0;
  /// Of the steps that were warned of, together.
  StepStatistics troubles;

 private:
  class Stepper;
  void note(const LiveReport& report);
  void check_free() const;

  const Scene scene_;
  live::Session session_;
  bool runs_ = false;        // a step is being made, and the lock of the interpreter is free
  std::thread::id stepper_;  // the thread that is in step()
  bool is_slow_ = true;      // a step takes so long that it ought to be possible to end it
  int until_timed_ = 0;      // steps until one is timed again
  Views views_;
};

}  // namespace sheave::python
