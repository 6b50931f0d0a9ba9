// Rest lengths that follow from a pretension: the tensions of the start, and of a machine that such
// tensions leave at rest.

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"
#include "tests/support/friction_links.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::wrapped;

constexpr double start_pull = 500.0;      // [N]
constexpr double rope_stiffness = 2.0e4;  // EA [N]: a strain of 2.5 %

/// A rope from a wall over a post, half a turn, to the same wall.
test::Machine pretension_rope(double friction) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  const BodyId post = machine.model.add(test::post("post", {2.0, 0.0, 0.0}, 0.25));
  CableDef rope =
      cable("rope", {attach(BodyId::world(), {0.0, 0.25, 0.0}), wrapped(post, right, friction),
                     attach(BodyId::world(), {0.0, -0.25, 0.0})});
  machine.cables.push_back(rope);
  return machine;
}

/// Tension of each span of the first cable [N].
std::vector<double> pretension_tensions(const Simulation& simulation) {
  return test::tensions(simulation.cable_reports()[0]);
}

/// The tension is EA (l / L - 1): with l / L = 1.025 an error of 1e-16 of l / L is 4e-15 of the
/// tension, and lengths are rounded to 2^-50 of the cable, 1e-15, which is 4e-14 of the tension.
constexpr double tension_rounding = 1e-12;

TEST(Pretension, IsTheTensionOfEachSpanFromTheStart) {
  for (const double friction : {0.0, 0.3}) {
    test::Machine machine = pretension_rope(friction);
    machine.cables[0].axial_stiffness = rope_stiffness;
    machine.cables[0].pretension = start_pull;
    Simulation simulation = test::start(machine);
    for (const double tension : pretension_tensions(simulation))
      EXPECT_NEAR(tension, start_pull, tension_rounding * start_pull);
    // Nothing slides over the post: the arc has the strain of the spans.
    test::run(simulation.world, 1.0);
    for (const double tension : pretension_tensions(simulation))
      EXPECT_NEAR(tension, start_pull, tension_rounding * start_pull);
    const CableReport report = simulation.cable_reports()[0];
    EXPECT_NEAR(report.links[1].slip, 0.0, 1e-13);
    // All the cable is stretched alike: 4 m of spans and an arc of pi r.
    const double drawn = 4.0 + pi * 0.25;
    EXPECT_NEAR(report.total_length, drawn / (1.0 + start_pull / rope_stiffness), 1e-13 * drawn);
  }
}

TEST(Pretension, OfAComplianceStretchesEachSpanByComplianceTimesTension) {
  test::Machine machine = pretension_rope(0.0);
  machine.cables[0].compliance = 1e-4;
  machine.cables[0].pretension = start_pull;
  Simulation simulation = test::start(machine);
  for (const SpanReport& span : simulation.cable_reports()[0].spans) {
    EXPECT_NEAR(span.rest_length, span.length - 1e-4 * start_pull, 1e-14);
  }
  test::run(simulation.world, 1.0);
  for (const double tension : pretension_tensions(simulation))
    EXPECT_NEAR(tension, start_pull, tension_rounding * start_pull);
}

// The link holds as long as the ratio is below e^(0.3 pi) = 2.57.
TEST(Pretension, OfEachSpanMayDifferWhereFrictionHolds) {
  test::Machine machine = pretension_rope(0.3);
  machine.cables[0].axial_stiffness = rope_stiffness;
  machine.cables[0].pretensions = {start_pull, 0.5 * start_pull};
  Simulation simulation = test::start(machine);
  test::run(simulation.world, 0.5);
  const std::vector<double> tensions = pretension_tensions(simulation);
  EXPECT_NEAR(tensions[0], start_pull, tension_rounding * start_pull);
  EXPECT_NEAR(tensions[1], 0.5 * start_pull, tension_rounding * start_pull);
}

TEST(Pretension, LeavesABeltAtRest) {
  test::Machine machine = test::belt(0.2, 0.35, 1.5, 0.02, 0.05);
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.cables[0].axial_stiffness = rope_stiffness;
  machine.cables[0].pretension = start_pull;
  Simulation simulation = test::start(machine);
  test::run(simulation.world, 1.0);
  for (const double tension : pretension_tensions(simulation))
    EXPECT_NEAR(tension, start_pull, 1e-9 * start_pull);
  for (const BodyState& body : simulation.world.state().bodies) {
    EXPECT_NEAR(body.angular_velocity.norm(), 0.0, 1e-9);
  }
}

void expect_pretension_fault(const std::string& path, const std::function<void(CableDef&)>& spoil) {
  test::Machine machine = pretension_rope(0.0);
  spoil(machine.cables[0]);
  const Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  ASSERT_FALSE(made.ok()) << path;
  ASSERT_EQ(made.errors().size(), 1u) << test::text(made.errors());
  EXPECT_EQ(made.errors()[0].path, "/cables/0" + path) << made.errors()[0].message;
}

TEST(Pretension, IsRefusedWhereItSaysNothingOrToo) {
  expect_pretension_fault("/pretension",
                          [](CableDef& rope) { rope.pretension = start_pull; });  // rigid
  expect_pretension_fault("/pretension", [](CableDef& rope) {
    rope.axial_stiffness = rope_stiffness;
    rope.pretension = 0.0;
  });
  expect_pretension_fault("/pretension", [](CableDef& rope) {
    rope.axial_stiffness = rope_stiffness;
    rope.pretension = start_pull;
    rope.rest_lengths = {2.0, 2.0};
  });
  expect_pretension_fault("/pretension", [](CableDef& rope) {
    rope.axial_stiffness = rope_stiffness;
    rope.pretension = start_pull;
    rope.breaking_tension = start_pull;
  });
  expect_pretension_fault("/pretensions", [](CableDef& rope) {
    rope.axial_stiffness = rope_stiffness;
    rope.pretensions = {start_pull};
  });
  expect_pretension_fault("/pretensions", [](CableDef& rope) {
    rope.axial_stiffness = rope_stiffness;
    rope.pretension = start_pull;
    rope.pretensions = {start_pull, start_pull};
  });
}

TEST(Pretension, ThatStretchesASpanByItsWholeLengthNamesTheLargest) {
  test::Machine machine = pretension_rope(0.0);
  machine.cables[0].compliance = 1e-2;  // 2 m at 200 N
  machine.cables[0].pretension = 200.0;
  const Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.errors()[0].message.find("below 200 N"), std::string::npos)
      << made.errors()[0].message;
}

}  // namespace
}  // namespace sheave
