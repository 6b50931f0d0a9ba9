// How forces turn with bodies, against finite differences of the rows.
//
// Tolerance. Differences over e = 1e-6 of numbers of the size 1 leave e of truncation (second
// derivatives of gradients are some ones) and 1e-10 of rounding: 1e-4 of the largest has a margin
// of ten. Values are compared over a motion d of 1e-3 [m or rad]: what the second order leaves is
// d^3, 1e-9, times third derivatives of some tens.

#include "engine/solvers/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/index.h"
#include "engine/substep.h"
#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

/// Two free bodies of which one has a rotor, one in a plane, a slider, and a rotor on the world.
Model machine(Random& random) {
  Model model;
  model.bodies.push_back(lump("uneven", random.vector(1.0), 1.3));
  model.bodies.push_back(lump("even", random.vector(1.0), 0.7));
  model.bodies.back().inertia = Vector3(0.05, 0.05, 0.05);
  for (const Mobility mobility : {Mobility::planar, Mobility::slider, Mobility::rotor}) {
    BodyDef body = lump("body" + std::to_string(model.bodies.size()), random.vector(1.0), 2.1);
    body.mobility = mobility;
    body.axis = random.vector(1.0).normalized();
    model.bodies.push_back(body);
  }
  return model;
}

/// A row between points of two bodies, or of one and the world.
struct PointRow {
  int first = 0;
  int second = 0;
  Vector3 first_point = Vector3::Zero();  // of the body's own frame
  Vector3 second_point = Vector3::Zero();
  bool straight = false;  // along a direction that never turns
  Vector3 direction = Vector3::UnitX();

  void evaluate(const Substep& substep, Row& row) const {
    const Vector3 a = substep.point(first, first_point);
    const Vector3 b = substep.point(second, second_point);
    const double length = (b - a).norm();
    const Vector3 along = straight ? direction : Vector3((b - a) / length);
    row.value = straight ? direction.dot(a - b) : -length;
    if (first < substep.bodies.count()) substep.add_force(row, first, a, along);
    if (second < substep.bodies.count()) substep.add_force(row, second, b, -along);
    row.curved = true;
    row.turning = straight ? 0.0 : 1.0 / length;
  }
};

std::vector<PointRow> random_rows(Random& random, int bodies) {
  std::vector<PointRow> rows;
  for (int i = 0; i < 8; ++i) {
    PointRow row{random.below(bodies), random.below(bodies + 1)};
    if (row.second == row.first) row.second = bodies;
    row.first_point = random.vector(0.3);
    row.second_point = random.vector(row.second == bodies ? 2.0 : 0.3);
    row.straight = i % 3 == 2;
    row.direction = random.vector(1.0).normalized();
    rows.push_back(row);
  }
  return rows;
}

RowList evaluated(const std::vector<PointRow>& rows, const Substep& substep) {
  RowList list;
  for (const PointRow& row : rows) row.evaluate(substep, list.emplace_back());
  return list;
}

/// W J^T times the multipliers, along degrees of freedom.
std::vector<double> motion_of(const RowList& rows, const Substep& substep,
                              const std::vector<double>& multipliers) {
  const Coordinates& coordinates = substep.bodies.coordinates();
  std::vector<double> motion(at(coordinates.count()), 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const RowTerm& term : rows[i].active_terms()) {
      const BodyFreedom& freedom = coordinates[term.body];
      std::array<double, 6> parts{};
      std::array<double, 6> own{};
      project(freedom, substep.moving[at(term.body)], term.linear, term.angular, parts.data());
      weigh(freedom.kind, substep.moving[at(term.body)], parts.data(), own.data());
      for (int d = 0; d < size_of(freedom.kind); ++d) {
        motion[at(freedom.first + d)] += multipliers[i] * own[at(d)];
      }
    }
  }
  return motion;
}

void move(Substep& substep, const std::vector<double>& motion, double scale) {
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    MovingBody& body = substep.moving[at(freedom.body)];
    const double* own = motion.data() + freedom.first;
    body.position += scale * linear_motion(freedom, own);
    body.rotate(scale * angular_motion(freedom, body, own));
  }
}

TEST(Curvature, IsTheDerivativeOfTheForcesAndTheSecondDerivativeOfTheValues) {
  for (int seed = 1; seed <= 40; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto bodies = BodySet::create(machine(random));
    ASSERT_TRUE(bodies) << text(bodies.errors());
    const State state = bodies->initial_state();
    Substep substep(*bodies, state, 0.01, 1);
    const Coordinates& coordinates = bodies->coordinates();
    const std::vector<PointRow> points = random_rows(random, bodies->count());
    const RowList rows = evaluated(points, substep);
    std::vector<double> multipliers(rows.size());
    for (double& multiplier : multipliers) multiplier = random.between(-1.0, 1.0);
    std::vector<double> motion(at(coordinates.count()));
    for (double& part : motion) part = random.between(-1.0, 1.0);
    motion[0] = 0.0;
    Curvature curvature;
    ASSERT_TRUE(curvature.collect(rows, coordinates, substep.moving));
    std::vector<double> bent(motion.size(), 0.0);
    std::vector<double> second_order(rows.size(), 0.0);
    constexpr double small = 0.1;  // no span turns far
    for (double& part : motion) part *= small;
    ASSERT_TRUE(
        curvature.turn(coordinates, substep.moving, multipliers, motion, bent, second_order));

    constexpr double e = 1e-6;
    const std::vector<double> before = motion_of(rows, substep, multipliers);
    Substep moved = substep;
    move(moved, motion, e);
    const std::vector<double> after = motion_of(evaluated(points, moved), substep, multipliers);
    double largest = 0.0;
    for (const double part : bent) largest = std::max(largest, std::abs(part));
    for (std::size_t d = 0; d < bent.size(); ++d) {
      EXPECT_NEAR(bent[d], (after[d] - before[d]) / e, 1e-4 * largest) << seed << ' ' << d;
    }

    constexpr double step = 1e-2;  // of the motion: 1e-3
    Substep there = substep;
    move(there, motion, step);
    const RowList end = evaluated(points, there);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double linear = substep_change(rows[i], there.moving);
      const double expected = rows[i].value + linear + step * step * second_order[i];
      EXPECT_NEAR(end[i].value, expected, 1e-7) << seed << ' ' << i;
      // The linear part alone is off by far more, so that this says something.
      if (std::abs(second_order[i]) > 1e-2) {
        EXPECT_GT(std::abs(end[i].value - rows[i].value - linear), 5e-7) << seed << ' ' << i;
      }
    }
  }
}

TEST(Curvature, LeavesOutRowsOfConstantDirection) {
  // A weight on a slider below a fixed point, and one beside it.
  Model model;
  BodyDef weight = test::weight("weight", {0.0, -1.0, 0.0}, 1.0);
  weight.axis = Vector3::UnitY();
  model.add(weight);
  const auto bodies = BodySet::create(model);
  ASSERT_TRUE(bodies) << text(bodies.errors());
  const State state = bodies->initial_state();
  const Substep substep(*bodies, state, 0.01, 1);
  const Coordinates& coordinates = bodies->coordinates();
  Curvature curvature;
  PointRow row{0, 1};
  EXPECT_FALSE(curvature.collect(evaluated({row}, substep), coordinates, substep.moving));
  row.second_point = {0.5, 0.0, 0.0};
  EXPECT_TRUE(curvature.collect(evaluated({row}, substep), coordinates, substep.moving));
}

}  // namespace
}  // namespace sheave::test
