#include "scenes/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/field_check.h"

namespace sheave {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> quantities_of(const std::vector<CheckDef>& checks) {
  std::vector<std::string> quantities;
  for (const CheckDef& check : checks) quantities.push_back(check.quantity);
  return quantities;
}

/// The check in words: "weight.vy, rate from 0 to 1 s".
std::string title(const CheckDef& check, double from, double to) {
  const std::string_view statistic = statistic_names[static_cast<std::size_t>(check.statistic)];
  if (check.statistic == Statistic::at) {
    return fmt::format("{} at {} s", check.quantity, number_text(from));
  }
  return fmt::format("{}, {} from {} to {} s", check.quantity, statistic, number_text(from),
                     number_text(to));
}

}  // namespace

void CheckRecorder::Window::add(double time, double sample, double margin) {
  if (check.statistic == Statistic::at) {
    // Of two equally near samples the first counts.
    const bool nearer =
        course.count == 0.0 || std::abs(time - from) < std::abs(course.last_time - from) - margin;
    if (!nearer) return;
    course = {};
    course.add(time, sample);
    course.last_time = time;
    return;
  }
  // Times are sums of steps; a sample at the edge must not be lost by rounding.
  if (time < from - margin || time > to + margin) return;
  course.add(time, sample);
}

double CheckRecorder::Window::measured() const {
  return check.statistic == Statistic::at ? course.last : course.value(check.statistic);
}

CheckRecorder::CheckRecorder(const Scene& scene, const Simulation& simulation)
    : quantities_(QuantityIndex::of(simulation, quantities_of(scene.checks)), Taken::along_run),
      dt_(scene.model.step.dt) {
  for (const CheckDef& check : scene.checks) {
    Window& window = windows_.emplace_back();
    window.check = check;
    const bool moment = check.statistic == Statistic::at;
    window.to = (moment ? check.at : check.to).value_or(scene.duration);
    window.from = moment ? window.to : check.from.value_or(0.0);
    window.course.begin = window.from;
    window.value = quantities_.size();
    const Errors faults = quantities_.add(check.quantity);
    if (!faults.empty()) window.fault = faults.front().message;
  }
  values_.resize(quantities_.size());
  courses_.resize(quantities_.course_count());
}

void CheckRecorder::record(const Simulation& simulation) {
  if (windows_.empty()) return;
  const State& state = simulation.world.state();
  last_time_ = state.time;
  quantities_.follow(simulation, courses_, values_);
  for (Window& window : windows_) {
    if (!window.fault.empty()) continue;
    if (state.steps == 0 && !quantities_.known_at_start(window.value)) continue;
    window.add(state.time, values_[window.value], 1e-6 * dt_);
  }
}

std::vector<CheckResult> CheckRecorder::results() const {
  std::vector<CheckResult> results;
  results.reserve(windows_.size());
  for (const Window& window : windows_) results.push_back(result(window));
  return results;
}

CheckResult CheckRecorder::result(const Window& window) const {
  const CheckDef& check = window.check;
  CheckResult result{check, nan, nan, check.allowed_error(), false, {}};
  const std::string what = title(check, window.from, window.to);
  const bool needs_two = check.statistic == Statistic::rate ||
                         check.statistic == Statistic::drift ||
                         check.statistic == Statistic::integral;
  if (!window.fault.empty()) {
    result.message = fmt::format("{}: {}", what, window.fault);
  } else if (last_time_ < window.to - 0.5 * dt_ * (1.0 + 1e-6)) {
    result.message = last_time_ < 0.0 ? fmt::format("{}: nothing was simulated", what)
                                      : fmt::format("{}: the run ended early, at {} s", what,
                                                    number_text(last_time_));
  } else if (window.course.count < (needs_two ? 2.0 : 1.0)) {
    result.message = fmt::format("{}: no step {}falls into this time", what,
                                 needs_two && window.course.count > 0.0 ? "but one " : "");
  } else if (window.course.finite == 0.0) {
    result.message = fmt::format("{}: a value is not finite", what);
  } else {
    result.measured = window.measured();
    result.error = result.measured - check.equals;
    result.passed = std::abs(result.error) <= result.tolerance;
    result.message = fmt::format("{}: {:.9g}, wanted {:.9g} within {:.3g}, error {:.3g}", what,
                                 result.measured, check.equals, result.tolerance, result.error);
  }
  return result;
}

}  // namespace sheave
