// Cable robots of CASPR: lengths along trajectories by the formula of the inverse kinematics, and
// tensions that balance wrenches, both from the tables of the files.

#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>

#include <Eigen/QR>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "statics/equilibrium.h"
#include "statics/joint_space.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using import::Outcome;
using testing::HasSubstr;

class Caspr : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

std::string caspr_text(const std::string& name) {
  std::ifstream file(test::model_path("caspr/" + name), std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The attachments of the first eight cables of a table: frame, platform, frame, ...
std::vector<Vector3> attachments(const std::string& robot) {
  const std::string text = caspr_text(robot + "_cables.xml");
  const std::regex pattern("<location>\\s*(\\S+)\\s+(\\S+)\\s+([^\\s<]+)\\s*</location>");
  std::vector<Vector3> list;
  for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) {
    list.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]), std::stod((*i)[3]));
  }
  list.resize(16);
  return list;
}

using Pose6 = std::array<double, 6>;  // x y z [m], angles about x, y, z that turn with the body

Matrix3 turn_of(const Pose6& q) {
  return (Eigen::AngleAxisd(q[3], Vector3::UnitX()) * Eigen::AngleAxisd(q[4], Vector3::UnitY()) *
          Eigen::AngleAxisd(q[5], Vector3::UnitZ()))
      .toRotationMatrix();
}

