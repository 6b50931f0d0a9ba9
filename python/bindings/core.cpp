#include "python/bindings/core.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "python/bindings/arguments.h"
#include "python/bindings/errors.h"
#include "python/bindings/warnings.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::python {
namespace {

using Clock = std::chrono::steady_clock;

/// A program in the same process is trusted, so its requests have wider limits.
live::Limits wide_limits() {
  live::Limits limits;
  limits.line_bytes = std::size_t{64} << 20U;
  limits.depth = 64;
  limits.values = 8'000'000;
  limits.faults = 1000;
  return limits;
}

}  // namespace

Core::Core(Scene scene, Simulation simulation, std::string notice)
    : scene_(std::move(scene)),
      notice_(std::move(notice)),
      session_(scene_, std::move(simulation), {}, wide_limits()) {}

std::shared_ptr<Core> Core::load(const std::string& source, const std::string& name, bool is_file,
                                 const std::vector<Override>& overrides) {
  SceneResult scene;
  std::optional<Result<Simulation>> simulation;
  {
    const py::gil_scoped_release unlocked;
    scene = is_file ? load_scene(source, overrides) : load_scene_text(source, name, overrides);
    if (scene) simulation.emplace(create_simulation(*scene));
  }
  if (!scene) raise_scene_error(scene.errors);
  if (!*simulation) raise_scene_error(is_file ? source : name, simulation->errors());
  return std::make_shared<Core>(std::move(*scene.scene), std::move(**simulation),
                                std::move(scene.notice));
}

const std::vector<Warning>& Core::start() {
  if (!start_) start_ = warnings_at_start(scene_, notice_);
  return *start_;
}

void Core::check_free() const {
  if (runs_) raise("Error", "another thread is stepping this simulation; wait until it is done");
}

LiveWorld& Core::world() {
  check_free();
  return session_.state().world;
}

live::SessionState& Core::session() {
  check_free();
  return session_.state();
}

std::string Core::answer(const std::string& request) {
  check_free();
  return session_.answer(request);
}

bool Core::has_stopped() {
  const Supervisor* own = simulation().supervisor.get();
  return own != nullptr && own->has_stopped(world().state());
}

std::int64_t Core::steps_until(std::optional<double> end) {
  constexpr double most = 9e15;  // beyond this a double cannot count single steps
  const double dt = simulation().world.model().step.dt;
  const double steps = std::round(end.value_or(scene_.duration) / dt);
  if (end && std::isnan(*end)) raise("ArgumentError", "until: must be a time in s, was nan");
  if (end && steps > most) {
    raise("ArgumentError",
          fmt::format("until: must be at most 9e15 steps away, {:g} s, was {:g}", most * dt, *end));
  }
  const double least = end ? 0.0 : 1.0;
  const auto last = static_cast<std::int64_t>(std::clamp(steps, least, most));
  return std::max<std::int64_t>(last - world().state().steps, 0);
}

void Core::note(const LiveReport& report) {
  const auto add = [&](Event event) {
    events.push_back(std::move(event));
    if (events.size() <= most_events) return;
    events.pop_front();
    ++dropped_events;
  };
  for (const CableEvent& event : report.events) {
    add({event.time, std::string(cable_event_names[static_cast<std::size_t>(event.kind)]),
         event.cable, event.link, event.body});
  }
  const LiveWorld& world = session_.state().world;
  for (const JointHandle joint : report.broken_joints) {
    add({world.time(), "break", *world.name(joint), -1, {}});
  }
  dropped_events += static_cast<std::int64_t>(report.omitted);
  if (report.warnings.empty()) return;
  add_troubles(report.statistics, troubles);
}

