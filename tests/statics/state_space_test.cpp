// x' = A x + B u against the machine in motion: drives of joints as inputs.

#include <cmath>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A trolley of 3 kg on a rail along x that a drive moves, a rod of 2 kg with a damped hinge below
/// it, unequal springs from the rod's lower end to both walls: two motions, or one where the drive
/// holds the trolley.
std::string trolley(const std::string& drive, int steps_per_second) {
  return fmt::format(
      R"("step": {{"dt": {}, "solver": "direct", "integrator": "rattle"}},
    "bodies": [
    {{"name": "trolley", "mobility": "planar", "axis": [0, 0, 1], "mass": 3, "inertia": [1, 1, 1]}},
    {{"name": "rod", "mobility": "planar", "axis": [0, 0, 1], "mass": 2, "position": [0, -0.5, 0],
      "shape": {{"type": "box", "size": [0.05, 1, 0.05]}}}}],
    "joints": [
    {{"type": "slider", "name": "rail", "body_b": "trolley", "anchor": [0, 0, 0], "axis": [1, 0, 0], "damping": 0.4, {}}},
    {{"type": "hinge", "name": "pin", "body_a": "trolley", "body_b": "rod", "anchor": [0, 0, 0],
      "axis": [0, 0, 1], "damping": 0.3}}],
    "cables": [
    {{"name": "left", "axial_stiffness": 60, "rest_lengths": [0.9], "links": [
      {{"type": "attachment", "body": "world", "point": [-1, -1.2, 0]}},
      {{"type": "attachment", "body": "rod", "point": [0, -0.5, 0]}}]}},
    {{"name": "right", "axial_stiffness": 50, "rest_lengths": [0.9], "links": [
      {{"type": "attachment", "body": "rod", "point": [0, -0.5, 0]}},
      {{"type": "attachment", "body": "world", "point": [1, -1, 0]}}]}}])",
      1.0 / steps_per_second, drive);
}

/// Displacements of trolley and rod after `time` of an input that has grown steadily to `last`, by
/// the linear model.
Eigen::VectorXd predicted(const Modes& modes, double time, double last) {
  const Eigen::Index k = modes.motions.cols();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(modes.state_matrix.rows());
  const auto rate = [&](const Eigen::VectorXd& at, double now) {
    return Eigen::VectorXd(modes.state_matrix * at +
                           modes.input_matrix.col(0) * (last * now / time));
  };
  // Runge and Kutta's method of the fourth order: (w h)^4 / 100 with w h < 0.01 is rounding.
  constexpr int steps = 2000;
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const double now = i * h;
    const Eigen::VectorXd a = rate(x, now);
    const Eigen::VectorXd b = rate(x + 0.5 * h * a, now + 0.5 * h);
    const Eigen::VectorXd c = rate(x + 0.5 * h * b, now + 0.5 * h);
    const Eigen::VectorXd d = rate(x + h * c, now + h);
    x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return modes.motions * x.head(k) + modes.driven_motions * x.tail(x.size() - 2 * k);
}

/// The same of the machine, by a central difference of two runs: x of the trolley [m], turn of the
/// rod [rad].
Eigen::Vector2d simulated(const std::string& drive, int steps_per_second, double time,
                          double last) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const double sign : {1.0, -1.0}) {
    Simulation simulation = simulation_of(trolley(drive, steps_per_second));
    EXPECT_TRUE(find_equilibrium(simulation).converged);
    DriveTarget target(sign * last, time);
    // A place that is reached with a speed that has grown steadily.
    if (drive.find("position") != std::string::npos) {
      target = DriveTarget(sign * last * time / 2.0, time, sign * last);
    }
    EXPECT_TRUE(simulation.world.set_joint_drive(0, 0, target).empty());
    for (int i = 0; i < static_cast<int>(std::lround(time * steps_per_second)); ++i) {
      EXPECT_TRUE(simulation.step().ok());
    }
    const std::vector<BodyState>& bodies = simulation.world.state().bodies;
    const Quaternion& q = bodies[1].orientation;
    sum += 0.5 * sign * Eigen::Vector2d(bodies[0].position.x(), 2.0 * std::atan2(q.z(), q.w()));
  }
  return sum;
}

