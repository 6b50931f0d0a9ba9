// OpenSim models: coordinates that follow others, points and wraps of paths that depend on the
// start.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/control/scene_supervisor.h"
#include "tests/import/opensim_files.h"

namespace sheave {
namespace {

using nlohmann::json;
using test::opensim_axis;
using test::opensim_body;
using test::opensim_document;
using test::opensim_joint;
using testing::HasSubstr;

class OpenSimJoints : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

std::string in_set(const std::string& tag, const std::string& content) {
  return "<" + tag + "><objects>" + content + "</objects></" + tag + ">\n";
}
std::string coupler(const std::string& follower, const std::string& leader,
                    const std::string& function) {
  return in_set("ConstraintSet",
                "<CoordinateCouplerConstraint name=\"c\"><coupled_coordinates_function>" +
                    function + "</coupled_coordinates_function><independent_coordinate_names>" +
                    leader + "</independent_coordinate_names><dependent_coordinate_name>" +
                    follower + "</dependent_coordinate_name></CoordinateCouplerConstraint>");
}

/// The number of a body of a scene.
BodyId body_named(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    if (scene.model.bodies[i].name == name) return BodyId{static_cast<int>(i)};
  }
  throw std::runtime_error("no body " + name);
}
double angle_of(const World& world, BodyId body) {
  const Quaternion turn = world.orientation(body);
  return 2.0 * std::atan2(turn.z(), turn.w());
}

// Two pendulums whose angles a constraint ties, 2 a + 0.1: from the start on, to the solver's 1e-9.
TEST_F(OpenSimJoints, CoordinatesFollowTheirConstraint) {
  const Scene scene = test::opensim_scene(test::with_coordinates(
      opensim_document(
          in_set("BodySet", opensim_body("first") + opensim_body("second")) +
          in_set("JointSet", opensim_joint("PinJoint", "j", "first", {"a"}) +
                                 opensim_joint("PinJoint", "k", "second", {"b"})) +
          coupler("b", "a", "<LinearFunction><coefficients>2 0.1</coefficients></LinearFunction>")),
      {{"a", 0.3}}));
  Result<Simulation> simulation = create_simulation(scene);
  ASSERT_TRUE(simulation) << simulation.errors().front().message;
  const BodyId first = body_named(scene, "first");
  const BodyId second = body_named(scene, "second");
  double least = 1.0;
  for (int i = 0; i < 500; ++i) {
    const double angle = angle_of(simulation->world, first);
    EXPECT_NEAR(angle_of(simulation->world, second), 2.0 * angle + 0.1, 1e-8);
    least = std::min(least, angle);
    ASSERT_TRUE(simulation->step().ok());
  }
  EXPECT_LT(least, 0.1);
}

// A kneecap: its coordinate moves it by curves alone, and follows the knee. The curve here is a
// cubic through points of a cubic, so that the polynomial is the curve.
TEST_F(OpenSimJoints, BodiesThatOnlyCurvesMoveFollowTheLeader) {
  const auto cubic = [](double q) { return 0.02 + 0.03 * q - 0.01 * q * q * q; };
  std::string x, y;
  for (const double q : {-1.0, -0.5, 0.0, 0.4, 1.0}) {
    x += std::to_string(q) + " ";
    y += std::to_string(cubic(q)) + " ";
  }
  const std::string spline = "<SimmSpline><x>" + x + "</x><y>" + y + "</y></SimmSpline>";
  const std::string transform =
      "<SpatialTransform>" + opensim_axis("translation1", "beta", "1 0 0", spline) +
      opensim_axis("translation2", "beta", "0 1 0",
                   "<PolynomialFunction><coefficients>0.1 0 0</coefficients>"
                   "</PolynomialFunction>") +
      "</SpatialTransform>";
  const std::string text = opensim_document(
      in_set("BodySet", opensim_body("shank") + opensim_body("cap")) +
      in_set("JointSet", opensim_joint("PinJoint", "knee", "shank", {"q"}) +
                             opensim_joint("CustomJoint", "pf", "cap", {"beta"}, transform)) +
      coupler("beta", "q", "<LinearFunction><coefficients>-1 0</coefficients></LinearFunction>"));
  const Scene scene = test::opensim_scene(test::with_coordinates(text, {{"q", 0.7}}));
  Result<Simulation> simulation = create_simulation(scene);
  ASSERT_TRUE(simulation) << simulation.errors().front().message;
  const BodyId shank = body_named(scene, "shank");
  const BodyId cap = body_named(scene, "cap");
  for (int i = 0; i < 300; ++i) {
    const double q = angle_of(simulation->world, shank);
    const Vector3 at = simulation->world.position(cap);
    // Decimals of the text are 1e-6; the polynomial is the spline to 1e-9, the rows to 1e-9.
    EXPECT_NEAR(at.x(), cubic(-q), 2e-6);
    EXPECT_NEAR(at.y(), 0.1 * q * q, 1e-8);
    ASSERT_TRUE(simulation->step().ok());
  }
}

std::string pendulum_with(const std::string& points, const std::string& wraps = {},
                          const std::string& wrap_objects = {}) {
  std::string rod = opensim_body("rod");
  rod.insert(rod.find("</Body>"), wrap_objects);
  return opensim_document(
      in_set("BodySet", rod) +
      in_set("JointSet", opensim_joint("PinJoint", "pivot", "rod", {"angle"})) +
      in_set("ForceSet",
             "<PathActuator name=\"line\"><GeometryPath>" +
                 in_set("PathPointSet",
                        "<PathPoint name=\"a\"><socket_parent_frame>/ground</socket_parent_frame>"
                        "<location>0.3 0 0</location></PathPoint>" +
                            points +
                            "<PathPoint name=\"z\"><socket_parent_frame>/bodyset/rod"
                            "</socket_parent_frame><location>0 -0.3 0</location></PathPoint>") +
                 wraps + "</GeometryPath></PathActuator>"));
}
json path_cable(const std::string& text) {
  const import::Outcome made = import::import_model(text, "m.osim");
  if (!made.errors.empty()) throw std::runtime_error(to_string(made.errors.front()));
  return json::parse(made.json)["cables"][0];
}

TEST_F(OpenSimJoints, ConditionalPointsAreThereIfTheyAreAtTheStart) {
  const auto point = [](const std::string& range) {
    return pendulum_with(
        "<ConditionalPathPoint name=\"c\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>"
        "<location>0.1 -0.1 0</location><socket_coordinate>/jointset/pivot/angle"
        "</socket_coordinate><range>" +
        range + "</range></ConditionalPathPoint>");
  };
  EXPECT_EQ(path_cable(point("-2 2"))["links"].size(), 3U);
  EXPECT_EQ(path_cable(point("-0.1 0.1"))["links"].size(), 3U);
  EXPECT_EQ(path_cable(point("0.5 1"))["links"].size(), 2U);
  const auto told = [&](const std::string& range) {
    return import::report(import::import_model(point(range), "m.osim"));
  };
  EXPECT_THAT(told("-0.1 0.1"), HasSubstr("always a point of the path; in OpenSim while \"angle\" "
                                          "is in -0.1 ... 0.1"));
  EXPECT_THAT(told("0.5 1"), HasSubstr("never a point of the path"));
  EXPECT_THAT(told("-2 2"), Not(HasSubstr("ConditionalPathPoint \"c\": always")));
}

// A kink of 0.3 per rad on both sides differs from each polynomial of degree 9 by several mm.
TEST_F(OpenSimJoints, PointsThatMoveByNoPolynomialStandWhereTheyStart) {
  const auto axis = [](const std::string& name, const std::string& function) {
    return "<socket_" + name + "_coordinate>/jointset/pivot/angle</socket_" + name +
           "_coordinate><" + name + "_location>" + function + "</" + name + "_location>";
  };
  const std::string text = test::with_coordinates(
      pendulum_with(
          "<MovingPathPoint name=\"p\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>" +
          axis("x",
               "<PiecewiseLinearFunction><x>-1 0 1</x><y>0.3 0 0.3</y>"
               "</PiecewiseLinearFunction>") +
          axis("y", "<Constant><value>-0.1</value></Constant>") +
          axis("z", "<Constant><value>0</value></Constant>") + "</MovingPathPoint>"),
      {{"angle", 0.5}});
  const json point = path_cable(text)["links"][1]["point"];
  EXPECT_NEAR(point[0].get<double>(), 0.15, 1e-15);
  EXPECT_THAT(import::report(import::import_model(text, "m.osim")),
              HasSubstr("in OpenSim it moves along an axis by up to 0.15 m"));
}

// The second one of three segments crosses the bar; a bar that is too short is left out.
TEST_F(OpenSimJoints, WrapsLieBetweenThePointsThatTheyBend) {
  const auto bar = [](const std::string& length) {
    return pendulum_with(
        "<PathPoint name=\"b\"><socket_parent_frame>/ground</socket_parent_frame>"
        "<location>0.2 -0.02 0.3</location></PathPoint>"
        "<PathPoint name=\"c\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>"
        "<location>-0.2 -0.02 0.3</location></PathPoint>",
        in_set("PathWrapSet",
               "<PathWrap name=\"w\"><wrap_object>bar</wrap_object>"
               "<range>-1 -1</range></PathWrap>"),
        in_set("WrapObjectSet", "<WrapCylinder name=\"bar\"><radius>0.05</radius><length>" +
                                    length +
                                    "</length><translation>0 0 0</translation></WrapCylinder>"));
  };
  const json links = path_cable(bar("2"))["links"];
  ASSERT_EQ(links.size(), 5U);
  EXPECT_EQ(links[2]["type"], "surface");
  EXPECT_EQ(path_cable(bar("0.1"))["links"].size(), 4U);
  EXPECT_THAT(import::report(import::import_model(bar("0.1"), "m.osim")),
              HasSubstr("at the start the path lies beyond an end of the cylinder"));
}

}  // namespace
}  // namespace sheave
