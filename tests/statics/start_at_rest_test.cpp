// Runs that start at rest stay there, and machines without a rest tell why they have none.

#include "statics/start_at_rest.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/statics/scene_at_rest.h"

namespace sheave::testing {
namespace {

constexpr double share = 0.05;

/// A load of 2 kg on a rope over a wheel; `rope` has the settings of the rope.
std::string load_over_wheel(const std::string& rope, const std::string& of_load = "") {
  return R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 1,
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0])" +
         of_load + R"(}],
  "cables": [{"name": "rope", )" +
         rope + R"(, "links": [
    {"type": "attachment", "body": "world", "point": [-0.5, -1, 0]},
    {"type": "rolling", "body": "wheel", "winding": "clockwise"},
    {"type": "attachment", "body": "load"}]}])";
}

std::string hanging_load(const std::string& rope, const std::string& of_load = "") {
  return R"("bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
      "position": [0, -1, 0])" +
         of_load + R"(}],
  "cables": [{"name": "rope", )" +
         rope + R"(, "links": [
    {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}])";
}

std::string message_of(const Errors& errors) { return errors.empty() ? "" : errors[0].message; }

void expect_no_rest(const std::string& parts, const std::string& words) {
  Simulation simulation = simulation_of(parts);
  const std::uint64_t before = hash(simulation.world.state());
  const std::string message = message_of(start_at_rest(simulation));
  EXPECT_NE(message.find("cannot start at rest: "), std::string::npos) << message;
  EXPECT_NE(message.find(words), std::string::npos) << message;
  EXPECT_NE(message.find("\"start\": \"pose\""), std::string::npos) << message;
  EXPECT_EQ(hash(simulation.world.state()), before) << "an error changes nothing";
}

// The search ends with residual forces below 1e-11 of the weight. A load of mass m on springs of
// stiffness k then swings with 1e-11 m g / k at most, and its tension with as much of the weight.
// Rounding of positions, 1e-16 x 2 m, changes the tension of 2000 N/m by 4e-13 N per substep, of
// 20 N; in 3840 substeps that is 7e-11 if all errors have one sign.
TEST(StartAtRest, KeepsALoadOnARopeOverAWheelInItsPlace) {
  for (const char* rope : {R"("compliance": 0.0005)", R"("axial_stiffness": 4000)",
                           R"("compliance": 0.0005, "damping": 3)"}) {
    for (const char* integrator : {"xpbd", "rattle"}) {
      for (const int substeps : {1, 4, 16, 64}) {
        SCOPED_TRACE(std::string(rope) + " " + integrator + " x " + std::to_string(substeps));
        Simulation simulation = simulation_of(
            load_over_wheel(rope) + R"(, "step": {"solver": "direct", "integrator": ")" +
            integrator + R"(", "substeps": )" + std::to_string(substeps) + "}");
        ASSERT_EQ(message_of(start_at_rest(simulation)), "");
        const double energy = simulation.world.energy().total();
        const double height = simulation.world.position(BodyId{1}).y();
        EXPECT_LT(height, -2.0) << "the rope is stretched";
        for (int i = 0; i < 60; ++i) {
          ASSERT_TRUE(simulation.step().ok());
          for (const std::size_t span : {0U, 1U}) {
            EXPECT_NEAR(tension(simulation, 0, span), 20.0, 20.0 * 1e-9);
          }
        }
        EXPECT_NEAR(simulation.world.energy().total(), energy, 1e-9 * std::abs(energy));
        EXPECT_NEAR(simulation.world.position(BodyId{1}).y(), height, 1e-9);
      }
    }
  }
}

TEST(StartAtRest, KeepsTheTimeAndTheDrives) {
  Simulation simulation = simulation_of(hanging_load(R"("compliance": 0.002)"));
  ASSERT_EQ(message_of(start_at_rest(simulation)), "");
  EXPECT_EQ(simulation.world.state().time, 0.0);
  EXPECT_EQ(simulation.world.state().steps, 0);
  EXPECT_NEAR(simulation.world.position(BodyId{0}).y(), -1.04, 1e-10);
  EXPECT_NEAR(tension(simulation, 0, 0), 20.0, 1e-9);
}

TEST(StartAtRest, TellsThatNothingHoldsABody) {
  expect_no_rest(R"("bodies": [{"name": "stone", "mass": 1, "inertia": [1, 1, 1]}])", "\"stone\"");
}

TEST(StartAtRest, TellsThatTheEquilibriumIsUnstable) {
  // The rod stands on its hinge.
  expect_no_rest(R"("bodies": [{"name": "rod", "mobility": "planar", "mass": 1,
      "inertia": [1, 1, 1], "position": [0, 1, 0]}],
    "joints": [{"type": "hinge", "name": "foot", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1]}])",
                 "unstable: 1 of 1 independent motions run away, most of all body \"rod\"");
}

