#include "tools/run_monitor.h"

#include <algorithm>
#include <cmath>

namespace sheave::tools {
namespace {

/// How much longer than allowed the spans of a rigid cable are, all together [m].
double excess_of(const CableReport& cable) {
  // Only rigid cables report a stretch. What is left of one that is cut hangs free.
  if (!(cable.max_stretch > 0.0) || cable.cut) return 0.0;
  double excess = 0.0;
  for (const SpanReport& span : cable.spans) {
    excess += std::max(0.0, span.length - span.rest_length);
  }
  for (const WrapReport& wrap : cable.wraps) {
    excess += std::max(0.0, wrap.span.length - wrap.span.rest_length);
  }
  return excess;
}

}  // namespace

RunMonitor::RunMonitor(std::int64_t steps)
    : stride_(std::max<std::int64_t>(1, steps / 2000)), half_(steps / 2) {}

void RunMonitor::observe(const Simulation& simulation) {
  final_ = simulation.world.energy();
  if (observed_ == 0) {
    initial_ = final_;
    start_ = simulation.world.state().bodies;
  }
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  if (observed_ % stride_ == 0 || observed_ == half_) observe_cables(simulation);
  if (observed_ == half_) {
    for (CableCourse& course : cables_) course.excess_at_half = course.excess;
  }
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
    course.length = reports[i].total_length;
    course.excess = excess_of(reports[i]);
    for (const LinkReport& link : reports[i].links) {
      course.way = std::max(course.way, way_of(simulation.world, link));
    }
  }
}

double RunMonitor::way_of(const World& world, const LinkReport& link) const {
  if (link.body.is_world() || start_.empty()) return 0.0;
  const auto body = static_cast<std::size_t>(link.body.index);
  const BodyState& now = world.state().bodies[body];
  const double moved = (now.position - start_[body].position).norm();
  return std::max(moved, link.radius * std::abs(now.angle - start_[body].angle));
}

}  // namespace sheave::tools
