#include "engine/solvers/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/index.h"

namespace sheave {
namespace {

/// Largest turn of a span's direction [rad].
constexpr double most_turn = 0.5;
/// Distance from a plane (for angles, its square) up to which a row counts as planar. The turn of
/// the forces affects the speed of convergence of the rounds, not their solution.
constexpr double planar = 1e-9;

}  // namespace

void Curvature::add_part(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                         const Vector3& normal, const CurvedRow& row, double sign) {
  const auto turn = [&](int dof) {
    const double sense = dot(body.axis, normal) > 0.0 ? 1.0 : -1.0;
    parts_.push_back({dof, sense * term.reach, term.reach, body.angular_yield});
  };
  const Vector3 across = cross(normal, row.direction);
  const int first = freedom.first;
  if (freedom.kind == Freedom::angle) {
    // A cable over a wheel pulls along the rim at every angle of the wheel.
    constexpr double rounding = 1e-12;
    if (std::abs(term.reach) > rounding * std::sqrt(dot(term.angular, term.angular))) turn(first);
    return;
  }
  if (row.turning != 0.0) {
    const double along = dot(freedom.along, across);
    if (freedom.kind == Freedom::plane) {
      parts_.push_back({first, sign * along, 0.0, body.linear_yield});
      parts_.push_back({first + 1, sign * dot(freedom.across, across), 0.0, body.linear_yield});
    } else if (std::abs(along) > planar) {
      parts_.push_back({first, sign * along, 0.0, body.linear_yield});
    }
  }
  if (freedom.kind == Freedom::plane && term.reach != 0.0) turn(first + 2);
}

bool Curvature::add_parts(const Row& row, const Coordinates& coordinates,
                          std::span<const MovingBody> bodies, CurvedRow& curved) {
  const Vector3* normal = nullptr;
  for (const RowTerm& term : row.active_terms()) {
    const Freedom kind = coordinates[term.body].kind;
    if (kind == Freedom::space) return false;
    if (kind != Freedom::plane && kind != Freedom::angle) continue;
    const Vector3& axis = bodies[at(term.body)].axis;
    if (normal == nullptr) normal = &axis;
    const double cosine = dot(*normal, axis);
    if (cosine * cosine < 1.0 - planar) return false;
  }
  if (normal == nullptr || std::abs(dot(*normal, curved.direction)) > planar) return false;
  curved.first = static_cast<int>(parts_.size());
  for (const RowTerm& term : row.active_terms()) {
    const BodyFreedom& freedom = coordinates[term.body];
    // The turn of a mounted wheel is no part of a force; the carrier's term has the force.
    const double square = dot(term.linear, term.linear);
    if (square == 0.0 || freedom.kind == Freedom::none) continue;
    const double sign = dot(term.linear, curved.direction);
    const bool slides_out =
        freedom.kind == Freedom::line && std::abs(dot(freedom.along, *normal)) > planar;
    if (square - sign * sign > planar * square || slides_out) {
      parts_.resize(at(curved.first));
      return false;
    }
    add_part(term, freedom, bodies[at(term.body)], *normal, curved, sign);
  }
  curved.planar = true;
  curved.last = static_cast<int>(parts_.size());
  return true;
}

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
  // The arm of a cable over a wheel turns along the force.
  if (freedom.kind == Freedom::angle && (!force.has_arm || !across(cross(body.axis, force.arm)))) {
    return;
  }
  forces_.push_back(force);
}

bool Curvature::collect(const RowList& rows, const Coordinates& coordinates,
                        std::span<const MovingBody> bodies) {
  numbers_.clear();
  rows_.clear();
  parts_.clear();
  forces_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (!row.curved || row.source != nullptr || row.term_count == 0) continue;
    const Vector3& along = row.terms[0].linear;
    CurvedRow curved{static_cast<int>(forces_.size()), 0, row.turning, false, along};
    const double square = dot(along, along);
    if (!(square > 0.0)) continue;
    if (square != 1.0) curved.direction /= std::sqrt(square);
    if (!add_parts(row, coordinates, bodies, curved)) {
      curved.first = static_cast<int>(forces_.size());
      for (const RowTerm& term : row.active_terms()) {
        add_force(term, coordinates[term.body], bodies[at(term.body)], curved);
      }
      curved.last = static_cast<int>(forces_.size());
    }
    if (curved.last == curved.first) continue;
    numbers_.push_back(static_cast<int>(i));
    rows_.push_back(curved);
  }
  return !rows_.empty();
}

