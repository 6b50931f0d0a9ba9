// Parameters of a scene, and settings of triggers and controllers, as numbers of expressions.

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/quantity_list.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using testing::HasSubstr;

/// A winch with a load, and a door; `extra` are further keys.
std::string with_parameters(const std::string& parameters, const std::string& extra = "") {
  return fmt::format(R"({{
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "parameters": [{}],
    "bodies": [
      {{"name": "drum", "mobility": "rotor", "mass": 5, "position": [-0.2, 6, 0],
        "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.4}},
        "drive": "speed", "drive_values": [1]}},
      {{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 50}},
      {{"name": "leaf", "mass": 1, "position": [3, 0, 0],
        "shape": {{"type": "sphere", "radius": 0.1}}}}],
    "joints": [{{"type": "hinge", "name": "door", "body_b": "leaf", "anchor": [3, 0, 0],
      "axis": [0, 0, 1], "drive": "torque", "drive_values": [0]}}],
    "cables": [{{"name": "rope", "links": [
      {{"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 4}},
      {{"type": "attachment", "body": "load"}}]}}]{}}})",
                     parameters, extra);
}

const std::string some_parameters =
    R"({"name": "limit", "value": 600, "unit": "N", "meaning": "of the rope"},
  {"name": "rise", "value": 0.1, "unit": "m"}, {"name": "my", "value": 2})";

SceneResult loaded_text(const std::string& text, const std::vector<SceneParameter>& parameters = {},
                        const std::vector<Override>& overrides = {}) {
  return load_scene_text(text, "scene.json", overrides, {parameters, {}});
}

std::string first_fault(const SceneResult& scene) {
  return scene ? "" : to_string(scene.errors.front());
}

/// The unit and the value at the start.
std::string number_of(const Scene& scene, const std::string& text) {
  const Result<Simulation> simulation = create_simulation(scene);
  EXPECT_TRUE(simulation.ok());
  QuantityList list(QuantityIndex::of(*simulation, std::vector{text}));
  const Errors errors = list.add(text);
  if (!errors.empty()) return errors.front().message;
  std::vector<double> values(1);
  list.sample(*simulation, values);
  return fmt::format("{:.9g} {}", values[0], list.unit(0));
}

const std::string some_controls = R"(, "triggers": [
    {"name": "high", "quantity": "load.y - rise", "above": 0, "action": "set",
     "target": "drum.drive", "value": 0.5},
    {"name": "heavy", "quantity": "rope.0.tension", "above": 7e5, "action": "set",
     "target": "load.force_y", "value": -3},
    {"name": "later", "at": 0.5, "action": "set", "target": "door.drive", "value": 7}],
  "controllers": [
    {"type": "pid", "name": "lead", "measures": "load.y", "setpoint_values": [0.2],
     "setpoint_times": [0], "control": "door.drive", "proportional": 3, "integral": 2,
     "derivative": 1, "feed_forward": 4, "upper": 9},
    {"type": "bang-bang", "name": "hold", "measures": "load.vy", "setpoint": 0.3, "on": false,
     "control": "gravity.x", "low": 0, "high": 1, "hysteresis": 0.05}])";

TEST(SceneParameters, AreNumbersOfExpressionsWithTheirUnits) {
  const SceneResult scene = loaded_text(with_parameters(some_parameters));
  ASSERT_TRUE(scene) << first_fault(scene);
  EXPECT_EQ(number_of(*scene, "limit"), "600 N");
  EXPECT_EQ(number_of(*scene, "limit / (/bodies/load/mass * 10[m/s2])"), "1.2 ");
  EXPECT_EQ(number_of(*scene, "load.y + 2 * rise"), "0.2 m");
  EXPECT_EQ(number_of(*scene, "/parameters/limit/value / my"), "300 N");
  EXPECT_EQ(number_of(*scene, "/parameters/1/value"), "0.1 m");
  EXPECT_THAT(number_of(*scene, "load.y + limit"), HasSubstr("+ needs one unit"));
  EXPECT_THAT(number_of(*scene, "limt + 1"), HasSubstr("did you mean \"limit\"?"));
  EXPECT_THAT(number_of(*scene, "limit(2)"), HasSubstr("there is no function \"limit\""));
  EXPECT_THAT(number_of(*scene, "/parameters/limt/value"), HasSubstr("did you mean \"limit\"?"));
}

