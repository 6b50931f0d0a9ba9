// Whole machines at rest: a cable robot against a solution of its own, the hand against motion that
// damping has settled, the crane in closed form.

#include <array>
#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::scene_file;
using testing::simulation_of;
using testing::tension;

/// Newton's method ends where rounding is left: 1e-11 of forces and of the scene's size.
constexpr double near_exact = 1e-9;

/// A box of 0.6 x 0.2 x 0.4 m and 30 kg on eight ropes between the corners of a hall and its own,
/// and a push.
struct CableRobot {
  static constexpr int count = 8;
  static constexpr double stiffness = 4000.0;  // EA [N]
  static constexpr double mass = 30.0;         // [kg]
  Vector3 push{40.0, 0.0, -25.0};              // at the centre of mass [N]
  std::array<Vector3, count> corners;
  std::array<Vector3, count> ties;
  std::array<double, count> lengths{};  // unstretched [m]

  CableRobot() {
    for (int i = 0; i < count; ++i) {
      const double x = (i & 1) != 0 ? 1.0 : -1.0;
      const double y = (i & 2) != 0 ? 1.0 : -1.0;
      const double z = (i & 4) != 0 ? 1.0 : -1.0;
      const auto k = static_cast<std::size_t>(i);
      corners[k] = {3.0 * x, 2.0 + 2.0 * y, 2.0 * z};
      ties[k] = {0.3 * x, 0.1 * y, 0.2 * z};
      lengths[k] = 0.985 * (corners[k] - Vector3(0.0, 2.0, 0.0) - ties[k]).norm();
    }
    lengths[0] *= 1.03;  // one hangs loose
  }

  [[nodiscard]] std::string scene() const {
    std::string cables;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3& c = corners[i];
      const Vector3& t = ties[i];
      cables += fmt::format(
          R"({}{{"name": "c{}", "axial_stiffness": {}, "rest_lengths": [{}], "links": [
        {{"type": "attachment", "body": "world", "point": [{}, {}, {}]}},
        {{"type": "attachment", "body": "platform", "point": [{}, {}, {}]}}]}})",
          i == 0 ? "" : ", ", i, stiffness, lengths[i], c.x(), c.y(), c.z(), t.x(), t.y(), t.z());
    }
    return fmt::format(
        R"("bodies": [{{"name": "platform", "mass": {}, "inertia": [1, 1, 1], "position": [0, 2, 0],
      "force": [{}, {}, {}]}}], "cables": [{}])",
        mass, push.x(), push.y(), push.z(), cables);
  }

  using Pose = Eigen::Matrix<double, 6, 1>;  // position, rotation vector

  /// Pulls on the platform and their moments about its centre of mass, with weight and push.
  [[nodiscard]] Pose wrench(const Vector3& position, const Matrix3& turn) const {
    Pose sum = Pose::Zero();
    sum.head<3>() = push + Vector3(0.0, -10.0 * mass, 0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3 arm = turn * ties[i];
      const Vector3 way = corners[i] - position - arm;
      const Vector3 pull = tension_of(i, way.norm()) * way.normalized();
      sum.head<3>() += pull;
      sum.tail<3>() += arm.cross(pull);
    }
    return sum;
  }
  [[nodiscard]] double tension_of(std::size_t i, double length) const {
    return std::max(0.0, stiffness * (length - lengths[i]) / lengths[i]);
  }

  /// Where the wrench is zero, by Newton's method with differences.
  void solve(Vector3& position, Matrix3& turn) const {
    constexpr double step = 1e-6;
    const auto moved = [&](const Pose& by) {
      const Vector3 angle = by.tail<3>();
      const double size = angle.norm();
      const Matrix3 more = size > 0.0 ? Eigen::AngleAxisd(size, angle / size).toRotationMatrix()
                                      : Matrix3::Identity();
      return std::pair<Vector3, Matrix3>(position + by.head<3>(), more * turn);
    };
    for (int round = 0; round < 50; ++round) {
      Eigen::Matrix<double, 6, 6> slope;
      for (int k = 0; k < 6; ++k) {
        const auto [ahead, ahead_turn] = moved(step * Pose::Unit(k));
        const auto [back, back_turn] = moved(-step * Pose::Unit(k));
        slope.col(k) = (wrench(ahead, ahead_turn) - wrench(back, back_turn)) / (2.0 * step);
      }
      Pose by = slope.partialPivLu().solve(-wrench(position, turn));
      by *= std::min(1.0, 0.05 / by.norm());
      std::tie(position, turn) = moved(by);
      if (by.norm() < 1e-14) break;
    }
  }
};

