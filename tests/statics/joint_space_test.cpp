// Machines in the coordinates of their joints against closed forms and against the motion of steps.

#include "statics/joint_space.h"

#include <cmath>

#include "tests/statics/robot_scenes.h"

namespace sheave {
namespace {

using testing::ask;
using testing::four_bar;
using testing::names;
using testing::place;
using testing::positions;
using testing::rates;
using testing::robot;
using testing::turn;
using testing::two_links;

/// Products of a few dozen numbers of size 1 to 10 have rounding errors of some 1e-14.
constexpr double of_products = 1e-12;
/// The difference along the motion has an error of the fourth power of 1e-3 rad, times 4, and
/// rounding over 1e-3.
constexpr double of_difference = 1e-10;

ModalMatrix mass_matrix(LiveWorld& world) {
  return ask<ModalMatrix>(world, [](JointSpace& space) { return space.mass_matrix(); });
}

ModalVector bias_forces(LiveWorld& world) {
  return ask<ModalVector>(world, [](JointSpace& space) { return space.bias_forces(); });
}

class TwoLinks : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Mobilities, TwoLinks, ::testing::Values("planar", "free"));

TEST_P(TwoLinks, HaveTheMassMatrixAndBiasOfTextbooks) {
  LiveWorld world = robot(two_links(GetParam()));
  EXPECT_EQ(names(world), (std::vector<std::string>{"shoulder.angle", "elbow.angle"}));
  const double q1 = 0.4;
  const double q2 = -0.9;
  place(world, {{"shoulder", q1}, {"elbow", q2}});
  turn(world, {{"shoulder", 1.7}, {"elbow", -2.3}});
  EXPECT_NEAR(positions(world)[0], q1, of_products);
  EXPECT_NEAR(positions(world)[1], q2, of_products);
  EXPECT_NEAR(rates(world)[1], -2.3, of_products);

  const double m1 = 2.0, m2 = 1.5, i1 = 0.3, i2 = 0.07, l1 = 1.0, c1 = 0.5, c2 = 0.3;
  const ModalMatrix mass = mass_matrix(world);
  EXPECT_NEAR(mass(1, 1), i2 + m2 * c2 * c2, of_products);
  EXPECT_NEAR(mass(0, 1), i2 + m2 * (c2 * c2 + l1 * c2 * std::cos(q2)), of_products);
  EXPECT_EQ(mass(0, 1), mass(1, 0));
  EXPECT_NEAR(mass(0, 0),
              i1 + i2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2.0 * l1 * c2 * std::cos(q2)),
              of_products);
  const double h = m2 * l1 * c2 * std::sin(q2);
  const double outer = m2 * c2 * 10.0 * std::cos(q1 + q2);
  const ModalVector bias = bias_forces(world);
  EXPECT_NEAR(
      bias[0],
      -h * (2.0 * 1.7 * -2.3 + 2.3 * 2.3) + (m1 * c1 + m2 * l1) * 10.0 * std::cos(q1) + outer,
      of_difference * 30.0);
  EXPECT_NEAR(bias[1], h * 1.7 * 1.7 + outer, of_difference * 30.0);
}

TEST(JointSpace, SpringsDampersAndDragArePassiveForces) {
  LiveWorld world = robot(two_links("planar", R"(, "stiffness": 5, "rest": 0.2, "damping": 0.6)"));
  place(world, {{"shoulder", 0.4}, {"elbow", -0.9}});
  turn(world, {{"shoulder", 1.7}, {"elbow", -2.3}});
  const ModalVector forces =
      ask<ModalVector>(world, [](JointSpace& space) { return space.passive_forces(); });
  EXPECT_NEAR(forces[0], -5.0 * (0.4 - 0.2) - 0.6 * 1.7, of_products);
  EXPECT_NEAR(forces[1], -5.0 * (-0.9 - 0.2) + 0.6 * 2.3, of_products);
}

TEST(JointSpace, DrivesOfJointsAreNoConstraints) {
  LiveWorld world =
      robot(two_links("planar", R"(, "drive": "angle", "drive_values": [0])"), "[0,0,0]");
  EXPECT_EQ(names(world).size(), 2U);
  EXPECT_NEAR(mass_matrix(world)(1, 1), 0.07 + 1.5 * 0.09, of_products);
}