TEST(SceneParameters, ActInTriggersControllersAndChecks) {
  const SceneResult scene = loaded_text(with_parameters(
      some_parameters,
      some_controls + R"(, "checks": [{"quantity": "rope.0.tension - limit", "equals": -100,
      "tolerance": 1e-6, "at": 0.25}])"));
  ASSERT_TRUE(scene) << first_fault(scene);
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation.ok());
  const auto& supervisor = dynamic_cast<const SceneSupervisor&>(*simulation->supervisor);
  CheckRecorder recorder(*scene, *simulation);
  recorder.record(*simulation);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(simulation->step().ok());
    recorder.record(*simulation);
  }
  EXPECT_TRUE(recorder.results()[0].passed) << "50 kg x 10 m/s2 - 600 N";
  // The load rises at 1 rad/s x 0.2 m, so it passes 0.1 m at 0.5 s.
  EXPECT_NEAR(supervisor.acted_at(simulation->world.state())[0].value_or(-1.0), 0.5, 1e-9);
}

TEST(SceneParameters, AreSetByNameAndByPointer) {
  const std::string text = with_parameters(some_parameters);
  const SceneResult named = loaded_text(text, {{"limit", "650"}, {"rise", "0.2"}});
  ASSERT_TRUE(named) << first_fault(named);
  EXPECT_EQ(named->model.parameters[0].value, 650.0);
  EXPECT_EQ(named->model.parameters[1].value, 0.2);
  const SceneResult both =
      loaded_text(text, {{"limit", "650"}}, {{"/parameters/limit/value", "700", ""}});
  ASSERT_TRUE(both) << first_fault(both);
  EXPECT_EQ(both->model.parameters[0].value, 700.0) << "a pointer is the last word";
  EXPECT_THAT(first_fault(loaded_text(text, {{"limt", "1"}})),
              HasSubstr("has no parameter \"limt\", did you mean \"limit\"?; it has \"limit\", "
                        "\"rise\", \"my\""));
  EXPECT_THAT(first_fault(loaded_text(text, {{"limit", "much"}})), HasSubstr("--param limit"));
  EXPECT_THAT(first_fault(loaded_text("{", {{"limit", "1"}})),
              HasSubstr("has no parameter \"limit\""));
}

TEST(SceneParameters, HaveSoundNamesAndUnits) {
  const auto fault_of = [](const std::string& one) {
    return first_fault(loaded_text(with_parameters(one)));
  };
  EXPECT_EQ(fault_of(R"({"name": "a_1", "value": 1, "unit": "N m/rad"})"), "");
  for (const char* name : {"my rope", "a-b", "1a", "_a"}) {
    EXPECT_THAT(fault_of(fmt::format(R"({{"name": "{}", "value": 1}})", name)),
                HasSubstr("that begins with a letter"))
        << name;
  }
  for (const char* name : {"t", "pi", "max", "hypot", "mean", "if"}) {
    EXPECT_THAT(fault_of(fmt::format(R"({{"name": "{}", "value": 1}})", name)),
                HasSubstr("is a word of expressions"))
        << name;
  }
  EXPECT_THAT(fault_of(R"({"name": "a", "value": 1}, {"name": "a", "value": 2})"),
              HasSubstr("\"a\""));
  EXPECT_THAT(fault_of(R"({"name": "a", "value": 1, "unit": "kN"})"),
              HasSubstr("\"kN\" is no unit"));
  EXPECT_THAT(fault_of(R"({"name": "a"})"), HasSubstr("value"));
}

// A hyphen beside a parameter could be a minus.
TEST(SceneParameters, AreNotMistakenForPartsOfNames) {
  std::string text = with_parameters(some_parameters);
  for (std::size_t at = text.find("\"rope\""); at != std::string::npos;
       at = text.find("\"rope\"")) {
    text.replace(at, 6, "\"my-rope\"");
  }
  const SceneResult scene = loaded_text(text);
  ASSERT_TRUE(scene) << first_fault(scene);
  EXPECT_THAT(number_of(*scene, "my-rope.0.tension / 2"), HasSubstr("could be a difference, too"));
  EXPECT_EQ(number_of(*scene, "'my-rope'.0.tension / 2"), "0 N");
}

