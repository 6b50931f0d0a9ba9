// Parts that come into a world that runs, written as in scenes.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "engine/joints/slider.h"
#include "engine/shapes/box.h"
#include "live/protocol.h"
#include "tests/live/live_scenes.h"
#include "tests/support/schema_validator.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A scene with two bodies that nothing holds, far from everything, and these parts.
std::string scene_with(const std::string& bodies, const std::string& others) {
  return R"({"format":"sheave-scene/1","gravity":[0,-10,0],"duration":9,"step":{"dt":0.01,"substeps":4},
    "bodies":[{"name":"wall","mobility":"static","position":[0,4,0]},
              {"name":"stone","mass":3,"position":[50,0,0],"shape":{"type":"sphere","radius":0.2}})" +
         bodies + "]" + others + "}";
}

struct Arrival {
  const char* name;
  const char* bodies;  // each begins with a comma
  const char* others;  // of a scene
  const char* changes;
  const char* watched;
};

const Arrival arrivals[] = {
    {"spring",
     R"(,{"name":"mass","mass":2,"position":[0,1,0],"shape":{"type":"box","size":[0.2,0.3,0.4]}})",
     R"(,"joints":[{"type":"slider","name":"rail","body_a":"wall","body_b":"mass","anchor":[0,1,0],"axis":[0,1,0],"stiffness":180,"rest":0.1}])",
     R"({"type":"add_body","body":{"name":"mass","mass":2,"position":[0,1,0],"shape":{"type":"box","size":[0.2,0.3,0.4]}}},
        {"type":"add_joint","joint":{"type":"slider","name":"rail","body_a":"wall","body_b":"mass","anchor":[0,1,0],"axis":[0,1,0],"stiffness":180,"rest":0.1}})",
     "mass"},
    {"double pendulum",
     R"(,{"name":"upper","mass":2,"position":[0.5,3,0],"angular_velocity":[0,0,1],"velocity":[0,0.5,0],"shape":{"type":"box","size":[1,0.1,0.1]}},
        {"name":"lower","mass":1,"position":[1.5,3,0],"velocity":[0,1,0],"shape":{"type":"box","size":[1,0.1,0.1]}})",
     R"(,"joints":[{"type":"hinge","name":"first","body_b":"upper","anchor":[0,3,0],"axis":[0,0,1]},
                   {"type":"ball","name":"second","body_a":"upper","body_b":"lower","anchor":[1,3,0]}])",
     R"({"type":"add_body","body":{"name":"upper","mass":2,"position":[0.5,3,0],"angular_velocity":[0,0,1],"velocity":[0,0.5,0],"shape":{"type":"box","size":[1,0.1,0.1]}}},
        {"type":"add_body","body":{"name":"lower","mass":1,"position":[1.5,3,0],"velocity":[0,1,0],"shape":{"type":"box","size":[1,0.1,0.1]}}},
        {"type":"add_joint","joint":{"type":"hinge","name":"first","body_b":"upper","anchor":[0,3,0],"axis":[0,0,1]}},
        {"type":"add_joint","joint":{"type":"ball","name":"second","body_a":"upper","body_b":"lower","anchor":[1,3,0]}})",
     "lower"},
    {"machine",
     R"(,{"name":"wheel","mobility":"rotor","mass":2,"position":[0,3,0],"shape":{"type":"cylinder","radius":0.5,"length":0.1}},
        {"name":"light","mass":1,"position":[-0.5,1,0],"shape":{"type":"sphere","radius":0.1}},
        {"name":"heavy","mass":2,"position":[0.5,1,0],"shape":{"type":"sphere","radius":0.1}})",
     R"(,"cables":[{"name":"rope","compliance":1e-4,"links":[{"type":"attachment","body":"light"},{"type":"rolling","body":"wheel","winding":"clockwise"},{"type":"attachment","body":"heavy"}]}])",
     R"({"type":"add_cable","cable":{"name":"rope","compliance":1e-4,"links":[{"type":"attachment","body":"light"},{"type":"rolling","body":"wheel","winding":"clockwise"},{"type":"attachment","body":"heavy"}]}})",
     "heavy"}};

/// The machine's bodies must come before its cable.
std::string changes_of(const Arrival& arrival) {
  if (std::string(arrival.changes).find("add_body") != std::string::npos) return arrival.changes;
  std::string changes;
  for (const json& body : json::parse("[" + std::string(arrival.bodies).substr(1) + "]")) {
    changes += json{{"type", "add_body"}, {"body", body}}.dump() + ",";
  }
  return changes + arrival.changes;
}

