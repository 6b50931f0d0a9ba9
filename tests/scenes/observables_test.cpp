#include "scenes/observables.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/reactions.h"
#include "scenes/generators.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// A free lump that turns and falls, and a wheel with a cable.
Machine machine() {
  Machine m;
  m.model.gravity = down;
  BodyDef body = lump("lump", {1.0, 2.0, 3.0}, 2.0);
  body.velocity = {0.5, 1.0, -1.0};
  body.angular_velocity = {0.0, 0.0, 2.0};
  m.model.add(body);
  const BodyId turning = m.model.add(wheel("drum", Vector3::Zero(), 0.5, 0.3));
  const BodyId load = m.model.add(weight("load", {0.5, -2.0, 0.0}, 1.0));
  auto end = roll(turning, right);
  end->stored_length = 3.0;
  m.cables.push_back(cable("rope", {end, attach(load)}));
  return m;
}

double value(const ObservableSet& set, const Simulation& simulation, std::string_view name) {
  const Result<int> index = set.index_of(name);
  EXPECT_TRUE(index) << name;
  std::vector<double> values;
  set.sample(simulation, values);
  return values.at(static_cast<std::size_t>(*index));
}

TEST(Observables, HaveTheValuesOfTheSimulation) {
  Simulation simulation = start(machine());
  const ObservableSet set(simulation);
  run(simulation.world, 0.5);
  const World& world = simulation.world;
  const BodyId lump{0};
  EXPECT_EQ(value(set, simulation, "t"), world.state().time);
  EXPECT_EQ(value(set, simulation, "lump.x"), world.position(lump).x());
  EXPECT_EQ(value(set, simulation, "lump.z"), world.position(lump).z());
  EXPECT_EQ(value(set, simulation, "lump.qw"), world.orientation(lump).w());
  EXPECT_EQ(value(set, simulation, "lump.qz"), world.orientation(lump).z());
  EXPECT_EQ(value(set, simulation, "lump.vy"), world.velocity(lump).y());
  EXPECT_EQ(value(set, simulation, "lump.wz"), world.angular_velocity(lump).z());
  EXPECT_EQ(value(set, simulation, "drum.angle"), world.state().bodies[1].angle);
  const CableReport rope = simulation.cable_reports()[0];
  EXPECT_EQ(value(set, simulation, "rope.0.tension"), rope.spans[0].tension);
  EXPECT_EQ(value(set, simulation, "rope.0.length"), rope.spans[0].length);
  EXPECT_EQ(value(set, simulation, "rope.0.rest_length"), rope.spans[0].rest_length);
  EXPECT_EQ(value(set, simulation, "rope.link0.stored_length"), rope.links[0].stored_length);
  EXPECT_EQ(value(set, simulation, "rope.length_error"), rope.length_error);
  EXPECT_EQ(value(set, simulation, "energy.total"), world.energy().total());
  EXPECT_EQ(value(set, simulation, "energy.kinetic"), world.energy().kinetic);
  EXPECT_GT(value(set, simulation, "rope.0.tension"), 1.0);
}

TEST(Observables, OfADefinitionEqualThoseOfItsSimulation) {
  const Machine m = machine();
  EXPECT_EQ(ObservableSet(m.model, m.cables).names(), ObservableSet(start(m)).names());
}

TEST(Observables, NamesAreUniqueAndTheNumberIsAsDocumented) {
  const Machine m = machine();
  const std::vector<std::string> names = ObservableSet(m.model, m.cables).names();
  // time, 3 bodies, 1 span, 2 links, the cable, energies
  const std::size_t columns = 1U + 3U * 14U + 5U + 2U * 9U + 5U + 4U;
  EXPECT_EQ(ObservableSet(m.model, m.cables).default_count(), columns);
  // On request: momentum of 3 bodies, a rotor's bearings, the span's direction and floor, friction of
  // 2 links, the cable's memory and floor, sums
  EXPECT_EQ(names.size(), columns + 3U * 6U + 8U + 4U + 2U + 3U + 6U + 2U);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Observables, ASelectionHasTheSameValues) {
  Simulation simulation = start(machine());
  run(simulation.world, 0.1);
  const ObservableSet set(simulation);
  std::vector<double> all;
  set.sample(simulation, all);
  std::vector<int> indices;
  for (int i = static_cast<int>(all.size()) - 1; i >= 0; i -= 2) indices.push_back(i);
  std::vector<double> some(indices.size());
  set.sample(simulation, indices, some);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    EXPECT_EQ(some[i], all[static_cast<std::size_t>(indices[i])])
        << set.names()[static_cast<std::size_t>(indices[i])];
  }
}

