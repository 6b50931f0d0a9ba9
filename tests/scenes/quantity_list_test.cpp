#include "scenes/quantity_list.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/shapes/sphere.h"
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
  QuantityList list(std::make_shared<const QuantityIndex>(simulation));
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

TEST(QuantityLists, HaveSettingsOfTheScene) {
  Machine machine;
  BodyDef body = lump("heavy load", {1.0, 2.0, 3.0}, 2.5);
  body.shapes.clear();
  auto sphere = std::make_shared<Sphere>();
  sphere->radius = 0.25;
  PlacedShape placed;
  placed.shape = sphere;
  body.shapes.push_back(placed);
  machine.model.add(body);
  machine.model.gravity = {0.0, -10.0, 0.0};
  const Simulation simulation = start(machine);
  const auto value = [&](const std::string& one) {
    const std::vector<std::string> texts{one};
    QuantityList list(QuantityIndex::of(simulation, texts));
    const Errors errors = list.add(one);
    EXPECT_TRUE(errors.empty()) << text(errors);
    double number = 0.0;
    if (errors.empty()) list.sample(simulation, {&number, 1});
    return errors.empty() ? fmt::format("{} {}", number, list.unit(0)) : text(errors);
  };
  EXPECT_EQ(value("/bodies/heavy load/mass"), "2.5 kg");
  EXPECT_EQ(value("/bodies/0/mass"), "2.5 kg");
  EXPECT_EQ(value("/bodies/heavy load/shape/radius"), "0.25 m");
  EXPECT_EQ(value("/bodies/heavy load/shapes/0/radius"), "0.25 m");
  EXPECT_EQ(value("/bodies/heavy load/position/2"), "3 m");
  EXPECT_EQ(value("-/bodies/heavy load/mass * /gravity/1"), "25 N");
  EXPECT_EQ(value("/step/dt * 60"), fmt::format("{} s", machine.model.step.dt * 60));
}

TEST(QuantityLists, FaultsOfSettingsTellTheirPlace) {
  Machine machine;
  machine.model.add(lump("load", {0.0, 0.0, 0.0}, 2.5));
  const Simulation simulation = start(machine);
  QuantityList list(QuantityIndex::of(simulation, std::vector<std::string>{"/x"}));
  const auto fault = [&](const std::string& one) { return text(list.add(one)); };
  using testing::HasSubstr;
  EXPECT_THAT(fault("/bodies/lod/mass"),
              HasSubstr("there is no body \"lod\", did you mean \"load\"?"));
  EXPECT_THAT(fault("/bodies/load/mas"), HasSubstr("a body has no setting \"mas\", did you mean"));
  EXPECT_THAT(fault("/bodies/load/position"),
              HasSubstr("position has 3 numbers, from position/0 on"));
  EXPECT_THAT(fault("/bodies/load/mobility"), HasSubstr("mobility is no number"));
  EXPECT_THAT(fault("/duration"), HasSubstr("it begins with /bodies/NAME"));
  EXPECT_THAT(fault("max(load.x)"),
              HasSubstr("has a statistic over time, and here a quantity has"));
}

TEST(QuantityLists, FollowARun) {
  Machine machine;
  BodyDef body = lump("load", {0.0, 0.0, 0.0}, 2.0);
  body.velocity = {3.0, 0.0, 0.0};
  machine.model.add(body);
  Simulation simulation = start(machine);
  QuantityList list(QuantityIndex::of(simulation, {}), Taken::along_run);
  EXPECT_TRUE(list.add("max(load.x) - load.x").empty());
  EXPECT_TRUE(list.add("integral(load.x)").empty());
  ASSERT_EQ(list.course_count(), 2U);
  std::vector<Course> courses(2);
  std::array<double, 2> values{};
  list.follow(simulation, courses, values);
  const double dt = machine.model.step.dt;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(simulation.step().ok());
    list.follow(simulation, courses, values);
  }
  EXPECT_EQ(values[0], 0.0);
  // The trapezium rule is exact for x = 3 t; 60 sums of rounded numbers.
  const double time = 60 * dt;
  EXPECT_NEAR(values[1], 1.5 * time * time, 60 * 1e-15 * 1.5 * time * time);
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