/// What the linear model is off the machine by, as a share of the largest displacement.
double difference(const std::string& drive, double last, int steps_per_second) {
  constexpr double time = 0.8;
  Simulation simulation = simulation_of(trolley(drive, steps_per_second));
  EXPECT_TRUE(find_equilibrium(simulation).converged);
  ModeInput input;
  input.kind = ModeInput::Kind::joint_drive;
  const Modes modes = find_modes(simulation, {input});
  const Eigen::VectorXd q = predicted(modes, time, last);
  EXPECT_EQ(freedom_names(simulation)[5], "rod.turn");
  // The trolley moves along x alone; a planar body's first two directions lie anyhow in its plane.
  const Eigen::Vector2d model(std::hypot(q[0], q[1]), q[5]);
  const Eigen::Vector2d machine = simulated(drive, steps_per_second, time, last);
  return (model - machine).cwiseAbs().maxCoeff() / machine.cwiseAbs().maxCoeff();
}

/// Rattle is of the second order: with w = 10 /s and 1 / 1000 s (w h)^2 / 12 = 8e-6, and a quarter
/// of it with half the step. What is not linear is odd in the input, (4e-4)^2 of the displacements.
void expect_agreement(const std::string& drive, double last) {
  const double coarse = difference(drive, last, 1000);
  const double fine = difference(drive, last, 2000);
  EXPECT_LT(coarse, 2e-5) << drive;
  EXPECT_LT(fine, 5e-6) << drive;
  EXPECT_LT(fine, 0.3 * coarse + 1.6e-7) << drive;
}

TEST(StateSpace, ForceOfAJointsDriveIsAnInput) {
  expect_agreement(R"("drive": "force", "drive_values": [0])", 1e-3);
}

TEST(StateSpace, SpeedOfAJointsDriveIsAnInput) {
  expect_agreement(R"("drive": "speed", "drive_values": [0])", 1e-3);
}

TEST(StateSpace, SpeedOfARigidDriveToAPlaceIsAnInput) {
  expect_agreement(R"("drive": "position", "drive_values": [0])", 1e-3);
}

TEST(StateSpace, SpeedOfADriveToAPlaceThatGivesIsAnInput) {
  expect_agreement(R"("drive": "position", "drive_values": [0], "drive_compliance": 0.002)", 1e-3);
}

TEST(StateSpace, DriveAtItsLimitHoldsNothing) {
  // As the scene has it the springs pull the trolley with 0.5 N: more than a drive of 0.1 N has.
  const auto motions = [](double limit) {
    Simulation simulation = simulation_of(trolley(
        fmt::format(R"("drive": "speed", "drive_values": [0], "drive_limit": {})", limit), 1000));
    ModeInput input;
    input.kind = ModeInput::Kind::joint_drive;
    const Modes modes = find_modes(simulation, {input});
    return std::pair(modes.modes.size(), modes.input_matrix.topRows(modes.modes.size() * 2).norm() +
                                             modes.driven_motions.norm());
  };
  const auto [held, moved] = motions(100.0);
  const auto [stalled, idle] = motions(0.1);
  EXPECT_EQ(held, 1U);
  EXPECT_GT(moved, 0.1);
  EXPECT_EQ(stalled, 2U);
  EXPECT_EQ(idle, 0.0);
}

TEST(StateSpace, KnowsWhichCoordinatesHaveDrives) {
  const Simulation simulation =
      simulation_of(trolley(R"("drive": "force", "drive_values": [0])", 1000));
  EXPECT_TRUE(has_joint_drive(simulation.world, 0, 0));
  EXPECT_FALSE(has_joint_drive(simulation.world, 1, 0));
}

}  // namespace
}  // namespace sheave
