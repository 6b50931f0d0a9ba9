// Imports of URDF: bodies, accelerations and parts against MuJoCo's own reading of URDF, and faults.

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/joint_report.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/import/import.h"
#include "scenes/import/log.h"
#include "scenes/import/mjcf/scene.h"
#include "scenes/import/urdf/reader.h"
#include "scenes/import/xml.h"
#include "statics/joint_space.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using import::Outcome;
using nlohmann::json;
using testing::HasSubstr;

std::string robot(const std::string& content) {
  return "<robot name='r'>\n" + content + "\n</robot>\n";
}
std::string urdf_link(const std::string& name, const std::string& mass = "1") {
  return "<link name='" + name + "'><inertial><mass value='" + mass +
         "'/><inertia ixx='.1' iyy='.1' izz='.1'/></inertial></link>\n";
}
std::string urdf_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const std::string& more = {}) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>\n";
}

Outcome made_robot(const std::string& text) { return import::import_model(text, "robot.urdf"); }

json robot_scene(const std::string& text) {
  const Outcome outcome = made_robot(text);
  if (!outcome.errors.empty()) throw std::runtime_error(to_string(outcome.errors.front()));
  const SceneResult scene = load_scene_text(text, "robot.urdf");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return json::parse(outcome.json);
}

class Urdf : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