TEST(Machines, CableRobotSharesItsLoad) {
  const CableRobot robot;
  Simulation simulation = simulation_of(robot.scene());
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_EQ(rest.stability, Stability::stable);
  const BodyState& platform = simulation.world.state().bodies[0];
  const Matrix3 turn = platform.orientation.toRotationMatrix();

  Vector3 position(0.0, 2.0, 0.0);
  Matrix3 solved = Matrix3::Identity();
  robot.solve(position, solved);
  EXPECT_LT((platform.position - position).norm(), near_exact);
  EXPECT_LT((turn - solved).norm(), near_exact);

  // Forces and moments of the tensions that are told, along the ropes as they lie.
  Vector3 force = robot.push + Vector3(0.0, -10.0 * CableRobot::mass, 0.0);
  Vector3 moment = Vector3::Zero();
  double largest = 0.0;
  for (std::size_t i = 0; i < robot.corners.size(); ++i) {
    const Vector3 arm = turn * robot.ties[i];
    const Vector3 way = robot.corners[i] - platform.position - arm;
    const double pull = tension(simulation, i, 0);
    largest = std::max(largest, pull);
    // Rounding of lengths, times EA per length.
    EXPECT_NEAR(pull, robot.tension_of(i, way.norm()), 10.0 * CableRobot::stiffness * near_exact)
        << i;
    force += pull * way.normalized();
    moment += arm.cross(pull * way.normalized());
  }
  EXPECT_LT(force.norm(), largest * near_exact);
  EXPECT_LT(moment.norm(), largest * near_exact);
  // It is a test of slack ropes only with one.
  EXPECT_EQ(tension(simulation, 0, 0), 0.0);
  EXPECT_GE(rest.slack_spans.size(), 1U);
  EXPECT_GT(largest, 100.0);
}

/// The paper's hand with a constant pull on its flexors, and without the ball: what rests on it by
/// friction rests where it has been pushed.
Scene hand(double torque) {
  Scene scene = scene_file("paper/hand.json");
  EXPECT_EQ(scene.model.bodies.back().name, "ball");
  scene.model.bodies.pop_back();
  scene.model.colliders.pop_back();
  for (BodyDef& body : scene.model.bodies) {
    if (body.drive != DriveKind::torque) continue;
    body.drive_times = {0.0};
    body.drive_values = {torque};
  }
  return scene;
}

TEST(Machines, HandRestsWhereDampingSettlesIt) {
  // 2.5 N at drums of 9 mm. After 1.7 s some 5e-11 m were left, after 2.5 s 1e-13 m.
  const Scene scene = hand(0.0225);
  Simulation still = simulation_of(scene);
  const Equilibrium rest = find_equilibrium(still);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_EQ(rest.stability, Stability::stable);
  Simulation moving = simulation_of(scene);
  while (moving.world.state().time < 3.0) ASSERT_TRUE(moving.step().ok());
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    const Vector3 off =
        still.world.state().bodies[i].position - moving.world.state().bodies[i].position;
    EXPECT_LT(off.norm(), 1e-8) << scene.model.bodies[i].name;
  }
  const std::vector<CableReport> at_rest = still.cable_reports();
  const std::vector<CableReport> settled = moving.cable_reports();
  for (std::size_t c = 0; c < at_rest.size(); ++c) {
    for (std::size_t k = 0; k < at_rest[c].spans.size(); ++k) {
      // Of 2.5 N.
      EXPECT_NEAR(at_rest[c].spans[k].tension, settled[c].spans[k].tension, 2.5e-8)
          << at_rest[c].name << " " << k;
    }
  }
  const std::vector<JointReport> held = joint_reports(still.world);
  const std::vector<JointReport> holding = joint_reports(moving.world);
  for (std::size_t j = 0; j < held.size(); ++j) {
    EXPECT_LT((held[j].force - holding[j].force).norm(), 2.5e-8) << held[j].name;
  }
}

TEST(Machines, CraneHangsAtItsTextbookTensions) {
  const Scene scene = scene_file("machines/crane.json");
  Simulation simulation = simulation_of(scene);
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_EQ(rest.stability, Stability::stable);
  // 5000 kg on two parts; the luff tackle from moments about the boom's foot, whose arms the scene
  // tells with 7 digits.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(tension(simulation, 0, k), 24525.0, 24525.0 * near_exact);
    EXPECT_NEAR(tension(simulation, 1, k), 48306.85, 48306.85 * 1e-6);
  }
}

