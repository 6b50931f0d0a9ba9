// Imports of MJCF: how elements are taken, and faults with their places.

#include "scenes/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/control/scene_supervisor.h"
#include "scenes/import/xml.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

namespace fs = std::filesystem;
using import::Outcome;
using nlohmann::json;
using testing::HasSubstr;

/// A model with this content, the world's bodies first.
std::string model(const std::string& world, const std::string& other = {}) {
  return "<mujoco>\n<worldbody>\n" + world + "\n</worldbody>\n" + other + "\n</mujoco>\n";
}

Outcome made(const std::string& text) { return import::import_model(text, "model.xml"); }

/// The scene of a model that must be sound.
json scene_of(const std::string& text) {
  const Outcome outcome = made(text);
  EXPECT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
  const SceneResult scene = load_scene_text(text, "model.xml");
  EXPECT_TRUE(scene) << to_string(scene.errors.front());
  return json::parse(outcome.json);
}

/// The notes about the element on a line.
std::string note_on(const Outcome& outcome, int line) {
  for (const import::Note& note : outcome.notes) {
    if (note.line == line) return note.text;
  }
  return "no note";
}

class Import : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

TEST_F(Import, AModelIsRecognisedByItsFirstCharacter) {
  EXPECT_TRUE(import::is_model("  \n<mujoco/>"));
  EXPECT_TRUE(import::is_model("\xef\xbb\xbf<mujoco/>"));
  EXPECT_FALSE(import::is_model("{\"format\": \"<\"}"));
  EXPECT_FALSE(import::is_model(""));
}

TEST_F(Import, AllWaysOfAnOrientationAgree) {
  // A quarter turn about z, in every way that MJCF has.
  for (const char* const way :
       {"quat='1 0 0 1'", "euler='0 0 90'", "axisangle='0 0 2 90'", "xyaxes='0 1 0 -1 0 0'"}) {
    const json scene = scene_of(
        model(std::string("<body pos='1 2 3' ") + way + "><freejoint/><geom size='.1'/></body>"));
    const json& q = scene["bodies"][0]["orientation"];
    EXPECT_NEAR(q[0].get<double>(), std::sqrt(0.5), 1e-15) << way;
    EXPECT_NEAR(q[3].get<double>(), std::sqrt(0.5), 1e-15) << way;
    EXPECT_EQ(scene["bodies"][0]["position"], json({1, 2, 3})) << way;
  }
}

TEST_F(Import, ABodyWithoutAJointIsAPartOfItsParent) {
  // Two balls of 1 kg at x = 0 and 2: the centre lies between them, and each adds 1 kg m2 there.
  const json scene =
      scene_of(model("<body name='a'><freejoint/><geom size='.1' mass='1'/>"
                     "<body name='b' pos='2 0 0'><geom size='.1' mass='1'/></body></body>"));
  ASSERT_EQ(scene["bodies"].size(), 1U);
  const json& body = scene["bodies"][0];
  EXPECT_EQ(body["mass"], 2.0);
  EXPECT_EQ(body["center_of_mass"], json({1, 0, 0}));
  EXPECT_NEAR(body["inertia"][0].get<double>(), 2.0 * 0.4 * 0.01, 1e-15);
  EXPECT_NEAR(body["inertia"][1].get<double>(), 2.0 * 0.4 * 0.01 + 2.0, 1e-15);
  EXPECT_EQ(body["shapes"].size(), 2U);
}

TEST_F(Import, RangesSpringsAndDampersCountFromTheStart) {
  const json scene = scene_of(model(
      "<body><joint name='j' range='-30 60' ref='10' stiffness='3' springref='40' damping='.2' "
      "frictionloss='.1'/><geom size='.1'/></body>"));
  const json& joint = scene["joints"][0];
  const double degree = std::acos(-1.0) / 180.0;
  EXPECT_EQ(joint["type"], "hinge");
  EXPECT_NEAR(joint["lower"].get<double>(), -40.0 * degree, 1e-15);
  EXPECT_NEAR(joint["upper"].get<double>(), 50.0 * degree, 1e-15);
  EXPECT_NEAR(joint["rest"].get<double>(), 30.0 * degree, 1e-15);
  EXPECT_EQ(joint["stiffness"], 3.0);
  EXPECT_EQ(joint["damping"], 0.2);
  EXPECT_EQ(joint["friction"], 0.1);
}

