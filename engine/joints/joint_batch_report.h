#pragma once
// What reports tell of a joint's coordinates and errors: a part of engine/joints/joint_batch.h, which
// includes it.

#include <algorithm>
#include <cmath>

#include "engine/joints/joint_batch.h"

namespace sheave {

template <class Kernel>
void JointBatch<Kernel>::append_coordinates(const Substep& now, const Joint& joint,
                                            const FeatureState& own, JointReport& report) const {
  for (int k = 0; k < joint.reported; ++k) {
    JointCoordinateReport coordinate{Kernel::coordinates[at(k)].name,
                                     Kernel::coordinates[at(k)].angle};
    Row row;
    coordinate.value = measure(now, joint, k, coordinates(own), row);
    for (const RowTerm& term : row.active_terms()) {
      if (term.body >= now.bodies.count()) continue;
      const BodyState& body = now.start.bodies[at(term.body)];
      coordinate.rate += term.linear.dot(body.velocity) + term.angular.dot(body.angular_velocity);
    }
    for (int i = joint.lock_count; i < joint.lock_count + joint.effect_count; ++i) {
      const JointEffect& acting = effect(joint, i);
      if (acting.coordinate != k) continue;
      if (acting.kind == JointEffect::Kind::friction) {
        coordinate.friction_force += own.reals[at(joint.first_row + i)];
      }
      if (!acting.is_drive()) continue;
      coordinate.drive_force = own.reals[at(joint.first_row + i)];
      const DriveDemand demand(acting, now.start.controls);
      coordinate.drive_target = demand.at(now.start.time);
      coordinate.drive_error = drive_error(acting, demand, now.start.time, coordinate.drive_force,
                                           coordinate.value, coordinate.rate);
    }
    report.coordinates.push_back(coordinate);
  }
}

template <class Kernel>
void JointBatch<Kernel>::find_errors(const Substep& now, const Joint& joint,
                                     const FeatureState& own, JointReport& report) const {
  // Anchors coincide in any direction, so their errors add up as vectors do.
  double squares = 0.0;
  Row row;
  for (int i = 0; i < joint.lock_count + joint.effect_count; ++i) {
    const bool lock = i < joint.lock_count;
    if (!lock && !effect(joint, i).holds()) continue;
    row.clear();
    evaluate_at(now, joint, i, coordinates(own), row);
    if (row.compliance > 0.0) continue;
    if (row.is_free()) continue;
    const double error = std::abs(row.value);
    const bool angle = std::all_of(row.terms.begin(), row.terms.begin() + row.term_count,
                                   [](const RowTerm& term) { return is_zero(term.linear); });
    if (angle && row.term_count > 0) {
      report.angle_error = std::max(report.angle_error, error);
    } else if (lock) {
      squares += error * error;
    } else {
      report.error = std::max(report.error, error);
    }
  }
  report.error = std::max(report.error, std::sqrt(squares));
}

}  // namespace sheave
