// What a cable's definition can get wrong, and what compiling makes of a right one.

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "cable/span_geometry.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

std::shared_ptr<RollingLink> spool(BodyId body, Winding winding, double stored) {
  auto link = roll(body, winding);
  link->stored_length = stored;
  return link;
}

void expect_fault(const std::string& path, const std::function<void(test::Machine&)>& spoil) {
  test::Machine machine = test::Atwood{}.machine();
  spoil(machine);
  const Result<Simulation> simulation = Simulation::create(machine.model, machine.cables);
  ASSERT_FALSE(simulation.ok()) << path;
  const Errors& errors = simulation.errors();
  ASSERT_EQ(errors.size(), 1u) << path << "\n" << test::text(errors);
  EXPECT_EQ(errors[0].path, path) << errors[0].message;
  EXPECT_GT(errors[0].message.size(), 10u);
}

TEST(CableCompile, RefusesEmptyAndRepeatedNames) {
  expect_fault("/cables/0/name", [](test::Machine& m) { m.cables[0].name = ""; });
  expect_fault("/cables/1/name", [](test::Machine& m) { m.cables.push_back(m.cables[0]); });
}

TEST(CableCompile, RefusesSettingsOutOfRange) {
  for (const double bad : {-1.0, nan_value, infinite}) {
    expect_fault("/cables/0/compliance", [&](test::Machine& m) { m.cables[0].compliance = bad; });
    expect_fault("/cables/0/axial_stiffness",
                 [&](test::Machine& m) { m.cables[0].axial_stiffness = bad; });
    expect_fault("/cables/0/damping", [&](test::Machine& m) {
      m.cables[0].compliance = 0.1;
      m.cables[0].damping = bad;
    });
    expect_fault("/cables/0/rest_lengths/1", [&](test::Machine& m) {
      m.cables[0].rest_lengths = {2.0, bad};
    });
  }
  expect_fault("/cables/0/axial_stiffness", [](test::Machine& m) {
    m.cables[0].compliance = 0.1;
    m.cables[0].axial_stiffness = 100.0;
  });
  expect_fault("/cables/0/damping", [](test::Machine& m) { m.cables[0].damping = 1.0; });
  expect_fault("/cables/0/damping", [](test::Machine& m) {
    m.cables[0].compliance = 0.0;
    m.cables[0].damping = 1.0;
  });
}

TEST(CableCompile, RefusesWrongRestLengths) {
  expect_fault("/cables/0/rest_lengths",
               [](test::Machine& m) { m.cables[0].rest_lengths = {2.0}; });
  expect_fault("/cables/0/rest_lengths/0", [](test::Machine& m) {
    m.cables[0].rest_lengths = {1.9, 2.0};
  });
  test::Machine elastic = test::Atwood{}.machine();
  elastic.cables[0].rest_lengths = {1.9, 2.5};
  elastic.cables[0].compliance = 0.01;
  EXPECT_TRUE(Simulation::create(elastic.model, elastic.cables).ok());
}

TEST(CableCompile, RefusesWrongLinks) {
  expect_fault("/cables/0/links", [](test::Machine& m) { m.cables[0].links.clear(); });
  expect_fault("/cables/0/links", [](test::Machine& m) { m.cables[0].links.resize(1); });
  expect_fault("/cables/0/links/1/body", [](test::Machine& m) {
    m.model.bodies[0].shapes.clear();  // no wheel to roll on
  });
  expect_fault("/cables/0/links/1/radius", [](test::Machine& m) {
    auto link = roll({0}, right);
    link->radius = 0.0;
    m.cables[0].links[1] = link;
  });
  expect_fault("/cables/0/links/1/normal", [](test::Machine& m) {
    auto link = roll({0}, right);
    link->normal = Vector3::Zero();
    m.cables[0].links[1] = link;
  });
  expect_fault("/cables/0/links/1/normal", [](test::Machine& m) {
    auto link = roll({0}, right);
    link->normal = Vector3(0.1, 0.0, 1.0);  // not the wheel's axis
    m.cables[0].links[1] = link;
  });
  expect_fault("/cables/0/links/1/turns", [](test::Machine& m) {
    auto link = roll({0}, right);
    link->turns = -1;
    m.cables[0].links[1] = link;
  });
  expect_fault("/cables/0/links/2/point/0", [](test::Machine& m) {
    m.cables[0].links[2] = attach({2}, {nan_value, 0.0, 0.0});
  });
}

TEST(CableCompile, RefusesWrongStoredLengths) {
  expect_fault("/cables/0/links/0", [](test::Machine& m) {
    m.cables[0].links = {roll({0}, right), attach({2})};
  });
  expect_fault("/cables/0/links/1/stored_length",
               [](test::Machine& m) { m.cables[0].links[1] = spool({0}, right, 1.0); });
  expect_fault("/cables/0/links/0/stored_length", [](test::Machine& m) {
    m.cables[0].links = {spool({0}, right, -1.0), attach({2})};
  });
  expect_fault("/cables/0/links/0/turns", [](test::Machine& m) {
    auto drum = spool({0}, right, 1.0);
    drum->turns = 2;
    m.cables[0].links = {drum, attach({2})};
  });
}