TEST_F(Import, SeveralJointsOfABodyBecomeTheOneThatMovesAlike) {
  const std::string ball = "<geom size='.1'/></body>";
  const auto type = [&](const std::string& joints) {
    return scene_of(model("<body>" + joints + ball))["joints"][0]["type"];
  };
  EXPECT_EQ(type("<joint axis='1 0 0'/><joint axis='0 1 0' pos='0 .5 0'/>"), "universal");
  EXPECT_EQ(type("<joint type='slide' axis='0 0 1'/><joint axis='0 0 -2'/>"), "cylindrical");
  EXPECT_EQ(type("<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>"
                 "<joint axis='0 0 1'/>"),
            "plane");
  EXPECT_EQ(type("<joint axis='1 0 0'/><joint axis='0 1 0'/><joint axis='0 0 1'/>"), "ball");
  // Others become chains (split_joints_test.cpp).
  for (const char* const joints :
       {"<joint axis='1 0 0'/><joint axis='1 0 0' pos='0 1 0'/>",
        "<joint axis='1 0 0'/><joint axis='0 1 0' pos='0 0 .5'/>",
        "<joint axis='1 0 0'/><joint axis='1 1 0'/>", "<joint type='ball'/><joint/>",
        "<joint type='slide' axis='1 0 0'/><joint axis='0 1 0'/>",
        "<joint axis='1 0 0'/><joint axis='0 1 0'/><joint axis='0 0 1' damping='1'/>"}) {
    const json scene = scene_of(model("<body>" + std::string(joints) + ball));
    EXPECT_EQ(scene["joints"].size(), scene["bodies"].size()) << joints;
    EXPECT_GE(scene["joints"].size(), 2U) << joints;
  }
}

TEST_F(Import, AnArmatureAboutAFixedAxisAddsItsInertia) {
  // A point of 2 kg at 0.5 m with 0.3 kg m2 of armature: alpha = m g r / (m r^2 + I + A).
  const std::string text = model(
      "<body pos='0 0 1'><joint axis='0 1 0' armature='.3'/>"
      "<inertial pos='.5 0 0' mass='2' diaginertia='.01 .01 .01'/></body>",
      "<option gravity='0 0 -10'/>");
  SceneResult scene = load_scene_text(text, "model.xml", {{"/step/dt", "1e-4", ""}});
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  ASSERT_TRUE(simulation->step().ok());
  const double expected = 2.0 * 10.0 * 0.5 / (2.0 * 0.25 + 0.01 + 0.3);
  // The angle changes by 1e-7 rad in the step, and with it the arm of gravity by 1e-14.
  EXPECT_NEAR(simulation->world.angular_velocity(BodyId{0}).y() / 1e-4, expected, 1e-7 * expected);
  // A slide: a = g m / (m + A), because armature has no weight.
  const std::string slide = model(
      "<body><joint type='slide' axis='0 0 1' armature='3'/><geom size='.1' mass='1'/></body>",
      "<option gravity='0 0 -10'/>");
  scene = load_scene_text(slide, "model.xml");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  ASSERT_TRUE(simulation->step().ok());
  EXPECT_NEAR(simulation->world.velocity(BodyId{0}).z() / 2e-3, -2.5, 1e-9);
}

TEST_F(Import, ActuatorsOnJointsAreDrives) {
  const std::string world = "<body><joint name='j'/><geom size='.1'/></body>";
  const auto joint = [&](const std::string& actuators) {
    return scene_of(model(world, "<actuator>" + actuators + "</actuator><keyframe/>"))["joints"][0];
  };
  const json motor = joint("<motor joint='j' gear='4'/>");
  EXPECT_EQ(motor["drive"], "torque");
  EXPECT_EQ(motor["drive_values"], json({0.0}));
  const json position = joint("<position joint='j' kp='5' gear='2' forcerange='-3 3'/>");
  EXPECT_EQ(position["drive"], "angle");
  EXPECT_EQ(position["drive_compliance"], 1.0 / 20.0);
  EXPECT_EQ(position["drive_limit"], 6.0);
  const json velocity = joint("<velocity joint='j' kv='.5' gear='2'/>");
  EXPECT_EQ(velocity["drive"], "torque");
  EXPECT_EQ(velocity["damping"], 2.0);
  const json general =
      joint("<general joint='j' gainprm='3' biastype='affine' biasprm='1.5 -3 -.25'/>");
  EXPECT_EQ(general["drive"], "angle");
  EXPECT_EQ(general["drive_values"], json({0.5}));
  EXPECT_EQ(general["damping"], 0.25);
}

