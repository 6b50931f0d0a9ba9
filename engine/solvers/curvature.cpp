#include "engine/solvers/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/index.h"

namespace sheave {

void Curvature::add_force(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                          const CurvedRow& row) {
  if (freedom.kind == Freedom::none) return;
  const auto across = [&](const Vector3& motion) {
    constexpr double rounding = 1e-12;
    const Vector3 part = motion - dot(motion, row.direction) * row.direction;
    return dot(part, part) > rounding * rounding * dot(motion, motion);
  };
  const bool slides = freedom.kind == Freedom::line;
  if (slides && (row.turning == 0.0 || !across(freedom.along))) return;
  const double square = dot(term.linear, term.linear);
  if (!(square > 0.0)) return;
  Force force{term.body, false, dot(term.linear, row.direction), Vector3::Zero(), term.linear};
  if (!slides && (term.reach != 0.0 || !is_zero(term.angular))) {
    force.arm = (1.0 / square) * sum(cross(term.linear, term.angular), term.reach, term.linear);
    force.has_arm = true;
  }
  // The arm of what runs over a wheel turns along the force.
  if (freedom.kind == Freedom::angle && (!force.has_arm || !across(cross(body.axis, force.arm)))) {
    return;
  }
  forces_.push_back(force);
}

bool Curvature::collect(const RowList& rows, const Coordinates& coordinates,
                        std::span<const MovingBody> bodies) {
  numbers_.clear();
  rows_.clear();
  forces_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (!row.curved || row.source != nullptr || row.term_count == 0) continue;
    const Vector3& along = row.terms[0].linear;
    CurvedRow curved{static_cast<int>(forces_.size()), 0, row.turning, along};
    const double square = dot(along, along);
    if (!(square > 0.0)) continue;
    if (square != 1.0) curved.direction /= std::sqrt(square);
    for (const RowTerm& term : row.active_terms()) {
      add_force(term, coordinates[term.body], bodies[at(term.body)], curved);
    }
    curved.last = static_cast<int>(forces_.size());
    if (curved.last == curved.first) continue;
    numbers_.push_back(static_cast<int>(i));
    rows_.push_back(curved);
  }
  return !rows_.empty();
}

bool Curvature::turn(const Coordinates& coordinates, std::span<const MovingBody> bodies,
                     std::span<const double> multipliers, std::span<const double> motion,
                     std::span<double> bent, std::span<double> second_order) {
  constexpr double most_turn = 0.5;  // [rad]
  motions_.resize(bodies.size());
  wrenches_.resize(bodies.size());
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const double* own = motion.data() + freedom.first;
    motions_[at(freedom.body)] = {linear_motion(freedom, own),
                                  angular_motion(freedom, bodies[at(freedom.body)], own)};
    wrenches_[at(freedom.body)] = {};
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const CurvedRow& row = rows_[i];
    const double multiplier = multipliers[at(numbers_[i])];
    const std::span<const Force> forces(forces_.data() + row.first, forces_.data() + row.last);
    Vector3 turn = Vector3::Zero();  // of the direction
    if (row.turning != 0.0) {
      for (const Force& force : forces) {
        const Motion& body = motions_[at(force.body)];
        turn = sum(turn, -row.turning * force.sign, body.linear);
        if (!force.has_arm) continue;
        turn = sum(turn, -row.turning * force.sign, cross(body.angular, force.arm));
      }
      turn = sum(turn, -dot(turn, row.direction), row.direction);
      if (!(dot(turn, turn) <= most_turn * most_turn)) return false;
    }
    double sum_of_row = 0.0;
    for (const Force& force : forces) {
      const Motion& body = motions_[at(force.body)];
      Motion& wrench = wrenches_[at(force.body)];
      const Vector3 linear = force.sign * turn;
      sum_of_row += dot(linear, body.linear);
      wrench.linear = sum(wrench.linear, multiplier, linear);
      if (!force.has_arm) continue;
      const Vector3 angular =
          cross(cross(body.angular, force.arm), force.force) + cross(force.arm, linear);
      sum_of_row += dot(angular, body.angular);
      wrench.angular = sum(wrench.angular, multiplier, angular);
    }
    second_order[at(numbers_[i])] = 0.5 * sum_of_row;
  }
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const Motion& wrench = wrenches_[at(freedom.body)];
    const MovingBody& body = bodies[at(freedom.body)];
    std::array<double, 6> parts{};
    project(freedom, body, wrench.linear, wrench.angular, parts.data());
    weigh(freedom.kind, body, parts.data(), bent.data() + freedom.first);
  }
  return true;
}

double Curvature::largest(std::span<const double> values) const {
  double most = 0.0;
  for (const int row : numbers_) most = std::max(most, std::abs(values[at(row)]));
  return most;
}

}  // namespace sheave
