#include <algorithm>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "engine/shapes/box.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> errors_of(const SceneResult& result) {
  std::vector<std::string> texts;
  for (const SceneError& error : result.errors) texts.push_back(to_string(error));
  return texts;
}
SceneResult load(const std::string& text, const std::vector<Override>& overrides = {}) {
  return load_scene_text(text, "s.json", overrides);
}

TEST(Load, ReadsEveryKindOfSetting) {
  const SceneResult scene = load(R"({
    // A comment.
    "format": "sheave-scene/1", "name": "N", "description": "D",
    "gravity": [0, -9.81, 0], "duration": 2.5,
    "step": {"dt": 0.01, "substeps": 3, "iterations": 7},
    "bodies": [
      {"name": "wheel", "mobility": "rotor", "mass": 2, "mount": "cart",
       "shape": {"type": "cylinder", "radius": 0.25, "length": 0.1}},
      {"name": "cart", "mobility": "slider", "axis": [1, 0, 0], "mass": 3,
       "shapes": [
         {"type": "box", "size": [1, 2, 3], "position": [0, 1, 0], "orientation": [0, 1, 0, 0]},
         {"type": "sphere", "radius": 0.5}]}
    ],
    "joints": [{"type": "distance", "name": "rod", "body_b": "cart", "anchor_a": [0, 9, 0],
                "anchor_b": [0, 0, 0]}],
    "cables": [{"name": "c", "closed": false, "axial_stiffness": 1000, "links": [
      {"type": "attachment", "body": "world", "point": [5, 5, 0]},
      {"type": "rolling", "body": "wheel", "winding": "clockwise", "stored_length": 1}]}],
    "ground": {"point": [0, -50, 0]},
    "camera": {"position": [0, 0, 9], "target": [0, 1, 0], "labels": true},
    "checks": [{"quantity": "c.0.tension", "statistic": "mean", "from": 1, "to": 2,
                "equals": 5, "tolerance": 100, "because": "why"}]
  })");
  ASSERT_TRUE(scene) << testing::PrintToString(errors_of(scene));
  EXPECT_EQ(scene->name, "N");
  EXPECT_EQ(scene->duration, 2.5);
  EXPECT_EQ(scene->model.gravity.y(), -9.81);
  EXPECT_EQ(scene->model.step.substeps, 3);
  ASSERT_EQ(scene->model.bodies.size(), 2U);
  EXPECT_EQ(scene->model.bodies[0].mount, BodyId{1});
  const BodyDef& cart = scene->model.bodies[1];
  EXPECT_EQ(cart.mobility, Mobility::slider);
  ASSERT_EQ(cart.shapes.size(), 2U);
  EXPECT_EQ(cart.shapes[0].position.y(), 1.0);
  EXPECT_EQ(cart.shapes[0].orientation.x(), 1.0);
  const auto* box = dynamic_cast<const Box*>(cart.shapes[0].shape.get());
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->size.z(), 3.0);
  ASSERT_EQ(scene->model.joints.size(), 1U);
  EXPECT_EQ(scene->model.joints[0]->type(), "distance");
  EXPECT_TRUE(scene->model.joints[0]->body_a.is_world());
  ASSERT_EQ(scene->cables.size(), 1U);
  EXPECT_EQ(scene->cables[0].axial_stiffness, 1000.0);
  EXPECT_EQ(scene->cables[0].links[1]->body, BodyId{0});
  ASSERT_TRUE(scene->model.ground);
  EXPECT_EQ(scene->model.ground->point.y(), -50.0);
  ASSERT_TRUE(scene->camera);
  EXPECT_TRUE(scene->camera->labels);
  ASSERT_EQ(scene->checks.size(), 1U);
  EXPECT_EQ(scene->checks[0].statistic, Statistic::mean);
  EXPECT_EQ(scene->checks[0].because, "why");
}

std::string bare_scene(const std::string& step) {
  return R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1)" + step + "}";
}

