// OpenSim models: functions, muscles, forces, constraints, reports and faults.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/control/scene_supervisor.h"
#include "scenes/import/opensim/function.h"
#include "tests/import/opensim_files.h"

namespace sheave {
namespace {

using import::Outcome;
using import::opensim::Function;
using nlohmann::json;
using test::opensim_axis;
using test::opensim_body;
using test::opensim_document;
using test::opensim_joint;
using testing::HasSubstr;

class OpenSim : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

std::string body_set(const std::string& content) {
  return "<BodySet><objects>" + content + "</objects></BodySet>\n";
}
std::string joint_set(const std::string& content) {
  return "<JointSet><objects>" + content + "</objects></JointSet>\n";
}
/// A pendulum with further sections.
std::string osim_pendulum(const std::string& more) {
  return opensim_document(body_set(opensim_body("rod")) +
                          joint_set(opensim_joint("PinJoint", "pivot", "rod", {"angle"})) + more);
}
std::string osim_path(const std::string& more = {}) {
  return "<GeometryPath><PathPointSet><objects>"
         "<PathPoint name=\"a\"><socket_parent_frame>/ground</socket_parent_frame>"
         "<location>0.1 0 0</location></PathPoint>\n"
         "<PathPoint name=\"b\"><socket_parent_frame>/bodyset/rod</socket_parent_frame>"
         "<location>0 -0.3 0</location></PathPoint>\n</objects></PathPointSet>" +
         more + "</GeometryPath>";
}
std::string force_set(const std::string& content) {
  return "<ForceSet><objects>" + content + "</objects></ForceSet>\n";
}

Outcome made_osim(const std::string& text) { return import::import_model(text, "m.osim"); }
json osim_scene(const std::string& text) {
  const Outcome made = made_osim(text);
  if (!made.errors.empty()) throw std::runtime_error(to_string(made.errors.front()));
  const SceneResult scene = load_scene_text(made.json, "made.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return json::parse(made.json);
}
void refuses_osim(const std::string& text, const std::string& message) {
  const Outcome made = made_osim(text);
  ASSERT_FALSE(made.errors.empty()) << message;
  EXPECT_THAT(to_string(made.errors.front()), HasSubstr(message));
  EXPECT_GE(made.errors.front().line, 1);
}

// A cubic has its own third derivative at both ends, so the spline through its points is the cubic.
TEST_F(OpenSim, SplinesThroughPointsOfACubicAreTheCubic) {
  const auto cubic = [](double x) { return 0.3 - x + 0.5 * x * x - 2.0 * x * x * x; };
  const std::vector<double> x{-1.0, -0.4, 0.1, 0.3, 1.2, 1.5};
  std::vector<double> y;
  for (const double one : x) y.push_back(cubic(one));
  const Function spline = Function::through(x, y, true);
  for (double t = -1.0; t <= 1.5; t += 0.01) EXPECT_NEAR(spline(t), cubic(t), 1e-13) << t;
  // Beyond the points it is the tangent.
  const auto slope = [](double t) { return -1.0 + t - 6.0 * t * t; };
  EXPECT_NEAR(spline(2.0), cubic(1.5) + 0.5 * slope(1.5), 1e-12);
  EXPECT_NEAR(spline(-1.5), cubic(-1.0) - 0.5 * slope(-1.0), 1e-12);
}

TEST_F(OpenSim, FunctionsOfALineAreTheSameFunctions) {
  const Function spline = Function::through({0.0, 0.5, 1.0, 2.0}, {1.0, -1.0, 0.5, 0.2}, true);
  const Function linear = Function::through({0.0, 0.5, 1.0}, {1.0, -1.0, 0.5}, false);
  const Function cubic({1.0, 2.0, -1.0, 0.5});
  for (const Function& one : {spline, linear, cubic}) {
    const Function turned = one.of_line(-2.0, 0.7);
    for (double t = -1.0; t <= 1.0; t += 0.1) {
      EXPECT_NEAR(turned(t), one(-2.0 * t + 0.7), 1e-13) << t;
    }
  }
}

// exp has the Chebyshev coefficients 2 I_k(1), below 1.2e-10 for k = 10, so degree 9 reaches 1.2e-10.
TEST_F(OpenSim, PolynomialsAreAsCloseAsTheirDegreeAllows) {
  std::vector<double> x, y;
  for (int i = 0; i <= 2000; ++i) {
    x.push_back(-1.0 + 0.001 * i);
    y.push_back(std::exp(x.back()));
  }
  const Function smooth = Function::through(x, y, true);
  const import::opensim::Fit fit = fit_polynomial(smooth, -1.0, 1.0, 0.0);
  EXPECT_LT(fit.deviation, 6e-10);
  EXPECT_GT(fit.deviation, 1e-11);
  // The series of |x| up to degree 8 ends with 2 / (9 pi) missing at 0; 200 nodes change it by 1e-4.
  const Function corner = Function::through({-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, false);
  EXPECT_NEAR(fit_polynomial(corner, -1.0, 1.0, 0.0).deviation, 2.0 / (9.0 * std::acos(-1.0)),
              2e-4);
}

// To first order about the optimal length: force F cos a, and L = 1 where the fibres have it.
TEST_F(OpenSim, MusclesHaveTheForceOfTheirFibresAlongTheTendon) {
  const json scene = osim_scene(osim_pendulum(force_set(
      "<Thelen2003Muscle name=\"m\">" + osim_path() +
      "<max_isometric_force>400</max_isometric_force><optimal_fiber_length>0.1"
      "</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length>"
      "<pennation_angle_at_optimal>0.5</pennation_angle_at_optimal>"
      "<max_contraction_velocity>8</max_contraction_velocity><default_activation>0.3"
      "</default_activation><activation_time_constant>0.015</activation_time_constant>"
      "<deactivation_time_constant>0.05</deactivation_time_constant></Thelen2003Muscle>")));
  const json& load = scene["loads"][0];
  const double cosine = std::cos(0.5);
  EXPECT_NEAR(load["force"].get<double>(), 400.0 * cosine, 1e-10);
  EXPECT_NEAR(load["optimal_length"].get<double>(), 0.1 / cosine, 1e-14);
  const double at_optimum =
      load["tendon_length"].get<double>() + load["optimal_length"].get<double>();
  EXPECT_NEAR(at_optimum, 0.2 + 0.1 * cosine, 1e-14);
  EXPECT_EQ(load["max_speed"], 8.0);
  EXPECT_EQ(load["activation"], 0.3);
  EXPECT_EQ(load["activation_time"], 0.015);
  EXPECT_EQ(load["deactivation_time"], 0.05);
}

TEST_F(OpenSim, ForcesOfCoordinatesAreThoseOfJoints) {
  const json scene = osim_scene(osim_pendulum(force_set(
      "<CoordinateActuator name=\"motor\"><coordinate>angle</coordinate><optimal_force>5"
      "</optimal_force></CoordinateActuator>"
      "<CoordinateLimitForce name=\"stop\"><coordinate>angle</coordinate><upper_stiffness>2"
      "</upper_stiffness><upper_limit>30</upper_limit><lower_stiffness>4</lower_stiffness>"
      "<lower_limit>-60</lower_limit></CoordinateLimitForce>"
      "<SpringGeneralizedForce name=\"spring\"><coordinate>angle</coordinate><stiffness>7"
      "</stiffness><rest_length>0.2</rest_length><viscosity>0.5</viscosity>"
      "</SpringGeneralizedForce>")));
  const json& joint = scene["joints"][0];
  EXPECT_EQ(joint["drive"], "torque");
  EXPECT_EQ(joint["stiffness"], 7.0);
  EXPECT_EQ(joint["rest"], 0.2);
  EXPECT_EQ(joint["damping"], 0.5);
  const double degree = std::acos(-1.0) / 180.0;
  EXPECT_NEAR(joint["upper"].get<double>(), 30.0 * degree, 1e-15);
  EXPECT_NEAR(joint["lower"].get<double>(), -60.0 * degree, 1e-15);
  // The mean of 2 and 4 N m per degree.
  EXPECT_NEAR(joint["limit_compliance"].get<double>(), degree / 3.0, 1e-15);
}

TEST_F(OpenSim, PathSpringsAreElasticCables) {
  const json scene =
      osim_scene(osim_pendulum(force_set("<PathSpring name=\"s\">" + osim_path() +
                                         "<stiffness>50</stiffness><resting_length>0.2"
                                         "</resting_length></PathSpring>")));
  const json& cable = scene["cables"][0];
  EXPECT_NEAR(cable["axial_stiffness"].get<double>(), 50.0 * 0.2, 1e-12);
  EXPECT_NEAR(cable["rest_lengths"][0].get<double>(), 0.2, 1e-15);
}

TEST_F(OpenSim, PathSpringsOverEllipsoidsAreTheirPathAlone) {
  std::string text = osim_pendulum(force_set(
      "<PathSpring name=\"s\">" +
      osim_path("<PathWrapSet><objects><PathWrap><wrap_object>egg</wrap_object></PathWrap>"
                "</objects></PathWrapSet>") +
      "<stiffness>50</stiffness><resting_length>0.2</resting_length></PathSpring>"));
  text.insert(text.find("</Body>"),
              "<WrapObjectSet><objects><WrapEllipsoid name=\"egg\"><dimensions>0.03 0.04 0.05"
              "</dimensions><translation>0.05 -0.15 0</translation></WrapEllipsoid></objects>"
              "</WrapObjectSet>");
  const json cable = osim_scene(text)["cables"][0];
  EXPECT_FALSE(cable.contains("axial_stiffness"));
  EXPECT_EQ(cable["links"][1]["type"], "surface");
  EXPECT_THAT(import::report(made_osim(text)), HasSubstr("PathSpring \"s\": its path alone"));
}

// A body slides by a polynomial of the angle by which it turns: the scene starts and stays on it.
TEST_F(OpenSim, DisplacementsFollowTheirCoordinateInMotion) {
  const std::string constant = "<Constant><value>0</value></Constant>";
  const std::string transform =
      "<SpatialTransform>" +
      opensim_axis("rotation1", "angle", "0 0 1",
                   "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>") +
      opensim_axis("translation1", "angle", "1 0 0",
                   "<PolynomialFunction><coefficients>0.05 0.02 0.01 0</coefficients>"
                   "</PolynomialFunction>") +
      opensim_axis("translation2", "", "0 1 0", constant) + "</SpatialTransform>";
  const std::string text = opensim_document(
      body_set(opensim_body("rod")) +
      joint_set(opensim_joint("CustomJoint", "knee", "rod", {"angle"}, transform)));
  const Scene scene = test::opensim_scene(test::with_coordinates(text, {{"angle", 0.6}}));
  Result<Simulation> simulation = create_simulation(scene);
  ASSERT_TRUE(simulation) << simulation.errors().front().message;
  const auto polynomial = [](double q) { return 0.01 * q + 0.02 * q * q + 0.05 * q * q * q; };
  const World& world = simulation->world;
  const auto rod = std::find_if(scene.model.bodies.begin(), scene.model.bodies.end(),
                                [](const BodyDef& body) { return body.name == "rod"; });
  ASSERT_NE(rod, scene.model.bodies.end());
  const BodyId id{static_cast<int>(rod - scene.model.bodies.begin())};
  double least = 1.0;
  for (int i = 0; i < 800; ++i) {
    ASSERT_TRUE(simulation->step().ok());
    const Quaternion turn = world.orientation(id);
    const double angle = 2.0 * std::atan2(turn.z(), turn.w());
    least = std::min(least, angle);
    // The constraint is solved to 1e-9; the origin turns about itself.
    EXPECT_NEAR(world.position(id).x(), polynomial(angle), 1e-8);
    EXPECT_NEAR(world.position(id).y(), 0.0, 1e-8);
  }
  EXPECT_LT(least, -0.3);  // it swings through
}

TEST_F(OpenSim, NothingIsDroppedInSilence) {
  const Outcome made = made_osim(osim_pendulum(
      force_set("<BushingForce name=\"soft\"><x>1</x></BushingForce>"
                "<Thelen2003Muscle name=\"m\">" +
                osim_path() + "<KshapeActive>0.5</KshapeActive></Thelen2003Muscle>") +
      "<ControllerSet><objects><PrescribedController name=\"c\"><on>1</on>"
      "</PrescribedController></objects></ControllerSet>"
      "<MarkerSet><objects><Marker name=\"k\"><x>1</x></Marker></objects></MarkerSet>"));
  ASSERT_TRUE(made.errors.empty()) << to_string(made.errors.front());
  const std::string report = import::report(made);
  for (const char* const part :
       {"BushingForce \"soft\": no force that is known here", "not taken: KshapeActive",
        "PrescribedController \"c\": it has no counterpart",
        "Marker \"k\": it has no counterpart"}) {
    EXPECT_THAT(report, HasSubstr(part));
  }
}

TEST_F(OpenSim, FaultsAreNamedWithTheirLine) {
  refuses_osim("<OpenSimDocument Version=\"1.0\"><Model/></OpenSimDocument>", "Version must be");
  refuses_osim("<OpenSimDocument Version=\"40000\"/>", "<Model> is missing");
  refuses_osim(osim_pendulum("<length_units>feet</length_units>"), "other units are not known");
  refuses_osim(osim_pendulum("<gravity>0 nan 0</gravity>"), "3 finite numbers");
  refuses_osim(osim_pendulum(force_set("<PathSpring name=\"s\">" + osim_path() + "</PathSpring>")),
               "resting_length must be > 0");
  refuses_osim(osim_pendulum(force_set("<CoordinateActuator name=\"a\"><coordinate>x</coordinate>"
                                       "</CoordinateActuator>")),
               "must be the name of a coordinate");
  refuses_osim(osim_pendulum(force_set(
                   "<PathSpring name=\"s\">" +
                   osim_path("<PathWrapSet><objects><PathWrap><wrap_object>no</wrap_object>"
                             "</PathWrap></objects></PathWrapSet>") +
                   "</PathSpring>")),
               "must be the name of a wrap object");
  refuses_osim(opensim_document(body_set(opensim_body("a") + opensim_body("a"))), "the same name");
  refuses_osim(opensim_document(body_set(opensim_body("a")) +
                                joint_set(opensim_joint("PinJoint", "p", "b", {"q"}))),
               "there is no frame or body");
  refuses_osim(opensim_document(body_set(opensim_body("a")) +
                                joint_set(opensim_joint("ScapulothoracicJoint", "p", "a", {"q"}))),
               "no joint that is known here");
  refuses_osim(opensim_document(body_set(opensim_body("a")) +
                                joint_set(opensim_joint("PinJoint", "p", "a", {"q"}) +
                                          opensim_joint("PinJoint", "r", "a", {"s"}))),
               "joints form a tree");
  refuses_osim(opensim_document(body_set(opensim_body("a")) +
                                joint_set(opensim_joint("PinJoint", "p", "a", {}))),
               "a PinJoint has 1 coordinates");
}

TEST_F(OpenSim, FramesInALoopAreRefused) {
  const std::string frames =
      "<frames><PhysicalOffsetFrame name=\"f\"><socket_parent>g</socket_parent>"
      "</PhysicalOffsetFrame><PhysicalOffsetFrame name=\"g\"><socket_parent>f</socket_parent>"
      "</PhysicalOffsetFrame></frames>";
  std::string joint = opensim_joint("PinJoint", "p", "a", {"q"}, frames);
  joint.replace(joint.find("/ground"), 7, "f");
  refuses_osim(opensim_document(body_set(opensim_body("a")) + joint_set(joint)),
               "frames in a loop");
}

TEST_F(OpenSim, ChainsOfBodiesInALoopAreRefused) {
  std::string first = opensim_joint("PinJoint", "p", "a", {"q"});
  first.replace(first.find("/ground"), 7, "/bodyset/b");
  std::string second = opensim_joint("PinJoint", "r", "b", {"s"});
  second.replace(second.find("/ground"), 7, "/bodyset/a");
  refuses_osim(
      opensim_document(body_set(opensim_body("a") + opensim_body("b")) + joint_set(first + second)),
      "form a loop");
}

TEST_F(OpenSim, FunctionsFarFromPolynomialsAreRefused) {
  const std::string transform =
      "<SpatialTransform>" +
      opensim_axis("rotation1", "q", "0 0 1",
                   "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>") +
      opensim_axis("translation1", "q", "1 0 0",
                   "<PiecewiseLinearFunction><x>-1 0 1</x><y>1 0 1</y>"
                   "</PiecewiseLinearFunction>") +
      "</SpatialTransform>";
  refuses_osim(
      opensim_document(body_set(opensim_body("a")) +
                       joint_set(opensim_joint("CustomJoint", "p", "a", {"q"}, transform))),
      "polynomial of degree 9, which differs");
}

// Versions before 4 have joints in bodies, and bodies of points by name.
TEST_F(OpenSim, OldVersionsHaveTheSameMeaning) {
  const std::string old =
      "<OpenSimDocument Version=\"30000\"><Model name=\"m\"><BodySet><objects>"
      "<Body name=\"ground\"><mass>0</mass><Joint/></Body>"
      "<Body name=\"rod\"><mass>1</mass><mass_center>0 -0.2 0</mass_center>"
      "<inertia_xx>0.01</inertia_xx><inertia_yy>0.01</inertia_yy><inertia_zz>0.01</inertia_zz>"
      "<inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz><Joint>"
      "<PinJoint name=\"pivot\"><parent_body>ground</parent_body><location_in_parent>0 0 0"
      "</location_in_parent><orientation_in_parent>0 0 0</orientation_in_parent><location>0 0 0"
      "</location><orientation>0 0 0</orientation><CoordinateSet><objects>"
      "<Coordinate name=\"angle\"><default_value>0</default_value><range>-1 1</range>"
      "</Coordinate></objects></CoordinateSet></PinJoint></Joint></Body></objects></BodySet>"
      "<ForceSet><objects><PathSpring name=\"s\"><isDisabled>false</isDisabled><GeometryPath>"
      "<PathPointSet><objects><PathPoint name=\"a\"><location>0.1 0 0</location><body>ground"
      "</body></PathPoint><PathPoint name=\"b\"><location>0 -0.3 0</location><body>rod</body>"
      "</PathPoint></objects></PathPointSet></GeometryPath><stiffness>50</stiffness>"
      "<resting_length>0.2</resting_length></PathSpring></objects></ForceSet>"
      "</Model></OpenSimDocument>";
  EXPECT_EQ(osim_scene(old),
            osim_scene(osim_pendulum(force_set("<PathSpring name=\"s\">" + osim_path() +
                                               "<stiffness>50</stiffness><resting_length>0.2"
                                               "</resting_length></PathSpring>"))));
}

}  // namespace
}  // namespace sheave
