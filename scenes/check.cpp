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

void CheckRecorder::Course::add(double time, double sample, double margin) {
  if (check.statistic == Statistic::at) {
    // Of two equally near samples the first counts.
    const bool nearer =
        nearest_time < 0.0 || std::abs(time - from) < std::abs(nearest_time - from) - margin;
    if (!nearer) return;
    nearest = sample;
    nearest_time = time;
    count = 1;
    finite = std::isfinite(sample);
    return;
  }
  // Times are sums of steps; a sample at the edge must not be lost by rounding.
  if (time < from - margin || time > to + margin) return;
  area += count == 0 ? (time - from) * sample : 0.5 * (time - last_time) * (last + sample);
  if (count == 0) {
    first = minimum = maximum = sample;
    first_time = time;
  }
  ++count;
  last = sample;
  last_time = time;
  minimum = std::min(minimum, sample);
  maximum = std::max(maximum, sample);
  sum += sample;
  finite = finite && std::isfinite(sample);
}

double CheckRecorder::Course::measured() const {
  switch (check.statistic) {
    case Statistic::at:
      return nearest;
    case Statistic::mean:
      return sum / static_cast<double>(count);
    case Statistic::rate:
      return (last - first) / (last_time - first_time);
    case Statistic::minimum:
      return minimum;
    case Statistic::maximum:
      return maximum;
    case Statistic::range:
      return maximum - minimum;
    case Statistic::drift:
      return last - first;
    case Statistic::integral:
      return area;
  }
  return nan;
}

CheckRecorder::CheckRecorder(const Scene& scene, const Simulation& simulation)
    : quantities_(QuantityIndex::of(simulation, quantities_of(scene.checks))),
      dt_(scene.model.step.dt) {
  for (const CheckDef& check : scene.checks) {
    Course& course = courses_.emplace_back();
    course.check = check;
    const bool moment = check.statistic == Statistic::at;
    course.to = (moment ? check.at : check.to).value_or(scene.duration);
    course.from = moment ? course.to : check.from.value_or(0.0);
    course.value = quantities_.size();
    const Errors faults = quantities_.add(check.quantity);
    if (!faults.empty()) course.fault = faults.front().message;
  }
  values_.resize(quantities_.size());
}

void CheckRecorder::record(const Simulation& simulation) {
  if (courses_.empty()) return;
  const State& state = simulation.world.state();
  last_time_ = state.time;
  quantities_.sample(simulation, values_);
  for (Course& course : courses_) {
    if (!course.fault.empty()) continue;
    if (state.steps == 0 && !quantities_.known_at_start(course.value)) continue;
    course.add(state.time, values_[course.value], 1e-6 * dt_);
  }
}

std::vector<CheckResult> CheckRecorder::results() const {
  std::vector<CheckResult> results;
  results.reserve(courses_.size());
  for (const Course& course : courses_) results.push_back(result(course));
  return results;
}

CheckResult CheckRecorder::result(const Course& course) const {
  const CheckDef& check = course.check;
  CheckResult result{check, nan, nan, check.allowed_error(), false, {}};
  const std::string what = title(check, course.from, course.to);
  const bool needs_two = check.statistic == Statistic::rate ||
                         check.statistic == Statistic::drift ||
                         check.statistic == Statistic::integral;
  if (!course.fault.empty()) {
    result.message = fmt::format("{}: {}", what, course.fault);
  } else if (last_time_ < course.to - 0.5 * dt_ * (1.0 + 1e-6)) {
    result.message = last_time_ < 0.0 ? fmt::format("{}: nothing was simulated", what)
                                      : fmt::format("{}: the run ended early, at {} s", what,
                                                    number_text(last_time_));
  } else if (course.count < (needs_two ? 2 : 1)) {
    result.message = fmt::format("{}: no step {}falls into this time", what,
                                 needs_two && course.count > 0 ? "but one " : "");
  } else if (!course.finite) {
    result.message = fmt::format("{}: a value is not finite", what);
  } else {
    result.measured = course.measured();
    result.error = result.measured - check.equals;
    result.passed = std::abs(result.error) <= result.tolerance;
    result.message = fmt::format("{}: {:.9g}, wanted {:.9g} within {:.3g}, error {:.3g}", what,
                                 result.measured, check.equals, result.tolerance, result.error);
  }
  return result;
}

}  // namespace sheave