json pose_of(live::Session& session, const std::string& body) {
  return done(session, R"({"type":"observe","poses":[")" + body + R"("]})")["poses"][body];
}

TEST(LiveParts, MoveAsInASceneThatHadThemFromTheStart) {
  for (const Arrival& arrival : arrivals) {
    live::Session early = session_of(scene_with(arrival.bodies, arrival.others));
    live::Session late = session_of(scene_with("", ""));
    done(late, R"({"type":"step","count":37})");
    done(late, edit_of(changes_of(arrival)));
    for (int i = 0; i < 10; ++i) {
      done(early, R"({"type":"step","count":7})");
      done(late, R"({"type":"step","count":7})");
      const json a = pose_of(early, arrival.watched);
      const json b = pose_of(late, arrival.watched);
      for (const char* key : {"position", "orientation", "velocity", "angular_velocity"}) {
        for (std::size_t k = 0; k < a[key].size(); ++k) {
          // All numbers are below 10; the same steps, but for rounding and for what the solver's
          // tolerance leaves.
          EXPECT_NEAR(a[key][k].get<double>(), b[key][k].get<double>(), 1e-9)
              << arrival.name << ' ' << key << ' ' << k;
        }
      }
    }
  }
}

TEST(LiveParts, ASpringSwingsByItsClosedForm) {
  live::Session session = session_of(scene_with("", ""));
  done(session, R"({"type":"step","count":50})");
  done(session, edit_of(arrivals[0].changes));
  done(session, R"({"type":"step","count":30})");
  // m = 2 kg, k = 180 N/m, at rest 0.1 m above: about 0.1 m - m g / k with omega = sqrt(k / m).
  const double middle = 0.1 - 2.0 * 10.0 / 180.0;
  const double expected = middle - middle * std::cos(std::sqrt(90.0) * 0.3);
  // Of second order: (omega h)^2 / 24 of the phase, h = 2.5 ms: 2.3e-5 x 2.8 rad x 11 mm.
  EXPECT_NEAR(pose_of(session, "mass")["position"][1].get<double>(), 1.0 + expected, 2e-6);
}

TEST(LiveParts, ACrateIsHungOnACraneAndCutOff) {
  SceneResult scene = load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/machines/crane.json");
  ASSERT_TRUE(scene);
  Result<Simulation> simulation = create_simulation(*scene);
  std::vector<json> events;
  live::Session session(
      *scene, std::move(*simulation),
      {.event = [&](const std::string& line, bool) { events.push_back(json::parse(line)); }});
  done(
      session,
      edit_of(
          R"({"type":"add_body","body":{"name":"crate","mass":1000,"position":[13.324355652982143,0,0],
                            "shape":{"type":"box","size":[1,1,1]}}},
      {"type":"add_cable","cable":{"name":"sling","links":[
        {"type":"attachment","body":"hook"},{"type":"attachment","body":"crate","point":[0,0.5,0]}]}})"));
  done(
      session,
      R"({"type":"subscribe","name":"s","events":true,"quantities":["crate.vy","sling.0.tension"]})");
  done(session, R"({"type":"step","count":30})");
  const json hung = done(
      session,
      R"({"type":"observe","quantities":["sling.0.tension","hoist cable.0.tension","crate.y"]})");
  // The crane is rigid and stands still until 1 s: m g, and half of all that hangs. Within 1e-9 of
  // the forces, for rounding and what the solver's tolerance of 1e-10 leaves.
  EXPECT_NEAR(hung["values"]["sling.0.tension"].get<double>(), 9810.0, 1e-5);
  EXPECT_NEAR(hung["values"]["hoist cable.0.tension"].get<double>(), 6000.0 * 9.81 / 2.0, 1e-5);
  EXPECT_NEAR(hung["values"]["crate.y"].get<double>(), 0.0, 1e-9);
  // It is lifted: from 1 s on by 1.5 rad/s2 x 0.3 m / 2.
  done(session, R"({"type":"step","until":2})");
  const json lifted =
      done(session, R"({"type":"observe","quantities":["sling.0.tension","crate.vy"]})");
  EXPECT_NEAR(lifted["values"]["crate.vy"].get<double>(), 0.225, 1e-9);
  EXPECT_NEAR(lifted["values"]["sling.0.tension"].get<double>(), 1000.0 * (9.81 + 0.225), 1e-5);
  // By its breaking tension, so that it is told.
  done(session,
       R"({"type":"set","controls":[{"type":"breaking_tension","cable":"sling","value":5000}]})");
  done(session, R"({"type":"step"})");
  const auto is_cut = [](const json& event) {
    return event["event"] == "cable" && event["cable"] == "sling" && event["kind"] == "cut";
  };
  EXPECT_EQ(std::count_if(events.begin(), events.end(), is_cut), 1);
  const auto speed = [&] {
    return done(session, R"({"type":"observe","quantities":["crate.vy"]})")["values"]["crate.vy"]
        .get<double>();
  };
  const double before = speed();
  done(session, edit_of(R"({"type":"remove_cable","cable":"sling"})"));
  done(session, R"({"type":"step","count":30})");
  // 30 frames of 1/60 s of free fall; rounding.
  EXPECT_NEAR(speed() - before, -9.81 * 0.5, 1e-9);
  EXPECT_TRUE(events.back()["values"]["sling.0.tension"].is_null());
}

