// Bodies with several joints that become chains of bodies.

#include <cmath>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/import/import.h"
#include "scenes/scene.h"
#include "statics/joint_space.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using import::mjcf::Model;
using import::mjcf::Pose;
using testing::HasSubstr;

/// Joints of all kinds that no joint of a scene has together, on a machine that branches. The
/// bodies carry parts, and an equality, springs, dampers and a range name them.
constexpr const char* machine = R"(<mujoco>
  <option gravity="1 -2 -9"/>
  <compiler angle="radian"/>
  <worldbody>
    <body name="base" pos=".1 .2 .3" euler=".3 -.2 .5">
      <joint name="x" type="slide" axis="1 .2 0" stiffness="3" springref=".1"/>
      <joint name="y" type="slide" axis="0 1 .3" damping=".4"/>
      <joint name="turn" axis="0 .1 1" pos=".05 0 0" damping=".2"/>
      <inertial pos=".1 .02 0" mass="2" diaginertia=".05 .06 .04"/>
      <body name="hip" pos=".3 0 .1" euler="0 .4 .1">
        <joint name="a" axis="1 0 0" pos="0 .02 0" damping=".1" range="-3 3"/>
        <joint name="b" axis="0 1 0" stiffness="2" springref=".3"/>
        <joint name="c" axis=".1 0 1" pos=".01 0 .02" ref=".2"/>
        <inertial pos="0 0 -.2" mass="1" diaginertia=".02 .02 .003"/>
        <body pos="0 0 -.4"><inertial pos="0 0 0" mass=".3" diaginertia=".001 .001 .001"/></body>
        <body name="foot" pos="0 .1 -.5">
          <joint name="d" axis="0 1 0"/>
          <joint name="e" axis="0 1 0" pos="0 0 -.1"/>
          <inertial pos=".05 0 -.1" mass=".5" diaginertia=".004 .003 .002"/>
        </body>
      </body>
      <body name="arm" pos="-.2 .1 0">
        <joint name="f" axis="1 0 0"/>
        <inertial pos="0 .2 0" mass=".7" diaginertia=".01 .002 .01"/>
      </body>
    </body>
  </worldbody>
</mujoco>)";

class SplitJoints : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

Eigen::VectorXd random_vector(int size, double most, unsigned& seed) {
  Eigen::VectorXd vector(size);
  for (double& value : vector) {
    seed = 1664525U * seed + 1013904223U;
    value = most * (2.0 * static_cast<double>(seed) / 4294967296.0 - 1.0);
  }
  return vector;
}

std::vector<double> values_of(const Eigen::VectorXd& vector) {
  return {vector.begin(), vector.end()};
}

/// Momentum of the model along its coordinates, d kinetic energy / d rate: the sum over bodies of
/// m v . dv + w . I dw, with the velocities that pose_of() has for the rates.
Eigen::VectorXd momentum(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  const auto pose = [&](const Eigen::VectorXd& rates) {
    return pose_of(model, values_of(q), values_of(rates));
  };
  const Pose own = pose(u);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(q.size());
  for (int k = 0; k < q.size(); ++k) {
    const Pose unit = pose(Eigen::VectorXd::Unit(q.size(), k));
    for (std::size_t i = 1; i < model.bodies.size(); ++i) {
      const import::mjcf::Inertial& part = model.bodies[i].inertial;
      const Matrix3 turn = own.bodies[i].frame.orientation.toRotationMatrix();
      const Vector3 arm = turn * part.center;
      const auto speed = [&](const Pose& at) -> Vector3 {
        return at.bodies[i].velocity + at.bodies[i].angular_velocity.cross(arm);
      };
      sum[k] += part.mass * speed(own).dot(speed(unit)) +
                (turn.transpose() * own.bodies[i].angular_velocity)
                    .dot(part.inertia * (turn.transpose() * unit.bodies[i].angular_velocity));
    }
  }
  return sum;
}

/// Kinetic energy less that of gravity and springs.
double lagrangian(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  double sum = 0.5 * u.dot(momentum(model, q, u));
  const Pose pose = pose_of(model, values_of(q), {});
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const import::mjcf::Inertial& part = model.bodies[i].inertial;
    sum += part.mass * model.option.gravity.dot(pose.bodies[i].frame.point(part.center));
  }
  for (const import::mjcf::Joint& joint : model.joints) {
    const double stretch = q[joint.qpos] - joint.spring_reference;
    sum -= 0.5 * joint.stiffness * stretch * stretch;
  }
  return sum;
}

/// Accelerations by Lagrange's equations, M a = dL/dq - (dp/dq) u - damping u, with central
/// differences of step h: their error is h^2 / 6 of the third derivatives, and 1e-16 / h of rounding.
Eigen::VectorXd accelerations(const Model& model, const Eigen::VectorXd& q,
                              const Eigen::VectorXd& u) {
  constexpr double h = 1e-5;
  const auto n = q.size();
  Eigen::MatrixXd mass(n, n);
  Eigen::VectorXd force(n);
  for (int k = 0; k < n; ++k) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(n, k);
    mass.col(k) = momentum(model, q, Eigen::VectorXd::Unit(n, k));
    force[k] = (lagrangian(model, q + step, u) - lagrangian(model, q - step, u)) / (2.0 * h) -
               model.joints[static_cast<std::size_t>(k)].damping * u[k];
  }
  force -= (momentum(model, q + h * u, u) - momentum(model, q - h * u, u)) / (2.0 * h);
  return mass.ldlt().solve(force);
}

