#include "tools/run_monitor.h"

#include <algorithm>
#include <cmath>

namespace sheave::tools {

RunMonitor::RunMonitor(std::int64_t steps) : stride_(std::max<std::int64_t>(1, steps / 2000)) {}

void RunMonitor::observe(const Simulation& simulation) {
  final_ = simulation.world.energy();
  if (observed_ == 0) initial_ = final_;
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  if (observed_ % stride_ == 0) observe_cables(simulation);
  ++observed_;
}

void RunMonitor::finish(const Simulation& simulation) {
  // After a divergence the state is one that no step reported.
  final_ = simulation.world.energy();
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  observe_cables(simulation);
}

void RunMonitor::observe_cables(const Simulation& simulation) {
  const std::vector<CableReport> reports = simulation.cable_reports();
  cables_.resize(reports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    CableCourse& course = cables_[i];
    // Written so that NaN counts as large.
    if (!(std::abs(reports[i].length_error) <= std::abs(course.length_error))) {
      course.length_error = reports[i].length_error;
    }
    course.max_stretch = std::max(course.max_stretch, reports[i].max_stretch);
  }
}

}  // namespace sheave::tools
