#include "engine/friction_rows.h"

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "engine/index.h"

namespace sheave {
namespace {

/// W of the rows; for two rows the remaining entries are those of a unit matrix.
Matrix3 yield_of(std::span<const Row> rows, std::span<const RowResponse> responses) {
  Matrix3 yield = Matrix3::Identity();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      double sum = 0.0;
      for (std::size_t t = 0; t < at(rows[i].term_count); ++t) {
        sum += dot(rows[i].terms[t].linear, responses[j].linear[t]) +
               dot(rows[i].terms[t].angular, responses[j].angular[t]);
      }
      yield(static_cast<int>(i), static_cast<int>(j)) = sum;
    }
  }
  return yield;
}

}  // namespace

Vector3 hold_within(const Matrix3& yield, const Vector3& wanted, double bound) {
  // A minimal yield of immovable directions, without which their multipliers would be undetermined.
  constexpr double least = 1e-14;
  constexpr int most_steps = 60;
  const double size = yield.trace();
  if (!(size > 0.0) || !(bound > 0.0)) return Vector3::Zero();
  double give = least * size;
  Vector3 force = Vector3::Zero();
  for (int i = 0; i < most_steps; ++i) {
    const Matrix3 inverse = (yield + give * Matrix3::Identity()).inverse();
    force = inverse * wanted;
    const double norm = force.norm();
    if (i == 0 && norm <= bound) return force;
    if (std::abs(norm - bound) <= 1e-15 * bound) break;
    // Newton's method for 1 / |l| = 1 / b. The left side is concave in m, so steps from the left
    // never overshoot.
    give += norm * norm / force.dot(inverse * force) * (norm - bound) / bound;
  }
  return force * (bound / force.norm());
}

double solve_friction(std::span<const Row> rows, std::span<double> multipliers,
                      std::span<MovingBody> bodies) {
  std::array<RowResponse, 3> responses;
  Vector3 before = Vector3::Zero();
  Vector3 slip = Vector3::Zero();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    // respond() leaves the linear part of bodies that do not translate unset.
    responses[k].linear.fill(Vector3::Zero());
    respond(rows[k], bodies, responses[k]);
    before[static_cast<int>(k)] = multipliers[k];
    slip[static_cast<int>(k)] = rows[k].value;
  }
  const Matrix3 yield = yield_of(rows, responses);
  const Vector3 after = hold_within(yield, yield * before - slip, rows[0].upper);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double increment = after[static_cast<int>(k)] - before[static_cast<int>(k)];
    multipliers[k] += increment;
    if (increment != 0.0) apply_multiplier(rows[k], responses[k], increment, bodies);
  }
  return (yield * (after - before)).norm();
}

}  // namespace sheave
