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

void Curvature::add_parts(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                          const Vector3& normal, const Vector3& across, double sign) {
  const double along = sign * dot(freedom.along, across);
  if (freedom.kind == Freedom::line) {
    if (std::abs(along) > planar) parts_.push_back({freedom.first, along, 0.0, body.linear_yield});
    return;
  }
  const double sense = dot(body.axis, normal) > 0.0 ? 1.0 : -1.0;
  const Part turn{freedom.first, sense * term.reach, term.reach, body.angular_yield};
  if (freedom.kind == Freedom::angle) {
    parts_.push_back(turn);
    return;
  }
  parts_.push_back({freedom.first, along, 0.0, body.linear_yield});
  parts_.push_back({freedom.first + 1, sign * dot(freedom.across, across), 0.0, body.linear_yield});
  if (term.reach == 0.0) return;
  parts_.push_back(turn);
  parts_.back().dof += 2;
}

bool Curvature::add_in_plane(const Row& row, const Coordinates& coordinates,
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
  const std::size_t arms = arms_.size();
  const Vector3 across = cross(*normal, curved.direction);
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
      arms_.resize(arms);
      return false;
    }
    // A cable over a wheel pulls along the rim at every angle of the wheel.
    constexpr double rounding = 1e-12;
    const MovingBody& body = bodies[at(term.body)];
    const bool turns = freedom.kind == Freedom::plane || freedom.kind == Freedom::angle;
    if (freedom.kind == Freedom::angle &&
        !(term.reach * term.reach > rounding * rounding * dot(term.angular, term.angular))) {
      continue;
    }
    if (row.turning != 0.0) {
      add_parts(term, freedom, body, *normal, across, sign);
    } else if (turns && term.reach != 0.0) {
      const int dof = freedom.first + size_of(freedom.kind) - 1;
      arms_.push_back({curved.row, dof, term.reach, body.angular_yield});
    }
  }
  curved.last = static_cast<int>(parts_.size());
  if (curved.last > curved.first) planar_.push_back(curved);
  if (curved.last > curved.first || arms_.size() > arms) numbers_.push_back(curved.row);
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
  arms_.clear();
  planar_.clear();
  parts_.clear();
  spatial_.clear();
  forces_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (!row.curved || row.source != nullptr || row.term_count == 0) continue;
    const Vector3& along = row.terms[0].linear;
    CurvedRow curved{static_cast<int>(i), 0, 0, row.turning, along};
    const double square = dot(along, along);
    if (!(square > 0.0)) continue;
    if (square != 1.0) curved.direction /= std::sqrt(square);
    if (add_in_plane(row, coordinates, bodies, curved)) continue;
    curved.first = static_cast<int>(forces_.size());
    for (const RowTerm& term : row.active_terms()) {
      add_force(term, coordinates[term.body], bodies[at(term.body)], curved);
    }
    curved.last = static_cast<int>(forces_.size());
    if (curved.last == curved.first) continue;
    numbers_.push_back(curved.row);
    spatial_.push_back(curved);
  }
  return !numbers_.empty();
}

void Curvature::turn_arms(std::span<const double> multipliers, std::span<const double> motion,
                          std::span<double> bent, std::span<double> second_order) {
  double turn = 0.0;
  double part = 0.0;
  for (const Arm& arm : arms_) {
    const double own = motion[at(arm.dof)];
    const double pushed = arm.reach * own;
    second_order[at(arm.row)] -= 0.5 * pushed * own;
    bent[at(arm.dof)] -= arm.yield * multipliers[at(arm.row)] * pushed;
    turn = std::max(turn, std::abs(own));
    part = std::max(part, std::abs(pushed * own));  // of both bodies of the row
  }
  largest_turn_ = turn;
  largest_part_ = part;
}

bool Curvature::turn_in_plane(const CurvedRow& row, double multiplier,
                              std::span<const double> motion, std::span<double> bent,
                              double& second_order) {
  const std::span<const Part> parts(parts_.data() + row.first, parts_.data() + row.last);
  double moved = 0.0;
  double along = 0.0;
  double largest = 0.0;
  for (const Part& part : parts) {
    const double own = motion[at(part.dof)];
    moved += part.across * own;
    along += part.reach * own * own;
    if (part.reach != 0.0) largest = std::max(largest, std::abs(own));
  }
  const double turn = -row.turning * moved;
  if (!(std::abs(turn) <= most_turn)) return false;
  second_order = 0.5 * (turn * moved - along);
  largest_turn_ = std::max(largest_turn_, std::max(largest, std::abs(turn)));
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
  for (const int row : numbers_) second_order[at(row)] = 0.0;
  turn_arms(multipliers, motion, bent, second_order);
  for (const CurvedRow& row : planar_) {
    if (!turn_in_plane(row, multipliers[at(row.row)], motion, bent, second_order[at(row.row)])) {
      return false;
    }
  }
  if (spatial_.empty()) return true;
  motions_.resize(bodies.size());
  wrenches_.resize(bodies.size());
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const double* own = motion.data() + freedom.first;
    motions_[at(freedom.body)] = {linear_motion(freedom, own),
                                  angular_motion(freedom, bodies[at(freedom.body)], own)};
    wrenches_[at(freedom.body)] = {};
  }
  for (const CurvedRow& row : spatial_) {
    if (!turn_in_space(row, multipliers[at(row.row)], second_order[at(row.row)])) return false;
  }
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