TEST(Load, APresetGivesTheStepSettingsThatAreNotGiven) {
  const auto step_of = [](const std::string& step, const std::vector<Override>& overrides = {}) {
    const SceneResult scene = load(bare_scene(step), overrides);
    EXPECT_TRUE(scene) << step;
    return scene->model.step;
  };
  const StepSettings paper = step_of(R"(, "step": {"preset": "paper"})");
  EXPECT_EQ(paper, StepSettings::paper());
  EXPECT_EQ(paper.dt, 1.0 / 60.0);
  EXPECT_EQ(paper.substeps, 1);
  EXPECT_EQ(paper.iterations, 10);
  EXPECT_EQ(paper.solver, SolverKind::gauss_seidel);
  EXPECT_EQ(paper.integrator, IntegratorKind::xpbd);
  // Whichever stands first, and whatever the value would be without the preset.
  StepSettings some = StepSettings::paper();
  some.substeps = 7;
  some.integrator = IntegratorKind::rattle;
  EXPECT_EQ(step_of(R"(, "step": {"substeps": 7, "integrator": "rattle", "preset": "paper"})"),
            some);
  EXPECT_EQ(step_of("", {{"/step/preset", "paper", {}},
                         {"/step/integrator", "rattle", {}},
                         {"/step/substeps", "7", {}}}),
            some);
  EXPECT_EQ(step_of(""), StepSettings{});
  EXPECT_EQ(step_of(R"(, "step": {"preset": "standard"})"), StepSettings{});
  EXPECT_EQ(step_of(R"(, "step": {"preset": "paper"})", {{"/step/preset", "standard", {}}}),
            StepSettings{});
}

TEST(Load, FaultsOfAStepWithAPresetAreReportedOnce) {
  const SceneResult scene =
      load(bare_scene(R"(, "step": {"preset": "papr", "substeps": 0, "solver": 3})"));
  EXPECT_THAT(errors_of(scene),
              ElementsAre(AllOf(HasSubstr("/step/preset"), HasSubstr("did you mean \"paper\"")),
                          HasSubstr("/step/substeps"), HasSubstr("/step/solver")));
}

TEST(Load, FaultsOfLoadsAreReportedOnce) {
  const SceneResult scene = load(scene_text(
      R"("bodies": [{"name": "b", "mass": 1, "shape": {"type": "sphere", "radius": 1}}],
         "loads": [{"type": "force", "name": "gust", "body": "b", "times": [1, 0.5],
           "forces": [[0, 0, 0], [1, 0, 0]]}],
         "triggers": [{"name": "end", "quantity": "b.x", "above": 9, "action": "stop"}])"));
  ASSERT_FALSE(scene);
  const std::vector<std::string> errors = errors_of(scene);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(std::count(errors.begin(), errors.end(), errors[i]), 1) << errors[i];
  }
}

TEST(Load, SidesMayBeSaidInFull) {
  const auto side_of = [](const std::string& side) {
    const SceneResult scene =
        load(R"({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "bodies": [
      {"name": "wheel", "mobility": "rotor", "mass": 1, "spin_inertia": 1, "shape": {"type": "cylinder",
       "radius": 0.5, "length": 0.1}}], "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "world", "point": [-1, 0, 0]},
      {"type": "rolling", "body": "wheel", "side": ")" +
             side + R"("},
      {"type": "attachment", "body": "world", "point": [1, 0, 0]}]}]})");
    return scene ? write_scene(*scene) : to_string(scene.errors.front());
  };
  EXPECT_EQ(side_of("left of the way"), side_of("left"));
  EXPECT_EQ(side_of("right of the way"), side_of("right"));
  EXPECT_NE(side_of("left"), side_of("right"));
  EXPECT_THAT(side_of("left of the road"), HasSubstr("unknown choice"));
}

TEST(Load, ReportsAllFaultsInTheOrderOfTheFile) {
  const SceneResult scene = load(R"({
  "format": "sheave-scene/1",
  "gravity": [0, "down", 0],
  "duraton": 2,
  "bodies": [
    {"name": "a", "mass": -1, "colour": "red"},
    {"name": "a", "mobility": "rotor", "shape": {"type": "cylinder", "radius": 0, "length": 1}}
  ],
  "cables": [{"name": "c", "links": [{"type": "attachment", "body": "b"}, {"type": "knot"}]}],
  "step": {"substeps": 0, "substeps": 1}
})");
  EXPECT_THAT(
      errors_of(scene),
      ElementsAre(
          HasSubstr("s.json:1:1: /duration: required key is missing"),
          "s.json:3:18: /gravity/1: value \"down\": must be a number [m/s2]",
          HasSubstr("s.json:4:3: /duraton: unknown key in a scene, did you mean \"duration\"?"),
          "s.json:6:27: /bodies/0/mass: value -1: must be > 0 [kg]",
          HasSubstr("s.json:6:31: /bodies/0/colour: unknown key in a body; allowed: name, "),
          HasSubstr("s.json:7:14: /bodies/1/name: value \"a\": names of bodies must differ"),
          HasSubstr("s.json:7:80: /bodies/1/shape/radius: value 0: must be > 0 [m]"),
          HasSubstr("s.json:9:69: /cables/0/links/0/body: value \"b\": there is no body of this"),
          HasSubstr("s.json:9:84: /cables/0/links/1/type: value \"knot\": unknown type of link"),
          HasSubstr("s.json:10:24: /step/substeps: value 0: must be 1 ... 100000"),
          HasSubstr("s.json:10:27: /step/substeps: duplicate key")));
}