TEST_F(Import, AKeyframeIsTheStart) {
  const std::string text =
      model("<body><joint name='j' axis='0 1 0'/><geom size='.1' pos='1 0 0'/></body>",
            "<actuator><position joint='j' kp='2'/></actuator>\n"
            "<keyframe><key name='up' qpos='.5' qvel='2' ctrl='.75'/><key qpos='0'/></keyframe>");
  import::Options options;
  options.keyframe = "up";
  const json scene = json::parse(import::import_model(text, "model.xml", options).json);
  EXPECT_NEAR(scene["bodies"][0]["orientation"][2].get<double>(), std::sin(0.25), 1e-15);
  EXPECT_EQ(scene["bodies"][0]["angular_velocity"], json({0, 2, 0}));
  // The drive counts from the start.
  EXPECT_EQ(scene["joints"][0]["drive_values"], json({0.25}));
  options.keyframe = "1";
  EXPECT_TRUE(import::import_model(text, "model.xml", options).errors.empty());
  options.keyframe = "down";
  const Outcome none = import::import_model(text, "model.xml", options);
  ASSERT_EQ(none.errors.size(), 1U);
  EXPECT_THAT(none.errors[0].message, HasSubstr("the model has up, 1"));
}

const std::string two_points =
    "<site name='a' pos='0 0 2'/><body pos='0 0 1'><freejoint/><geom size='.1' mass='1'/>"
    "<site name='b'/></body>";

json cable_of(const std::string& spatial) {
  return scene_of(model(two_points, "<tendon>" + spatial + "</tendon>"))["cables"][0];
}

TEST_F(Import, ATendonWithARangeIsARigidCableOfThatLength) {
  const json cable = cable_of("<spatial range='0 1.5'><site site='a'/><site site='b'/></spatial>");
  EXPECT_EQ(cable["rest_lengths"], json({1.5}));
  EXPECT_FALSE(cable.contains("compliance"));
  const std::string text =
      model(two_points,
            "<tendon>\n<spatial range='0 .8'><site site='a'/><site site='b'/></spatial></tendon>");
  // As in a run: the bob hangs in the cable at the length that it had.
  const Outcome outcome = made(text);
  EXPECT_THAT(note_on(outcome, 6), HasSubstr("the cable is 1 m long, as at the start"));
}

TEST_F(Import, AnElasticTendonHasItsStiffnessWhateverItsSpans) {
  // 1 kg of weight on 50 N/m, with a rest length of 0.9 m, through a hole at z = 3: at rest it is
  // g / k longer.
  const std::string text = model(
      "<site name='a' pos='0 0 1.5'/><site name='hole' pos='0 0 2'/>"
      "<body pos='0 0 1'><joint type='slide' axis='0 0 1' damping='20'/>"
      "<geom size='.1' mass='1'/><site name='b'/></body>",
      "<option gravity='0 0 -10'/><tendon><spatial stiffness='50' springlength='1.4'>"
      "<site site='a'/><site site='hole'/><site site='b'/></spatial></tendon>");
  SceneResult scene = load_scene_text(text, "model.xml");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  // Overdamped: the slower of its rates is 2.92 / s, so 10 s leave e^-29.
  for (int i = 0; i < 5000; ++i) ASSERT_TRUE(simulation->step().ok());
  EXPECT_NEAR(simulation->world.position(BodyId{0}).z(), 2.0 - (1.4 + 10.0 / 50.0 - 0.5), 1e-9);
  // A pulley with the divisor 2 has twice the length and a quarter of the stiffness.
  const json halved = cable_of(
      "<spatial stiffness='40' springlength='.4'><pulley divisor='2'/><site site='a'/>"
      "<site site='b'/></spatial>");
  EXPECT_EQ(halved["rest_lengths"], json({0.8}));
  EXPECT_NEAR(halved["axial_stiffness"].get<double>(), 10.0 * 0.8, 1e-15);
}

