// States that worlds take and refuse.

#include "engine/state_check.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/world.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A planar body, a rotor, and a rotor that a free body carries; none moves. The angles are those
/// at time 0 [rad].
World resting(double planar, double rotor, double carrier) {
  Model model;
  model.gravity = Vector3::Zero();
  const Quaternion turn = rotation_by({0.0, 0.0, planar});
  BodyDef flat = test::lump("flat", {2.0, 0.0, 0.0}, 1.0);
  flat.mobility = Mobility::planar;
  flat.orientation = turn;
  model.add(flat);
  BodyDef wheel = test::wheel("wheel", {0.0, 0.0, 0.0}, 0.5, 1.0);
  wheel.orientation = rotation_by({0.0, 0.0, rotor});
  model.add(wheel);
  BodyDef frame = test::lump("frame", {-3.0, 0.0, 0.0}, 1.0);
  frame.orientation = rotation_by({carrier, 0.0, 0.0});
  const BodyId mount = model.add(frame);
  BodyDef mounted = test::wheel("mounted", {-3.0, 0.0, 0.0}, 0.5, 1.0);
  mounted.mount = mount;
  mounted.orientation = frame.orientation * rotation_by({0.0, 0.0, rotor});
  mounted.axis = frame.orientation * Vector3::UnitZ();
  model.add(mounted);
  Result<World> world = World::create(model);
  EXPECT_TRUE(world.ok()) << (world ? "" : world.errors().front().message);
  return std::move(*world);
}

double apart(const Quaternion& a, const Quaternion& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

// The angles of a state count from the pose at time 0. A world that began otherwise takes the orientations, not the angles:
// nothing jumps in the next step, which used to turn the bodies back by the difference.
TEST(StateCheck, ARestoredPoseDoesNotDependOnThePoseAtTimeZero) {
  World from = resting(0.2, -0.4, 0.5);
  World to = resting(0.9, 2.9, -0.7);
  State state = from.state();
  state.bodies[1].angle += 6.0 * std::numbers::pi;  // three turns more
  ASSERT_THAT(to.restore(state), IsEmpty());
  ASSERT_TRUE(to.step().ok());
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    // Rounding of some products of quaternions.
    EXPECT_LT(apart(to.state().bodies[i].orientation, state.bodies[i].orientation), 1e-14) << i;
  }
  EXPECT_NEAR(to.state().bodies[0].angle, 0.2 - 0.9, 1e-14);
  // The angle that is nearest to that of the state, 6 pi.
  EXPECT_NEAR(to.state().bodies[1].angle, -0.4 - 2.9 + 8.0 * std::numbers::pi, 1e-13);
}

TEST(StateCheck, AnglesThatFitKeepTheirBits) {
  World world = resting(0.2, -0.4, 0.5);
  State state = world.state();
  state.bodies[1].angular_velocity = {0.0, 0.0, 37.0};
  ASSERT_THAT(world.restore(state), IsEmpty());
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(world.step().ok());
  state = world.state();
  World again = resting(0.2, -0.4, 0.5);
  ASSERT_THAT(again.restore(state), IsEmpty());
  EXPECT_EQ(hash(again.state()), hash(state));
}

TEST(StateCheck, RefusesImpossibleStates) {
  World world = resting(0.2, -0.4, 0.5);
  const State good = world.state();
  const auto fault = [&](auto change) {
    State bad = good;
    change(bad);
    const Errors errors = world.restore(bad);
    EXPECT_EQ(hash(world.state()), hash(good));
    return errors.empty() ? "" : errors.front().message;
  };
  EXPECT_THAT(fault([](State& s) { s.time = -5.0; }), HasSubstr("time is below 0"));
  EXPECT_THAT(fault([](State& s) { s.steps = -1; }), HasSubstr("number of steps"));
  EXPECT_THAT(fault([](State& s) { s.bodies[2].orientation.coeffs().setZero(); }),
              HasSubstr("\"frame\": its orientation is no unit quaternion"));
  EXPECT_THAT(fault([](State& s) { s.bodies[2].orientation.coeffs() *= 3.0; }),
              HasSubstr("no unit quaternion"));
  EXPECT_THAT(fault([](State& s) {
                s.bodies[1].orientation = rotation_by({0.3, 0.0, 0.0});
              }),
              HasSubstr("\"wheel\": its orientation is not reached"));
  EXPECT_THAT(fault([](State& s) { s.bodies[0].velocity.x() = std::nan(""); }),
              HasSubstr("\"flat\": its velocity is not finite"));
}

}  // namespace
}  // namespace sheave
