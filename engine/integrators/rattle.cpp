#include "engine/integrators/rattle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/kinetic_energy.h"
#include "engine/stages.h"

namespace sheave {
namespace {

bool left_to_xpbd(const Substep& substep) { return substep.load_share == 1.0; }

/// Whether bodies are not at the place that the forces of turning contacts give; `before`:
/// DirectSolver::is_there().
bool is_astray(const RowSystem& positions, const Substep& substep, double& before) {
  return positions.turns_contacts() && !DirectSolver::is_there(substep, positions.astray(), before);
}

/// Kinetic energy of the velocities in substep.next [J].
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
  // The substep usually begins with a load share of one half.
  if (substep.load_share != 0.5) {
    substep.load_share = 0.5;
    substep.update_inertias();
  }
  // Without rows the predicted motion is the motion of the substep, here and below.
  if (!features.empty()) positions_.remember_start(substep, features);
}

bool RattleSolver::found(Substep& substep, double violated, double first, double off,
                         double first_off) const {
  const double size = substep.bodies.scale();
  // Gauss-Seidel may end before it has converged. If Newton's method has not converged, it has
  // failed: bodies have swung so far that no multipliers along the gradients of the start reach a
  // solution, and the rounds stay at some distance from one.
  constexpr double nearly = 1e-3;
  const double left = solver_ == SolverKind::direct ? nearly * std::min(first_off, size) : first;
  // Sweeps that leave a large residual, as a share of the first one and of the scene's size, do not
  // converge slowly: rows contradict each other. Each integrator would move the bodies to another
  // compromise, and they would jump between the two.
  constexpr double gross = 1e-3;
  const bool torn = violated > 0.5 * first && violated > gross * size;
  if (torn || (off > left && violated > DirectSolver::tolerance * size)) return false;
  StepStatistics& statistics = substep.statistics;
  statistics.rows = positions_.row_count();
  statistics.last_correction = std::max(statistics.last_correction, violated);
  positions_.count_impossible(substep);
  return true;
}

bool RattleSolver::solve_round(Substep& substep, int round) {
  // With frozen gradients only the values of rows are nonlinear, by the square of the turn. The
  // second round removes a residual of the first round that is smaller than this.
  constexpr double least_swing = 1e-4;  // [rad]
  // No round satisfies rows that contradict each other; xpbd makes them give way.
  if (round > 2 && positions_.contradicts()) return false;
  if (!positions_.solve(substep)) return false;
  if (round > 0 || positions_.swing() > least_swing) {
    const double share = positions_.may_end_first(substep) ? DirectSolver::first_share : 1.0;
    positions_.bend(substep, share * DirectSolver::tolerance * substep.bodies.scale());
  }
  positions_.ask_for_guess(substep, round);
  return true;
}

bool RattleSolver::try_positions(Substep& substep, Features features) {
  const double enough = DirectSolver::tolerance * substep.bodies.scale();
  // The residual after Newton's last round is far below the residual before it. After a sweep the
  // residual is a share of the one before, and this residual is still an error of the force. Once
  // the discrete states of features no longer change, sweeps therefore go on to rounding.
  constexpr double rounding = 1e-15;
  const bool direct = solver_ == SolverKind::direct;
  const double done = direct ? enough : rounding * substep.bodies.scale();
  double first = 0.0;
  double violated = 0.0;
  double off = 0.0;
  double first_off = 0.0;
  bool revised = false;
  bool settled = false;
  bool at_start = false;
  bool yields = false;  // rows that share a load, in the last round
  double astray = std::numeric_limits<double>::infinity();
  // There is one linearisation more than rounds. The residual at x1 decides whether x1 is a
  // solution or xpbd must do the substep, and only the rows at x1 have this residual. The solution
  // for the velocities needs these rows, too.
  if (!direct) substep.may_guess = false;  // a history is of another solver
  positions_.move_on(substep);
  for (int round = 0; round <= substep.iterations; ++round) {
    bool looked = direct && round > 0 && positions_.look(substep, features);
    if (!looked && !positions_.linearise(substep, features, RowSystem::Rule::midpoint, false)) {
      return false;
    }
    violated = positions_.violation();
    off = direct ? positions_.displacement(violated) : violated;
    if (round == 0) first = violated, first_off = off;
    if (!at_start && direct && DirectSolver::runs_away(substep, violated, first)) {
      at_start = true;
      looked = false;
      violated = positions_.begin_at_start(substep, features, RowSystem::Rule::midpoint);
      off = positions_.displacement(violated);
    }
    if (!std::isfinite(violated)) return false;
    if (is_astray(positions_, substep, astray)) {
      violated = std::max(violated, astray), off = std::max(off, astray);
    }
    const double left = direct ? DirectSolver::residual_before(round, positions_, substep) : enough;
    settled = settled || (round > 0 && !revised && violated <= left && !yields);
    if ((settled && violated <= done) || round == substep.iterations) break;
    if (looked && !positions_.look_closer(substep)) return false;
    if (!direct) {
      positions_.relax(substep, 1);
    } else if (!solve_round(substep, round)) {
      return false;
    }
    if (positions_.take_back_guess(substep, features)) return try_positions(substep, features);
    yields = direct && positions_.yielded() > 1e-3 * enough;
    positions_.apply(substep, features);
    if (settled) continue;
    revised = false;
    // Features revise their states after the last round, too, because the velocities have a round
    // left.
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
      // Sweeps that have not converged are no failure.
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
  velocities_.linearise(substep, positions_);
  const bool direct = solver_ == SolverKind::direct;
  const auto find_impulses = [&] {
    if (velocities_.find_impulses(substep, direct, substep.iterations)) return true;
    substep.failed = substep.resort != Resort::anything;
    if (substep.failed) return false;
    ++substep.statistics.solver_fallbacks;
    velocities_.relax(substep, substep.iterations);
    return true;
  };
  // Links that begin to slide by these impulses may make other links slide.
  constexpr int most_revisions = 4;
  bool found = find_impulses();
  for (int i = 0; i < most_revisions && found; ++i) {
    if (!direct || !velocities_.revise(substep, features, positions_)) break;
    found = find_impulses();
  }
  for (const auto& feature : features) feature->end_impulses();
  if (!found) return;
  // Sweeps leave a residual in the velocities, so their impulses do work.
  if (direct && substep.resort != Resort::anything &&
      velocities_.work_error(substep, positions_) > unresolved * energy_of_motion(substep)) {
    substep.failed = true;
    return;
  }
  velocities_.apply(substep, features);
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
    // The angular momentum after the first half of the loads and after the constraints, which act
    // at the start. No torque changes it from there on.
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