TEST(Observables, UnknownNamesGetASuggestion) {
  const Machine m = machine();
  const ObservableSet set(m.model, m.cables);
  EXPECT_THAT(set.index_of("rope.0.tensoin").errors()[0].message,
              testing::HasSubstr("did you mean \"rope.0.tension\"?"));
  EXPECT_THAT(set.index_of("what").errors()[0].message, testing::HasSubstr("allowed are t,"));
  EXPECT_FALSE(set.index_of("rope.1.tension"));
  EXPECT_FALSE(set.index_of(""));
}

TEST(Observables, OnlyTensionsAreUnknownAtTheStart) {
  const Machine m = machine();
  const ObservableSet set(m.model, m.cables);
  for (std::size_t i = 0; i < set.default_count(); ++i) {
    const bool is_tension = set.names()[i].ends_with("tension");
    EXPECT_EQ(set.known_at_start(static_cast<int>(i)), !is_tension) << set.names()[i];
  }
}

TEST(Observables, RequestedOnesAgreeWithTheSimulation) {
  Machine m = machine();
  m.model.bodies[1].drive = DriveKind::speed;
  m.model.bodies[1].drive_values = {-1.0};
  Simulation simulation = start(m);
  const ObservableSet set(simulation);
  const auto asked = [&](std::string_view name) {
    const Result<int> index = set.index_of(name);
    EXPECT_TRUE(index) << name;
    double result = 0.0;
    set.sample(simulation, std::span(&*index, 1), std::span(&result, 1));
    return result;
  };
  EXPECT_TRUE(std::isnan(asked("drum.bearing_fy"))) << "nothing is known before the first step";
  EXPECT_FALSE(set.known_at_start(*set.index_of("drum.bearing_fy")));
  EXPECT_TRUE(set.known_at_start(*set.index_of("lump.momentum_x")));
  run(simulation.world, 0.2);
  const Reactions reactions = std::move(*Reactions::of(simulation));
  EXPECT_EQ(asked("drum.bearing_fy"), reactions.bearing(1).force.y());
  EXPECT_EQ(asked("drum.bearing_force"), reactions.bearing(1).force.norm());
  EXPECT_EQ(asked("drum.bearing_torque"), reactions.bearing(1).torque.norm());
  EXPECT_EQ(asked("drum.bearing_tx"), reactions.bearing(1).torque.x());
  EXPECT_EQ(asked("drum.drive_torque"), reactions.drive(1).torque);
  EXPECT_EQ(asked("drum.drive_power"), reactions.drive(1).power);
  EXPECT_EQ(asked("drum.drive_error"), reactions.drive(1).error);
  EXPECT_EQ(asked("power.drives"), reactions.drive_power());
  EXPECT_EQ(asked("power.friction"), 0.0);
  EXPECT_EQ(asked("rope.link1.friction_power"), 0.0);
  EXPECT_EQ(asked("lump.momentum_z"), momentum(simulation.world, 0).linear.z());
  EXPECT_EQ(asked("lump.angular_momentum_z"), momentum(simulation.world, 0).angular.z());
  EXPECT_EQ(asked("momentum.linear_y"), momentum(simulation.world).linear.y());
  EXPECT_EQ(asked("momentum.angular_x"), momentum(simulation.world).angular.x());
  EXPECT_NEAR(asked("rope.0.direction_y"), -1.0, 1e-12) << "straight down";
}

TEST(Observables, LengthsOfACableAddUpInMotion) {
  const SceneResult scene = generate_scene("wheel-train", {{"wheels", "5"}});
  ASSERT_TRUE(scene);
  auto simulation = Simulation::create(scene->model, scene->cables);
  ASSERT_TRUE(simulation);
  const ObservableSet set(*simulation);
  const auto total = [&] {
    std::vector<double> values;
    set.sample(*simulation, values);
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string& name = set.names()[i];
      if (name.ends_with(".rest_length") || name.ends_with(".stored_length")) sum += values[i];
    }
    return sum;
  };
  const double before = total();
  run(simulation->world, 1.0);
  EXPECT_NEAR(total(), before, 1e-12 * before);
}

}  // namespace
}  // namespace sheave::test