/// Adds a crate with a wheel on it, in place of the weight; tells what the crate is called.
BodyId replace_weight(const LiveWorld& world, Edit& edit) {
  edit.remove(*world.cable("string"));
  edit.remove(*world.body("weight"));
  BodyDef crate;
  crate.name = "crate";
  crate.mass = 3.0;
  crate.position = {2.0, -4.0, 1.0};
  crate.velocity = {0.1, 0.0, 0.0};
  auto box = std::make_shared<Box>();
  box->size = {0.3, 0.2, 0.1};
  crate.shapes.push_back({box});
  const BodyId own = edit.id(edit.add(crate));
  BodyDef wheel;
  wheel.name = "wheel";
  wheel.mobility = Mobility::rotor;
  wheel.mount = own;
  wheel.mass = 1.0;
  wheel.position = {2.0, -4.0, 1.2};
  wheel.inertia = {0.1, 0.1, 0.2};
  edit.add(wheel);
  return own;
}

/// The changes of the next test in C++.
void change_workshop(const LiveWorld& world, Edit& edit) {
  const BodyId own = replace_weight(world, edit);
  auto rail = std::make_shared<SliderJoint>();
  rail->name = "rail";
  rail->body_a = edit.id(*world.body("hand"));
  rail->body_b = own;
  rail->anchor = {2.0, -4.0, 1.0};
  rail->axis = {1.0, 0.0, 0.0};
  edit.add(rail);
  CableDef tow;
  tow.name = "tow";
  tow.compliance = 1e-4;
  auto first = std::make_shared<AttachmentLink>();
  first->body = edit.id(*world.body("hand"));
  auto last = std::make_shared<AttachmentLink>();
  last->body = own;
  last->point = {0.0, 0.1, 0.0};
  tow.links = {first, last};
  edit.add(tow);
  ColliderDef collider;
  collider.body = own;
  collider.friction = 0.5;
  edit.add(collider);
  collider = {};
  collider.body = edit.id(*world.body("load"));
  edit.add(collider);
  auto eyelet = std::make_shared<PinholeLink>();
  eyelet->point = {0.0, -1.0, 0.0};
  edit.insert(*world.cable("rope"), 0, eyelet);
  edit.change(*world.body("load"), [](BodyDef& load) {
    load.mass = 2.5;
    load.damping = 0.3;
  });
  StepSettings step = world.simulation().world.model().step;
  step.substeps = 3;
  edit.set_step(step);
}

