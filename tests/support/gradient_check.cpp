#include "tests/support/gradient_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace sheave::test {
namespace {

struct Motion {
  int body = 0;
  Vector3 direction = Vector3::Zero();
  bool rotation = false;
};

void apply(Substep& substep, const Motion& motion, double amount) {
  MovingBody& body = substep.moving[static_cast<std::size_t>(motion.body)];
  const Vector3 d = amount * motion.direction;
  if (!motion.rotation) {
    body.position += d;
    return;
  }
  body.turn += d;
  // A rotor's orientation follows from its turn.
  if (body.tracks_orientation) body.orientation = turned(body.orientation, d);
}

/// A basis of the motions that the bodies' mobilities allow now.
std::vector<Motion> allowed_motions(const Substep& substep) {
  std::vector<Motion> motions;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& body = substep.bodies[i];
    const auto add_across = [&](bool rotation) {
      const Vector3 e = any_perpendicular(body.axis);
      motions.push_back({i, e, rotation});
      motions.push_back({i, body.axis.cross(e), rotation});
    };
    switch (body.mobility) {
      case Mobility::free:
        for (int k = 0; k < 6; ++k) motions.push_back({i, Vector3::Unit(k % 3), k >= 3});
        break;
      case Mobility::planar:
        add_across(false);
        motions.push_back({i, body.axis, true});
        break;
      case Mobility::slider:
        motions.push_back({i, body.axis, false});
        break;
      case Mobility::rotor: {
        if (!substep.moving[static_cast<std::size_t>(i)].rotates) break;  // no row turns it
        const Vector3 axis =
            body.mount < 0 ? body.axis : Vector3(substep.orientation(body.mount) * body.axis);
        motions.push_back({i, axis, true});
        break;
      }
      case Mobility::fixed:
      case Mobility::kinematic:
      case Mobility::knot:
        break;
    }
  }
  return motions;
}

std::vector<double> values(Substep& substep, ConstraintBatch& batch) {
  RowList rows;
  batch.linearise(substep, rows);
  std::vector<double> result;
  for (const Row& row : rows) result.push_back(row.value);
  return result;
}

double predicted(const Row& row, const Motion& motion) {
  double sum = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (term.body != motion.body) continue;
    sum += (motion.rotation ? term.angular : term.linear).dot(motion.direction);
  }
  return sum;
}

/// Of the differences to either side alone, (-25 f0 + 48 f1 - 36 f2 + 16 f3 - 3 f4) / 12 h, the one
/// closer to `expected` for each row.
std::vector<double> one_sided(Substep& substep, ConstraintBatch& batch, const Motion& motion,
                              const std::vector<double>& expected) {
  // Truncation h^4/5 times the fifth derivative and rounding 10 eps/h, reaching 1e-3 to one side.
  constexpr double step = 2.5e-4;
  constexpr double factors[] = {-25.0, 48.0, -36.0, 16.0, -3.0};
  const std::vector<MovingBody> saved = substep.moving;
  std::vector<double> closest(expected.size(), std::numeric_limits<double>::infinity());
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> sums(expected.size(), 0.0);
    for (int k = 0; k < 5; ++k) {
      apply(substep, motion, side * k * step);
      const std::vector<double> here = values(substep, batch);
      for (std::size_t r = 0; r < sums.size(); ++r) {
        sums[r] += factors[k] * here[r] / (side * 12.0 * step);
      }
      substep.moving = saved;
    }
    for (std::size_t r = 0; r < sums.size(); ++r) {
      if (std::abs(sums[r] - expected[r]) < std::abs(closest[r] - expected[r])) {
        closest[r] = sums[r];
      }
    }
  }
  return closest;
}

}  // namespace

GradientCheck check_gradients(Substep& substep, ConstraintBatch& batch, bool kinks) {
  // Truncation h^4/30 f''''' and rounding eps/h balance near h = 1e-3 for machines of about 1 m.
  constexpr double step = 1e-3;
  GradientCheck check;
  RowList rows;
  batch.linearise(substep, rows);
  const std::vector<Motion> motions = allowed_motions(substep);
  const std::vector<MovingBody> saved = substep.moving;
  std::vector<std::vector<double>> at;  // values at -2, -1, 1, 2 steps
  std::vector<double> scale(rows.size(), 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const Motion& motion : motions) {
      scale[r] = std::max(scale[r], std::abs(predicted(rows[r], motion)));
    }
    check.largest = std::max(check.largest, scale[r]);
  }
  for (const Motion& motion : motions) {
    at.clear();
    for (const double steps : {-2.0, -1.0, 1.0, 2.0}) {
      apply(substep, motion, steps * step);
      at.push_back(values(substep, batch));
      substep.moving = saved;
    }
    std::vector<double> expected;
    for (const Row& row : rows) expected.push_back(predicted(row, motion));
    std::vector<double> beside;
    if (kinks) beside = one_sided(substep, batch, motion, expected);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double difference = (8.0 * (at[2][r] - at[1][r]) - (at[3][r] - at[0][r])) / (12.0 * step);
      if (kinks && std::abs(beside[r] - expected[r]) < std::abs(difference - expected[r])) {
        difference = beside[r];
      }
      const double error =
          std::abs(difference - predicted(rows[r], motion)) / std::max(scale[r], 1e-3);
      ++check.compared;
      if (!(error <= check.error)) {
        check.error = error;
        check.worst = "row " + std::to_string(r) + ", " +
                      (motion.rotation ? "rotation of \"" : "translation of \"") +
                      substep.bodies.name(motion.body) + "\": row says " +
                      std::to_string(predicted(rows[r], motion)) + ", differences say " +
                      std::to_string(difference);
      }
    }
  }
  return check;
}

void displace(Substep& substep, double distance, double angle, unsigned seed) {
  std::mt19937 random(seed);
  for (const Motion& motion : allowed_motions(substep)) {
    // Not std::uniform_real_distribution, whose numbers differ between libraries.
    const double unit = static_cast<double>(random()) / 2147483648.0 - 1.0;
    apply(substep, motion, unit * (motion.rotation ? angle : distance));
  }
}

}  // namespace sheave::test
