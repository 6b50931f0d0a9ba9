// The side of its wheel on which a cable runs, given by a word or by the shortest way.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/surface.h"
#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

std::shared_ptr<RollingLink> on_side(BodyId body, Side side) {
  auto link = roll(body, left);
  link->winding.reset();
  link->side = side;
  return link;
}

/// The machine with the shortest side in place of each winding between the ends of its cables.
test::Machine shortest(test::Machine machine) {
  for (CableDef& own : machine.cables) {
    for (auto& link : own.links) {
      const auto* rolling = dynamic_cast<const RollingLink*>(link.get());
      if (rolling == nullptr || rolling->stored_length) continue;
      auto other = std::make_shared<RollingLink>(*rolling);
      other->winding.reset();
      other->side = Side::shortest;
      link = other;
    }
  }
  return machine;
}

std::vector<int> windings(const test::Machine& machine) {
  std::vector<int> all;
  for (const CableReport& report : test::start(machine).cable_reports()) {
    for (const LinkReport& link : report.links) all.push_back(link.winding);
  }
  return all;
}

Errors side_faults(const test::Machine& machine) {
  const Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  return made ? Errors{} : made.errors();
}

void expect_side_fault(const test::Machine& machine, const std::string& path,
                       const std::string& word) {
  const Errors errors = side_faults(machine);
  ASSERT_EQ(errors.size(), 1u) << path << "\n" << test::text(errors);
  EXPECT_EQ(errors[0].path, path) << errors[0].message;
  EXPECT_NE(errors[0].message.find(word), std::string::npos) << errors[0].message;
}

TEST(CableSides, LeftIsCounterClockwiseAndRightIsClockwise) {
  for (const Side side : {Side::left, Side::right}) {
    test::Machine machine = test::Atwood{}.machine();
    const BodyId wheel{0};
    machine.cables[0].links[1] = roll(wheel, side == Side::left ? left : right);
    const std::vector<int> wound = windings(machine);
    machine.cables[0].links[1] = on_side(wheel, side);
    EXPECT_EQ(windings(machine), wound);
    EXPECT_EQ(wound[1], side == Side::left ? 1 : -1);
  }
}

TEST(CableSides, TheShortestWayIsThatOfMachinesWithGivenWindings) {
  for (const test::Machine& machine :
       {test::Atwood{}.machine(), test::Tackle{.strands = 2}.machine(),
        test::Tackle{.strands = 6}.machine()}) {
    EXPECT_EQ(windings(shortest(machine)), windings(machine));
  }
}

/// A cable from one point past wheels at these places to another point.
test::Machine past_wheels(const std::vector<Vector3>& centers, const Vector3& end) {
  test::Machine machine;
  machine.model.step = test::settings(0.01, 1, 1);
  CableDef rope = cable("rope", {attach(BodyId::world(), {-3.0, 0.0, 0.0})});
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const BodyId wheel =
        machine.model.add(test::wheel("wheel " + std::to_string(i), centers[i], 0.2, 0.01));
    rope.links.push_back(roll(wheel, left));
  }
  rope.links.push_back(attach(BodyId::world(), end));
  machine.cables.push_back(rope);
  return machine;
}

/// Length of the cable on these sides, one bit per wheel [m]; none if the cable is refused.
std::optional<double> length_on(test::Machine machine, unsigned sides) {
  auto& links = machine.cables[0].links;
  for (std::size_t i = 1; i + 1 < links.size(); ++i) {
    const unsigned bit = sides >> (i - 1) & 1U;
    links[i] = roll({static_cast<int>(i) - 1}, bit != 0 ? left : right);
  }
  const Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  if (!made) return {};
  return made->cable_reports()[0].total_length;
}

// Rounding of a length of some 20 m, and of the quantum of the stored lengths.
TEST(CableSides, TheShortestWayIsTheLeastOfAllSides) {
  test::Random random(7);
  int compared = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Vector3> centers;
    for (int i = 0; i < 5; ++i) {
      centers.emplace_back(-2.0 + i, random.between(-0.6, 0.6), 0.0);
    }
    const test::Machine machine = past_wheels(centers, {3.0, random.between(-1.0, 1.0), 0.0});
    const Result<Simulation> made = [&] {
      const test::Machine free = shortest(machine);
      return Simulation::create(free.model, free.cables);
    }();
    // A wheel that the cable would rather pass by is refused, as with a winding.
    if (!made) continue;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned sides = 0; sides < 32; ++sides) {
      if (const auto length = length_on(machine, sides)) least = std::min(least, *length);
    }
    EXPECT_NEAR(made->cable_reports()[0].total_length, least, 1e-12 * least);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(CableSides, ABeltNeedsTheSideOfOneWheel) {
  test::Machine machine = test::belt(0.2, 0.3, 1.5, 0.01, 0.01);
  auto& links = machine.cables[0].links;
  links = {on_side({0}, Side::shortest), on_side({1}, Side::shortest)};
  expect_side_fault(machine, "/cables/0/links/0/side", "equally long");
  links[0] = on_side({0}, Side::right);
  EXPECT_EQ(windings(machine), (std::vector<int>{-1, -1}));
}

TEST(CableSides, AStraightCableThroughAWheelsCentreHasNoShortestSide) {
  test::Machine machine = shortest(past_wheels({Vector3::Zero()}, {3.0, 0.0, 0.0}));
  expect_side_fault(machine, "/cables/0/links/1/side", "\"left\" or \"right\"");
}

TEST(CableSides, NeedExactlyOneOfSideAndWinding) {
  test::Machine machine = test::Atwood{}.machine();
  auto link = roll({0}, right);
  link->side = Side::right;
  machine.cables[0].links[1] = link;
  expect_side_fault(machine, "/cables/0/links/1/side", "exclude each other");
  link->side.reset();
  link->winding.reset();
  expect_side_fault(machine, "/cables/0/links/1", "\"winding\"");
  expect_side_fault(machine, "/cables/0/links/1", "\"shortest\"");
}

TEST(CableSides, ALiftedWheelHasNoShortestSide) {
  test::Machine machine = shortest(test::wheel_train(3, 1.0, 1.0, 0.1, 1e-3));
  auto link =
      std::make_shared<RollingLink>(dynamic_cast<const RollingLink&>(*machine.cables[0].links[1]));
  link->lifted = true;
  machine.cables[0].links[1] = link;
  expect_side_fault(machine, "/cables/0/links/1/side", "lifted");
}

TEST(CableSides, ASurfaceLinkTakesNoShortestSide) {
  test::Machine machine = past_wheels({{0.0, -0.1, 0.0}}, {3.0, 0.0, 0.0});
  auto link = std::make_shared<SurfaceLink>();
  link->body = {0};
  link->side = Side::shortest;
  machine.cables[0].links[1] = link;
  EXPECT_FALSE(side_faults(machine).empty());
  link->side = Side::right;
  EXPECT_TRUE(side_faults(machine).empty()) << test::text(side_faults(machine));
}

}  // namespace
}  // namespace sheave