/// Joints of all kinds in space: a turning base with a spinning rotor, a slider, a ball joint with
/// a bar of three moments of inertia, springs, dampers and drag.
std::string crooked_arm(double dt) {
  return R"("step": {"dt": )" + std::to_string(dt) + R"(, "substeps": 1}, "bodies": [
    {"name": "base", "mass": 3, "inertia": [0.4, 0.5, 0.7], "position": [0.2, 0.1, 0]},
    {"name": "gyro", "mobility": "rotor", "mount": "base", "axis": [0.6, 0, 0.8], "mass": 0.5,
     "position": [0.2, 0.1, 0], "inertia": [0.02, 0.02, 0.02]},
    {"name": "sledge", "mass": 1, "inertia": [0.1, 0.2, 0.15], "position": [0.7, 0.4, 0.1], "damping": 0.3,
     "angular_damping": 0.02},
    {"name": "bar", "mass": 0.8, "inertia": [0.02, 0.2, 0.21], "position": [1.2, 0.3, 0.4]}],
    "joints": [
    {"type": "hinge", "name": "waist", "body_b": "base", "anchor": [0, 0, 0], "axis": [0.2, 1, 0.1],
     "stiffness": 3, "damping": 0.1},
    {"type": "slider", "name": "rail", "body_a": "base", "body_b": "sledge", "anchor": [0.7, 0.4, 0.1],
     "axis": [1, 0.3, -0.2], "stiffness": 20, "damping": 0.5},
    {"type": "ball", "name": "wrist", "body_a": "sledge", "body_b": "bar", "anchor": [0.8, 0.35, 0.2],
     "damping": 0.05}])";
}

void set_going(LiveWorld& world) {
  place(world, {{"waist", 0.7}, {"rail", 0.15}, {"bar.turn_x", 0.3}, {"bar.turn_y", -0.5}});
  turn(world, {{"waist", 1.1},
               {"rail", -0.4},
               {"bar.turn_x", 2.0},
               {"bar.turn_y", -1.5},
               {"bar.turn_z", 0.8},
               {"gyro.turn", 25.0}});
}

TEST(JointSpace, JointsComeFirstAndFreeTurnsOfBodiesAfterThem) {
  LiveWorld world = robot(crooked_arm(0.001));
  EXPECT_EQ(names(world), (std::vector<std::string>{"waist.angle", "rail.travel", "gyro.turn",
                                                    "bar.turn_x", "bar.turn_y", "bar.turn_z"}));
  set_going(world);
  const ModalVector q = positions(world);
  // Newton's method ends with a correction below 1e-12 of the scene's size.
  EXPECT_NEAR(q[0], 0.7, 1e-12);
  EXPECT_NEAR(q[1], 0.15, 1e-12);
  EXPECT_NEAR(q[3], 0.3, 1e-12);
  EXPECT_NEAR(q[4], -0.5, 1e-12);
  EXPECT_NEAR(q[5], 0.0, 1e-12);
  EXPECT_NEAR(rates(world)[2], 25.0, 1e-11);
}

/// The largest deviation of inverse_dynamics() from 0 for the mean acceleration of one step.
ModalVector left_by_step(double dt) {
  LiveWorld world = robot(crooked_arm(dt));
  set_going(world);
  const LiveSnapshot start = world.snapshot();
  const ModalVector before = rates(world);
  EXPECT_TRUE(world.step().ok());
  const ModalVector mean = (rates(world) - before) / dt;
  EXPECT_TRUE(world.restore(start).empty());
  return ask<ModalVector>(world, [&](JointSpace& space) { return *space.inverse_dynamics(mean); });
}

TEST(JointSpace, InverseDynamicsAgreesWithStepsInFirstOrder) {
  // Over a step of length h, the mean acceleration differs from that of its start by h/2 times the
  // derivative, and in second order. Halving h halves the first, and 2 f(h/2) - f(h) is free of it.
  const ModalVector whole = left_by_step(2e-4);
  const ModalVector half = left_by_step(1e-4);
  const ModalVector quarter = left_by_step(5e-5);
  EXPECT_NEAR(whole.norm() / half.norm(), 2.0, 0.05);
  EXPECT_NEAR(half.norm() / quarter.norm(), 2.0, 0.05);
  const double first = (2.0 * half - whole).norm();
  const double second = (2.0 * quarter - half).norm();
  EXPECT_LT(second, 2e-3 * quarter.norm());
  EXPECT_NEAR(first / second, 4.0, 0.6);
}

TEST(JointSpace, ForwardDynamicsIsTheInverseOfInverseDynamics) {
  LiveWorld world = robot(crooked_arm(0.001));
  set_going(world);
  const double off = ask<double>(world, [](JointSpace& space) {
    ModalVector forces(6);
    forces << 1.0, -2.0, 0.3, 0.5, -0.7, 0.2;
    const ModalVector there = *space.forward_dynamics(forces);
    return (*space.inverse_dynamics(there) - forces).norm();
  });
  EXPECT_LT(off, 1e-10);
}