TEST(Load, SemanticFaultsOfSeveralEntitiesComeTogether) {
  const SceneResult scene = load(scene_text(R"("bodies": [
    {"name": "a", "mass": 1},
    {"name": "b", "mass": 1, "density": 2, "shape": {"type": "sphere", "radius": 1}}
  ],
  "camera": {"target": [0, 0, 0]},
  "checks": [{"quantity": "a.z", "equals": 1}])"));
  EXPECT_THAT(errors_of(scene),
              ElementsAre(HasSubstr("s.json:6:5: /bodies/0: body \"a\""),
                          HasSubstr("s.json:7:41: /bodies/1/density: value 2: body \"b\""),
                          HasSubstr("s.json:9:24: /camera/target: value [0, 0, 0]"),
                          HasSubstr("s.json:10:14: /checks/0: check of \"a.z\"")));
}

TEST(Load, AnOnlyShapeIsFoundHoweverItIsWritten) {
  const std::string flat =
      R"("type": "prism", "length": 1, "outline": [[0,0,0], [1,0,0], [2,0,0]])";
  const SceneResult single =
      load(scene_text(R"("bodies": [{"name": "a", "mass": 1, "shape": {)" + flat + "}}]"));
  const SceneResult several =
      load(scene_text(R"("bodies": [{"name": "a", "mass": 1, "shapes": [{)" + flat + "}]}]"));
  ASSERT_EQ(single.errors.size(), 1U);
  ASSERT_EQ(several.errors.size(), 1U);
  EXPECT_EQ(single.errors[0].pointer, "/bodies/0/shape/outline");
  EXPECT_EQ(several.errors[0].pointer, "/bodies/0/shapes/0/outline");
  EXPECT_EQ(several.errors[0].line, 5);
  const SceneResult second = load(scene_text(
      R"("bodies": [{"name": "a", "mass": 1, "shapes": [{"type": "sphere", "radius": 1}, {)" +
      flat + "}]}]"));
  ASSERT_EQ(second.errors.size(), 1U);
  EXPECT_EQ(second.errors[0].pointer, "/bodies/0/shapes/1/outline");
}

TEST(Load, HugeCountsAreRefusedBeforeAnythingIsMade) {
  std::string text = "\"bodies\": [0";
  for (int i = 0; i < 1'000'000; ++i) text += ",0";
  EXPECT_THAT(errors_of(load(scene_text(text + "]"))),
              ElementsAre(HasSubstr("must not have more than 1000000 elements, has 1000001")));
  std::string lengths = R"("cables": [{"name": "c", "rest_lengths": [1)";
  for (int i = 0; i < 1'000'000; ++i) lengths += ",1";
  EXPECT_THAT(errors_of(load(scene_text(lengths + "], \"links\": []}]"))),
              ElementsAre(HasSubstr("/cables/0/rest_lengths: must not have more than 1000000")));
}

TEST(Load, AFileThatIsTooLargeIsRefused) {
  std::string text = scene_text();
  text.resize((std::size_t{64} << 20U) + 1, ' ');
  EXPECT_THAT(errors_of(load(text)), ElementsAre(HasSubstr("bytes are too many")));
}

