// The matrix that RowSlots assembles along degrees of freedom against J W K^T with whole vectors
// per body.

#include "engine/solvers/row_slots.h"

#include <map>

#include <gtest/gtest.h>

#include "engine/index.h"
#include "engine/substep.h"
#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

/// A body of every mobility, and two free ones of which one has equal moments of inertia.
Model every_mobility(Random& random) {
  Model model;
  model.bodies.push_back(lump("uneven", random.vector(1.0), 1.3));
  model.bodies.push_back(lump("even", random.vector(1.0), 0.7));
  model.bodies.back().inertia = Vector3(0.05, 0.05, 0.05);
  for (const Mobility mobility : {Mobility::planar, Mobility::slider, Mobility::rotor,
                                  Mobility::kinematic, Mobility::fixed}) {
    BodyDef body = lump("body" + std::to_string(model.bodies.size()), random.vector(1.0), 2.1);
    body.mobility = mobility;
    const bool has_axis =
        mobility == Mobility::planar || mobility == Mobility::slider || mobility == Mobility::rotor;
    if (has_axis) body.axis = random.vector(1.0).normalized();
    model.bodies.push_back(body);
  }
  model.bodies[2].angular_damping = 0.3;
  model.bodies[3].damping = 2.0;
  model.bodies.push_back(sheave("mounted", BodyId{0}, random.vector(1.0), 0.2, 0.4, 0.01));
  return model;
}

RowList random_rows(const Substep& substep, Random& random, int count) {
  RowList rows;
  for (int i = 0; i < count; ++i) {
    Row& row = rows.emplace_back();
    const int ends = 1 + random.below(2);
    for (int end = 0; end < ends; ++end) {
      const int body = random.below(substep.bodies.count() + 1);
      if (body == substep.bodies.count()) continue;
      substep.add_force(row, body, random.vector(1.0), random.vector(1.0));
    }
    row.tied = i > 0 && random.chance(0.3);
  }
  // Rows that share no unknown have the weight 1.
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool shares = rows[i].tied || (i + 1 < rows.size() && rows[i + 1].tied);
    rows[i].weight = shares ? random.between(0.5, 1.0) : 1.0;
  }
  return rows;
}

double along(const Row& row, const Row& other, std::span<const MovingBody> bodies) {
  RowResponse response;
  respond(other, bodies, response);
  double sum = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    for (std::size_t t = 0; t < at(other.term_count); ++t) {
      if (other.terms[t].body != term.body) continue;
      if (bodies[at(term.body)].translates) sum += dot(term.linear, response.linear[t]);
      if (response.turns[t]) sum += dot(term.angular, response.angular[t]);
    }
  }
  return sum;
}

TEST(RowSlots, MatrixEqualsThatOfWholeVectors) {
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    const Model model = every_mobility(random);
    const auto bodies = BodySet::create(model);
    ASSERT_TRUE(bodies) << text(bodies.errors());
    const State state = bodies->initial_state();
    const Substep substep(*bodies, state, 0.01, 1);
    const RowList rows = random_rows(substep, random, 12);
    RowSlots slots;
    EXPECT_TRUE(slots.fill(bodies->coordinates(), rows, substep.moving));
    EXPECT_FALSE(slots.fill(bodies->coordinates(), rows, substep.moving));
    slots.join(rows);
    slots.assemble(false);

    std::vector<int> unknown_of;
    for (const Row& row : rows) {
      unknown_of.push_back(row.tied ? unknown_of.back()
                                    : (unknown_of.empty() ? 0 : unknown_of.back() + 1));
    }
    std::map<std::pair<int, int>, double> expected;
    double largest = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) {
        const double value = rows[j].weight * along(rows[i], rows[j], substep.moving);
        expected[{unknown_of[i], unknown_of[j]}] += value;
        largest = std::max(largest, std::abs(value));
      }
    }
    // Sums of some ten products, in another order.
    const double tolerance = 1e-14 * largest;
    ASSERT_EQ(slots.unknown_count(), unknown_of.back() + 1);
    for (std::size_t e = 0; e < slots.entries().size(); ++e) {
      const auto [i, j] = slots.entries()[e];
      EXPECT_NEAR(slots.above()[e], (expected[{i, j}]), tolerance);
      EXPECT_NEAR(slots.below()[e], (expected[{j, i}]), tolerance);
      expected.erase({i, j});
      expected.erase({j, i});
    }
    for (int i = 0; i < slots.unknown_count(); ++i) {
      EXPECT_NEAR(slots.diagonal()[at(i)], (expected[{i, i}]), tolerance);
      expected.erase({i, i});
    }
    // What is no entry does not couple.
    for (const auto& [pair, value] : expected) EXPECT_NEAR(value, 0.0, tolerance);
  }
}

TEST(RowSlots, CopiesOfAnotherEditionAreMadeAnew) {
  Random random(6);
  const Model model = every_mobility(random);
  const auto bodies = BodySet::create(model);
  ASSERT_TRUE(bodies) << text(bodies.errors());
  const State state = bodies->initial_state();
  Substep substep(*bodies, state, 0.01, 1);
  Row source;
  source.add(0, Vector3::UnitX(), Vector3::Zero());
  RowList rows;
  RowSlots slots;
  const auto diagonal = [&] {
    rows.clear();
    rows.append_copy(source);
    slots.fill(bodies->coordinates(), rows, substep.moving);
    slots.join(rows);
    slots.assemble(true);
    return slots.diagonal()[0];
  };
  const double first = diagonal();
  source.terms[0].linear *= 2.0;
  EXPECT_EQ(diagonal(), first) << "its edition has not changed";
  ++source.edition;
  EXPECT_EQ(diagonal(), 4.0 * first);
  // Copies of it touch what it touches now.
  source.terms[0].body = 3;
  ++source.edition;
  EXPECT_NE(diagonal(), 4.0 * first);
}

}  // namespace
}  // namespace sheave::test
