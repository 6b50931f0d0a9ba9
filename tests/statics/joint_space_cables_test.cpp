// Moment arms of cables and the motion near rest against closed forms and differences.

#include <cmath>

#include "tests/statics/robot_scenes.h"

namespace sheave {
namespace {

using testing::ask;
using testing::names;
using testing::place;
using testing::positions;
using testing::rates;
using testing::robot;
using testing::turn;

CableArms cable_arms(LiveWorld& world) {
  return ask<CableArms>(world, [](JointSpace& space) { return space.cable_arms(); });
}

Result<LinearMotion> linearise(LiveWorld& world) {
  std::optional<Result<LinearMotion>> result;
  ask<int>(world, [&](JointSpace& space) {
    result.emplace(space.linearise());
    return 0;
  });
  return std::move(*result);
}

/// Arms by differences of lengths, with the cables' own lengths kept. The error of a central
/// difference is the square of the step times the third derivative, and rounding over the step.
void expect_arms_are_differences(LiveWorld& world, double tolerance) {
  constexpr double step = 1e-5;
  const CableArms here = cable_arms(world);
  const ModalVector q = positions(world);
  const std::vector<std::string> all = names(world);
  const LiveSnapshot start = world.snapshot();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    std::array<ModalVector, 2> lengths;
    for (int side = 0; side < 2; ++side) {
      place(world, {{all[static_cast<std::size_t>(i)], q[i] + (side == 0 ? step : -step)}},
            Keep::length);
      lengths[static_cast<std::size_t>(side)] = cable_arms(world).lengths;
      ASSERT_TRUE(world.restore(start).empty());
    }
    const ModalVector slope = (lengths[0] - lengths[1]) / (2.0 * step);
    for (Eigen::Index c = 0; c < slope.size(); ++c) {
      EXPECT_NEAR(here.arms(c, i), slope[c], tolerance) << all[static_cast<std::size_t>(i)];
    }
  }
}

TEST(CableArms, ADrumHasItsRadius) {
  LiveWorld world = robot(R"("bodies": [
    {"name": "drum", "mobility": "rotor", "mass": 1, "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 3, "position": [0.25, -2, 0]}],
    "cables": [{"name": "rope", "compliance": 1e-4, "links": [
      {"type": "rolling", "body": "drum", "winding": "clockwise", "stored_length": 3},
      {"type": "attachment", "body": "load"}]}])");
  ASSERT_EQ(names(world), (std::vector<std::string>{"drum.turn", "load.along"}));
  const CableArms arms = cable_arms(world);
  EXPECT_NEAR(std::abs(arms.arms(0, 0)), 0.25, 1e-14);
  EXPECT_NEAR(arms.arms(0, 1), -1.0, 1e-14);
  expect_arms_are_differences(world, 1e-9);
  turn(world, {{"drum", 2.0}, {"load", 0.3}});
  EXPECT_NEAR(cable_arms(world).rates[0], 2.0 * arms.arms(0, 0) - 0.3, 1e-13);
  // In many parts the cable leaves the drum, and its length stays.
  place(world, {{"drum", -6.0}, {"load", -2.0 - 6.0 * arms.arms(0, 0)}}, Keep::length);
  EXPECT_NEAR(cable_arms(world).lengths[0], arms.lengths[0], 1e-12);
  EXPECT_NEAR(*world.rest_length(*world.cable("rope"), 0), 2.0 + 6.0 * arms.arms(0, 0), 1e-9);
}

/// A finger whose tendon runs over pinholes, and one over a wheel at the joint.
constexpr const char* finger = R"("bodies": [
  {"name": "first", "mobility": "planar", "mass": 0.5, "inertia": [1, 1, 0.01], "position": [0.3, 0, 0]},
  {"name": "second", "mobility": "planar", "mass": 0.3, "inertia": [1, 1, 0.01], "position": [0.8, 0, 0]},
  {"name": "wheel", "mobility": "rotor", "mass": 0.1, "shape": {"type": "cylinder", "radius": 0.08, "length": 0.02}}],
  "joints": [
  {"type": "hinge", "name": "knuckle", "body_b": "first", "anchor": [0, 0, 0], "axis": [0, 0, 1]},
  {"type": "hinge", "name": "tip", "body_a": "first", "body_b": "second", "anchor": [0.6, 0, 0], "axis": [0, 0, 1]}],
  "cables": [
  {"name": "flexor", "compliance": 1e-3, "links": [
    {"type": "attachment", "body": "world", "point": [-0.3, -0.1, 0]},
    {"type": "pinhole", "body": "first", "point": [0, -0.1, 0]},
    {"type": "attachment", "body": "second", "point": [0, -0.05, 0]}]},
  {"name": "extensor", "compliance": 1e-3, "links": [
    {"type": "attachment", "body": "world", "point": [-0.4, 0.08, 0]},
    {"type": "rolling", "body": "wheel", "winding": "clockwise"},
    {"type": "attachment", "body": "first", "point": [0, 0.08, 0]}]}])";