TEST(Load, AHundredThousandLevelsDoNotCrash) {
  EXPECT_THAT(errors_of(load("{\"bodies\": " + std::string(100'000, '['))),
              ElementsAre(HasSubstr("nested more than 64 deep")));
}

TEST(Load, ThousandsOfFaultsAreListedUpToALimit) {
  std::string text = "\"bodies\": [{}";
  for (int i = 0; i < 5000; ++i) text += ",\n{}";
  const SceneResult scene = load(scene_text(text + "]"));
  ASSERT_EQ(scene.errors.size(), 1001U);
  EXPECT_EQ(to_string(scene.errors.back()), "s.json: 4001 further faults are not listed");
}

TEST(Load, DistinguishesMissingFromUnreadableFiles) {
  EXPECT_EQ(load_scene("no/such/file.json").status, SceneStatus::not_found);
  EXPECT_EQ(load_scene(SHEAVE_SOURCE_DIR).status, SceneStatus::unreadable);
  EXPECT_THAT(errors_of(load_scene("no/such/file.json")),
              ElementsAre("no/such/file.json: there is no such file"));
}

TEST(Load, QuaternionsAreNormalisedOnce) {
  const std::string body = R"("bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1],
    "orientation": [0.7071068, 0, 0, 0.7071068]}])";
  const SceneResult scene = load(scene_text(body));
  ASSERT_TRUE(scene);
  EXPECT_NEAR(scene->model.bodies[0].orientation.norm(), 1.0, 1e-15);
  EXPECT_NEAR(scene->model.bodies[0].orientation.w(), std::sqrt(0.5), 1e-15);
}

TEST(Overrides, ChangeSettingsBeforeTheyAreChecked) {
  const std::string text =
      scene_text(R"("bodies": [{"name": "a", "mass": -5, "inertia": [1, 1, 1]}])");
  const SceneResult scene = load(text, {{"/bodies/0/mass", "5", ""},
                                        {"/step/dt", "0.001", "--dt"},
                                        {"/step/solver", "gauss-seidel", "--solver"},
                                        {"/name", "\"quoted\"", ""},
                                        {"/bodies/0/velocity", "[1, 2, 3]", ""}});
  ASSERT_TRUE(scene) << testing::PrintToString(errors_of(scene));
  EXPECT_EQ(scene->model.bodies[0].mass, 5.0);
  EXPECT_EQ(scene->model.step.dt, 0.001);
  EXPECT_EQ(scene->name, "quoted");
  EXPECT_EQ(scene->model.bodies[0].velocity.z(), 3.0);
}

TEST(Overrides, AreNamedInErrors) {
  EXPECT_THAT(errors_of(load(scene_text(), {{"/step/dt", "-1", "--dt"}})),
              ElementsAre("--dt:1:1: /step/dt: value -1: must be > 0 [s]"));
  EXPECT_THAT(
      errors_of(load(scene_text(), {{"/step/dtt", "1", ""}})),
      ElementsAre(HasSubstr("--set /step/dtt:1:1: /step/dtt: unknown key in a step, did you "
                            "mean \"dt\"?")));
  EXPECT_THAT(errors_of(load(scene_text(), {{"/bodies/3/mass", "1", ""}})),
              ElementsAre(HasSubstr("there is no /bodies/3")));
  EXPECT_THAT(errors_of(load(scene_text(), {{"/ground/normal", "[0, 1, 0]", ""}})),
              ElementsAre(HasSubstr("there is no /ground")));
}

TEST(Overrides, KnowBodiesJointsAndCablesByName) {
  const std::string text = scene_text(R"("bodies": [
      {"name": "drum", "mobility": "rotor", "mass": 2, "inertia": [1, 1, 1]},
      {"name": "2", "mass": 1, "inertia": [1, 1, 1], "position": [0, -1, 0]},
      {"name": "heavy load", "mass": 1, "inertia": [1, 1, 1], "position": [0, -2, 0]}],
    "joints": [{"type": "hinge", "name": "door", "body_b": "2", "anchor": [0, 0, 0], "axis": [0, 0, 1]}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "drum", "point": [0.1, 0, 0]},
      {"type": "attachment", "body": "heavy load"}]}])");
  const SceneResult scene = load(text, {{"/bodies/drum/mass", "5", ""},
                                        {"/bodies/heavy load/mass", "7", ""},
                                        {"/joints/door/breaking_force", "9", ""},
                                        {"/cables/rope/links/1/point", "[0, 0.1, 0]", ""}});
  ASSERT_TRUE(scene) << testing::PrintToString(errors_of(scene));
  EXPECT_EQ(scene->model.bodies[0].mass, 5.0);
  EXPECT_EQ(scene->model.bodies[2].mass, 7.0);
  EXPECT_EQ(scene->model.joints[0]->breaking_force, 9.0);
  // A number is a place, whatever things are called.
  EXPECT_EQ(load(text, {{"/bodies/2/mass", "4", ""}})->model.bodies[2].mass, 4.0);
  EXPECT_THAT(errors_of(load(text, {{"/bodies/drumm/mass", "5", ""}})),
              ElementsAre("--set /bodies/drumm/mass:1:1: /bodies/drumm/mass: /bodies has nothing "
                          "called \"drumm\"; near it are \"drum\""));
  EXPECT_THAT(errors_of(load(text, {{"/bodies/winch/mass", "5", ""}})),
              ElementsAre(HasSubstr("there are \"drum\", \"2\", \"heavy load\"")));
  EXPECT_THAT(errors_of(load(text, {{"/bodies/drums", "5", ""}})),
              ElementsAre(HasSubstr("near it are \"drum\"")));
  EXPECT_THAT(errors_of(load(text, {{"/bodies/3/mass", "5", ""}})),
              ElementsAre(HasSubstr("there is no /bodies/3 in the scene: /bodies has 3 elements")));
  // What is wrong with the value is told at the option.
  EXPECT_THAT(errors_of(load(text, {{"/bodies/drum/mass", "-5", ""}})),
              ElementsAre(HasSubstr("--set /bodies/drum/mass:1:1: /bodies/0/mass: value -5")));
}