/// Without its luffing cable the boom falls, with the load, and there is nothing to fall on.
TEST(Machines, UnheldBoomFindsNoEquilibriumAtItsPose) {
  Scene scene = scene_file("machines/crane.json");
  scene.cables.pop_back();
  Simulation simulation = simulation_of(scene);
  const double before = simulation.world.state().bodies[1].position.y();
  const Equilibrium rest = find_equilibrium(simulation);
  // Either it hangs below its foot, or the message names what is left.
  if (rest.converged) {
    EXPECT_LT(simulation.world.state().bodies[1].position.y(), before - 1.0);
  } else {
    EXPECT_NE(rest.message.find("no equilibrium was found: on \""), std::string::npos);
  }
}

TEST(Machines, MotorThatNothingStopsHasNoRest) {
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "motor", "mobility": "rotor", "mass": 1, "drive": "torque", "drive_values": [5],
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}}])");
  EquilibriumSettings settings;
  settings.iterations = 40;
  const Equilibrium rest = find_equilibrium(simulation, settings);
  EXPECT_FALSE(rest.converged);
  EXPECT_NE(rest.message.find("no equilibrium was found: on \"motor\" 5 N or N m are left"),
            std::string::npos)
      << rest.message;
}

/// A pendulum of the length p that carries the hook (m, I about its centre of mass, which is c below
/// its sheave's axle): M = [m p^2, m p c; m p c, I + m c^2], K = m g [p, c]. That the two parts of
/// the rope lie about sheaves does not matter: the hook sheave moves about the point at which its
/// part leaves the tip sheave (an involute), with the radius p.
std::array<double, 2> sway_squares(double mass, double inertia, double part, double below) {
  Eigen::Matrix2d masses;
  masses << mass * part * part, mass * part * below, mass * part * below,
      inertia + mass * below * below;
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
  stiffness.diagonal() << mass * 9.81 * part, mass * 9.81 * below;
  const Eigen::Matrix2d inverse = masses.inverse() * stiffness;
  const double half = 0.5 * inverse.trace();
  const double root = std::sqrt(half * half - inverse.determinant());
  return {half - root, half + root};
}

constexpr double of_differences = 1e-6;  // as in modes_test.cpp

TEST(Machines, CraneSwaysAsAPendulum) {
  const Scene scene = scene_file("machines/crane.json");
  Simulation simulation = simulation_of(scene);
  ASSERT_TRUE(find_equilibrium(simulation).converged);
  const BodyProperties& hook = simulation.world.bodies()[4];
  const double below = 4.0 - simulation.world.state().bodies[4].position.y();
  const auto expected = sway_squares(hook.mass, hook.axis_inertia, 8.0, below);
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.modes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(modes.modes[i].eigenvalue, expected[i], of_differences * expected[i]);
  }
}

TEST(Machines, CraneOnAHoistRopeThatStretchesSwaysMoreSlowlyAndBounces) {
  // c = 2e-5 m/N of each of three spans under T = m g / 2: the parts are 3 c T / 2 longer. Up and
  // down, the rope of 3 c carries with two parts: k = 4 / 3 c, and 2 T turns with the sway alone.
  constexpr double compliance = 2e-5;
  Scene scene = scene_file("machines/crane.json");
  scene.cables[0].compliance = compliance;
  Simulation simulation = simulation_of(scene);
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const BodyProperties& hook = simulation.world.bodies()[4];
  const double stretch = 3.0 * compliance * hook.mass * 9.81 / 2.0;
  const double part = 8.0 + 0.5 * stretch;
  EXPECT_NEAR(simulation.cable_reports()[0].spans[1].length, part, 8.0 * near_exact);
  const double below = 4.0 - 0.5 * stretch - simulation.world.state().bodies[4].position.y();
  const auto sway = sway_squares(hook.mass, hook.axis_inertia, part, below);
  const double bounce = 4.0 / (3.0 * compliance * hook.mass);
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.modes.size(), 3U);
  EXPECT_NEAR(modes.modes[0].eigenvalue, sway[0], of_differences * sway[0]);
  EXPECT_NEAR(modes.modes[1].eigenvalue, std::min(sway[1], bounce), of_differences * bounce);
  EXPECT_NEAR(modes.modes[2].eigenvalue, std::max(sway[1], bounce), of_differences * bounce);
}

}  // namespace
}  // namespace sheave
