#include "engine/integrators/rattle.h"

#include <algorithm>
#include <cmath>

#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/kinetic_energy.h"
#include "engine/stages.h"

namespace sheave {
namespace {

bool left_to_xpbd(const Substep& substep) { return substep.load_share == 1.0; }

/// Of the velocities in substep.next [J].
double energy_of_motion(const Substep& substep) {
  double sum = 0.0;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyState& next = substep.next.bodies[at(i)];
    sum += kinetic_energy(substep, i, next.velocity, next.angular_velocity);
  }
  return sum;
}

}  // namespace

void RattleSolver::begin(Substep& substep, Features features) {
  // Mostly the substep has begun with it.
  if (substep.load_share != 0.5) {
    substep.load_share = 0.5;
    substep.update_inertias();
  }
  // Without rows the prediction is the motion, here and below.
  if (!features.empty()) positions_.remember_start(substep, features);
}

bool RattleSolver::found(Substep& substep, double violated, double first, double off,
                         double first_off) const {
  const double size = substep.bodies.scale();
  // Gauss-Seidel need not have converged; Newton's method that has not is lost: where bodies have
  // swung so far that no multipliers along the gradients of the start reach a solution, it comes
  // near one and stays there.
  constexpr double nearly = 1e-3;
  const double left = solver_ == SolverKind::direct ? nearly * std::min(first_off, size) : first;
  // Sweeps that leave much of what is no small share of the scene are no slow convergence either:
  // rows contradict each other, and each integrator would move the bodies to a compromise of its
  // own, to and fro.
  constexpr double gross = 1e-3;
  const bool torn = violated > 0.5 * first && violated > gross * size;
  if (torn || (off > left && violated > DirectSolver::tolerance * size)) return false;
  StepStatistics& statistics = substep.statistics;
  statistics.rows = positions_.row_count();
  statistics.last_correction = std::max(statistics.last_correction, violated);
  positions_.count_impossible(substep);
  return true;
}

bool RattleSolver::try_positions(Substep& substep, Features features) {
  const double enough = DirectSolver::tolerance * substep.bodies.scale();
  // Newton's last round leaves far less than it found. A sweep leaves a share, which is a force
  // still, so when what the features decide is settled, sweeps go on to rounding.
  constexpr double rounding = 1e-15;
  const bool direct = solver_ == SolverKind::direct;
  const double done = direct ? enough : rounding * substep.bodies.scale();
  // Here only values bend, by the square of the turn; what the first round leaves of less than this
  // the second one mends.
  constexpr double least_swing = 1e-4;  // [rad]
  double first = 0.0;
  double violated = 0.0;
  double off = 0.0;
  double first_off = 0.0;
  bool revised = false;
  bool settled = false;
  bool at_start = false;
  bool yields = false;  // rows that share a load, in the last round
  // One linearisation more than rounds: whether x1 is a solution or the substep must be left to
  // xpbd is decided by what the last round has left, which only the rows at x1 tell. The velocities
  // need these rows, too.
  positions_.move_on(substep);
  for (int round = 0; round <= substep.iterations; ++round) {
    if (!positions_.linearise(substep, features, RowSystem::Rule::midpoint, false)) return false;
    violated = positions_.violation();
    off = direct ? positions_.displacement(violated) : violated;
    if (round == 0) first = violated, first_off = off;
    if (!at_start && direct && DirectSolver::runs_away(substep, violated, first)) {
      at_start = true;
      violated = positions_.begin_at_start(substep, features, RowSystem::Rule::midpoint);
      off = positions_.displacement(violated);
    }
    if (!std::isfinite(violated)) return false;
    settled = settled || (round > 0 && !revised && violated <= enough && !yields);
    if ((settled && violated <= done) || round == substep.iterations) break;
    if (direct) {
      // What rows ask for that contradict each other no round finds; xpbd makes them give way.
      if (round > 2 && positions_.contradicts()) return false;
      if (!positions_.solve(substep)) return false;
      yields = positions_.yielded() > 1e-3 * enough;
      if (round > 0 || positions_.swing() > least_swing) positions_.bend(substep, enough);
    } else {
      positions_.relax(substep, 1);
    }
    positions_.apply(substep, features);
    if (settled) continue;
    revised = false;
    // After the last round, too: what it finds has the round of the velocities to act in.
    for (const auto& feature : features) revised = feature->revise(substep) || revised;
  }
  return found(substep, violated, first, off, first_off);
}

void RattleSolver::solve_positions(Substep& substep, Features features) {
  if (features.empty()) return;
  const bool impact = std::any_of(features.begin(), features.end(),
                                  [](const auto& feature) { return feature->meets(); });
  if (!impact) {
    if (substep.resort != Resort::other_integrator) {
      if (try_positions(substep, features)) return;
      // Sweeps need not converge.
      substep.failed = solver_ == SolverKind::direct && substep.resort == Resort::none;
      if (substep.failed) return;
    }
    ++substep.statistics.integrator_fallbacks;
  }
  substep.load_share = 1.0;
  substep.restart();
  for (std::size_t i = 0; i < features.size(); ++i) {
    features[i]->begin(substep, substep.start.features[i]);
  }
  limit_drives(substep, features);
  move_kinematic_bodies(substep);
  predict(substep);
  if (solver_ == SolverKind::direct) {
    direct_.solve(substep, features);
  } else {
    sweeps_.solve(substep, features);
  }
}

