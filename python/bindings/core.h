#pragma once
// The data of a simulation in Python: a live world, and additional records.

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

/// An event of a step.
struct Event {
  double time = 0.0;  ///< [s]
  std::string kind;   ///< kind of a cable event, or "break" of a joint
  std::string name;   ///< of the cable or joint
  /// Index of the link in its cable; -1 for a body outside the list of links, and for joints.
  int link = -1;
  std::string body;  ///< body of the link; empty: the world, or a joint
};

/// NumPy arrays that view the state. They are valid as long as the structure of the world is
/// unchanged.
struct Views {
  std::shared_ptr<const void> revision;
  py::array positions, orientations, velocities, angular_velocities, angles;
  py::array tensions, rest_lengths;
};

class Core : public std::enable_shared_from_this<Core> {
 public:
  /// Largest number of stored events; older ones are dropped.
  static constexpr std::size_t most_events = 10'000;

  /// `notice`: SceneResult::notice of an imported model.
  Core(Scene scene, Simulation simulation, std::string notice = {});
  /// Loads a scene with the interpreter lock released; raises SceneError.
  static std::shared_ptr<Core> load(const std::string& source, const std::string& name,
                                    bool is_file, const std::vector<Override>& overrides);

  // All of these raise if another thread is stepping the world.
  [[nodiscard]] LiveWorld& world();
  [[nodiscard]] live::SessionState& session();
  [[nodiscard]] const Simulation& simulation() { return world().simulation(); }
  /// The answer to a request in the protocol of live sessions.
  [[nodiscard]] std::string answer(const std::string& request);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Steps with the interpreter lock released. False if a trigger has stopped the run. The
  /// callables may be None; they are called with `self`.
  bool step(std::int64_t count, py::handle self, py::handle before_step, py::handle before_substep);
  /// Whether a trigger has stopped the run.
  [[nodiscard]] bool has_stopped();
  /// Number of steps left in the scene's duration, or until `end` [s].
  [[nodiscard]] std::int64_t steps_until(std::optional<double> end);

  /// Views of the world's present structure.
  [[nodiscard]] Views& views();
  /// Warnings of the import and of the start of the scene; a search finds some of them, once.
  [[nodiscard]] const std::vector<Warning>& start();
  std::deque<Event> events;
  std::int64_t dropped_events = 0;
  /// Sum of the step statistics that caused warnings.
  StepStatistics troubles;

 private:
  class Stepper;
  void note(const LiveReport& report);
  void check_free() const;

  const Scene scene_;
  const std::string notice_;
  std::optional<std::vector<Warning>> start_;
  live::Session session_;
  bool runs_ = false;        // a step is running, with the interpreter lock released
  std::thread::id stepper_;  // the thread in step()
  bool is_slow_ = true;      // a step takes so long that signals are polled within it
  int until_timed_ = 0;      // steps until the next timed one
  Views views_;
};

}  // namespace sheave::python
