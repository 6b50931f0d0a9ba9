#include "scenes/quantity_list.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// Two lumps with known velocities in free fall, and a weight on a rope.
Machine listed_machine() {
  Machine m;
  m.model.gravity = down;
  for (const char* name : {"first", "second"}) {
    const double side = name[0] == 'f' ? 1.0 : -1.0;
    BodyDef body = lump(name, {side, 2.0, 3.0}, 2.0);
    body.velocity = {4.0 * side, 1.0, 0.0};
    m.model.add(body);
  }
  const BodyId load = m.model.add(weight("load", {0.5, -2.0, 0.0}, 1.0));
  m.cables.push_back(cable("hoist-rope", {attach(BodyId{}, {0.5, 0.0, 0.0}), attach(load)}));
  return m;
}

QuantityList list_of(const Simulation& simulation, const std::vector<std::string>& texts) {
  QuantityList list(QuantityIndex::of(simulation, texts));
  for (const std::string& one : texts) EXPECT_EQ(text(list.add(one)), "");
  return list;
}

TEST(QuantityLists, HaveTheValuesAndUnitsOfTheirQuantities) {
  Simulation simulation = start(listed_machine());
  run(simulation.world, 0.5);
  const QuantityList list =
      list_of(simulation, {"first.x", "first.x - second.x", "hypot(first.vx, first.vy)",
                           "hoist-rope.0.tension / 2", "first.momentum_x / 2", "first.x"});
  ASSERT_EQ(list.size(), 6U);
  std::vector<double> values(list.size());
  list.sample(simulation, values);
  const World& world = simulation.world;
  const double x0 = world.position(BodyId{0}).x();
  EXPECT_EQ(values[0], x0);
  EXPECT_EQ(values[1], x0 - world.position(BodyId{1}).x());
  EXPECT_NEAR(values[1], 2.0 + 8.0 * 0.5, 1e-12) << "they part at 8 m/s";
  // The fall of 0.5 s has the speed 1 - g 0.5.
  EXPECT_NEAR(values[2], std::hypot(4.0, 1.0 - 0.5 * g), 1e-9);
  EXPECT_NEAR(values[3], 0.5 * g, 1e-9) << "half the weight of the load";
  EXPECT_NEAR(values[4], 4.0, 1e-12) << "m v / m";
  EXPECT_EQ(values[5], values[0]);
  EXPECT_EQ(list.unit(0), "m");
  EXPECT_EQ(list.unit(2), "m/s");
  EXPECT_EQ(list.unit(3), "N");
  EXPECT_EQ(list.unit(4), "kg m/s");
  EXPECT_EQ(list.text(0), "first.x");
  EXPECT_EQ(list.text(1), "first.x - second.x");
}

TEST(QuantityLists, AnExpressionIsKnownIfAllItsQuantitiesAre) {
  Simulation simulation = start(listed_machine());
  const QuantityList list =
      list_of(simulation, {"first.x - load.y", "first.x * hoist-rope.0.tension",
                           "power.friction + 0 * power.drives", "hoist-rope.0.tension"});
  EXPECT_TRUE(list.known_at_start(0));
  EXPECT_FALSE(list.known_at_start(1));
  EXPECT_TRUE(list.follows_from_state(1));
  EXPECT_FALSE(list.follows_from_state(2));
  std::vector<double> values(list.size());
  list.observe(simulation, values);
  EXPECT_EQ(values[0], 3.0);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_TRUE(std::isnan(values[3]));
  run(simulation.world, 0.1);
  list.observe(simulation, values);
  EXPECT_FALSE(std::isnan(values[1]));
}

TEST(QuantityLists, ManyExpressionsEvaluateEachQuantityOnce) {
  Simulation simulation = start(listed_machine());
  run(simulation.world, 0.1);
  const ObservableSet set(simulation);
  QuantityList list(std::make_shared<const QuantityIndex>(ObservableSet(simulation)));
  std::vector<double> expected(set.names().size());
  std::vector<int> indices;
  for (std::size_t i = 0; i < set.names().size(); ++i) {
    indices.push_back(static_cast<int>(i));
    // Names with hyphens need no quotes.
    EXPECT_EQ(text(list.add(fmt::format("1 * {} + 0", set.names()[i]))), "");
  }
  set.sample(simulation, indices, expected);
  std::vector<double> values(list.size());
  list.sample(simulation, values);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i])) continue;
    EXPECT_EQ(values[i], expected[i]) << set.names()[i];
  }
}

TEST(QuantityLists, FaultsSuggestAName) {
  const Simulation simulation = start(listed_machine());
  QuantityList list(QuantityIndex::of(simulation, {}));
  EXPECT_THAT(text(list.add("first.x - secnd.x")),
              testing::HasSubstr("column 11: there is no quantity \"secnd.x\", did you mean "
                                 "\"second.x\"?"));
  EXPECT_THAT(text(list.add("2 * hoist-rope.0.tensoin")),
              testing::HasSubstr("did you mean \"hoist-rope.0.tension\"?"));
  EXPECT_EQ(list.size(), 0U);
}

}  // namespace
}  // namespace sheave::test