Scene robot_at(const std::string& robot, const Pose6& q) {
  std::string start = "q_initial=\"";
  for (const double one : q) start += std::to_string(one) + " ";
  const std::string text = std::regex_replace(caspr_text(robot + "_bodies.xml"),
                                              std::regex("q_initial=\"[^\"]*\""), start + "\"");
  const Outcome made =
      import::import_model(text, test::model_path("caspr/" + robot + "_bodies.xml"));
  if (!made.errors.empty()) throw std::runtime_error(to_string(made.errors.front()));
  SceneResult scene = load_scene_text(made.json, "made.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

/// The number with the six decimals of robot_at().
double rounded(double value) { return std::stod(std::to_string(value)); }

/// A quintic between two poses at rest, at the part s of its time.
Pose6 between(const Pose6& from, const Pose6& to, double s) {
  const double part = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  Pose6 q{};
  for (std::size_t i = 0; i < 6; ++i) q[i] = rounded(from[i] + part * (to[i] - from[i]));
  return q;
}

struct Trajectory {
  std::string robot;
  Pose6 from;
  Pose6 to;
};

// The first trajectories of both robots in CASPR. Lengths are norms of sums of a few terms of 10 m,
// each rounded once.
TEST_F(Caspr, LengthsAlongTrajectoriesAreThoseOfTheFormula) {
  for (const Trajectory& one :
       {Trajectory{"CoGiRo", {-3.0, -1.0, 2.0, -0.5, 0.2, 0.3}, {2.0, -3.0, 4.0, 0.2, -0.1, 0.1}},
        Trajectory{
            "IPAnema_1", {-1.0, -0.5, 1.5, 0.2, -0.4, 0.1}, {1.0, 0.5, 0.5, 0.3, 0.0, -0.2}}}) {
    const std::vector<Vector3> table = attachments(one.robot);
    for (int k = 0; k <= 100; ++k) {
      const Pose6 q = between(one.from, one.to, 0.01 * k);
      const Scene scene = robot_at(one.robot, q);
      ASSERT_EQ(scene.cables.size(), 8U);
      Result<Simulation> simulation = create_simulation(scene);
      ASSERT_TRUE(simulation) << simulation.errors().front().message;
      const std::vector<CableReport> cables = simulation->cable_reports();
      for (std::size_t i = 0; i < 8; ++i) {
        const Vector3 end = Vector3(q[0], q[1], q[2]) + turn_of(q) * table[2 * i + 1];
        EXPECT_NEAR(cables[i].spans[0].length, (end - table[2 * i]).norm(), 1e-14)
            << one.robot << " cable " << i + 1 << " at " << k;
      }
    }
  }
}

constexpr Pose6 static_pose{0.5, -0.4, 2.0, 0.05, -0.03, 0.1};

/// Unit wrenches of the cables of CoGiRo about the centre of mass in that pose.
Eigen::Matrix<double, 6, 8> unit_wrenches() {
  const Pose6& q = static_pose;
  const std::vector<Vector3> table = attachments("CoGiRo");
  const Vector3 center = turn_of(q) * Vector3(-0.034, -0.013, 0.264);
  Eigen::Matrix<double, 6, 8> wrenches;
  for (int i = 0; i < 8; ++i) {
    const Vector3 arm = turn_of(q) * table[static_cast<std::size_t>(2 * i + 1)];
    const Vector3& frame = table[static_cast<std::size_t>(2 * i)];
    const Vector3 pull = (frame - Vector3(q[0], q[1], q[2]) - arm).normalized();
    wrenches.col(i) << pull, (arm - center).cross(pull);
  }
  return wrenches;
}

struct Load {
  Vector3 force;   ///< [N]
  Vector3 torque;  ///< [N m]

  /// With the weight of the platform.
  [[nodiscard]] Eigen::Matrix<double, 6, 1> whole() const {
    Eigen::Matrix<double, 6, 1> sum;
    sum << force + Vector3(0.0, 0.0, -9.81 * 91.058), torque;
    return sum;
  }
};
const std::vector<Load>& loads() {
  static const std::vector<Load> list{{{0, 0, 0}, {0, 0, 0}},     {{100, 0, 0}, {0, 0, 0}},
                                      {{-80, 60, 0}, {0, 0, 0}},  {{0, -100, 200}, {0, 0, 0}},
                                      {{0, 0, -3000}, {0, 0, 0}}, {{50, 20, -400}, {30, -20, 10}},
                                      {{0, 0, 0}, {40, 0, 0}},    {{0, 0, 0}, {0, 50, -20}}};
  return list;
}

/// Tensions at rest under a load; `compliance` is that of each cable [m/N].
Eigen::Matrix<double, 8, 1> tensions_under(const Load& load, double compliance) {
  Scene scene = robot_at("CoGiRo", static_pose);
  scene.model.bodies.front().force = load.force;
  scene.model.bodies.front().torque = load.torque;
  for (CableDef& cable : scene.cables) {
    if (compliance > 0.0) cable.compliance = compliance;
  }
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  const Equilibrium rest = find_equilibrium(*simulation);
  if (!rest.converged) throw std::runtime_error(rest.message);
  Eigen::Matrix<double, 8, 1> tensions;
  for (int i = 0; i < 8; ++i) {
    tensions[i] = simulation->cable_reports()[static_cast<std::size_t>(i)].spans[0].tension;
  }
  return tensions;
}

// The wrench of rigid cables on the platform is minus that of weight and load, to the residual of
// the search for the equilibrium, 1e-11.
TEST_F(Caspr, TensionsBalanceWrenches) {
  for (const Load& load : loads()) {
    const Eigen::Matrix<double, 8, 1> tensions = tensions_under(load, 0.0);
    EXPECT_LT((unit_wrenches() * tensions + load.whole()).norm(), 1e-9 * load.whole().norm());
    EXPECT_GE(tensions.minCoeff(), 0.0);
  }
}

// Equal compliances c have the least energy c t^2 / 2, so where all tensions of the solution with
// the smallest norm are above 0 the platform takes these. It moves by c t = 2e-6 m of spans of 10 m
// and arms of 0.5 m, which changes directions by 4e-6.
TEST_F(Caspr, EqualCompliancesHaveTheSmallestTensions) {
  int compared = 0;
  for (const Load& load : loads()) {
    const Eigen::Matrix<double, 8, 1> least =
        unit_wrenches().completeOrthogonalDecomposition().solve(-load.whole());
    if (least.minCoeff() <= 0.0) continue;
    ++compared;
    const Eigen::Matrix<double, 8, 1> tensions = tensions_under(load, 1e-9);
    EXPECT_LT((tensions - least).norm(), 1e-4 * least.norm()) << load.whole().transpose();
  }
  EXPECT_GE(compared, 3);
}

std::string caspr_bodies(const std::string& type, const std::string& start) {
  return "<bodies_system><links><link_rigid num=\"1\" name=\"a\"><joint type=\"" + type +
         "\" q_initial=\"" + start +
         "\"/>\n<physical><mass>2</mass><com_location>0 0 0.1</com_location><inertia ref=\"com\">"
         "<Ixx>0.1</Ixx><Iyy>0.1</Iyy><Izz>0.1</Izz></inertia></physical>"
         "<parent><num>0</num><location>0.5 0 0</location></parent></link_rigid></links>"
         "</bodies_system>";
}
std::string caspr_cables(const std::string& cable = "cable_ideal",
                         const std::string& settings = {}) {
  return "<cables default_cable_set=\"s\"><cable_set id=\"s\"><" + cable +
         " name=\"c\" attachment_reference=\"com\"><properties>" + settings +
         "</properties><attachments><attachment><link>0</link><location>0 0 3</location>"
         "</attachment><attachment><link>1</link><location>0.2 0 0</location></attachment>"
         "</attachments></" +
         cable + "></cable_set></cables>";
}
Outcome made_robot_of(const std::string& bodies, const std::string& cables) {
  import::Options options;
  options.other_text = cables;
  return import::import_model(bodies, "r_bodies.xml", options);
}

// Each type's pose, written out: the link's origin and its turn.
TEST_F(Caspr, JointsHaveTheCoordinatesOfTheirType) {
  struct Case {
    const char* type;
    const char* start;
    Vector3 origin;
    Vector3 turn;  ///< rotation vector
  };
  for (const Case& one :
       {Case{"R_X", "0.3", {0.5, 0, 0}, {0.3, 0, 0}}, Case{"R_Y", "0.3", {0.5, 0, 0}, {0, 0.3, 0}},
        Case{"R_Z", "0.3", {0.5, 0, 0}, {0, 0, 0.3}},
        Case{"U_XZ", "0 0.3", {0.5, 0, 0}, {0, 0, 0.3}}, Case{"P_X", "0.7", {1.2, 0, 0}, {0, 0, 0}},
        Case{"P_XZ", "0.7 0.1", {1.2, 0, 0.1}, {0, 0, 0}},
        Case{"T_XYZ", "0.7 0.1 0.2", {1.2, 0.1, 0.2}, {0, 0, 0}},
        Case{"PLANAR_XY", "0.7 0.1 0.2", {1.2, 0.1, 0}, {0, 0, 0.2}},
        Case{"PLANAR_XZ", "0.7 0.1 0.2", {1.2, 0, 0.1}, {0, 0.2, 0}},
        Case{"PLANAR_YZ", "0.7 0.1 0.2", {0.5, 0.7, 0.1}, {0.2, 0, 0}},
        Case{"S_EULER_XYZ", "0 0.4 0", {0.5, 0, 0}, {0, 0.4, 0}},
        Case{"S_FIXED_XYZ", "0 0 0.4", {0.5, 0, 0}, {0, 0, 0.4}},
        Case{"SPATIAL_EULER_XYZ", "1 2 3 0.4 0 0", {1.5, 2, 3}, {0.4, 0, 0}}}) {
    const Outcome made = made_robot_of(caspr_bodies(one.type, one.start), caspr_cables());
    ASSERT_TRUE(made.errors.empty()) << one.type << to_string(made.errors.front());
    const SceneResult scene = load_scene_text(made.json, "made.json");
    ASSERT_TRUE(scene) << one.type << to_string(scene.errors.front());
    const BodyDef& link = scene->model.bodies.back();
    EXPECT_LT((link.position - one.origin).norm(), 1e-15) << one.type;
    const double angle = one.turn.norm();
    const Eigen::AngleAxisd turn(
        angle, angle > 0.0 ? Vector3(one.turn / angle) : Vector3(Vector3::UnitX()));
    EXPECT_LT((link.orientation.toRotationMatrix() - turn.toRotationMatrix()).norm(), 1e-15)
        << one.type;
  }
}

// CASPR's K of a passive spring is its stiffness; that of a linear one is the stiffness of 1 m.
TEST_F(Caspr, SpringsAreElasticCables) {
  const auto cable = [](const Outcome& made) {
    if (!made.errors.empty()) throw std::runtime_error(to_string(made.errors.front()));
    return nlohmann::json::parse(made.json)["cables"][0];
  };
  const std::string body = caspr_bodies("P_X", "0");
  const auto passive = cable(
      made_robot_of(body, caspr_cables("cable_passive_linear_spring", "<K>50</K><l0>2</l0>")));
  EXPECT_NEAR(passive["axial_stiffness"].get<double>(), 100.0, 1e-12);
  const auto linear = cable(made_robot_of(body, caspr_cables("cable_linear_spring", "<K>50</K>")));
  EXPECT_NEAR(linear["axial_stiffness"].get<double>(), 50.0, 1e-12);
}

TEST_F(Caspr, FaultsAreNamed) {
  const auto refused = [](const Outcome& made, const std::string& message) {
    ASSERT_FALSE(made.errors.empty()) << message;
    EXPECT_THAT(to_string(made.errors.front()), HasSubstr(message));
  };
  const std::string good = caspr_bodies("P_X", "0");
  refused(import::import_model(good, "robot.xml"), "two files in one folder");
  refused(import::import_model(good, "robot_bodies.xml"),
          "\"robot_cables.xml\" must be in the same");
  refused(made_robot_of(good, good), "one with <cables>");
  refused(made_robot_of(caspr_bodies("Q", "0"), caspr_cables()), "type must be one of");
  refused(made_robot_of(caspr_bodies("P_X", "0 1"), caspr_cables()), "q_initial must be 1 finite");
  refused(made_robot_of(good, caspr_cables("cable_linear_spring")), "<K> must be given");
  std::string wrong = caspr_cables();
  wrong.replace(wrong.find("<link>1"), 7, "<link>7");
  refused(made_robot_of(good, wrong), "the number of a link");
  std::string set = caspr_cables();
  set.replace(set.find("set=\"s\""), 7, "set=\"t\"");
  refused(made_robot_of(good, set), "default_cable_set names");
  refused(made_robot_of("<!DOCTYPE a [<!ENTITY b 'c'>]>" + good, caspr_cables()),
          "document type declaration");
}

}  // namespace
}  // namespace sheave