TEST(JointSpace, ATurntableThrowsAPendulumOutwards) {
  // A bob at l = 0.5 m below a hinge on the axis of a table that a drive turns: with the moment of
  // inertia i about all axes, the torque about the hinge at u' = 0 is
  // m g l sin q - m l^2 w^2 sin q cos q.
  LiveWorld world = robot(R"("bodies": [
    {"name": "table", "mobility": "rotor", "axis": [0, 1, 0], "mass": 1, "inertia": [1, 1, 1],
     "drive": "speed", "drive_values": [4], "angular_velocity": [0, 4, 0]},
    {"name": "bob", "mass": 2, "inertia": [0.03, 0.03, 0.03], "position": [0, -0.5, 0]}],
    "joints": [{"type": "hinge", "name": "pivot", "body_a": "table", "body_b": "bob",
                "anchor": [0, 0, 0], "axis": [0, 0, 1]}])");
  EXPECT_EQ(names(world), (std::vector<std::string>{"pivot.angle"}));
  place(world, {{"pivot", 0.6}});
  EXPECT_NEAR(mass_matrix(world)(0, 0), 2.0 * 0.25 + 0.03, of_products);
  const double wanted =
      2.0 * 10.0 * 0.5 * std::sin(0.6) - 2.0 * 0.25 * 16.0 * std::sin(0.6) * std::cos(0.6);
  EXPECT_NEAR(bias_forces(world)[0], wanted, 1e-9);
}

TEST(JointSpace, ALoopHasTheCoordinatesThatAreIndependent) {
  LiveWorld world = robot(four_bar);
  EXPECT_EQ(names(world), (std::vector<std::string>{"a.angle"}));
  // The energy of a loop at the rate u is M u^2 / 2, and that of its bodies is another computation.
  place(world, {{"a", 0.5}});
  turn(world, {{"a", 3.0}});
  EXPECT_NEAR(0.5 * 9.0 * mass_matrix(world)(0, 0), world.energy().kinetic, 1e-11);
}

TEST(JointSpace, JacobiansAreCentralDifferences) {
  LiveWorld world = robot(crooked_arm(0.001));
  set_going(world);
  const LiveSnapshot here = world.snapshot();
  const Vector3 local(0.3, -0.1, 0.2);
  const BodyHandle bar = *world.body("bar");
  const PointJacobian jacobian = ask<PointJacobian>(
      world, [&](JointSpace& space) { return space.jacobian({bar.slot}, local); });
  // The error is of the square of the step, and rounding of 1e-12 over the step.
  constexpr double step = 1e-5;
  const ModalVector q = positions(world);
  for (int i = 0; i < 2; ++i) {
    const std::string name = names(world)[static_cast<std::size_t>(i)];
    std::array<Vector3, 2> points;
    for (int side = 0; side < 2; ++side) {
      place(world, {{name, q[i] + (side == 0 ? step : -step)}});
      points[static_cast<std::size_t>(side)] = *world.point(bar, local);
      ASSERT_TRUE(world.restore(here).empty());
    }
    const Vector3 slope = (points[0] - points[1]) / (2.0 * step);
    const Vector3 linear = jacobian.linear.col(i);
    EXPECT_LT((slope - linear).norm(), 1e-7 * linear.norm()) << name;
  }
  // The columns of free turns, and of the velocities of all coordinates together.
  const Vector3 velocity = jacobian.linear * rates(world);
  const Vector3 turning = jacobian.angular * rates(world);
  const BodyPose pose = *world.pose(bar);
  EXPECT_LT((turning - pose.angular_velocity).norm(), 1e-11);
  EXPECT_LT((velocity - pose.velocity - turning.cross(pose.orientation * local)).norm(), 1e-11);
}

TEST(JointSpace, QuestionsLeaveTheMotionAsItIs) {
  for (const char* scene : {"machines/crane.json", "analytic/atwood.json", "machines/winch.json"}) {
    LiveWorld asked = LiveWorld::of(testing::simulation_of(testing::scene_file(scene)));
    LiveWorld plain = LiveWorld::of(testing::simulation_of(testing::scene_file(scene)));
    for (int i = 0; i < 20; ++i) {
      ask<ModalVector>(asked, [](JointSpace& space) {
        static_cast<void>(space.cable_arms());
        static_cast<void>(space.passive_forces());
        static_cast<void>(space.linearise());
        return space.bias_forces();
      });
      ASSERT_TRUE(asked.step().ok());
      ASSERT_TRUE(plain.step().ok());
    }
    EXPECT_EQ(hash(asked.state()), hash(plain.state())) << scene;
  }
}

TEST(JointSpace, WrongAnswersAreRefused) {
  LiveWorld world = robot(two_links("planar"));
  ask<int>(world, [](JointSpace& space) {
    const auto shorter = space.inverse_dynamics(ModalVector::Zero(1));
    EXPECT_FALSE(shorter);
    EXPECT_EQ(shorter.errors().front().message,
              "accelerations: must be 2 numbers, one per coordinate, not 1");
    EXPECT_FALSE(space.forward_dynamics(ModalVector::Constant(2, std::nan(""))));
    return 0;
  });
}

}  // namespace
}  // namespace sheave
