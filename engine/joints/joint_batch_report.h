#pragma once
// Reactions, breaking, energy and reports of joints; a part of engine/joints/joint_batch.h, which
// includes it.

#include <algorithm>
#include <cmath>

#include "engine/joints/joint_batch.h"

namespace sheave {

template <class Kernel>
double JointBatch<Kernel>::measure(int index, int coordinate, const Substep& now,
                                   const FeatureState& own, Row& gradient) const {
  return measure(now, joint_of(own, at(index)), coordinate, coordinates(own), gradient);
}

template <class Kernel>
double JointBatch<Kernel>::coupling_excess(const Substep& now, const Joint& joint,
                                           const FeatureState& own) const {
  double excess = 0.0;
  Row row;
  for (int i = joint.lock_count; i < joint.lock_count + joint.effect_count; ++i) {
    if (effect(joint, i).second < 0) continue;
    row.clear();
    evaluate_at(now, joint, i, coordinates(own), row);
    if (!row.is_free()) excess += row.value;
  }
  return excess;
}

template <class Kernel>
std::string JointBatch<Kernel>::fault_of_hold(const Substep& now, const Joint& joint,
                                              const FeatureState& own) const {
  Row row;
  for (int i = joint.lock_count; i < joint.lock_count + joint.effect_count; ++i) {
    row.clear();
    evaluate_at(now, joint, i, coordinates(own), row);
    const JointEffect& acting = effect(joint, i);
    std::string fault =
        hold_fault(acting, Kernel::coordinates[at(acting.coordinate)], row, now.bodies.scale());
    if (!fault.empty()) return fault;
  }
  return {};
}

template <class Kernel>
double JointBatch<Kernel>::elastic_energy(const BodySet& bodies, const State& state,
                                          const FeatureState& own) const {
  if (!elastic_) return 0.0;
  const Substep now(bodies, state, 1.0, 1);
  double energy = 0.0;
  Row row;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (layout_.broken_at(own, j) >= 0.0) continue;
    const Joint joint = joint_of(own, j);
    for (int i = 0; i < joint.lock_count + joint.effect_count; ++i) {
      if (i >= joint.lock_count && !effect(joint, i).elastic()) continue;
      row.clear();
      evaluate_at(now, joint, i, coordinates(own), row);
      if (row.compliance > 0.0 && !row.is_free())
        energy += 0.5 * row.value * row.value / row.compliance;
    }
  }
  return energy;
}

template <class Kernel>
Wrench JointBatch<Kernel>::reaction(const Substep& substep, const Joint& joint,
                                    const FeatureState& state, bool friction_alone) const {
  Wrench wrench;
  wrench.about = joint.kernel.anchor(substep);
  for (int i = friction_alone ? joint.lock_count : 0; i < joint.lock_count + joint.effect_count;
       ++i) {
    const double force = state.reals[at(joint.first_row + i)];
    if (force == 0.0) continue;
    if (friction_alone && !effect(joint, i).shared) continue;
    Row row;
    const auto on_b = [&](double scale) {
      return JointTerms(substep, row, joint.kernel.anchor_body(), scale, wrench);
    };
    if (i < joint.lock_count) {
      JointTerms terms = on_b(force);
      joint.kernel.lock(i, terms);
    } else if constexpr (coordinate_count > 0) {
      const JointEffect& acting = effect(joint, i);
      JointTerms first = on_b(acting.factor * force);
      joint.kernel.coordinate(acting.coordinate, first);
      if (acting.second < 0) continue;
      JointTerms second = on_b(acting.second_factor * force);
      joint.kernel.coordinate(acting.second, second);
    }
  }
  return wrench;
}

template <class Kernel>
void JointBatch<Kernel>::break_joints(const Substep& substep, FeatureState& next) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (intact_[j] == 0 || !breaking_.can_break(j)) continue;
    const Wrench wrench = reaction(substep, joints_[j], next);
    breaking_.note(j, substep.h, wrench.force.norm(), wrench.torque.norm());
    if (substep.breakage != Breakage::by_means || !breaking_.breaks_by_means(j)) continue;
    layout_.set_broken(next, j, substep.next.time);
  }
}

template <class Kernel>
bool JointBatch<Kernel>::asks_for_forces(const FeatureState& own) const {
  for (std::size_t j = 0; breaking_.any() && j < joints_.size(); ++j) {
    if (breaking_.can_break(j) && layout_.broken_at(own, j) < 0.0) return true;
  }
  return false;
}

template <class Kernel>
bool JointBatch<Kernel>::arise(const BodySet& /*bodies*/, double time, FeatureState& own) {
  bool any = false;
  for (std::size_t j = 0; breaking_.any() && j < joints_.size(); ++j) {
    if (layout_.broken_at(own, j) >= 0.0 || !breaking_.breaks_now(j)) continue;
    layout_.set_broken(own, j, time);
    any = true;
  }
  return any;
}

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
  // The distances between anchors in the directions of the locks add up as vectors do.
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
