// Points of OpenSim paths that move by coordinates: lengths, moment arms and torques in closed form.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "statics/joint_space.h"
#include "tests/import/opensim_files.h"

namespace sheave {
namespace {

using testing::HasSubstr;

class MovingPoints : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

std::string list_of(const std::string& tag, const std::string& content) {
  return "<" + tag + "><objects>" + content + "</objects></" + tag + ">\n";
}

/// A component of a moving point by the coordinate "angle" of the joint "pivot".
std::string component(const std::string& axis, const std::string& function) {
  return "<socket_" + axis + "_coordinate>/jointset/pivot/angle</socket_" + axis + "_coordinate><" +
         axis + "_location>" + function + "</" + axis + "_location>";
}
std::string constant_function(double value) {
  return fmt::format("<Constant><value>{}</value></Constant>", value);
}

/// A rod that turns about z, with a path from a point of the ground over a moving point of the rod
/// to a point of the rod, or the other way round.
std::string swing(const std::string& x, const std::string& y, bool reversed) {
  const std::string ground =
      "<PathPoint name=\"a\"><socket_parent_frame>/ground</socket_parent_frame>"
      "<location>0.3 0.1 0.05</location></PathPoint>";
  const std::string moving =
      "<MovingPathPoint name=\"p\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>" +
      component("x", x) + component("y", y) + component("z", constant_function(0.02)) +
      "</MovingPathPoint>";
  const std::string rod =
      "<PathPoint name=\"b\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>"
      "<location>-0.1 -0.4 0</location></PathPoint>";
  const std::string path = reversed ? rod + moving + ground : ground + moving + rod;
  return test::opensim_document(
      list_of("BodySet", test::opensim_body("rod")) +
      list_of("JointSet", test::opensim_joint("PinJoint", "pivot", "rod", {"angle"})) +
      list_of("ForceSet", "<PathSpring name=\"s\"><GeometryPath>" + list_of("PathPointSet", path) +
                              "</GeometryPath><resting_length>0.2</resting_length>"
                              "<stiffness>100</stiffness></PathSpring>"));
}

/// Length of the path and its derivative by the angle, for the point (x, y) with the derivatives
/// (dx, dy): the first span from a to R p has the rate e . (z x R p + R p'), the second, from p to b
/// in the rod, e . p'.
std::pair<double, double> path_length(double angle, double x, double y, double dx, double dy) {
  const Quaternion turn = Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  const Vector3 p(x, y, 0.02);
  const Vector3 rate(dx, dy, 0.0);
  const Vector3 first = turn * p - Vector3(0.3, 0.1, 0.05);
  const Vector3 second = p - Vector3(-0.1, -0.4, 0.0);
  const Vector3 moved = Vector3::UnitZ().cross(turn * p) + turn * rate;
  return {first.norm() + second.norm(),
          first.normalized().dot(moved) + second.normalized().dot(rate)};
}

struct Measured {
  double length = 0.0;
  double arm = 0.0;           ///< about the coordinate "angle"
  double acceleration = 0.0;  ///< of the angle, from rest in the first step of 1e-5 s
  double inertia = 0.0;
};
Measured measured(const std::string& text) {
  Scene scene = test::opensim_scene(text);
  scene.model.step.dt = 1e-5;
  scene.model.gravity = Vector3::Zero();
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  Result<JointSpace> space = JointSpace::create(*simulation);
  if (!space) throw std::runtime_error(space.errors().front().message);
  if (space->coordinates().size() != 1U) throw std::runtime_error("not one coordinate");
  const CableArms arms = space->cable_arms();
  Measured own{arms.lengths[0], arms.arms(0, 0), 0.0, space->mass_matrix()(0, 0)};
  int rod = -1;
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    if (scene.model.bodies[i].name == "rod") rod = static_cast<int>(i);
  }
  if (!simulation->step().ok()) throw std::runtime_error("no step");
  own.acceleration = simulation->world.angular_velocity(BodyId{rod}).z() / 1e-5;
  return own;
}

// x = 0.1 + 0.2 q and y = -0.1 + 0.3 q^2 - 0.1 q^3 are polynomials, which a coupling has exactly.
// From rest a step of h turns the rod by T h^2 / (2 I), which changes the arm by 1e-8 of itself; the
// bodies of the point have 1e-6 of the mass of the rod.
TEST_F(MovingPoints, LengthsArmsAndTorquesAreThoseOfTheClosedForm) {
  for (const bool reversed : {false, true}) {
    for (const double q : {-1.1, -0.4, 0.0, 0.3, 0.9}) {
      const std::string text = test::with_coordinates(
          swing("<LinearFunction><coefficients>0.2 0.1</coefficients></LinearFunction>",
                "<PolynomialFunction><coefficients>-0.1 0.3 0 -0.1</coefficients>"
                "</PolynomialFunction>",
                reversed),
          {{"angle", q}});
      const Measured own = measured(text);
      const double value = -0.1 * q * q * q + 0.3 * q * q - 0.1;
      const double slope = -0.3 * q * q + 0.6 * q;
      const auto [length, arm] = path_length(q, 0.1 + 0.2 * q, value, 0.2, slope);
      EXPECT_NEAR(own.length, length, 1e-9) << q;
      EXPECT_NEAR(own.arm, arm, 1e-8) << q;
      const double torque = -100.0 * (length - 0.2) * arm;
      EXPECT_NEAR(own.acceleration * own.inertia, torque, 1e-5 * (1.0 + std::abs(torque))) << q;
    }
  }
}

}  // namespace
}  // namespace sheave