TEST(LiveParts, MoveAsAfterTheSameEditInCpp) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"step","count":10})");
  Result<Simulation> simulation = create_simulation(scene_of(live_scene));
  LiveWorld world = LiveWorld::of(std::move(*simulation));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  done(session, edit_of(R"(
      {"type":"remove_cable","cable":"string"},
      {"type":"remove_body","body":"weight"},
      {"type":"add_body","body":{"name":"crate","mass":3,"position":[2,-4,1],"velocity":[0.1,0,0],"shape":{"type":"box","size":[0.3,0.2,0.1]}}},
      {"type":"add_body","body":{"name":"wheel","mobility":"rotor","mount":"crate","mass":1,"position":[2,-4,1.2],"inertia":[0.1,0.1,0.2]}},
      {"type":"add_joint","joint":{"type":"slider","name":"rail","body_a":"hand","body_b":"crate","anchor":[2,-4,1],"axis":[1,0,0]}},
      {"type":"add_cable","cable":{"name":"tow","compliance":1e-4,"links":[{"type":"attachment","body":"hand"},{"type":"attachment","body":"crate","point":[0,0.1,0]}]}},
      {"type":"add_collider","collider":{"body":"crate","friction":0.5}},
      {"type":"add_collider","collider":{"body":"load"}},
      {"type":"insert_link","cable":"rope","span":0,"link":{"type":"pinhole","body":"world","point":[0,-1,0]}},
      {"type":"change_body","body":"load","settings":{"mass":2.5,"damping":0.3}},
      {"type":"set_step","step":{"substeps":3}})"));
  const Result<EditReport> report = world.edit([&](Edit& edit) { change_workshop(world, edit); });
  ASSERT_TRUE(report.ok()) << report.errors()[0].message;
  EXPECT_EQ(hash_of(session), hash(world.state()));
  done(session, R"({"type":"step","count":40})");
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(world.step().ok());
  EXPECT_EQ(hash_of(session), hash(world.state()));
  const json poses = done(session, R"({"type":"observe","poses":["crate"]})")["poses"];
  EXPECT_EQ(poses["crate"]["position"][0], world.pose(*world.body("crate"))->position.x());
}

/// A session that has added, changed, gone back and done it again, with its log.
TEST(LiveParts, ReplayAndGoBackWithSnapshots) {
  std::vector<std::string> log;
  std::vector<json> events;
  live::Session session = session_of(
      live_scene,
      {.event = [&](const std::string& line, bool) { events.push_back(json::parse(line)); },
       .log = [&](const std::string& line) { log.push_back(line); }});
  const std::string hang = edit_of(
      R"({"type":"add_body","body":{"name":"crate","mass":5,"position":[0,-4,0],"shape":{"type":"box","size":[0.3,0.3,0.3]}}},
         {"type":"add_cable","cable":{"name":"sling","compliance":1e-5,"links":[
           {"type":"attachment","body":"load"},{"type":"attachment","body":"crate"}]}})");
  done(session, R"({"type":"step","count":10})");
  done(session, R"({"type":"snapshot","name":"before"})");
  done(session, hang);
  done(session, R"({"type":"subscribe","name":"s","quantities":["crate.y"],"poses":["crate"]})");
  done(session, R"({"type":"set","controls":[{"type":"force","body":"crate","force":[3,0,0]}]})");
  done(session, R"({"type":"step","count":20})");
  EXPECT_TRUE(events.back()["values"]["crate.y"].is_number());
  const std::uint64_t first = hash_of(session);
  done(session, R"({"type":"snapshot","name":"after"})");
  done(session, R"({"type":"restore","name":"before"})");
  done(session, R"({"type":"step"})");
  EXPECT_TRUE(events.back()["values"]["crate.y"].is_null());
  EXPECT_TRUE(events.back()["poses"]["crate"].is_null());
  EXPECT_EQ(ask(session, R"({"type":"observe","poses":["crate"]})")["ok"], false);
  done(session, R"({"type":"restore","name":"before"})");
  done(session, hang);
  done(session, R"({"type":"set","controls":[{"type":"force","body":"crate","force":[3,0,0]}]})");
  done(session, R"({"type":"step","count":20})");
  EXPECT_EQ(hash_of(session), first);
  done(session, R"({"type":"restore","name":"after"})");
  EXPECT_EQ(hash_of(session), first);
  done(session, R"({"type":"step","count":5})");
  EXPECT_TRUE(events.back()["poses"]["crate"].is_object());
  session.finish_log();
  live::Session again = session_of(live_scene);
  for (const std::string& line : log) done(again, line);
  EXPECT_EQ(hash_of(again), hash_of(session));
}