TEST(Overrides, OfADriveRemoveSettingsThatNoLongerApply) {
  const std::string text = scene_text(R"("bodies": [
      {"name": "drum", "mobility": "rotor", "mass": 2, "inertia": [1, 1, 1], "drive": "speed",
       "drive_times": [0, 1], "drive_values": [0, 2], "drive_interpolation": "cubic"},
      {"name": "arm", "mass": 1, "inertia": [1, 1, 1], "position": [0, -1, 0]}],
    "joints": [{"type": "hinge", "name": "elbow", "body_b": "arm", "anchor": [0, 0, 0],
      "axis": [0, 0, 1], "drive": "angle", "drive_times": [0, 1], "drive_values": [0, 2],
      "drive_limit": 5, "drive_compliance": 0.1}])");
  const SceneResult none =
      load(text, {{"/bodies/drum/drive", "none", ""}, {"/joints/elbow/drive", "none", ""}});
  ASSERT_TRUE(none) << testing::PrintToString(errors_of(none));
  EXPECT_TRUE(none->model.bodies[0].drive_values.empty());
  EXPECT_EQ(none->model.bodies[0].drive_interpolation, Interpolation::linear);
  const auto& elbow = [](const SceneResult& scene) -> const JointCoordinate& {
    return dynamic_cast<const HingeJoint&>(*scene->model.joints[0]).angle;
  };
  EXPECT_EQ(elbow(none).drive, CoordinateDrive::none);
  EXPECT_FALSE(elbow(none).drive_limit);
  const SceneResult torque = load(text, {{"/joints/elbow/drive", "torque", ""}});
  ASSERT_TRUE(torque) << testing::PrintToString(errors_of(torque));
  EXPECT_FALSE(elbow(torque).drive_limit);
  EXPECT_EQ(elbow(torque).drive_values.size(), 2U);
  const SceneResult speed = load(text, {{"/joints/elbow/drive", "speed", ""}});
  ASSERT_TRUE(speed) << testing::PrintToString(errors_of(speed));
  EXPECT_EQ(elbow(speed).drive_limit, 5.0);
  EXPECT_EQ(elbow(speed).drive_compliance, 0.0);
  // What the command line itself says beside it must fit.
  EXPECT_FALSE(
      load(text, {{"/joints/elbow/drive", "torque", ""}, {"/joints/elbow/drive_limit", "3", ""}}));
  // A scene that says both is a scene with a fault.
  std::string contradictory = text;
  contradictory.replace(contradictory.find("\"angle\""), 7, "\"none\"");
  EXPECT_FALSE(load(contradictory));
}

TEST(Overrides, MayShortenARunBelowItsChecks) {
  const std::string text = scene_text(R"("checks": [
    {"quantity": "t", "equals": 1, "tolerance": 0.1, "at": 1},
    {"quantity": "t", "statistic": "mean", "equals": 1, "tolerance": 1, "from": 0.5, "to": 1},
    {"quantity": "t", "statistic": "mean", "equals": 1, "tolerance": 2, "from": 0.5}])");
  EXPECT_TRUE(load(text));
  EXPECT_TRUE(load(text, {{"/duration", "0.25", "--duration"}}));
  EXPECT_FALSE(load(text, {{"/checks/0/at", "2", ""}}));
}

}  // namespace
}  // namespace sheave::test