TEST(CableArms, ABentFingerHasTheShorterWayOverItsSites) {
  LiveWorld world = robot(finger);
  ASSERT_EQ(names(world), (std::vector<std::string>{"knuckle.angle", "tip.angle", "wheel.turn"}));
  place(world, {{"knuckle", -0.5}, {"tip", -0.7}});
  const CableArms arms = cable_arms(world);
  // The arm of a straight line is that of the force along it about the joint.
  const auto arm = [](const Vector3& joint, const Vector3& from, const Vector3& to) {
    return (to - joint).cross((to - from).normalized()).z();
  };
  const Vector3 knuckle = Vector3::Zero();
  const Vector3 site = *world.point(*world.body("first"), Vector3(0, -0.1, 0));
  const Vector3 end = *world.point(*world.body("second"), Vector3(0, -0.05, 0));
  const Vector3 tip = *world.point(*world.body("first"), Vector3(0.3, 0, 0));
  EXPECT_NEAR(arms.arms(0, 0), arm(knuckle, Vector3(-0.3, -0.1, 0), site), 1e-12);
  EXPECT_NEAR(arms.arms(0, 1), arm(tip, site, end), 1e-12);
  EXPECT_NEAR(arms.lengths[0], (site - Vector3(-0.3, -0.1, 0)).norm() + (end - site).norm(), 1e-12);
  // Around the wheel the arm is the radius, however far the finger is bent; and the wheel itself
  // takes from one span as much as it gives to the other.
  EXPECT_NEAR(std::abs(arms.arms(1, 0)), 0.08, 1e-12);
  EXPECT_NEAR(arms.arms(1, 2), 0.0, 1e-14);
  EXPECT_NEAR(std::abs(arms.span_arms(2, 2)), 0.08, 1e-12);
  expect_arms_are_differences(world, 1e-8);
}

TEST(CableArms, TensionsActAlongTheArms) {
  // With the tensions T the forces along the coordinates are -R^T T. The machine starts at rest, so
  // forces do not change in first order, and the means over a step agree with its start in second.
  const auto left = [](double dt) {
    LiveWorld world =
        robot(R"("step": {"dt": )" + std::to_string(dt) + R"(, "substeps": 1}, )" + finger);
    place(world, {{"knuckle", -0.5}, {"tip", -0.7}}, Keep::tension);
    place(world, {{"knuckle", -0.53}, {"tip", -0.4}}, Keep::length);
    const LiveSnapshot start = world.snapshot();
    EXPECT_TRUE(world.step().ok());
    const ModalVector mean = rates(world) / dt;
    ModalVector tensions(4);
    tensions << *world.tension(*world.cable("flexor"), 0),
        *world.tension(*world.cable("flexor"), 1), *world.tension(*world.cable("extensor"), 0),
        *world.tension(*world.cable("extensor"), 1);
    EXPECT_GT(tensions.maxCoeff(), 0.1);
    EXPECT_TRUE(world.restore(start).empty());
    return ask<double>(world, [&](JointSpace& space) {
      return (*space.inverse_dynamics(mean) + space.cable_arms().span_arms.transpose() * tensions)
          .norm();
    });
  };
  const double whole = left(1e-4);
  const double half = left(5e-5);
  EXPECT_NEAR(whole / half, 4.0, 0.1);
  EXPECT_LT(half, 0.01);
}

TEST(LinearMotion, APendulumHasItsClosedForm) {
  LiveWorld world = robot(R"("bodies": [{"name": "rod", "mobility": "planar", "mass": 2,
    "inertia": [1, 1, 0.3], "position": [0, -0.5, 0]}],
    "joints": [{"type": "hinge", "name": "pin", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1],
    "damping": 0.4}])");
  const Result<LinearMotion> linear = linearise(world);
  ASSERT_TRUE(linear);
  const double inertia = 0.3 + 2.0 * 0.25;
  // Differences of forces leave some 1e-10.
  ModalMatrix wanted(2, 2);
  wanted << 0.0, 1.0, -2.0 * 10.0 * 0.5 / inertia, -0.4 / inertia;
  EXPECT_LT((linear->state_matrix - wanted).norm(), 1e-8);
  EXPECT_NEAR(linear->input_matrix(0, 0), 0.0, 1e-15);
  EXPECT_NEAR(linear->input_matrix(1, 0), 1.0 / inertia, 1e-12);
}

TEST(LinearMotion, ACartWithAPoleHasItsClosedForm) {
  LiveWorld world = robot(R"("bodies": [
    {"name": "cart", "mobility": "slider", "axis": [1, 0, 0], "mass": 3},
    {"name": "pole", "mobility": "planar", "mass": 1, "inertia": [1, 1, 0.05], "position": [0, 0.4, 0]}],
    "joints": [{"type": "hinge", "name": "pivot", "body_a": "cart", "body_b": "pole",
                "anchor": [0, 0, 0], "axis": [0, 0, 1]}])");
  ASSERT_EQ(names(world), (std::vector<std::string>{"pivot.angle", "cart.along"}));
  const Result<LinearMotion> linear = linearise(world);
  ASSERT_TRUE(linear) << linear.errors().front().message;
  // The pole stands upright: M q'' = (m g l q, 0) + f with M = [[i + m l^2, -m l], [-m l, m + c]].
  ModalMatrix mass(2, 2);
  mass << 0.05 + 0.16, -0.4, -0.4, 4.0;
  ModalMatrix pull = ModalMatrix::Zero(2, 2);
  pull(0, 0) = 10.0 * 0.4;
  const ModalMatrix wanted = mass.inverse() * pull;
  EXPECT_LT((linear->state_matrix.bottomLeftCorner(2, 2) - wanted).norm(), 1e-7 * wanted.norm());
  EXPECT_LT((linear->input_matrix.bottomRows(2) - ModalMatrix(mass.inverse())).norm(), 1e-10);
}

TEST(LinearMotion, APoseThatIsNotAtRestIsRefused) {
  LiveWorld world = robot(testing::two_links("planar"));
  const Result<LinearMotion> linear = linearise(world);
  ASSERT_FALSE(linear);
  EXPECT_NE(linear.errors().front().message.find("not at rest"), std::string::npos);
}

}  // namespace
}  // namespace sheave
