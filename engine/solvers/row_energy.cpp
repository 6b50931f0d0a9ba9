// Work of the rows, as a test of whether a substep agrees with its integrator:
// engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/kinetic_energy.h"
#include "engine/solvers/velocity_system.h"

namespace sheave {

namespace {

/// Change of a row over the substep that the solver's tolerance allows, relative to the scene's
/// size.
constexpr double change_rounding = 1e-10;

}  // namespace

double RowSystem::imbalance(const Substep& substep) const {
  /// Motions of a body if all rows pushed it the same way, and the body were free to follow.
  struct Push {
    double way = 0.0;
    double turn = 0.0;
  };
  std::vector<Push> pushes(substep.moving.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double multiplier = std::abs(previous_[i]);
    if (multiplier == 0.0) continue;
    for (const RowTerm& term : rows_[i].active_terms()) {
      if (term.body == substep.bodies.count()) continue;
      const MovingBody& body = substep.moving[at(term.body)];
      Push& push = pushes[at(term.body)];
      push.way += multiplier * std::max(body.linear_yield * term.linear.norm(),
                                        (body.inverse_mass * term.linear).norm());
      push.turn += multiplier * std::max(body.angular_yield * term.angular.norm(),
                                         (body.inverse_inertia * term.angular).norm());
    }
  }
  double worst = 0.0;
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    const MovingBody& body = substep.moving[at(freedom.body)];
    const Push& push = pushes[at(freedom.body)];
    const double* motion = &motion_[at(freedom.first)];
    const double way = linear_motion(freedom, motion).norm();
    const double turn = angular_motion(freedom, body, motion).norm();
    if (way > worst * push.way) worst = way / push.way;
    if (turn > worst * push.turn) worst = turn / push.turn;
  }
  return worst;
}

double RowSystem::energy_gain(const Substep& substep) const {
  const double h = substep.h;
  double made = 0.0;
  double kinetic = 0.0;
  double rounding = 0.0;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const MovingBody& body = substep.moving[at(i)];
    if (!body.translates && !body.rotates) continue;
    const Pose& from = prediction_[at(i)];
    const Vector3& w = substep.predicted[at(i)].angular_velocity;
    const auto energy = [&](const Vector3& position, const Vector3& turn) {
      return kinetic_energy(substep, i, (position - body.start_position) / h,
                            w + (turn - substep.predicted_turn[at(i)]) / h);
    };
    const double own = energy(body.position, body.turn);
    made += own - energy(from.position, from.turn);
    kinetic += own;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    if (previous_[i] == 0.0) continue;
    double moved = 0.0;  // by bodies that rows can move
    double driven = 0.0;
    for (const RowTerm& term : row.active_terms()) {
      const MovingBody& body = substep.moving[at(term.body)];
      const double change =
          dot(term.linear, body.position - body.start_position) + dot(term.angular, body.turn);
      (body.translates || body.rotates ? moved : driven) += change;
    }
    const bool gives = row.compliance > 0.0 || row.rate != 0.0 || row.inertial ||
                       (std::isfinite(row.lower) && std::isfinite(row.upper));
    const double force = previous_[i] / (h * h);
    made -= force * (gives ? moved : -driven);
    rounding += std::abs(force) * change_rounding * substep.bodies.scale() / row.lever;
  }
  return made > rounding ? made / kinetic : 0.0;
}

double VelocitySystem::work_error(const Substep& substep, const RowSystem& positions) const {
  // An impulse p changes the kinetic energy by p times the mean of J v before and after it. As J v
  // = 0 at the start and at the end (where v contains the motion of drives), the work of each half
  // is p J v_half / 2, with h v_half = x1 - x0. J (x1 - x0) is the change of C, which is zero, plus
  // the effect of the turning of J.
  const std::span<const double> impulses = active_set_.solution();
  const double noise = change_rounding * substep.bodies.scale();
  double conserving = 0.0;
  double taking = 0.0;
  double rounding = 0.0;
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int r = feature_rows_[f]; r < feature_rows_[f + 1]; ++r) {
      const auto i = at(r);
      const Row& row = rows_[i];
      const Group& group = groups_[at(group_of_[i])];
      const double second = row.weight * (group.multiplier + impulses[at(group_of_[i])]);
      const double first = previous_[i] / substep.h;
      if (first == 0.0 && second == 0.0) continue;
      // Drives and feeds may give energy, springs may store it, and bounded friction may do either.
      const bool bounded = std::isfinite(row.lower) && std::isfinite(row.upper);
      const Row& start = positions.start_row(f, row.index);
      if (group.elastic || row.rate != 0.0 || start.rate != 0.0 || bounded || row.inertial) {
        continue;
      }
      rounding += (std::abs(first) + std::abs(second)) * noise / row.lever;
      // Two parts of the motion are no work: the residual of a row at the start, and the cable that
      // spans with a common unknown pass on to each other.
      const double change = row.value - start.value;
      const bool late = start.contact && positions.turns_contacts();
      const Row& first_row = late ? row : start;
      const double turned = substep_change(first_row, substep.moving) - change;
      if (std::abs(turned) * row.lever <= noise) continue;  // the other gradient gives the same
      const double work =
          0.5 * (first * turned + second * (substep_change(row, substep.moving) - change));
      // A row that closes takes energy. Rows that share an unknown with friction between them take
      // energy, too.
      const bool bilateral = !std::isfinite(row.lower) && !std::isfinite(row.upper);
      const bool conserves = !late && group.row_count == 1 && (bilateral || row.active);
      (conserves ? conserving : taking) += work;
    }
  }
  const double worst = std::max(std::abs(conserving), taking);
  return worst > rounding ? worst / substep.h : 0.0;
}

}  // namespace sheave