/// The robot of the tests in this pose.
Scene robot_in(const std::vector<double>& qpos, const std::vector<double>& qvel) {
  const std::string path = test::model_path("robot.urdf");
  const SceneText text = read_scene_text(path);
  const import::xml::Tree tree = import::xml::parse(text.text, path, {});
  import::Log log{import::Limits {}};
  import::mjcf::Model model = import::urdf::read_model(*tree.root, log);
  model.keyframes.push_back({&*tree.root, "test", qpos, qvel, {}, {}});
  import::Options options;
  options.keyframe = "test";
  const import::mjcf::Json made = import::mjcf::scene_of(model, options, path, log);
  SceneResult scene = load_scene_text(made.dump(), path);
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

TEST_F(Urdf, BodiesAreWhereMuJoCoHasThem) {
  // MuJoCo's numbers of the bodies, without that of the world: the tool is a part of the slide here.
  const std::vector<std::pair<std::string, std::size_t>> bodies{
      {"base", 0}, {"upper", 1}, {"fore", 2}, {"slide", 3}, {"side", 5}};
  const json reference = test::references("robot");
  std::size_t poses = 0;
  for (const json& pose : reference["poses"]) {
    ++poses;
    const Scene scene = robot_in(test::numbers(pose["qpos"]), {});
    for (const auto& [name, number] : bodies) {
      const auto found =
          std::find_if(scene.model.bodies.begin(), scene.model.bodies.end(),
                       [&name = name](const BodyDef& body) { return body.name == name; });
      ASSERT_NE(found, scene.model.bodies.end()) << name;
      const Vector3 expected = test::vector_at(pose["xpos"], 3 * number);
      EXPECT_LT((found->position - expected).norm(), 1e-12) << name;
      const Vector3 part = test::vector_at(pose["xquat"], 4 * number + 1);
      const Quaternion other(pose["xquat"][4 * number].get<double>(), part.x(), part.y(), part.z());
      EXPECT_NEAR(std::abs(found->orientation.dot(other)), 1.0, 1e-12) << name;
    }
  }
  EXPECT_EQ(poses, 20U);
}

// MuJoCo keeps principal moments, which it finds to some 1e-10 of a tensor. The inverse of the mass
// matrix, whose largest element is some 100 times the smallest, makes 1e-8 of it.
TEST_F(Urdf, AccelerationsAreThoseOfMuJoCo) {
  const json reference = test::references("robot");
  for (const json& pose : reference["poses"]) {
    Result<Simulation> simulation =
        create_simulation(robot_in(test::numbers(pose["qpos"]), test::numbers(pose["qvel"])));
    ASSERT_TRUE(simulation) << simulation.errors().front().message;
    Result<JointSpace> space = JointSpace::create(*simulation);
    ASSERT_TRUE(space);
    ASSERT_EQ(space->coordinates().size(), 4U);
    const Result<ModalVector> own = space->forward_dynamics(ModalVector::Zero(4));
    ASSERT_TRUE(own);
    const std::vector<double> expected = test::numbers(pose["qacc"]);
    double size = 1.0;
    for (const double a : expected) size = std::max(size, std::abs(a));
    for (Eigen::Index i = 0; i < 4; ++i) {
      EXPECT_NEAR((*own)[i], expected[static_cast<std::size_t>(i)], 1e-7 * size)
          << space->coordinates()[static_cast<std::size_t>(i)].name << " " << pose["qpos"];
    }
  }
}

TEST_F(Urdf, JointsAreThoseOfAScene) {
  const json scene = robot_scene(
      robot(urdf_link("base") + urdf_link("a") + urdf_link("b") + urdf_link("c") + urdf_link("d") +
            urdf_link("e") +
            urdf_joint("turn", "revolute", "base", "a",
                       "<axis xyz='0 0 2'/><limit lower='-1' upper='2'/>"
                       "<dynamics damping='.3' friction='.2'/>") +
            urdf_joint("push", "prismatic", "base", "b", "<limit lower='0' upper='1'/>") +
            urdf_joint("table", "planar", "base", "c", "<axis xyz='0 0 1'/>") +
            urdf_joint("spin", "continuous", "a", "d") +
            urdf_joint("loose", "floating", "a", "e", "<origin xyz='0 0 3'/>")));
  const auto named = [&](const std::string& name) {
    for (const json& one : scene["joints"]) {
      if (one["name"] == name) return one;
    }
    return json();
  };
  EXPECT_EQ(scene["bodies"][0]["mobility"], "static");
  const json turn = named("turn");
  EXPECT_EQ(turn["type"], "hinge");
  EXPECT_EQ(turn["axis"], json({0, 0, 1}));
  EXPECT_EQ(turn["lower"], -1.0);
  EXPECT_EQ(turn["upper"], 2.0);
  EXPECT_EQ(turn["damping"], 0.3);
  EXPECT_EQ(turn["friction"], 0.2);
  EXPECT_EQ(named("push")["type"], "slider");
  EXPECT_EQ(named("push")["axis"], json({1, 0, 0}));
  EXPECT_EQ(named("table")["type"], "plane");
  EXPECT_EQ(named("table")["normal"], json({0, 0, 1}));
  EXPECT_EQ(named("spin")["type"], "hinge");
  EXPECT_FALSE(named("spin").contains("lower"));
  EXPECT_TRUE(named("loose").is_null());  // a free body
  EXPECT_THAT(scene["description"].get<std::string>(), HasSubstr("(URDF)"));
}

// A gripper: the second finger has the opposite travel, 1 mm further.
TEST_F(Urdf, AMimicJointIsAHeldCoupling) {
  const std::string text = robot(urdf_link("base") + urdf_link("a") + urdf_link("b") +
                                 urdf_joint("left", "prismatic", "base", "a",
                                            "<axis xyz='0 1 0'/><limit lower='-1' upper='1'/>") +
                                 urdf_joint("right", "prismatic", "base", "b",
                                            "<axis xyz='0 1 0'/><limit lower='-1' upper='1'/>"
                                            "<mimic joint='left' multiplier='-1' offset='.001'/>"));
  const json scene = robot_scene(text);
  const json& coupling = scene["joints"][2];
  EXPECT_EQ(coupling["type"], "coupling");
  EXPECT_EQ(coupling["joints"], json({"right", "left"}));
  EXPECT_EQ(coupling["factors"], json({1.0, 1.0}));
  EXPECT_NEAR(scene["bodies"][2]["position"][1].get<double>(), 0.001, 1e-15);
  // A force of 3 N on one finger moves both of 1 kg.
  SceneResult loaded = load_scene_text(
      text, "robot.urdf",
      {{"/joints/0/drive", "\"force\"", ""}, {"/joints/0/drive_values", "[3]", ""}});
  ASSERT_TRUE(loaded) << to_string(loaded.errors.front());
  Result<Simulation> simulation = create_simulation(*loaded);
  ASSERT_TRUE(simulation);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulation->step().ok());
  EXPECT_NEAR(simulation->world.velocity(BodyId{1}).y(), 0.2 * 1.5, 1e-9);
  EXPECT_NEAR(simulation->world.velocity(BodyId{2}).y(), -0.2 * 1.5, 1e-9);
}

