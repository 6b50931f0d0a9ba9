#include "command/run/monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/body_set.h"
#include "engine/joint_report.h"

namespace sheave::command {

RunMonitor::RunMonitor(std::int64_t steps)
    : stride_(std::max<std::int64_t>(1, steps / 2000)),
      half_(steps / 2),
      joint_stride_(std::max<std::int64_t>(1, steps / 200)) {}

void RunMonitor::observe(const Simulation& simulation, const RunStatistics& statistics) {
  final_ = statistics.energy;
  finite_ &= std::isfinite(final_.total());
  if (observed_ == 0) {
    initial_ = final_;
    min_energy_ = final_.total();
  }
  min_energy_ = std::min(min_energy_, final_.total());
  max_gain_ = std::max(max_gain_, final_.total() - initial_.total());
  most_vivid_ = std::max(most_vivid_, final_.kinetic + final_.elastic);
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  if (observed_ % stride_ == 0 || observed_ == half_) observe_cables(simulation);
  if (observed_ % joint_stride_ == 0) observe_joints(simulation);
  ++observed_;
}

void RunMonitor::finish(const Simulation& simulation, const RunStatistics& statistics,
                        bool conservative) {
  exchanged_ = statistics.energy_exchanged;
  integrator_loss_ = std::max({0.0, statistics.energy_taken, statistics.numerical_damping});
  // Without an energy source the integrator cannot have removed more energy than is missing.
  if (conservative) {
    integrator_loss_ = std::min(integrator_loss_, initial_.total() - min_energy_);
  }
  // After a divergence the final state has no report of a step.
  final_ = simulation.world.energy();
  max_drift_ = std::max(max_drift_, std::abs(final_.total() - initial_.total()));
  observe_cables(simulation);
  observe_joints(simulation);
}

namespace {

/// The error of a drive that rounding alone can cause. A brake asks for 0, so this error must not count as a relative one. A
/// rate is the difference of two coordinates over a substep, so the rounding of the coordinates counts divided by its length.
double drive_rounding(const JointCoordinateReport& coordinate, const World& world) {
  const StepSettings& step = world.model().step;
  const double unit = coordinate.angle ? 1.0 : world.bodies().scale();
  const double rate = 16.0 * std::numeric_limits<double>::epsilon() *
                      std::max(std::abs(coordinate.value), unit) * step.substeps / step.dt;
  return 1e-12 * unit + rate;
}

}  // namespace

void RunMonitor::observe_joints(const Simulation& simulation) {
  const std::vector<JointReport> reports = joint_reports(simulation.world);
  const double time = simulation.world.state().time;
  joints_.resize(reports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    JointCourse& course = joints_[i];
    // This form of the condition counts NaN as large.
    if (!(reports[i].error <= course.error)) {
      course.error = reports[i].error;
      course.error_time = time;
    }
    if (!(reports[i].angle_error <= course.angle_error)) {
      course.angle_error = reports[i].angle_error;
      course.angle_error_time = time;
    }
    // Drives act in steps only.
    if (observed_ == 0) continue;
    for (const JointCoordinateReport& coordinate : reports[i].coordinates) {
      const double error = std::abs(coordinate.drive_error);
      if (!(error <= drive_rounding(coordinate, simulation.world))) course.drive_error += error;
      course.drive_asked += std::abs(coordinate.drive_target);
      ++course.drive_samples;
    }
  }
}

void RunMonitor::observe_cables(const Simulation& simulation) {
  if (simulation.cables == nullptr) return;
  if (links_.empty()) {
    for (const CableReport& report : simulation.cable_reports()) {
      std::vector<Touched>& links = links_.emplace_back();
      for (const LinkReport& link : report.links) {
        if (!link.body.is_world()) links.push_back({link.body, link.radius});
      }
      follow(simulation.world, links);
    }
    cables_.resize(links_.size());
  }
  simulation.gauge_cables(gauges_);
  for (std::size_t i = 0; i < gauges_.size(); ++i) {
    const CableGauge& gauge = gauges_[i];
    CableCourse& course = cables_[i];
    // This form of the condition counts NaN as large.
    if (!(std::abs(gauge.length_error) <= std::abs(course.length_error))) {
      course.length_error = gauge.length_error;
    }
    course.max_stretch = std::max(course.max_stretch, gauge.max_stretch);
    course.max_strain = std::max(course.max_strain, gauge.max_strain);
    course.length = gauge.total_length;
    if (observed_ > 0) {
      const std::size_t half = observed_ > half_ ? 1 : 0;
      course.way[half] += follow(simulation.world, links_[i]);
      course.stretching[half] += std::abs(gauge.excess - course.excess);
    }
    course.excess = gauge.excess;
  }
}

double RunMonitor::follow(const World& world, std::vector<Touched>& links) {
  double square = 0.0;
  for (Touched& link : links) {
    const BodyState& now = world.state().bodies[static_cast<std::size_t>(link.body.index)];
    const double turned = link.radius * (now.angle - link.angle);
    square = std::max({square, (now.position - link.position).squaredNorm(), turned * turned});
    link.position = now.position;
    link.angle = now.angle;
  }
  return std::sqrt(square);
}

}  // namespace sheave::command
