#pragma once
// Warnings of simulations and batches, as `sheave run` prints them.

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "cable/simulation.h"
#include "cable/step_warnings.h"
#include "scenes/scene.h"

namespace sheave::python {

/// The elements that an import has left out ("import"), numbers out of range, and
/// start_warnings(). `notice`: SceneResult::notice.
[[nodiscard]] std::vector<Warning> warnings_at_start(const Scene& scene, const std::string& notice);

/// Adds a step's statistics to `troubles`, as far as warnings need them.
void add_troubles(const StepStatistics& step, StepStatistics& troubles);

/// Appends the warnings of a run so far. `troubles`: the sum over its steps.
void append_run_warnings(const Simulation& simulation, const StepStatistics& troubles,
                         std::vector<Warning>& warnings);

/// A list of dicts with kind, subject and message.
[[nodiscard]] pybind11::list warning_dicts(const std::vector<Warning>& warnings);

}  // namespace sheave::python