TEST_F(Import, EqualitiesAreRigidJoints) {
  const std::string bodies =
      "<body name='a'><freejoint/><geom size='.1'/></body>"
      "<body name='b' pos='1 0 0'><freejoint/><geom size='.1'/></body>";
  const json scene =
      scene_of(model(bodies,
                     "<equality><connect name='c' body1='a' body2='b' anchor='.5 0 0'/>"
                     "<weld body1='b'/></equality>"));
  EXPECT_EQ(scene["joints"][0]["type"], "ball");
  EXPECT_EQ(scene["joints"][0]["anchor"], json({0.5, 0, 0}));
  EXPECT_EQ(scene["joints"][1]["type"], "fixed");
  EXPECT_EQ(scene["joints"][1]["body_b"], "world");
}

TEST_F(Import, NoElementIsTakenOrSkippedInSilence) {
  for (const char* const name :
       {"arm26", "machine", "wraps", "site", "site_wrap", "tendon", "wrap_sidesite", "finger_v0",
        "motorfinger_v0", "couplings", "branches", "insides"}) {
    const std::string path = test::model_path(std::string(name) + ".xml");
    const SceneText text = read_scene_text(path);
    const import::xml::Tree tree = import::xml::parse(text.text, path, {});
    ASSERT_TRUE(tree.root) << name;
    const Outcome outcome = import::import_model(text.text, path);
    ASSERT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
    const auto told = [&](const import::xml::Element& element) {
      return std::any_of(outcome.notes.begin(), outcome.notes.end(), [&](const auto& note) {
        return note.line == element.line && note.file == *element.file &&
               note.element.starts_with(element.tag);
      });
    };
    // The parts of a default class, of a path and of a section belong to the element above them.
    const std::function<void(const import::xml::Element&)> look = [&](const auto& element) {
      for (const auto& child : element.children) {
        if (child.tag == "default" || child.tag == "spatial" || child.tag == "fixed" ||
            child.tag == "option" || child.tag == "visual") {
          EXPECT_TRUE(told(child)) << name << ":" << child.line << " " << child.tag;
          continue;
        }
        const bool section = child.tag == "tendon" || child.tag == "actuator" ||
                             child.tag == "asset" || child.tag == "worldbody" ||
                             child.tag == "equality" || child.tag == "keyframe";
        EXPECT_TRUE(section || told(child)) << name << ":" << child.line << " " << child.tag;
        look(child);
      }
    };
    look(*tree.root);
  }
}

TEST_F(Import, PublicModelsRun) {
  for (const char* const name :
       {"arm26", "site", "site_wrap", "tendon", "wrap_sidesite", "finger_v0", "motorfinger_v0"}) {
    const SceneResult scene = load_scene(test::model_path(std::string(name) + ".xml"));
    ASSERT_TRUE(scene) << to_string(scene.errors.front());
    EXPECT_NE(scene.notice, "") << name;
    Result<Simulation> simulation = create_simulation(*scene);
    ASSERT_TRUE(simulation) << simulation.errors().front().message;
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulation->step().ok()) << name << " " << i;
  }
}