bool Curvature::turn_in_plane(const CurvedRow& row, double multiplier,
                              std::span<const double> motion, std::span<double> bent,
                              double& second_order) {
  const std::span<const Part> parts(parts_.data() + row.first, parts_.data() + row.last);
  double moved = 0.0;
  double along = 0.0;
  for (const Part& part : parts) {
    const double own = motion[at(part.dof)];
    moved += part.across * own;
    along += part.reach * own * own;
    if (part.reach != 0.0) largest_turn_ = std::max(largest_turn_, std::abs(own));
  }
  const double turn = -row.turning * moved;
  if (!(std::abs(turn) <= most_turn)) return false;
  second_order = 0.5 * (turn * moved - along);
  largest_turn_ = std::max(largest_turn_, std::abs(turn));
  largest_part_ = std::max(largest_part_, 0.5 * (std::abs(along) - turn * moved));
  if (multiplier == 0.0) return true;
  for (const Part& part : parts) {
    bent[at(part.dof)] +=
        part.yield * multiplier * (turn * part.across - part.reach * motion[at(part.dof)]);
  }
  return true;
}

bool Curvature::turn_in_space(const CurvedRow& row, double multiplier, double& second_order) {
  const std::span<const Force> forces(forces_.data() + row.first, forces_.data() + row.last);
  Vector3 turn = Vector3::Zero();  // of the row's direction
  if (row.turning != 0.0) {
    for (const Force& force : forces) {
      const Motion& body = motions_[at(force.body)];
      turn = sum(turn, -row.turning * force.sign, body.linear);
      if (!force.has_arm) continue;
      turn = sum(turn, -row.turning * force.sign, cross(body.angular, force.arm));
    }
    turn = sum(turn, -dot(turn, row.direction), row.direction);
    const double square = dot(turn, turn);
    if (!(square <= most_turn * most_turn)) return false;
    largest_turn_ = std::max(largest_turn_, std::sqrt(square));
  }
  double sum_of_row = 0.0;
  double parts = 0.0;
  for (const Force& force : forces) {
    const Motion& body = motions_[at(force.body)];
    Motion& wrench = wrenches_[at(force.body)];
    const Vector3 linear = force.sign * turn;
    const double across = dot(linear, body.linear);
    sum_of_row += across;
    parts += std::abs(across);
    wrench.linear = sum(wrench.linear, multiplier, linear);
    if (!force.has_arm) continue;
    const Vector3 angular =
        cross(cross(body.angular, force.arm), force.force) + cross(force.arm, linear);
    const double about = dot(angular, body.angular);
    sum_of_row += about;
    parts += std::abs(about);
    largest_turn_ = std::max(largest_turn_, std::sqrt(dot(body.angular, body.angular)));
    wrench.angular = sum(wrench.angular, multiplier, angular);
  }
  second_order = 0.5 * sum_of_row;
  largest_part_ = std::max(largest_part_, 0.5 * parts);
  return true;
}

bool Curvature::turn(const Coordinates& coordinates, std::span<const MovingBody> bodies,
                     std::span<const double> multipliers, std::span<const double> motion,
                     std::span<double> bent, std::span<double> second_order) {
  largest_turn_ = largest_part_ = 0.0;
  const bool in_space = !forces_.empty();
  if (in_space) {
    motions_.resize(bodies.size());
    wrenches_.resize(bodies.size());
    for (const BodyFreedom& freedom : coordinates.movable()) {
      const double* own = motion.data() + freedom.first;
      motions_[at(freedom.body)] = {linear_motion(freedom, own),
                                    angular_motion(freedom, bodies[at(freedom.body)], own)};
      wrenches_[at(freedom.body)] = {};
    }
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const CurvedRow& row = rows_[i];
    const std::size_t number = at(numbers_[i]);
    const bool turned =
        row.planar ? turn_in_plane(row, multipliers[number], motion, bent, second_order[number])
                   : turn_in_space(row, multipliers[number], second_order[number]);
    if (!turned) return false;
  }
  if (!in_space) return true;
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const Motion& wrench = wrenches_[at(freedom.body)];
    const MovingBody& body = bodies[at(freedom.body)];
    std::array<double, 6> parts{};
    std::array<double, 6> moved{};
    project(freedom, body, wrench.linear, wrench.angular, parts.data());
    weigh(freedom.kind, body, parts.data(), moved.data());
    for (int d = 0; d < size_of(freedom.kind); ++d) bent[at(freedom.first + d)] += moved[at(d)];
  }
  return true;
}

double Curvature::largest(std::span<const double> values) const {
  double most = 0.0;
  for (const int row : numbers_) most = std::max(most, std::abs(values[at(row)]));
  return most;
}

}  // namespace sheave
