// A closed rope of a driven wheel that nothing resists: it goes round without tension, and slides
// back over what is rough when the wheel turns back.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

class SlackRing : public test::ForEveryCombination {};

// What the driven wheel takes in on one side it gives on the other, so the way round is free: over
// a rough hole and a rough wheel on an axle, neither of which has to move.
TEST_P(SlackRing, IsDrivenRoundInBothDirections) {
  test::Machine m;
  m.model.step = step_settings(0.008, 20);
  BodyDef driven = test::wheel("driven", {-0.38, 0.657, 0.0}, 0.2, 0.01);
  driven.drive = DriveKind::angle;
  driven.drive_times = {0.0, 0.1, 0.3};
  driven.drive_values = {0.0, 0.07, -0.54};
  const BodyId moves = m.model.add(driven);
  const BodyId rests = m.model.add(test::wheel("rests", Vector3::Zero(), 0.27, 0.01));
  auto hole = std::make_shared<PinholeLink>();
  hole->body = BodyId::world();
  hole->point = {0.925, -0.12, 0.0};
  hole->friction = 0.188;
  auto rough = test::roll(rests, test::left);
  rough->friction = 0.214;
  m.cables.push_back(test::cable("rope", {hole, test::roll(moves, test::left), rough}));
  m.cables.back().closed = true;
  Simulation s = test::start(m);
  for (int i = 0; i < 38; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.impossible, 0);
    const CableReport rope = s.cable_reports()[0];
    // Rounds end at 1e-10 of the scene, of 1 m.
    for (const SpanReport& span : rope.spans) EXPECT_NEAR(span.length, span.rest_length, 1e-9);
  }
  // What has gone round has slid over the hole: R times the angle.
  EXPECT_NEAR(std::abs(s.cable_reports()[0].links[0].slip), 0.2 * 0.54, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, SlackRing, testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