TEST_F(Import, FaultsHaveTheirLineAndElement) {
  struct Fault {
    const char* world;
    const char* other;
    int line;
    const char* message;
  };
  for (const Fault& fault : {
           Fault{"<geom size='nan'/>", "", 3, "geom: size must be 1 to 3 finite numbers"},
           Fault{"<geom size='0x10'/>", "", 3, "size must be"},
           Fault{"<geom size='1e999'/>", "", 3, "size must be"},
           Fault{"<geom name='g' size='-1'/>", "", 3, "geom \"g\": size must be given and > 0"},
           Fault{"<geom type='ball' size='1'/>", "", 3, "type must be one of plane"},
           Fault{"<geom size='1' quat='0 0 0 0'/>", "", 3, "quat must be of a length"},
           Fault{"<geom size='1' quat='1 0 0 0' euler='0 0 1'/>", "", 3, "given in one way"},
           Fault{"<body><joint axis='0 0 0'/></body>", "", 3, "axis must be of a length"},
           Fault{"<body>\n<joint limited='true'/></body>", "", 4, "range must be given"},
           Fault{"<body>\n<joint range='2 1'/></body>", "", 4, "the smaller one first"},
           Fault{"<body name='a'/>\n<body name='a'/>", "", 4, "has the same name"},
           Fault{"<body><joint/></body>", "", 3, "needs mass and inertia"},
           Fault{"<body><joint/><freejoint/></body>", "", 3, "its only joint"},
           Fault{"<frame><geom size='1'/></frame>", "", 3, "save it, which writes them out"},
           Fault{"<joint/>", "", 3, "the world has no joints"},
           Fault{"<geom class='c' size='1'/>", "", 3, "no default class \"c\""},
           Fault{"", "<compiler coordinate='global'/>", 5, "must be converted first"},
           Fault{"", "<compiler eulerseq='abc'/>", 5, "three letters"},
           Fault{"", "<option timestep='0'/>", 5, "timestep must be > 0"},
           Fault{"", "<tendon><spatial><site site='s'/></spatial></tendon>", 5,
                 "there is no site of this name"},
           Fault{"<site name='s'/>", "<tendon><spatial><site site='s'/></spatial></tendon>", 5,
                 "a tendon, and each branch of it, needs two sites"},
           Fault{"", "<actuator><motor joint='j'/></actuator>", 5, "no joint of this name"},
           Fault{"", "<keyframe><key qpos='1'/></keyframe>", 5, "0 numbers"},
           Fault{"", "<default/><default><default/></default>", 5, "needs a name"},
       }) {
    const SceneResult result = load_scene_text(model(fault.world, fault.other), "model.xml");
    ASSERT_FALSE(result) << fault.message;
    EXPECT_EQ(result.status, SceneStatus::invalid);
    EXPECT_EQ(result.errors[0].line, fault.line) << to_string(result.errors[0]);
    EXPECT_EQ(result.errors[0].file, "model.xml");
    EXPECT_THAT(to_string(result.errors[0]), HasSubstr(fault.message));
  }
}

