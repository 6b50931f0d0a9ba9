// Friction in several directions as rows that turn with its slip: engine/friction_rows.h.
//
// With the multipliers l and the slip s after a round, and the effective inverse mass w of a row, l
// - s / w is the force that would hold. If its norm is within the bound, the contact sticks, and
// the rows keep the directions of the feature. Otherwise the contact slips, and the rows are turned
// so that the first one is opposite to that force. If the slip already obeys the law of friction,
// this direction is the direction of the slip for every w, and the step to it is Newton's.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/index.h"
#include "engine/math/portable.h"
#include "engine/solvers/velocity_system.h"

namespace sheave {
namespace {

/// Share of its bound from which friction counts as slipping.
constexpr double nearly = 1.0 - 1e-9;

/// Direction of the slip; empty if friction holds.
std::optional<Vector3> slip_direction(const Vector3& force, const Vector3& slip, double yield,
                                      double bound) {
  if (!(yield > 0.0)) return std::nullopt;
  const Vector3 holding = force - slip / yield;
  const double size = holding.norm();
  if (!(size >= nearly * bound) || !std::isfinite(size)) return std::nullopt;
  return Vector3(-holding / size);
}

/// Matrix whose rows are `along` and the directions across it.
Matrix3 directions_along(const Vector3& along, int count) {
  Matrix3 frame = Matrix3::Identity();
  frame.row(0) = along.transpose();
  if (count == 2) {
    frame.row(1) = Vector3(-along[1], along[0], 0.0).transpose();
  } else {
    const Vector3 across = any_perpendicular(along);
    frame.row(1) = across.transpose();
    frame.row(2) = cross(along, across).transpose();
  }
  return frame;
}

/// Regularisation of the rows across a slip, which grows with the slip. Above the limit a larger
/// value would have no effect.
double giving(double slip, double yield, double bound) {
  constexpr double most = 1e6;  // of the rows' own effective inverse mass
  return std::min(std::max(slip, 0.0) / bound, most * yield);
}

}  // namespace

void RowSystem::note_shared(std::size_t feature, int row, std::size_t place) {
  if (place >= shared_.size()) shared_.emplace_back();
  SharedFriction& friction = shared_[place];
  const Row& first = rows_[at(row)];
  if (friction.feature != feature || friction.index != first.index) friction = {};
  friction.feature = feature;
  friction.index = first.index;
  friction.first_row = row;
  friction.count = first.shares;
}

void RowSystem::follow_slip(const Substep& substep) {
  for (SharedFriction& friction : shared_) {
    const auto first = at(friction.first_row);
    const double bound = bound_share_ * rows_[first].upper;
    const bool slipped = std::exchange(friction.slips, false);
    friction.softness = 0.0;
    Vector3 force = Vector3::Zero();
    Vector3 slip = Vector3::Zero();
    for (int k = 0; k < friction.count; ++k) {
      force[k] = previous_[first + at(k)];
      slip[k] = rows_[first + at(k)].value;
    }
    const double used = force.norm();
    if (bound > 0.0 && (used == 0.0 || slipped || used >= nearly * bound)) {
      double yield = 0.0;
      RowResponse response;
      for (int k = 0; k < friction.count; ++k) {
        respond(rows_[first + at(k)], substep.moving, response);
        yield = std::max(yield, response.inverse_mass);
      }
      if (const auto along = slip_direction(force, slip, yield, bound)) {
        friction.slips = friction.turned = true;
        friction.frame = directions_along(*along, friction.count);
        friction.softness = giving(along->dot(slip), yield, bound);
      }
    }
    if (friction.turned) turn_rows(friction);
  }
}

void RowSystem::turn_rows(const SharedFriction& friction) {
  const auto first = at(friction.first_row);
  std::array<Row, 3> own;
  Vector3 multipliers = Vector3::Zero();
  for (int k = 0; k < friction.count; ++k) {
    own[at(k)] = rows_[first + at(k)];
    multipliers[k] = previous_[first + at(k)];
  }
  multipliers = times(friction.frame, multipliers);
  for (int i = 0; i < friction.count; ++i) {
    Row& row = rows_[first + at(i)];
    previous_[first + at(i)] = multipliers[i];
    row.value = row.rate = 0.0;
    for (RowTerm& term : std::span(row.terms).first(at(row.term_count))) {
      term = {term.body, Vector3::Zero(), Vector3::Zero(), 0.0};
    }
    for (int k = 0; k < friction.count; ++k) {
      const double share = friction.frame(i, k);
      row.value += share * own[at(k)].value;
      row.rate += share * own[at(k)].rate;
      for (std::size_t t = 0; t < at(row.term_count); ++t) {
        row.terms[t].linear += share * own[at(k)].terms[t].linear;
        row.terms[t].angular += share * own[at(k)].terms[t].angular;
        row.terms[t].reach += share * own[at(k)].terms[t].reach;
      }
    }
    if (i > 0) row.softness += friction.softness;
  }
}

void RowProblem::set_slipping_sides() {
  for (const SharedFriction& friction : shared_) {
    if (!friction.slips) continue;
    for (int k = 0; k < friction.count; ++k) {
      const auto g = at(group_of_[at(friction.first_row + k)]);
      problem_.free[g] = k > 0 && problem_.lower[g] != problem_.upper[g] ? 1 : 0;
    }
  }
}

double RowSystem::excess_friction() const {
  double most = 0.0;
  for (const SharedFriction& friction : shared_) {
    const auto first = at(friction.first_row);
    double square = 0.0;
    for (std::size_t i = first; i < first + at(friction.count); ++i) {
      square += previous_[i] * previous_[i];
    }
    const double bound = bound_share_ * rows_[first].upper;
    if (!(square > bound * bound)) continue;
    most = std::max(
        most, (std::sqrt(square) - bound) * slots_.yield(friction.first_row) * rows_[first].lever);
  }
  return most;
}

void RowProblem::turn_back(const SharedFriction& friction, std::span<double> multipliers) const {
  Vector3 own = Vector3::Zero();
  for (int k = 0; k < friction.count; ++k) own[k] = multipliers[at(friction.index + k)];
  const Vector3 back = friction.frame.transpose() * own;
  for (int k = 0; k < friction.count; ++k) multipliers[at(friction.index + k)] = back[k];
}

void VelocitySystem::begin_shared_friction() {
  for (const SharedFriction& friction : shared_) {
    for (int k = 0; k < friction.count; ++k) {
      const auto row = at(friction.first_row + k);
      const auto g = at(group_of_[row]);
      problem_.constant[g] += rows_[row].softness * groups_[g].multiplier;
    }
  }
  set_slipping_sides();
}

bool VelocitySystem::turn_friction() {
  const std::span<const double> change = active_set_.solution();
  bool changed = false;
  bool has_motion = false;
  for (SharedFriction& friction : shared_) {
    const auto first = at(group_of_[at(friction.first_row)]);
    const double bound = friction_bounds_[at(friction.first_row)];
    double square = 0.0;
    for (std::size_t g = first; g < first + at(friction.count); ++g) {
      const double force = groups_[g].multiplier + change[g];
      square += force * force;
    }
    const bool uses_all = square >= nearly * nearly * bound * bound;
    if (!(bound > 0.0) || (!uses_all && friction.softness == 0.0)) continue;
    if (!has_motion) {
      std::fill(motion_.begin(), motion_.end(), 0.0);
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (change[g] != 0.0) slots_.add_unknown(static_cast<int>(g), change[g], motion_.data());
      }
      has_motion = true;
    }
    changed = turn_to_slip(bound, friction) || changed;
  }
  if (!changed) return false;
  slots_.join(rows_);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    problem_.diagonal[g] = 0.0;
    for (int i = groups_[g].first_row; i < groups_[g].first_row + groups_[g].row_count; ++i) {
      problem_.diagonal[g] += rows_[at(i)].weight * yield_of_rate(at(i));
    }
  }
  assembled_ = false;
  assemble();
  return true;
}

