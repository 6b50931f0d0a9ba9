// The memory of a supervisor in the state: its start, its checks and the courses of statistics.

#include "scenes/control/supervisor_memory.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/control/scene_supervisor.h"

namespace sheave {
namespace {

bool is_flag(double number) { return number == 0.0 || number == 1.0; }

/// Whether a number is a count that a double represents exactly.
bool is_count(double number) {
  constexpr double most = 9007199254740992.0;  // 2^53
  return number >= 0.0 && number <= most && number == std::floor(number);
}

/// Whether `time` can be the time of the last action, in a state at `now`.
bool is_past(double time, double now) {
  return time == memory_at::never || (time >= 0.0 && time <= now);
}

}  // namespace

std::vector<double> SceneSupervisor::initial_memory() const {
  std::vector<double> memory(memory_size_, 0.0);
  for (const TriggerAtWork& trigger : triggers_)
    memory[trigger.first + memory_at::acted] = memory_at::never;
  for (const ControllerAtWork& controller : controllers_) {
    memory[controller.first + memory_at::is_on] = controller.definition->on ? 1.0 : 0.0;
    memory[controller.first + memory_at::sampled_at] = memory_at::never;
  }
  for (const LoadAtWork& load : loads_) {
    std::fill_n(memory.begin() + static_cast<std::ptrdiff_t>(load.first),
                load.acting->memory_size(), ActingLoad::no_memory);
  }
  for (std::size_t at = first_course_; at < memory_size_; at += Course::size) {
    Course{}.store(std::span(memory).subspan(at).first<Course::size>());
  }
  return memory;
}

bool SceneSupervisor::has_stopped(const State& state) const {
  return state.memory.size() == memory_size_ && state.memory[memory_at::stopped] != 0.0;
}

std::string SceneSupervisor::memory_fault(const State& state) const {
  const std::vector<double>& memory = state.memory;
  if (memory.size() != memory_size_) return "its memory belongs to other controllers and triggers";
  if (!is_flag(memory[memory_at::stopped]) || !is_count(memory[memory_at::refused])) {
    return "its memory of the run has values that no run leaves";
  }
  for (const TriggerAtWork& trigger : triggers_) {
    const double* const own = memory.data() + trigger.first;
    if (is_past(own[memory_at::acted], state.time) && is_flag(own[memory_at::holds])) continue;
    return fmt::format("its memory of trigger \"{}\" has values that no run leaves",
                       trigger.definition.name);
  }
  for (const ControllerAtWork& controller : controllers_) {
    const double* const own = memory.data() + controller.first;
    const std::span<const double> its(own + memory_at::controller_size,
                                      controller.definition->memory_size());
    const bool finite =
        std::all_of(its.begin(), its.end(), [](double x) { return std::isfinite(x); });
    const bool counts = own[memory_at::samples] >= 0.0;  // may exceed 2^53 for a sample time near 0
    if (is_flag(own[memory_at::is_on]) && counts &&
        is_past(own[memory_at::sampled_at], state.time) && finite)
      continue;
    return fmt::format("its memory of controller \"{}\" has values that no run leaves",
                       controller.definition->name);
  }
  for (const LoadAtWork& load : loads_) {
    const std::span<const double> own(memory.data() + load.first, load.acting->memory_size());
    if (std::all_of(own.begin(), own.end(), [](double x) { return std::isfinite(x); })) continue;
    return fmt::format("its memory of load \"{}\" has values that no run leaves",
                       load.definition->name);
  }
  for (const Course& course : courses_of(state)) {
    const bool counts = is_count(course.count) && is_flag(course.finite);
    if (counts && is_past(course.begin, state.time) && course.last_time <= state.time) continue;
    return "its memory of a statistic over time has values that no run leaves";
  }
  return {};
}

std::vector<Course> SceneSupervisor::courses_of(const State& state) const {
  std::vector<Course> courses;
  for (std::size_t at = first_course_; at < memory_size_; at += Course::size) {
    courses.push_back(Course::from(std::span(state.memory).subspan(at).first<Course::size>()));
  }
  return courses;
}

void SceneSupervisor::follow(Simulation& simulation) const {
  if (quantities_.course_count() == 0) return;
  std::vector<Course> courses = courses_of(simulation.world.state());
  std::vector<double> values(quantities_.size());
  quantities_.follow(simulation, courses, values);
  std::vector<double>& memory = simulation.world.memory();
  std::size_t at = first_course_;
  for (const Course& course : courses) {
    course.store(std::span(memory).subspan(at).first<Course::size>());
    at += Course::size;
  }
}

std::vector<std::optional<double>> SceneSupervisor::acted_at(const State& state) const {
  std::vector<std::optional<double>> times;
  for (const TriggerAtWork& trigger : triggers_) {
    const double time = state.memory[trigger.first + memory_at::acted];
    times.push_back(time < 0.0 ? std::nullopt : std::optional(time));
  }
  return times;
}

std::int64_t SceneSupervisor::refusals(const State& state) const {
  return static_cast<std::int64_t>(state.memory[memory_at::refused]);
}

}  // namespace sheave