TEST_F(Import, FaultsOfTheSceneAreLocatedInTheModel) {
  // No body has such a mass; the check of scenes finds it.
  const SceneResult result = load_scene_text(
      model("<geom size='1'/>\n<body name='b'><freejoint/>"
            "<inertial pos='0 0 0' mass='1e300' diaginertia='1e300 1e300 1e300'/></body>"),
      "model.xml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.errors[0].line, 4);
  EXPECT_THAT(to_string(result.errors[0]), HasSubstr("body \"b\""));
  EXPECT_THAT(to_string(result.errors[0]), HasSubstr("made scene: line"));
}

TEST_F(Import, NumbersThatOverflowAreLocated) {
  const Outcome outcome =
      made(model("<geom size='1'/>\n<body name='b' pos='1e308 0 0'>"
                 "<body pos='1e308 0 0'><joint/><geom size='1'/></body></body>"));
  ASSERT_EQ(outcome.errors.size(), 1U);
  EXPECT_EQ(outcome.errors[0].line, 4);
  EXPECT_THAT(outcome.errors[0].message, HasSubstr("is not finite"));
}

// Names that differ in characters that a scene does not allow, and actuators: with a search per part
// this would take minutes.
TEST_F(Import, ManyPartsAreTakenWithoutASearchPerPart) {
  constexpr int count = 20'000;
  std::string world;
  std::string actuators;
  for (int i = 0; i < count; ++i) {
    const int code = 0x4e00 + i;  // three bytes of UTF-8
    const std::string name{static_cast<char>(0xe0 | (code >> 12)),
                           static_cast<char>(0x80 | ((code >> 6) & 0x3f)),
                           static_cast<char>(0x80 | (code & 0x3f))};
    world += "<body name='" + name + "'/>";
    actuators += "<muscle/>";
  }
  const Outcome outcome = made(model(world, "<actuator>" + actuators + "</actuator>"));
  ASSERT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
  EXPECT_EQ(outcome.notes.size(), 2U * count);
  EXPECT_THAT(outcome.json, HasSubstr("\"___ 20000\""));
}

TEST_F(Import, HostileTextsAreRefused) {
  const auto refused = [](const std::string& text, const std::string& message) {
    const Outcome outcome = made(text);
    ASSERT_FALSE(outcome.errors.empty()) << message;
    EXPECT_THAT(to_string(outcome.errors[0]), HasSubstr(message));
    EXPECT_GE(outcome.errors[0].line, 1);
  };
  refused("<!DOCTYPE m [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;'>]><mujoco>&b;</mujoco>",
          "document type declaration");
  refused("<mujoco>", "closed by another name");
  refused("<mujoco a='1' a='2'/>", "not");
  refused("<robots/>", "the first element of a model is <mujoco> in MJCF");
  refused("<mujoco/>", "there is no <worldbody>");
  refused(std::string("<mujoco>\0</mujoco>", 18), "null");
  std::string deep = "<mujoco>";
  for (int i = 0; i < 150; ++i) deep += "<a>";
  for (int i = 0; i < 150; ++i) deep += "</a>";
  refused(deep + "</mujoco>", "deep");
  std::string deeper = "<mujoco>";
  for (int i = 0; i < 100'000; ++i) deeper += "<a>";
  refused(deeper, "deep");
  std::string wide = "<mujoco>";
  for (int i = 0; i < 200'001; ++i) wide += "<a/>";
  refused(wide + "</mujoco>", "more than 200000 elements");
  refused("<mujoco>" + std::string((std::size_t{16} << 20U), ' ') + "</mujoco>", "more than 16 MB");
}

/// A folder of this test alone.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "sheave-import.XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    path_ = name;
    fs::create_directory(path_ / "in");
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

TEST_F(Import, IncludedFilesArePartsOfTheModel) {
  const Folder folder;
  const std::string main = folder.write(
      "in/main.xml", "<mujoco><include file='parts.xml'/><option timestep='.003'/></mujoco>");
  folder.write("in/parts.xml",
               "<mujocoinclude><worldbody>\n<body name='b'><freejoint/><geom size='bad'/></body>"
               "</worldbody></mujocoinclude>");
  const SceneResult bad = load_scene(main);
  ASSERT_FALSE(bad);
  EXPECT_EQ(fs::path(bad.errors[0].file).filename(), "parts.xml");
  EXPECT_EQ(bad.errors[0].line, 2);
  folder.write("in/parts.xml",
               "<mujocoinclude><worldbody><body name='b'><freejoint/><geom size='1'/></body>"
               "</worldbody></mujocoinclude>");
  const SceneResult good = load_scene(main);
  ASSERT_TRUE(good) << to_string(good.errors.front());
  EXPECT_EQ(good->model.step.dt, 0.003);
  EXPECT_EQ(good->model.bodies[0].name, "b");
}

TEST_F(Import, IncludesStayInTheirFolderAndEnd) {
  const Folder folder;
  folder.write("secret.xml", "<mujocoinclude/>");
  folder.write("in/self.xml", "<mujocoinclude><include file='self.xml'/></mujocoinclude>");
  fs::create_symlink(folder.path() / "secret.xml", folder.path() / "in" / "link.xml");
  const auto refusal = [&](const std::string& file) {
    const std::string main =
        folder.write("in/main.xml", "<mujoco>\n<include file='" + file + "'/></mujoco>");
    const SceneResult result = load_scene(main);
    EXPECT_FALSE(result) << file;
    return result ? std::string() : to_string(result.errors[0]);
  };
  EXPECT_THAT(refusal("../secret.xml"), HasSubstr("must lie in the folder of the model"));
  EXPECT_THAT(refusal("link.xml"), HasSubstr("must lie in the folder of the model"));
  EXPECT_THAT(refusal((folder.path() / "secret.xml").string()),
              HasSubstr("must lie in the folder"));
  EXPECT_THAT(refusal("self.xml"), HasSubstr("is included already"));
  EXPECT_THAT(refusal("main.xml"), HasSubstr("is included already"));
  EXPECT_THAT(refusal("none.xml"), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal("."), HasSubstr("main.xml:2:"));
  ASSERT_EQ(::mkfifo((folder.path() / "in" / "pipe.xml").c_str(), 0600), 0);
  EXPECT_THAT(refusal("pipe.xml"), HasSubstr("is no file"));
}

TEST_F(Import, OverridesAndNoticesBelongToTheScene) {
  const std::string text = model("<body name='b'><freejoint/><geom size='1'/></body>\n<light/>");
  const SceneResult scene = load_scene_text(text, "model.xml", {{"/bodies/b/mass", "7", ""}});
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  EXPECT_EQ(scene->model.bodies[0].mass, 7.0);
  EXPECT_THAT(scene.notice, HasSubstr("1 element of the model skipped"));
  const Outcome outcome = made(text);
  EXPECT_THAT(import::report(outcome), HasSubstr("model.xml:4: light: "));
  EXPECT_THAT(import::report(outcome), HasSubstr("1 skipped"));
}

}  // namespace
}  // namespace sheave