/// Steps with the interpreter lock released; the lock is taken for calls into Python.
class Core::Stepper {
 public:
  Stepper(Core& core, py::handle self, py::handle before_step, py::handle before_substep)
      : core_(core),
        world_(core.session_.state().world),
        self_(self),
        before_step_(before_step),
        before_substep_(before_substep),
        outer_(core.stepper_) {
    core_.stepper_ = std::this_thread::get_id();
    core_.runs_ = true;
    // NOLINTNEXTLINE(cppcoreguidelines-prefer-member-initializer): only after `runs_` is set
    thread_ = PyEval_SaveThread();
    if (!before_substep_.is_none()) substep_ = [this] { call(before_substep_); };
    stop_ = [this] { return fault_ || (core_.is_slow_ && looks_at_signals()); };
  }
  ~Stepper() { lock(); }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  void run(std::int64_t count);
  /// Takes the lock again and raises pending errors.
  void finish() {
    lock();
    if (fault_) throw py::error_already_set(std::move(*fault_));
    if (divergence_) raise("DivergenceError", divergence_->message);
    if (refused_) raise("Error", "a simulation cannot be stepped from within a step or an edit");
  }

 private:
  void lock() {
    if (thread_ == nullptr) return;
    PyEval_RestoreThread(thread_);
    thread_ = nullptr;
    core_.runs_ = false;
    core_.stepper_ = outer_;
  }
  /// Runs `action` with the lock; an exception from it ends the step.
  template <class Action>
  void locked(const Action& action) {
    PyEval_RestoreThread(thread_);
    core_.runs_ = false;
    try {
      action();
    } catch (py::error_already_set& error) {
      if (!fault_) fault_.emplace(std::move(error));
    }
    core_.runs_ = true;
    thread_ = PyEval_SaveThread();
  }
  void call(py::handle callable) {
    if (fault_) return;
    locked([&] { callable(self_); });
  }
  bool looks_at_signals() {
    const Clock::time_point now = Clock::now();
    constexpr std::chrono::milliseconds interval(20);
    if (now - looked_ < interval) return false;
    looked_ = now;
    locked([] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    return fault_.has_value();
  }
  bool step();

  Core& core_;
  LiveWorld& world_;
  py::handle self_, before_step_, before_substep_;
  std::thread::id outer_;  // the thread of the enclosing step, if there is one
  PyThreadState* thread_ = nullptr;
  std::function<void()> substep_;
  StopRequest stop_;
  Clock::time_point looked_ = Clock::now();
  std::optional<py::error_already_set> fault_;
  std::optional<Divergence> divergence_;
  bool refused_ = false;
};

/// One step; false if it is the last.
bool Core::Stepper::step() {
  if (!before_step_.is_none()) call(before_step_);
  if (fault_) return false;
  const bool stoppable = core_.is_slow_ || substep_;
  LiveReport report = world_.step(stoppable ? stop_ : StopRequest{}, substep_);
  const bool quiet =
      report.events.empty() && report.broken_joints.empty() && report.warnings.empty();
  if (!quiet) core_.note(report);
  refused_ = report.stopped && !fault_;
  if (report.divergence) divergence_ = std::move(report.divergence);
  if (!report.ok() || fault_) return false;
  const Supervisor* supervisor = world_.simulation().supervisor.get();
  return supervisor == nullptr || !supervisor->has_stopped(world_.state());
}

void Core::Stepper::run(std::int64_t count) {
  // Reading a clock costs as much as a small step, so only one step in `stride` is timed.
  constexpr int stride = 16;
  constexpr std::chrono::microseconds slow(500);
  for (std::int64_t i = 0; i < count; ++i) {
    if (core_.until_timed_-- > 0) {
      if (!step()) return;
      continue;
    }
    core_.until_timed_ = stride;
    const Clock::time_point begin = Clock::now();
    const bool goes_on = step();
    core_.is_slow_ = Clock::now() - begin > slow;
    if (!goes_on || (i > 0 && looks_at_signals())) return;
  }
}

bool Core::step(std::int64_t count, py::handle self, py::handle before_step,
                py::handle before_substep) {
  check_free();
  check_callback(before_step, "before_step");
  check_callback(before_substep, "before_substep");
  if (stepper_ != std::thread::id() && stepper_ != std::this_thread::get_id()) {
    raise("Error", "another thread is stepping this simulation; wait until it is done");
  }
  Stepper stepper(*this, self, before_step, before_substep);
  stepper.run(count);
  stepper.finish();
  return !has_stopped();
}

}  // namespace sheave::python