TEST_F(SplitJoints, BodiesStandAndMoveAsInTheModel) {
  const test::ReadModel model(machine);
  unsigned seed = 5;
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd q = random_vector(model->position_count, 1.0, seed);
    const Eigen::VectorXd u = random_vector(model->velocity_count, 2.0, seed);
    const Scene scene = test::scene_in_keyframe(
        test::with_keyframe(machine, values_of(q), values_of(u)), "machine");
    const Pose pose = pose_of(*model, values_of(q), values_of(u));
    // Two bodies between for three joints, one for two.
    ASSERT_EQ(scene.model.bodies.size(), 4U + 2U + 2U + 1U);
    for (const BodyDef& body : scene.model.bodies) {
      const auto found = model->body_names.find(body.name);
      if (found == model->body_names.end()) continue;
      const import::mjcf::BodyPose& expected = pose.bodies[static_cast<std::size_t>(found->second)];
      EXPECT_LT((body.position - expected.frame.position).norm(), 1e-14) << body.name;
      EXPECT_LT(body.orientation.angularDistance(expected.frame.orientation), 1e-7) << body.name;
      EXPECT_LT((body.angular_velocity - expected.angular_velocity).norm(), 1e-13) << body.name;
    }
  }
}

// The bodies between have 1e-6 of the masses, so accelerations differ by 1e-6 of the largest times
// the spread of the mass matrix, in which a foot of 0.5 kg stands beside a base of 4.5 kg. Differences
// of momenta and energies of order 1 have errors of 1e-10.
TEST_F(SplitJoints, AccelerationsAreThoseOfLagrangesEquations) {
  const test::ReadModel model(machine);
  unsigned seed = 7;
  double worst = 0.0;
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd q = random_vector(model->position_count, 1.0, seed);
    const Eigen::VectorXd u = random_vector(model->velocity_count, 2.0, seed);
    const Scene scene = test::scene_in_keyframe(
        test::with_keyframe(machine, values_of(q), values_of(u)), "machine");
    Result<Simulation> simulation = create_simulation(scene);
    ASSERT_TRUE(simulation) << simulation.errors().front().message;
    Result<JointSpace> space = JointSpace::create(*simulation);
    ASSERT_TRUE(space) << space.errors().front().message;
    ASSERT_EQ(space->coordinates().size(), static_cast<std::size_t>(model->velocity_count));
    const Result<ModalVector> own = space->forward_dynamics(ModalVector::Zero(q.size()));
    ASSERT_TRUE(own);
    const Eigen::VectorXd expected = accelerations(*model, q, u);
    worst = std::max(worst, (*own - expected).norm() / expected.norm());
  }
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(worst, 1e-8) << "the bodies between have no mass";
}

// On slides along x and at 60 degrees to it a body falls freely in their plane. With the part e of
// its mass on the first slide, M q'' = f is
//   (1 + e) q1'' + c q2'' = 0,   c q1'' + q2'' = -g s,   c = cos 60, s = sin 60,
// so q1'' = c g s / (s^2 + e), and the body has x'' = q1'' + c q2'' = -e q1''.
TEST_F(SplitJoints, ABodyOnTwoSlantedSlidesFallsFreely) {
  const std::string text =
      "<mujoco><option gravity='0 0 -10'/><worldbody><body name='load'>"
      "<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0.5 0 0.8660254037844386'/>"
      "<inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/></body></worldbody></mujoco>";
  const import::Outcome made = import::import_model(text, "model.xml");
  ASSERT_TRUE(made.errors.empty());
  EXPECT_THAT(import::report(made), HasSubstr("1 small body between the joints of the body"));
  SceneResult scene = load_scene_text(made.json, "model.xml", {{"/step/dt", "1e-3", ""}});
  ASSERT_TRUE(scene);
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  constexpr int steps = 100;
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(simulation->step().ok());
  const double time = steps * 1e-3;
  const double s = std::sqrt(0.75);
  constexpr double e = 1e-6;
  const double first = 0.5 * 10.0 * s / (s * s + e);
  const Vector3 speed = simulation->world.velocity(BodyId{1});  // behind the one between
  // Constant accelerations are exact but for rounding, which the small mass makes 1e6 times larger.
  EXPECT_NEAR(speed.x(), -e * first * time, 1e-9);
  EXPECT_NEAR(speed.z(), (-10.0 + e * first * 0.5 / s) * time, 1e-9);
}

TEST_F(SplitJoints, ANameThatABodyHasGetsTheWordJoint) {
  const std::string text =
      "<mujoco><worldbody><body name='leg'><joint name='leg'/><geom size='.1'/></body>"
      "</worldbody></mujoco>";
  const SceneResult scene = load_scene_text(text, "model.xml");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  EXPECT_EQ(scene->model.joints.front()->name, "leg joint");
}

}  // namespace
}  // namespace sheave