void RattleSolver::solve_velocities(Substep& substep, Features features) {
  if (left_to_xpbd(substep) || features.empty()) return;
  substep.update_inertias();
  velocities_.linearise_velocities(substep, positions_);
  const bool direct = solver_ == SolverKind::direct;
  const auto find_impulses = [&] {
    if (velocities_.solve_velocities(substep, direct, substep.iterations)) return true;
    substep.failed = substep.resort != Resort::anything;
    if (substep.failed) return false;
    ++substep.statistics.solver_fallbacks;
    velocities_.relax(substep, substep.iterations);
    return true;
  };
  // Links of cables that begin to slide by these impulses may make others slide.
  constexpr int most_revisions = 4;
  bool found = find_impulses();
  for (int i = 0; i < most_revisions && found; ++i) {
    if (!direct || !velocities_.revise_impulses(substep, features, positions_)) break;
    found = find_impulses();
  }
  for (const auto& feature : features) feature->end_impulses();
  if (!found) return;
  // Sweeps leave velocities off the constraints, which do work of their own.
  if (direct && substep.resort != Resort::anything &&
      velocities_.work_error(substep, positions_) > unresolved * energy_of_motion(substep)) {
    substep.failed = true;
    return;
  }
  velocities_.apply_impulses(substep, features);
}

void correct_gyroscopic_velocities(Substep& substep) {
  if (left_to_xpbd(substep)) return;
  const double h = substep.h;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& body = substep.bodies[i];
    if (body.mobility != Mobility::free || (body.isotropic && body.mounted_rotors.empty())) {
      continue;
    }
    const BodyState& start = substep.start.bodies[at(i)];
    BodyState& next = substep.next.bodies[at(i)];
    // L after the first half of loads and constraints, which act at the start; it is constant from
    // there on.
    const Vector3 turned_by = substep.moving[at(i)].turn - substep.predicted_turn[at(i)];
    const Vector3 damped =
        damped_rotation(substep, i, start.orientation, start.angular_velocity, 0.5 * h);
    Vector3 momentum = times_inertia(body, start.orientation, false, damped + turned_by / h) +
                       0.5 * h * torque_on(substep, i, substep.start.bodies);
    for (const int r : body.mounted_rotors) {
      const BodyProperties& rotor = substep.bodies[r];
      const Vector3 axis = start.orientation * rotor.axis;
      const double change =
          axis.dot(substep.moving[at(r)].turn - substep.predicted_turn[at(r)]) / h;
      const double spin = axis.dot(substep.start.bodies[at(r)].angular_velocity);
      momentum += rotor.axis_inertia *
                  (spin * axis + change * axis - (spin + change) * (next.orientation * rotor.axis));
    }
    next.angular_velocity = times_inertia(body, next.orientation, true, momentum);
  }
}

void add_second_half_of_loads(Substep& substep) {
  if (left_to_xpbd(substep)) return;
  const double half = 0.5 * substep.h;
  const double middle = 0.5 * (substep.start.time + substep.next.time);
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& body = substep.bodies[i];
    const MovingBody& moving = substep.moving[at(i)];
    BodyState& next = substep.next.bodies[at(i)];
    if (!moving.translates && !moving.rotates) continue;
    const BodyDef& definition = substep.bodies.definition(i);
    if (moving.translates) {
      const Vector3 force = body.mass * substep.gravity + force_on(substep, i, substep.next.bodies);
      const double keep = decay(definition.damping / body.mass, half).keep;
      next.velocity =
          allowed_velocity(body, keep * next.velocity + half * times(moving.inverse_mass, force));
    }
    if (!moving.rotates) continue;
    const Vector3 torque = torque_on(substep, i, substep.next.bodies);
    if (body.mobility == Mobility::free) {
      Vector3 turning = torque;
      if (!is_zero(torque)) turning = times_inertia(body, next.orientation, true, torque);
      if (body.isotropic) {
        const auto [keep, gain] =
            decay(definition.angular_damping * body.inverse_inertia(0, 0), half);
        next.angular_velocity = keep * next.angular_velocity + gain * turning;
      } else {
        next.angular_velocity =
            damped_rotation(substep, i, next.orientation, next.angular_velocity, half) +
            half * turning;
      }
      continue;
    }
    const Vector3 axis = body.mount >= 0
                             ? Vector3(substep.next.bodies[at(body.mount)].orientation * body.axis)
                             : body.axis;
    const auto [keep, gain] = decay(definition.angular_damping / body.axis_inertia, half);
    double change = gain * axis.dot(torque) / body.axis_inertia +
                    (keep - 1.0) * axis.dot(next.angular_velocity);
    if (body.drive == DriveKind::torque) {
      const BodyDrive drive(body, substep.start.controls, i);
      change += gain / half * drive.integral(middle, substep.next.time) / body.axis_inertia;
    }
    next.angular_velocity += change * axis;
  }
  follow_carriers(substep);
}

}  // namespace sheave