TEST(SettingUnits, OfTriggersAndControllersFollowFromTheirQuantities) {
  const SceneResult scene = loaded_text(with_parameters(some_parameters, some_controls));
  ASSERT_TRUE(scene) << first_fault(scene);
  EXPECT_EQ(number_of(*scene, "/triggers/high/value"), "0.5 rad/s");
  EXPECT_EQ(number_of(*scene, "/triggers/high/above"), "0 m");
  EXPECT_EQ(number_of(*scene, "/triggers/heavy/above"), "700000 N");
  EXPECT_EQ(number_of(*scene, "/triggers/heavy/value"), "-3 N");
  EXPECT_EQ(number_of(*scene, "/triggers/later/value"), "7 N m");
  EXPECT_EQ(number_of(*scene, "/triggers/later/at"), "0.5 s");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/setpoint_values/0"), "0.2 m");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/proportional"), "3 N");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/integral"), "2 N/s");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/derivative"), "1 kg m/s");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/feed_forward"), "4 N m");
  EXPECT_EQ(number_of(*scene, "/controllers/lead/upper"), "9 N m");
  EXPECT_EQ(number_of(*scene, "/controllers/hold/setpoint"), "0.3 m/s");
  EXPECT_EQ(number_of(*scene, "/controllers/hold/hysteresis"), "0.05 m/s");
  EXPECT_EQ(number_of(*scene, "/controllers/hold/high"), "1 m/s2");
  EXPECT_THAT(number_of(*scene, "/triggers/high/below"), HasSubstr("below is not set"));
  EXPECT_THAT(number_of(*scene, "/triggers/hgh/value"), HasSubstr("did you mean \"high\"?"));
}

TEST(SettingUnits, OfDrivesAreThoseOfTheirKind) {
  const SceneResult scene = loaded_text(with_parameters(some_parameters));
  ASSERT_TRUE(scene) << first_fault(scene);
  EXPECT_EQ(number_of(*scene, "/bodies/drum/drive_values/0"), "1 rad/s");
  EXPECT_EQ(number_of(*scene, "/joints/door/drive_values/0"), "0 N m");
}

TEST(SettingUnits, AreNoneWhereAQuantityNamesItsOwnThreshold) {
  const SceneResult scene =
      loaded_text(with_parameters(some_parameters, R"(, "triggers": [{"name": "self",
    "quantity": "load.y - /triggers/self/value", "above": 1, "action": "set",
    "target": "load.force_y", "value": 2}])"));
  EXPECT_THAT(first_fault(scene), HasSubstr("- needs one unit")) << "metres and newtons";
  const SceneResult other =
      loaded_text(with_parameters(some_parameters, R"(, "triggers": [{"name": "self",
    "quantity": "load.y - /triggers/self/above", "above": 1, "action": "stop"}])"));
  EXPECT_THAT(first_fault(other), HasSubstr("give the number a name in parameters"));
}

// A trigger cuts a rope 1.5 m from its first link, and the load falls from there on.
TEST(TriggerPlace, CutsAtALength) {
  const std::string text = R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 50}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "world",
      "point": [0, 6, 0]}, {"type": "attachment", "body": "load"}]}],
    "triggers": [{"name": "shears", "at": 0.31, "action": "cut", "target": "rope", "place": 1.5}]})";
  const SceneResult scene = loaded_text(text);
  ASSERT_TRUE(scene) << first_fault(scene);
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation.ok());
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(simulation->step().ok());
  const CableReport report = simulation->cable_reports()[0];
  ASSERT_TRUE(report.cut);
  EXPECT_NEAR(report.pieces[0], 1.5, 6.0 * 1e-9);
  EXPECT_NEAR(report.pieces[1], 4.5, 6.0 * 1e-9);
  const double fallen = simulation->world.state().time - 0.31;
  EXPECT_NEAR(simulation->world.velocity(BodyId{0}).y(), -10.0 * fallen, 1e-9);
}

TEST(TriggerPlace, BelongsToCutsOnly) {
  const SceneResult scene =
      loaded_text(with_parameters(some_parameters, R"(, "triggers": [{"name": "end", "at": 1,
    "action": "stop", "place": 1}])"));
  EXPECT_THAT(first_fault(scene), HasSubstr("only cut has a place"));
}

}  // namespace
}  // namespace sheave