TEST_F(Urdf, NoElementIsTakenOrSkippedInSilence) {
  const std::string path = test::model_path("robot.urdf");
  const SceneText text = read_scene_text(path);
  const import::xml::Tree tree = import::xml::parse(text.text, path, {});
  const Outcome outcome = import::import_model(text.text, path);
  ASSERT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
  const std::function<void(const import::xml::Element&)> look = [&](const auto& element) {
    for (const auto& child : element.children) {
      const bool told =
          std::any_of(outcome.notes.begin(), outcome.notes.end(), [&](const import::Note& note) {
            return note.line == child.line && note.element.starts_with(child.tag);
          });
      EXPECT_TRUE(told) << child.line << " " << child.tag;
      // The content of an element without a counterpart belongs to it.
      const bool whole = child.tag == "mujoco" || child.tag == "transmission" ||
                         child.tag == "material" || child.tag == "visual";
      if (!whole) look(child);
    }
  };
  look(*tree.root);
}

TEST_F(Urdf, FaultsHaveTheirLineAndElement) {
  const auto refused = [](const std::string& content, int line, const std::string& message) {
    const Outcome outcome = made_robot(robot(content));
    ASSERT_FALSE(outcome.errors.empty()) << message;
    EXPECT_EQ(outcome.errors[0].line, line) << message;
    EXPECT_THAT(outcome.errors[0].message, HasSubstr(message));
    EXPECT_EQ(outcome.json, "");
  };
  const std::string two = urdf_link("a") + urdf_link("b");
  refused("", 1, "there are 0 links");
  refused(two, 1, "there are 2 links that are no child");
  refused(two + urdf_joint("j", "bent", "a", "b"), 4, "type must be one of revolute");
  refused(two + urdf_joint("j", "revolute", "a", "b"), 4, "<limit> is missing");
  refused(two + urdf_joint("j", "revolute", "a", "b", "<limit lower='2' upper='1'/>"), 4,
          "at most the upper limit");
  refused(two + urdf_joint("j", "continuous", "a", "c"), 4, "there is no link of this name");
  refused(two + urdf_joint("j", "continuous", "a", "b", "<axis xyz='0 0 0'/>"), 4, "of a length");
  refused(two + urdf_joint("j", "continuous", "a", "b", "<mimic joint='k'/>"), 4, "another joint");
  refused(two + urdf_joint("j", "fixed", "a", "b") + urdf_joint("k", "fixed", "a", "b"), 5,
          "another parent");
  refused(two + urdf_joint("j", "fixed", "a", "b") + urdf_joint("j", "fixed", "b", "a"), 5,
          "the same name");
  refused(urdf_link("root") + two + urdf_joint("j", "fixed", "a", "b") +
              urdf_joint("k", "fixed", "b", "a"),
          1, "form a loop");
  refused("<xacro:macro/>", 2, "run xacro on it first");
  refused("<link/>", 2, "\"name\" is missing");
  refused("<link name='a'><inertial><mass value='-1'/><inertia/></inertial></link>", 2, ">= 0");
  refused("<link name='a'><inertial/></link>", 2, "<mass> and <inertia>");
  refused("<link name='a'><visual><geometry><sphere radius='0'/></geometry></visual></link>", 2,
          "given and > 0");
  refused("<link name='a'><visual/></link>", 2, "<geometry> with one shape");
  refused("<link name='a'/><link name='b'/>" + urdf_joint("j", "continuous", "a", "b"), 2,
          "needs mass and inertia");
}

}  // namespace
}  // namespace sheave
