#include "tools/run_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/field_check.h"

namespace sheave::tools {

bool RunSummary::checks_passed() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const CheckResult& check) { return check.passed; });
}

namespace {

void append_cable_warnings(const CableSystem& cables, std::vector<Warning>& warnings) {
  for (const CableSystem::TangentWarning& warning : cables.tangent_warnings()) {
    std::string span = warning.span < 0 ? fmt::format("{} behind a wrap", warning.cable)
                                        : fmt::format("{}.{}", warning.cable, warning.span);
    std::string message = fmt::format(
        "span {} had no tangent in {} substeps, first at {} s: its wheels overlap, and its "
        "numbers mean little there",
        span, warning.substeps, number_text(warning.first_time));
    warnings.push_back({"no_tangent", std::move(span), std::move(message)});
  }
  for (const CableSystem::WrapWarning& warning : cables.wrap_warnings()) {
    std::string message = fmt::format(
        "cable {} found no place for another wrap in {} substeps, first at {} s, and went through "
        "the body; raise its most_wraps",
        warning.cable, warning.substeps, number_text(warning.first_time));
    warnings.push_back({"too_many_wraps", warning.cable, std::move(message)});
  }
}

/// A rigid cable that grows longer by much of the way that things move does not hold them: the solver has not converged, and
/// accelerations and tensions are wrong by about that share. A sag that stays what it was is none: there the forces are
/// right. Growth by less than 1e-7 of the cable is of no interest.
void append_stretch_warnings(const Simulation& simulation, const RunMonitor& monitor,
                             std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.05;
  constexpr double negligible = 1e-7;
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t i = 0; i < monitor.cables().size(); ++i) {
    const CableCourse& course = monitor.cables()[i];
    const double growth = course.excess - course.excess_at_half;
    if (growth <= std::max(share_limit * course.way, negligible * course.length)) continue;
    std::string name(reports[i].name);
    std::string message = fmt::format(
        "cable {} grew longer than it can be, by {:.3g} m at the end, while nothing on it moved by "
        "more than {:.3g} m: the solver did not converge, and motion and tensions are wrong by "
        "about that share; more iterations or the direct solver avoid that",
        name, course.excess, course.way);
    warnings.push_back({"stretched", std::move(name), std::move(message)});
  }
}

}  // namespace

std::vector<Warning> collect_warnings(const Simulation& simulation, const RunStatistics& statistics,
                                      const RunMonitor& monitor) {
  std::vector<Warning> warnings;
  if (simulation.cables != nullptr) {
    append_cable_warnings(*simulation.cables, warnings);
    append_stretch_warnings(simulation, monitor, warnings);
  }
  if (statistics.solver_fallbacks > 0) {
    std::string message = fmt::format(
        "the direct solver did not find which rows act in {} {} and left {} to Gauss-Seidel "
        "sweeps, so that precision is theirs there",
        statistics.solver_fallbacks, statistics.solver_fallbacks == 1 ? "substep" : "substeps",
        statistics.solver_fallbacks == 1 ? "it" : "them");
    warnings.push_back({"solver_fallback", "", std::move(message)});
  }
  if (statistics.integrator_fallbacks > 0) {
    std::string message = fmt::format(
        "things moved too far in {} {} for rattle, which left {} to xpbd and its damping; more "
        "substeps avoid that",
        statistics.integrator_fallbacks,
        statistics.integrator_fallbacks == 1 ? "substep" : "substeps",
        statistics.integrator_fallbacks == 1 ? "it" : "them");
    warnings.push_back({"integrator_fallback", "", std::move(message)});
  }
  return warnings;
}

std::vector<RunEvent> collect_events(const Simulation& simulation,
                                     const std::vector<JointReport>& joints) {
  std::vector<RunEvent> events;
  if (simulation.cables != nullptr) {
    for (const CableEvent& event : simulation.cables->events()) {
      events.push_back({event.time, false, event.cable, event.link, event.body,
                        cable_event_names[static_cast<std::size_t>(event.kind)]});
    }
  }
  for (const JointReport& joint : joints) {
    if (joint.broken_at) events.push_back({*joint.broken_at, true, joint.name, -1, "", "break"});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const RunEvent& a, const RunEvent& b) { return a.time < b.time; });
  return events;
}

double time_per_step(const RunOutcome& outcome) {
  if (outcome.steps == 0) return std::numeric_limits<double>::quiet_NaN();
  return outcome.step_time / static_cast<double>(outcome.steps);
}

}  // namespace sheave::tools
