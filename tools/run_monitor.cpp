#include "tools/run_monitor.h"

#include <algorithm>
#include <cmath>

namespace sheave::tools {

void RunMonitor::observe(const Simulation& simulation) {
  final_ = simulation.world.energy();
  if (!started_) initial_ = final_;
  started_ = true;
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  const std::vector<CableReport> reports = simulation.cable_reports();
  cables_.resize(reports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    CableCourse& course = cables_[i];
    if (std::abs(reports[i].length_error) > std::abs(course.length_error)) {
      course.length_error = reports[i].length_error;
    }
    course.max_stretch = std::max(course.max_stretch, reports[i].max_stretch);
  }
}

}  // namespace sheave::tools