bool VelocitySystem::turn_to_slip(double bound, SharedFriction& friction) {
  constexpr double settled_share = 1e-7;  // the same as for the bounds
  const auto row = at(friction.first_row);
  const auto first = at(group_of_[row]);
  const auto count = at(friction.count);
  Vector3 force = Vector3::Zero();
  Vector3 start = Vector3::Zero();
  Vector3 constant = Vector3::Zero();
  Vector3 slip = Vector3::Zero();
  double yield = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto c = static_cast<int>(k);
    start[c] = groups_[first + k].multiplier;
    force[c] = start[c] + active_set_.solution()[first + k];
    constant[c] = problem_.constant[first + k] - rows_[row + k].softness * start[c];
    slip[c] = constant[c] + slots_.along(static_cast<int>(first + k), motion_.data());
    yield = std::max(yield, slots_.yield(static_cast<int>(row + k)));
  }
  const auto along = slip_direction(force, slip, yield, bound);
  Matrix3 mixture = Matrix3::Identity();
  double softness = 0.0;
  if (along) {
    if (portable::hypot((*along)[1], (*along)[2]) <= settled_share) return false;
    mixture = directions_along(*along, friction.count);
    softness = giving(along->dot(slip), yield, bound);
  } else if (friction.softness * portable::hypot(force[1], force[2]) <=
             settled_share * yield * bound) {
    return false;
  }
  start = times(mixture, start);
  constant = times(mixture, constant);
  Vector3 before = Vector3::Zero();
  for (std::size_t k = 0; k < count; ++k) before[static_cast<int>(k)] = previous_[row + k];
  before = times(mixture, before);
  for (std::size_t k = 0; k < count; ++k) {
    const auto c = static_cast<int>(k);
    if (k > 0) rows_[row + k].softness += softness - friction.softness;
    previous_[row + k] = before[c];
    groups_[first + k].multiplier = start[c];
    problem_.constant[first + k] = constant[c] + rows_[row + k].softness * start[c];
    problem_.lower[first + k] = -bound - start[c];
    problem_.upper[first + k] = bound - start[c];
  }
  slots_.mix(friction.first_row, friction.count, mixture, true);
  friction.frame = mixture * friction.frame;
  friction.turned = true;
  friction.slips = along.has_value();
  friction.softness = softness;
  for (std::size_t k = 0; k < count; ++k) {
    problem_.free[first + k] = friction.slips && k == 0 ? 0 : 1;
  }
  return true;
}

}  // namespace sheave