TEST(CableCompile, SpansNeedATangent) {
  expect_fault("/cables/0/links/1", [](test::Machine& m) {
    m.cables[0].links[0] = attach(BodyId::world(), {0.1, 0.1, 0.0});  // inside the wheel
  });
  const auto two_wheels = [](double distance, double radius, Winding second) {
    return [=](test::Machine& m) {
      const BodyId id = m.model.add(test::wheel("second", {distance, 0.0, 0.0}, radius, 0.01));
      m.cables[0].links = {attach({1}), roll({0}, right), roll(id, second),
                           attach(BodyId::world(), {0.0, -5.0, 0.0})};
    };
  };
  expect_fault("/cables/0/links/2", two_wheels(0.4, 0.2, left));    // crossing, overlapping
  expect_fault("/cables/0/links/2", two_wheels(0.1, 0.05, right));  // nested
  test::Machine overlapping = test::Atwood{}.machine();
  two_wheels(0.4, 0.2, right)(overlapping);  // the outer tangent exists
  EXPECT_TRUE(Simulation::create(overlapping.model, overlapping.cables).ok());
  expect_fault("/cables/0/links/1", [](test::Machine& m) {
    m.cables[0].links = {attach({1}), attach({1}, {0.1, 0.0, 0.0})};
  });
}

TEST(CableCompile, EccentricWheelsOfMountedRotorsTurnWithTheRotor) {
  test::Machine machine = test::Tackle{}.machine();
  auto link = roll({2}, left);
  link->center = Vector3(0.01, 0.0, 0.0);
  machine.cables[0].links[1] = link;
  Simulation s = test::start(machine);
  const Vector3 before = s.cable_reports()[0].links[1].center;
  EXPECT_NEAR((before - s.world.position({2})).norm(), 0.01, 1e-15);
  test::run(s.world, 0.5);
  const Vector3 arm = s.cable_reports()[0].links[1].center - s.world.position({2});
  EXPECT_GT(std::abs(angle_between(Vector3::UnitX(), arm / arm.norm(), Vector3::UnitZ())), 0.1);
  EXPECT_NEAR((arm - s.world.orientation({2}) * Vector3(0.01, 0.0, 0.0)).norm(), 0.0, 1e-15);
}

TEST(CableCompile, FaultsOfAllCablesAndJointsAreReportedTogether) {
  test::Machine machine = test::Atwood{}.machine();
  machine.cables.push_back(machine.cables[0]);
  machine.cables[0].damping = 1.0;
  machine.cables[1].name = "second";
  machine.cables[1].compliance = -1.0;
  machine.model.step.dt = -1.0;
  const Result<Simulation> simulation = Simulation::create(machine.model, machine.cables);
  ASSERT_FALSE(simulation.ok());
  EXPECT_EQ(simulation.errors().size(), 3u) << test::text(simulation.errors());
}

TEST(CableCompile, NullPointersAndUnknownChoicesAreFaults) {
  test::Machine machine;
  machine.model.bodies = {test::wheel("wheel", {0.0, 0.0, 0.0}, 0.5, 1.0)};
  machine.model.joints = {nullptr};
  machine.cables = {test::cable("rope", {test::attach(BodyId::world(), {-0.5, -1.0, 0.0}), nullptr,
                                         test::attach(BodyId::world(), {0.5, -1.0, 0.0})})};
  const Errors errors = Simulation::check(machine.model, machine.cables);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].path, "/cables/0/links/1");
  EXPECT_EQ(errors[1].path, "/joints/0");
  machine.model.joints.clear();
  machine.cables.clear();
  machine.model.bodies[0].mobility = static_cast<Mobility>(55);
  machine.model.step.solver = static_cast<SolverKind>(9);
  EXPECT_EQ(Simulation::check(machine.model, {}).front().path, "/bodies/0/mobility");
  machine.model.bodies[0].mobility = Mobility::rotor;
  EXPECT_EQ(Simulation::check(machine.model, {}).front().path, "/step/solver");
}

TEST(CableCompile, StoredLengthIsTheArcAndWholeTurns) {
  for (const int turns : {0, 1, 5}) {
    test::Machine machine = test::Atwood{}.machine();
    auto link = roll({0}, right);
    link->turns = turns;
    machine.cables[0].links[1] = link;
    const CableReport report = test::start(machine).cable_reports()[0];
    // Rounded to the quantum, 2^-50 of the length.
    EXPECT_NEAR(report.links[1].stored_length, 0.25 * pi * (1 + 2 * turns), 1e-13);
    EXPECT_NEAR(report.links[1].wrap_angle, pi * (1 + 2 * turns), 1e-12);
    EXPECT_NEAR(report.total_length, 4.0 + 0.25 * pi * (1 + 2 * turns), 1e-13);
  }
}

TEST(CableCompile, ClosedBeltHasTheTextbookLength) {
  // Open belt: 2 sqrt(d^2 - (R - r)^2) + R (pi + 2 b) + r (pi - 2 b), sin b = (R - r) / d.
  const CableReport report = test::start(test::belt(0.3, 0.1, 1.0, 0.1, 0.1)).cable_reports()[0];
  const double b = std::asin(0.2);
  EXPECT_NEAR(report.total_length,
              2.0 * std::sqrt(1.0 - 0.04) + 0.3 * (pi + 2 * b) + 0.1 * (pi - 2 * b), 1e-13);
}

}  // namespace
}  // namespace sheave