TEST(StartAtRest, TellsAnInitialVelocity) {
  expect_no_rest(hanging_load(R"("compliance": 0.002)", R"(, "velocity": [0, 3, 0])"),
                 "body \"load\" has an initial velocity, 3 m/s");
}

TEST(StartAtRest, TellsThatACableParts) {
  // Each of two equal ropes takes half of 20 N, and the weak one breaks at 5 N.
  expect_no_rest(R"("bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
      "position": [0, -1, 0]}],
    "cables": [{"name": "weak", "compliance": 0.002, "breaking_tension": 5, "links": [
        {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]},
      {"name": "strong", "compliance": 0.002, "links": [
        {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}])",
                 "cable \"weak\" parts on the way");
}

TEST(UnsettledSpan, IsOneThatBouncesFromAnUnstretchedRope) {
  const auto found =
      find_unsettled_span(simulation_of(hanging_load(R"("compliance": 0.002)")), share);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cable, 0);
  EXPECT_EQ(found->span, 0);
  EXPECT_EQ(found->start, 0.0);
  EXPECT_NEAR(found->rest, 20.0, 1e-8);
  EXPECT_TRUE(
      find_unsettled_span(simulation_of(load_over_wheel(R"("axial_stiffness": 4000)")), share));
  EXPECT_TRUE(find_unsettled_span(
      simulation_of(hanging_load(R"("compliance": 0.002, "damping": 10)")), share));
}

TEST(UnsettledSpan, IsNoneWithinTheShareOfTheTension) {
  // The stretch at rest is 0.04 m. A rest length of 0.9616 m leaves 4 % of it, 0.9624 m leaves 6 %.
  const auto with_rest_length = [](const char* length) {
    return find_unsettled_span(
        simulation_of(
            hanging_load(std::string(R"("compliance": 0.002, "rest_lengths": [)") + length + "]")),
        share);
  };
  EXPECT_FALSE(with_rest_length("0.9616"));
  EXPECT_TRUE(with_rest_length("0.9624"));
  EXPECT_TRUE(with_rest_length("0.9576")) << "the rope is too short";
}

TEST(UnsettledSpan, IsNoneOfAMachineThatIsMeantToMove) {
  const std::string elastic = R"("compliance": 0.002)";
  // A pendulum that starts aside: its rest is another pose.
  EXPECT_FALSE(find_unsettled_span(
      simulation_of(R"("bodies": [{"name": "bob", "mass": 1, "inertia": [1, 1, 1],
          "position": [1, -1, 0]}], "cables": [{"name": "rope", "compliance": 0.002, "links": [
        {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "bob"}]}])"),
      share));
  // Two weights over a wheel have no rest.
  EXPECT_FALSE(find_unsettled_span(simulation_of(R"("bodies": [
        {"name": "wheel", "mobility": "rotor", "mass": 1,
         "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
        {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]},
        {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0]}],
      "cables": [{"name": "rope", "compliance": 0.002, "links": [
        {"type": "attachment", "body": "light"},
        {"type": "rolling", "body": "wheel", "winding": "clockwise"},
        {"type": "attachment", "body": "heavy"}]}])"),
                                   share));
  EXPECT_FALSE(find_unsettled_span(
      simulation_of(hanging_load(elastic, R"(, "velocity": [0, 1, 0])")), share));
  // A stretched rope that throws two bodies together is slack at rest.
  EXPECT_FALSE(find_unsettled_span(simulation_of(R"("bodies": [
        {"name": "left", "mobility": "slider", "axis": [1, 0, 0], "mass": 1, "position": [-1, 0, 0]},
        {"name": "right", "mobility": "slider", "axis": [1, 0, 0], "mass": 1, "position": [1, 0, 0]}],
      "cables": [{"name": "rope", "compliance": 0.002, "rest_lengths": [1.9], "links": [
        {"type": "attachment", "body": "left"}, {"type": "attachment", "body": "right"}]}])",
                                                 "[0,0,0]"),
                                   share));
  // A rigid rope has its tension at once.
  EXPECT_FALSE(find_unsettled_span(simulation_of(hanging_load(R"("compliance": 0)")), share));
}

TEST(UnsettledSpan, IsNoneOfADrivenMachine) {
  // A winch that runs at full speed from the first substep pulls the load up at 5 m/s.
  const auto winch = [](const char* drive) {
    return simulation_of(std::string(R"("bodies": [
      {"name": "drum", "mobility": "rotor", "mass": 1, "drive": "speed", )") +
                         drive + R"(,
       "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
      {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0]}],
    "cables": [{"name": "rope", "compliance": 0.002, "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 3},
      {"type": "attachment", "body": "load"}]}])");
  };
  EXPECT_FALSE(find_unsettled_span(winch(R"("drive_values": [10])"), share));
  // A gentle start leaves the bounce.
  EXPECT_TRUE(
      find_unsettled_span(winch(R"("drive_times": [0, 2], "drive_values": [0, 2])"), share));
}

}  // namespace
}  // namespace sheave::testing
