// Imports of MJCF: fixed tendons, equalities of joints, and tendons in branches.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/joint_report.h"
#include "engine/joints/coupling.h"
#include "scenes/control/scene_supervisor.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string coupled_text(const std::string& world, const std::string& other) {
  return "<mujoco>\n<worldbody>\n" + world + "\n</worldbody>\n" + other + "\n</mujoco>\n";
}
import::Outcome coupled_model(const std::string& text){
    return import::import_model(text, "model.xml");
}  // namespace
/// The scene of a model that must be sound.
json coupled_scene(const std::string& text) {
  const import::Outcome outcome = coupled_model(text);
  EXPECT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
  const SceneResult scene = load_scene_text(text, "model.xml");
  EXPECT_TRUE(scene) << to_string(scene.errors.front());
  return json::parse(outcome.json);
}
/// The notes about the element on a line.
std::string coupling_note(const import::Outcome& outcome, int line) {
  for (const import::Note& note : outcome.notes) {
    if (note.line == line) return note.text;
  }
  return "no note";
}

class ImportCouplings : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

// q1 = 0.2 + 0.5 q2 - q2^2 from the reference pose, where both are 0. The start of the keyframe has
// q2 = 0.3 and q1 = 0.26, so about it q1 changes by (0.5 - 0.6) v - v^2 for a change v of q2.
TEST_F(ImportCouplings, EqualitiesOfJointsAreHeldCouplings) {
  const std::string text = coupled_text(
      "<body><joint name='j1' axis='0 1 0'/><geom size='.1'/>"
      "<body pos='.5 0 0'><joint name='j2' axis='0 1 0'/><geom size='.1'/></body></body>",
      "<equality><joint name='e' joint1='j1' joint2='j2' polycoef='.2 .5 -1 0 0'/>"
      "</equality><keyframe><key name='test' qpos='.26 .3' qvel='-.2 2'/></keyframe>");
  Scene scene = test::scene_in_keyframe(text, "equality");
  const auto& coupling = static_cast<const CouplingJoint&>(*scene.model.joints.back());
  EXPECT_EQ(coupling.joints, (std::vector<std::string>{"j1", "j2"}));
  EXPECT_NEAR(coupling.factors[1], 0.1, 1e-15);
  EXPECT_EQ(coupling.curve, (std::vector<double>{1.0, 0.0, 0.0}));
  Result<Simulation> simulation = create_simulation(scene);
  ASSERT_TRUE(simulation);
  double moved = 0.0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(simulation->step().ok());
    const auto reports = joint_reports(simulation->world);
    moved = std::max(moved, std::abs(reports[1].coordinates[0].value));
    const double q1 = 0.26 + reports[0].coordinates[0].value;
    const double q2 = 0.3 + reports[1].coordinates[0].value;
    // The solver leaves 1e-10 of the size of the scene, some 1 m.
    ASSERT_NEAR(q1, 0.2 + 0.5 * q2 - q2 * q2, 2e-9) << i;
  }
  EXPECT_GT(moved, 0.1);
  // Alone, the first joint stands still; a start off the curve is told.
  const import::Outcome off = coupled_model(
      coupled_text("<body><joint name='j1'/><geom size='.1'/></body>",
                   "<equality>\n<joint joint1='j1' polycoef='.1 1 0 0 0'/></equality>"));
  EXPECT_THAT(coupling_note(off, 6), HasSubstr("coordinate 1 is -0.1 off"));
}

TEST_F(ImportCouplings, FixedTendonsAreCouplingsOfTheirLength) {
  const std::string world =
      "<body><joint name='j1' ref='30'/><geom size='.1'/><body pos='.5 0 0'>"
      "<joint name='j2' type='slide' axis='1 0 0'/><geom size='.1'/></body></body>";
  const auto coupling = [&](const std::string& settings, const std::string& more) {
    return coupled_scene(
        coupled_text(world, "<tendon><fixed name='t' " + settings +
                                "><joint joint='j1' coef='2'/><joint joint='j2' coef='-3'/>"
                                "</fixed></tendon>" +
                                more))["joints"][2];
  };
  // The length is 2 x 30 degrees at the start.
  const double start = 2.0 * std::acos(-1.0) / 6.0;
  const json spring = coupling("stiffness='5' damping='.3' springlength='1.5' range='1 2'", "");
  EXPECT_EQ(spring["type"], "coupling");
  EXPECT_EQ(spring["held"], false);
  EXPECT_EQ(spring["factors"], json({2.0, -3.0}));
  EXPECT_EQ(spring["joint_coordinates"], json({"angle", "travel"}));
  EXPECT_EQ(spring["stiffness"], 5.0);
  EXPECT_EQ(spring["damping"], 0.3);
  EXPECT_NEAR(spring["rest"].get<double>(), 1.5 - start, 1e-15);
  EXPECT_NEAR(spring["lower"].get<double>(), 1.0 - start, 1e-15);
  EXPECT_NEAR(spring["upper"].get<double>(), 2.0 - start, 1e-15);
  EXPECT_EQ(coupling("stiffness='5'", "")["rest"], 0.0);
  const json slack = coupling("stiffness='5' springlength='1 1.2'", "");
  EXPECT_NEAR(slack["upper"].get<double>(), 1.2 - start, 1e-15);
  EXPECT_EQ(slack["limit_compliance"], 0.2);
  const json drive =
      coupling("", "<actuator><position tendon='t' kp='4' gear='3' forcerange='-2 2'/></actuator>");
  EXPECT_EQ(drive["drive"], "position");
  EXPECT_NEAR(drive["drive_values"][0].get<double>(), -start, 1e-15);
  EXPECT_NEAR(drive["drive_compliance"].get<double>(), 1.0 / 36.0, 1e-15);
  EXPECT_EQ(drive["drive_limit"], 6.0);
}

TEST_F(ImportCouplings, BranchesShowTheirLengthsAndHaveNoForce) {
  const std::string world =
      "<site name='a'/><site name='b' pos='1 0 0'/><body pos='0 0 1'><freejoint/>"
      "<geom size='.1'/><site name='c'/></body>";
  const auto note = [&](const std::string& settings) {
    return coupling_note(coupled_model(coupled_text(
                             world, "<tendon>\n<spatial name='t' " + settings +
                                        "><site site='a'/><site site='c'/><pulley divisor='2'/>"
                                        "<site site='b'/><site site='c'/></spatial></tendon>")),
                         6);
  };
  EXPECT_THAT(note("stiffness='3'"), HasSubstr("not taken: range, stiffness and damping"));
  EXPECT_THAT(note(""), HasSubstr("\"t branch 2\": a cable that shows its length and has no force; "
                                  "of which 1 / 2 counts"));
}

}  // namespace sheave
}  // namespace sheave