TEST(LiveParts, NamesReferToTheListSoFar) {
  live::Session session = session_of(live_scene);
  // Another body of the name that one had, and what is on it; ends of cables find it, too.
  done(session, edit_of(R"({"type":"remove_cable","cable":"string"},
      {"type":"remove_body","body":"weight"},
      {"type":"add_body","body":{"name":"weight","mass":7,"position":[3,-1,0],"shape":{"type":"sphere","radius":0.1}}},
      {"type":"add_joint","joint":{"type":"ball","name":"b","body_a":"hand","body_b":"weight","anchor":[3,0,0]}},
      {"type":"detach","cable":"rope","end":"last"},
      {"type":"attach","cable":"rope","end":"last","body":"weight"},
      {"type":"pay_out","cable":"rope","span":0,"length":3},
      {"type":"change_body","body":"weight","settings":{"mass":8}},
      {"type":"change_body","body":"weight","settings":{"angular_damping":0.1}},
      {"type":"remove_joint","joint":"b"})"));
  const json told = done(session, R"({"type":"describe"})");
  EXPECT_EQ(told["bodies"].size(), 9U);
  EXPECT_EQ(told["joints"].size(), 1U);
  EXPECT_EQ(told["cables"][0]["links"][1]["body"], "weight");
  const Model& model = session.world().simulation().world.model();
  const BodyDef& weight =
      model.bodies[static_cast<std::size_t>(session.world().body("weight")->slot)];
  EXPECT_EQ(weight.mass, 8.0);
  EXPECT_EQ(weight.angular_damping, 0.1);
  const std::uint64_t before = hash_of(session);
  // A name may not be used before it is there.
  const json answer = ask(
      session,
      edit_of(
          R"({"type":"add_joint","joint":{"type":"ball","name":"c","body_a":"hand","body_b":"late","anchor":[0,0,0]}},
             {"type":"add_body","body":{"name":"late","mass":1,"shape":{"type":"sphere","radius":1}}})"));
  EXPECT_EQ(answer["errors"][0]["pointer"], "/changes/0/joint/body_b");
  EXPECT_EQ(answer["errors"][0]["code"], "unknown-body");
  EXPECT_EQ(hash_of(session), before);
}

TEST(LiveParts, SettingsThatAreNotGivenStayAndNullGivesTheDefault) {
  live::Session session = session_of(live_scene);
  const auto body = [&](const char* name) -> const BodyDef& {
    return session.world().simulation().world.model().bodies[static_cast<std::size_t>(
        session.world().body(name)->slot)];
  };
  done(session, edit_of(R"({"type":"change_body","body":"load","settings":{
      "mass":null,"density":500,"damping":2,"shapes":[{"type":"sphere","radius":0.5},{"type":"box","size":[1,1,1],"position":[2,0,0]}]}},
      {"type":"change_body","body":"dial","settings":{"drive":"none","drive_values":null}},
      {"type":"set_step","step":{"substeps":7,"solver":"gauss-seidel"}})"));
  EXPECT_FALSE(body("load").mass.has_value());
  EXPECT_EQ(body("load").density, 500.0);
  EXPECT_EQ(body("load").damping, 2.0);
  EXPECT_EQ(body("load").shapes.size(), 2U);
  EXPECT_EQ(body("dial").drive, DriveKind::none);
  done(session, edit_of(R"({"type":"change_body","body":"load","settings":{"damping":null}},
      {"type":"set_step","step":{"solver":null}})"));
  EXPECT_EQ(body("load").density, 500.0);
  EXPECT_EQ(body("load").damping, 0.0);
  const StepSettings& step = session.world().simulation().world.model().step;
  EXPECT_EQ(step.substeps, 7);
  EXPECT_EQ(step.solver, SolverKind::direct);
  EXPECT_EQ(step.dt, 0.01);
}

TEST(LiveParts, AnIndependentValidatorAcceptsTheSameRequests) {
  if (!SchemaValidator::available()) GTEST_SKIP() << "python3-jsonschema is not installed";
  SchemaValidator validator(live::protocol_schema());
  for (const Arrival& arrival : arrivals) {
    validator.add(arrival.name, edit_of(changes_of(arrival)), true);
  }
  const std::string right =
      R"({"type":"change_body","body":"load","settings":{"mass":null,"density":5}},{"type":"set_step","step":{"solver":null}})";
  validator.add("settings", edit_of(right), true);
  for (const char* wrong : {R"({"type":"add_body"})", R"({"type":"add_body","body":{"mass":1}})",
                            R"({"type":"add_body","body":{"name":"x","mas":1}})",
                            R"({"type":"add_body","body":{"name":"x","mass":0}})",
                            R"({"type":"add_body","body":{"name":"x"},"cable":"y"})",
                            R"({"type":"add_joint","joint":{"type":"hing"}})",
                            R"({"type":"insert_link","cable":"c","span":0})",
                            R"({"type":"change_body","body":"x","settings":{"position":[0,0,0]}})",
                            R"({"type":"change_body","body":"x","settings":{"mass":-1}})",
                            R"({"type":"set_step","step":{"dt":1}})"}) {
    validator.add(wrong, edit_of(wrong), false);
  }
  EXPECT_EQ(validator.disagreements(), "");
}

}  // namespace
}  // namespace sheave::test
