#include "python/bindings/warnings.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "cable/cable_system.h"
#include "scenes/start_warnings.h"

namespace sheave::python {

std::vector<Warning> warnings_at_start(const Scene& scene, const std::string& notice) {
  std::vector<Warning> warnings;
  if (!notice.empty()) warnings.push_back({"import", "", notice});
  std::ranges::move(magnitude_warnings(scene), std::back_inserter(warnings));
  std::ranges::move(start_warnings(scene), std::back_inserter(warnings));
  return warnings;
}

void add_troubles(const StepStatistics& step, StepStatistics& troubles) {
  troubles.solver_fallbacks += step.solver_fallbacks;
  troubles.impossible += step.impossible;
  troubles.dead_ends += step.dead_ends;
  troubles.most_impossible = std::max(troubles.most_impossible, step.most_impossible);
  troubles.integrator_fallbacks += step.integrator_fallbacks;
  troubles.cut_substeps += step.cut_substeps;
  troubles.substep_parts += step.substep_parts;
  troubles.unconverged += step.unconverged;
  troubles.exhausted += step.exhausted;
  troubles.unknown_forces += step.unknown_forces;
}

void append_run_warnings(const Simulation& simulation, const StepStatistics& troubles,
                         std::vector<Warning>& warnings) {
  append_solver_warnings(troubles, warnings);
  if (simulation.cables == nullptr) return;
  constexpr double ever = -std::numeric_limits<double>::infinity();
  append_cable_warnings(*simulation.cables, simulation.world.bodies(), ever, warnings);
}

pybind11::list warning_dicts(const std::vector<Warning>& warnings) {
  pybind11::list list;
  for (const Warning& warning : warnings) {
    pybind11::dict one;
    one["kind"] = warning.kind;
    one["subject"] = warning.subject;
    one["message"] = warning.message;
    list.append(std::move(one));
  }
  return list;
}

}  // namespace sheave::python
