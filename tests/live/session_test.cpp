// What requests do.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/live/live_scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace std::string_literals;

TEST(LiveSession, StepsLikeTheWorldAlone) {
  live::Session session = session_of(live_scene);
  Result<Simulation> alone = create_simulation(scene_of(live_scene));
  for (int i = 0; i < 25; ++i) ASSERT_TRUE(alone->step().ok());
  EXPECT_EQ(done(session, R"({"type":"step"})")["steps"], 1);
  EXPECT_EQ(done(session, R"({"type":"step","count":9})")["steps"], 9);
  const json last = done(session, R"({"id":7,"type":"step","until":0.25})");
  EXPECT_EQ(last["id"], 7);
  EXPECT_EQ(last["steps"], 15);
  EXPECT_EQ(last["step"], 25);
  EXPECT_NEAR(last["time"].get<double>(), 0.25, 1e-12);  // 25 sums of 0.01 with rounding
  EXPECT_EQ(hash_of(session), hash(alone->world.state()));
  EXPECT_EQ(done(session, R"({"type":"step","until":0.25})")["steps"], 0);
  EXPECT_EQ(done(session, R"({"type":"hash"})")["hash"], fmt::format("{:016x}", hash_of(session)));
}

TEST(LiveSession, AnswersHello) {
  live::Session session = session_of(live_scene);
  const json hello = done(session, R"({"type":"hello","protocol":"sheave-live/1"})");
  EXPECT_EQ(hello["protocol"], "sheave-live/1");
  EXPECT_EQ(hello["scene"], "Workshop");
  EXPECT_EQ(hello["dt"], 0.01);
  const json other = ask(session, R"({"type":"hello","protocol":"sheave-live/2"})");
  EXPECT_EQ(other["ok"], false);
  EXPECT_EQ(other["errors"][0]["pointer"], "/protocol");
}

/// The same controls, by a LiveWorld in C++ and by requests.
TEST(LiveSession, SetsEveryControlOfAWorld) {
  live::Session session = session_of(live_scene);
  Scene scene = scene_of(live_scene);
  Result<Simulation> simulation = create_simulation(scene);
  LiveWorld world = LiveWorld::of(std::move(*simulation));
  const BodyHandle hand = *world.body("hand");
  const JointHandle hinge = *world.joint("hinge");
  const CableHandle rope = *world.cable("rope");
  const CableHandle line = *world.cable("line");
  MotionTarget way;
  way.position = {3.0, 0.5, 0.0};
  way.orientation = Quaternion(std::cos(0.1), 0.0, 0.0, std::sin(0.1)).normalized();
  way.velocity = Vector3{0.1, 0.0, 0.0};
  way.angular_velocity = Vector3{0.0, 0.0, 0.2};
  way.over = 0.5;
  const Errors errors[] = {
      world.set_speed(*world.body("drum"), {0.7, 0.2}),
      world.set_angle(*world.body("dial"), {0.3, 0.1, 0.5}),
      world.set_torque(*world.body("fan"), 0.02),
      world.set_force(*world.body("load"), {.force = {1.0, 2.0, 0.0},
                                            .torque = {0.0, 0.0, 0.1},
                                            .point = Vector3{0.1, 0.0, 0.0},
                                            .frame = ForceFrame::body}),
      world.set_motion(hand, way),
      world.set_gravity({0.0, -9.0, 0.5}),
      world.set_drive(hinge, {0.4, 0.3}),
      world.set_drive_limit(hinge, 40.0),
      world.set_compliance(rope, 2e-5),
      world.set_breaking_tension(rope, 1e4),
      world.set_friction(line, 1, 0.3),
      world.set_feed_speed(line, 2, {0.1, 0.2}),
  };
  for (const Errors& fault : errors) EXPECT_TRUE(fault.empty()) << fault[0].message;
  const std::string turn = json({way.orientation->w(), 0.0, 0.0, way.orientation->z()}).dump();
  const json set =
      done(session, R"({"type":"set","controls":[
    {"type":"speed","body":"drum","value":0.7,"over":0.2},
    {"type":"angle","body":"dial","value":0.3,"over":0.1,"rate":0.5},
    {"type":"torque","body":"fan","value":0.02},
    {"type":"force","body":"load","force":[1,2,0],"torque":[0,0,0.1],"point":[0.1,0,0],"frame":"body"},
    {"type":"motion","body":"hand","position":[3,0.5,0],"orientation":)" +
                        turn +
                        R"(,"velocity":[0.1,0,0],"angular_velocity":[0,0,0.2],"over":0.5},
    {"type":"gravity","value":[0,-9,0.5]},
    {"type":"joint_drive","joint":"hinge","coordinate":"angle","value":0.4,"over":0.3},
    {"type":"joint_drive_limit","joint":"hinge","value":40},
    {"type":"compliance","cable":"rope","value":2e-5},
    {"type":"breaking_tension","cable":"rope","value":1e4},
    {"type":"friction","cable":"line","link":1,"value":0.3},
    {"type":"feed_speed","cable":"line","link":2,"value":0.1,"over":0.2}]})"s);
  EXPECT_EQ(set["controls"], 12);
  EXPECT_EQ(hash_of(session), hash(world.state()));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step().ok());
  done(session, R"({"type":"step","count":60})");
  EXPECT_EQ(hash_of(session), hash(world.state()));
  // And back.
  done(session, R"({"type":"clear","controls":[
    {"type":"drive","body":"drum"},{"type":"drive","body":"dial"},{"type":"drive","body":"fan"},
    {"type":"force","body":"load"},{"type":"motion","body":"hand","over":0.2},{"type":"gravity"},
    {"type":"joint_drive","joint":"hinge"},{"type":"compliance","cable":"rope"},
    {"type":"breaking_tension","cable":"rope"},{"type":"friction","cable":"line","link":1},
    {"type":"feed_speed","cable":"line","link":2}]})");
  for (const char* body : {"drum", "dial", "fan"}) {
    ASSERT_TRUE(world.clear_drive(*world.body(body)).empty());
  }
  ASSERT_TRUE(world.clear_force(*world.body("load")).empty());
  ASSERT_TRUE(world.clear_motion(hand, 0.2).empty());
  world.clear_gravity();
  ASSERT_TRUE(world.clear_drive(hinge).empty());
  ASSERT_TRUE(world.clear_compliance(rope).empty());
  ASSERT_TRUE(world.clear_breaking_tension(rope).empty());
  ASSERT_TRUE(world.clear_friction(line, 1).empty());
  ASSERT_TRUE(world.clear_feed_speed(line, 2).empty());
  EXPECT_EQ(hash_of(session), hash(world.state()));
}

TEST(LiveSession, SetsAllOrNothing) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.3}]})");
  done(session, R"({"type":"step","count":5})");
  const std::uint64_t before = hash_of(session);
  const json refused = ask(session, one_line(R"({"type":"set","controls":[
    {"type":"speed","body":"drum","value":1},{"type":"gravity","value":[0,0,0]},
    {"type":"force","body":"laod","force":[1,0,0]},{"type":"speed","body":"dial","value":1}]})"));
  EXPECT_EQ(refused["ok"], false);
  ASSERT_EQ(refused["errors"].size(), 2U);
  EXPECT_EQ(refused["errors"][0]["pointer"], "/controls/2/body");
  EXPECT_EQ(refused["errors"][0]["message"], "there is no body \"laod\", did you mean \"load\"?");
  EXPECT_EQ(refused["errors"][0]["value"], "\"laod\"");
  EXPECT_EQ(refused["errors"][1]["pointer"], "/controls/3");
  EXPECT_THAT(refused["errors"][1]["message"].get<std::string>(), HasSubstr("has an angle"));
  EXPECT_EQ(hash_of(session), before);
  // What comes then is as if it had not been asked for.
  live::Session other = session_of(live_scene);
  done(other, R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.3}]})");
  done(other, R"({"type":"step","count":25})");
  done(session, R"({"type":"step","count":20})");
  EXPECT_EQ(hash_of(session), hash_of(other));
}

TEST(LiveSession, ObservesQuantitiesAndPoses) {
  live::Session session = session_of(live_scene);
  const std::string request =
      R"({"type":"observe","quantities":["t","load.y","rope.0.tension","energy.total"],"poses":["load"]})";
  json seen = done(session, request);
  EXPECT_EQ(seen["values"]["rope.0.tension"], json()) << "not known yet";
  EXPECT_EQ(seen["values"]["load.y"], -3.0);
  done(session, R"({"type":"step","count":10})");
  seen = done(session, request);
  const LiveWorld& world = session.world();
  EXPECT_EQ(seen["values"]["t"], world.time());
  // The rope is elastic with a damper: the quantity is that of the instant.
  EXPECT_EQ(seen["values"]["rope.0.tension"],
            world.simulation().cable_reports()[0].spans[0].tension);
  EXPECT_EQ(seen["values"]["energy.total"], world.energy().total());
  const BodyPose pose = *world.pose(*world.body("load"));
  EXPECT_EQ(seen["poses"]["load"]["position"][1], pose.position.y());
  EXPECT_EQ(seen["poses"]["load"]["orientation"][0], pose.orientation.w());
  EXPECT_EQ(seen["poses"]["load"]["velocity"][1], pose.velocity.y());
  EXPECT_EQ(seen["poses"]["load"]["angular_velocity"][2], pose.angular_velocity.z());
}

TEST(LiveSession, ObservesExpressions) {
  live::Session session = session_of(live_scene);
  const std::string request =
      R"j({"type":"observe","quantities":["load.y - weight.y","rope.0.tension / 2","hypot(load.x, load.y)"]})j";
  json seen = done(session, request)["values"];
  EXPECT_EQ(seen["load.y - weight.y"], -1.0);
  EXPECT_EQ(seen["rope.0.tension / 2"], json()) << "not known yet";
  EXPECT_EQ(seen["hypot(load.x, load.y)"], 3.0);
  done(session, R"({"type":"step","count":10})");
  seen = done(session, request)["values"];
  const LiveWorld& world = session.world();
  EXPECT_EQ(seen["rope.0.tension / 2"],
            world.simulation().cable_reports()[0].spans[0].tension / 2.0);
}

// The quantities of a removed part are null from then on.
TEST(LiveSession, ExpressionsOfRemovedPartsAreNull) {
  std::vector<json> events;
  live::Session session =
      session_of(live_scene, {.event = [&](const std::string& line, bool /*needed*/) {
                   events.push_back(json::parse(line));
                 }});
  done(session, R"({"type":"subscribe","name":"s","quantities":["left.y - load.y","2 * load.y"]})");
  done(session, R"({"type":"edit","changes":[{"type":"remove_cable","cable":"line"},
                  {"type":"remove_body","body":"left"}]})");
  done(session, R"({"type":"step"})");
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0]["values"]["left.y - load.y"], json());
  EXPECT_TRUE(events[0]["values"]["2 * load.y"].is_number());
}

TEST(LiveSession, SendsSubscribersTheirQuantities) {
  std::vector<json> events;
  live::Session session =
      session_of(live_scene, {.event = [&](const std::string& line, bool needed) {
                   events.push_back(json::parse(line));
                   EXPECT_FALSE(needed);
                 }});
  done(session,
       R"({"type":"subscribe","name":"slow","every":3,"quantities":["load.y"],"poses":["hand"]})");
  done(session, R"({"type":"subscribe","name":"news","events":true})");
  done(session, R"({"type":"step","count":10})");
  ASSERT_EQ(events.size(), 3U) << "steps 3, 6 and 9";
  EXPECT_EQ(events[1]["event"], "values");
  EXPECT_EQ(events[1]["subscription"], "slow");
  EXPECT_EQ(events[1]["step"], 6);
  EXPECT_TRUE(events[1]["values"]["load.y"].is_number());
  EXPECT_EQ(events[1]["poses"]["hand"]["position"][0], 3.0);
  // The rope breaks, then the hinge.
  events.clear();
  done(session, R"({"type":"unsubscribe","name":"slow"})");
  done(session, R"({"type":"set","controls":[{"type":"breaking_tension","cable":"rope","value":1},
                    {"type":"force","body":"bar","force":[500,0,0]}]})"s);
  done(session, R"({"type":"step","count":5})");
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0]["event"], "cable");
  EXPECT_EQ(events[0]["cable"], "rope");
  EXPECT_EQ(events[0]["kind"], "cut");
  EXPECT_EQ(events[1]["event"], "joint");
  EXPECT_EQ(events[1]["joint"], "hinge");
}

TEST(LiveSession, GoesBackToSnapshots) {
  live::Session session = session_of(live_scene);
  const std::string course[] = {
      R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.4}]})",
      R"({"type":"step","count":300})",
      R"({"type":"set","controls":[{"type":"force","body":"load","force":[3,0,0]},{"type":"gravity","value":[1,-9,0]}]})",
      R"({"type":"step","count":400})",
      R"({"type":"clear","controls":[{"type":"force","body":"load"}]})",
      R"({"type":"set","controls":[{"type":"motion","body":"hand","position":[3,1,0],"over":1}]})",
      R"({"type":"step","count":300})"};
  done(session, R"({"type":"step","count":20})");
  done(session, R"({"type":"snapshot","name":"a"})");
  for (const std::string& line : course) done(session, line);
  const std::uint64_t first = hash_of(session);
  EXPECT_EQ(done(session, R"({"type":"restore","name":"a"})")["step"], 20);
  for (const std::string& line : course) done(session, line);
  EXPECT_EQ(hash_of(session), first);
  EXPECT_EQ(done(session, R"({"type":"restore","name":"start"})")["step"], 0);
  EXPECT_EQ(hash_of(session), hash(create_simulation(scene_of(live_scene))->world.state()));
  done(session, R"({"type":"forget","name":"a"})");
  EXPECT_EQ(ask(session, R"({"type":"restore","name":"a"})")["ok"], false);
}

// A motion that is over before time goes on is no motion: it is refused when it is set, and so there
// is no state that cannot be gone back to. What is refused changes nothing, whatever has been edited
// since.
TEST(LiveSession, CanRestoreEveryStateItHas) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"step","count":5})");
  for (const char* over : {"5e-324", "1e-320", "1e-18"}) {
    const std::uint64_t before = hash_of(session);
    for (const char* rest : {"", R"(,"velocity":[0,1,0])"}) {
      const json refused = ask(
          session,
          fmt::format(R"({{"type":"set","controls":[{{"type":"motion","body":"hand","position":)"
                      R"([3,1,0],"over":{}{}}}]}})",
                      over, rest));
      EXPECT_EQ(refused["ok"], false) << over << rest;
      EXPECT_EQ(hash_of(session), before);
    }
  }
  done(session, R"({"type":"snapshot","name":"a"})");
  const std::uint64_t kept = hash_of(session);
  done(session, R"({"type":"edit","changes":[{"type":"remove_cable","cable":"string"}]})");
  done(session, R"({"type":"step","count":3})");
  done(session, R"({"type":"restore","name":"a"})");
  EXPECT_EQ(hash_of(session), kept);
}

// Energies beyond the range of numbers are no change that anybody could tell: refused, all of it.
TEST(LiveSession, RefusesEnergiesThatAreNoNumbers) {
  live::Session session = session_of(live_scene);
  const std::uint64_t before = hash_of(session);
  const json edited = ask(
      session,
      R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"heavy","mass":1e99,)"
      R"("position":[0,100,0],"velocity":[0,1e120,0],"shape":{"type":"sphere","radius":0.1}}}]})");
  EXPECT_EQ(edited["ok"], false);
  EXPECT_THAT(edited["errors"][0]["message"].get<std::string>(), HasSubstr("beyond the range"));
  const json placed = ask(session, R"({"type":"place","body":"load","position":[0,1e308,0]})");
  EXPECT_EQ(placed["ok"], false);
  EXPECT_EQ(hash_of(session), before);
}

TEST(LiveSession, PutsBodiesElsewhere) {
  live::Session session = session_of(live_scene);
  const json placed =
      done(session, R"({"type":"place","body":"load","position":[0,-3.5,0],"keep":"tension"})");
  EXPECT_NEAR(placed["energy"].get<double>(), -2.0 * 10.0 * 0.5, 1e-9);  // m g h; rounding
  ASSERT_EQ(placed["cables"].size(), 1U);
  EXPECT_EQ(placed["cables"][0]["cable"], "rope");
  EXPECT_NEAR(placed["cables"][0]["added"].get<double>(), 0.5, 1e-9);
  const std::uint64_t before = hash_of(session);
  const json held = ask(session, R"({"type":"place","body":"bar","position":[0,0,0]})");
  EXPECT_EQ(held["ok"], false);
  EXPECT_THAT(held["errors"][0]["message"].get<std::string>(), HasSubstr("held by joint"));
  EXPECT_EQ(hash_of(session), before);
}

TEST(LiveSession, ReleasesAndLocksJoints) {
  live::Session session = session_of(live_scene);
  Result<Simulation> simulation = create_simulation(scene_of(live_scene));
  LiveWorld world = LiveWorld::of(std::move(*simulation));
  const JointHandle hinge = *world.joint("hinge");
  const std::uint64_t start = hash_of(session);
  done(session, R"({"type":"release","joint":"hinge"})");
  EXPECT_NE(hash_of(session), start);
  ASSERT_TRUE(world.release_joint(hinge).empty());
  done(session, R"({"type":"step","count":10})");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  EXPECT_LT(world.pose(*world.body("bar"))->velocity.y(), -0.9) << "it falls";
  done(session, R"({"type":"lock","joint":"hinge"})");
  ASSERT_TRUE(world.lock_joint(hinge).empty());
  done(session, R"({"type":"step","count":10})");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  EXPECT_EQ(hash_of(session), hash(world.state()));
}

TEST(LiveSession, CutsCables) {
  live::Session session = session_of(live_scene);
  Result<Simulation> simulation = create_simulation(scene_of(live_scene));
  LiveWorld world = LiveWorld::of(std::move(*simulation));
  done(session, R"({"type":"step","count":5})");
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(world.step().ok());
  done(session, R"({"type":"cut","cable":"string"})");
  ASSERT_TRUE(world.cut(*world.cable("string")).empty());
  EXPECT_EQ(hash_of(session), hash(world.state()));
  const double before = world.pose(*world.body("weight"))->velocity.y();
  done(session, R"({"type":"step","count":10})");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  EXPECT_EQ(hash_of(session), hash(world.state()));
  // Free fall of 0.1 s at 10 m/s2. A place up to 3 m has the rounding 4e-16 m, so the speed of each of
  // the 20 substeps of 5 ms has 1e-13 m/s.
  EXPECT_NEAR(world.pose(*world.body("weight"))->velocity.y() - before, -1.0, 2e-12);
}

TEST(LiveSession, ReportsWhyTheWorldHasEnded) {
  live::Session session = session_of(live_scene);
  // 5 rad are passed after half of the 10 rad.
  done(session,
       R"({"type":"set","controls":[{"type":"angle","body":"dial","value":10,"over":1}]})");
  const json ended = done(session, R"({"type":"step","count":200})");
  EXPECT_EQ(ended["ended"], "trigger");
  EXPECT_EQ(ended["reason"], "trigger \"end\" has stopped the run");
  EXPECT_NEAR(ended["time"].get<double>(), 0.5, 0.011);  // a step late
  const json again = ask(session, R"({"type":"step"})");
  EXPECT_EQ(again["ok"], false);
  EXPECT_THAT(again["errors"][0]["message"].get<std::string>(), HasSubstr("restore a snapshot"));
  done(session, R"({"type":"restore","name":"start"})");
  done(session, R"({"type":"set","controls":[{"type":"force","body":"load","force":[1e15,0,0]}]})");
  const json diverged = done(session, R"({"type":"step","count":200})");
  EXPECT_EQ(diverged["ended"], "divergence");
  EXPECT_THAT(diverged["reason"].get<std::string>(), HasSubstr("load"));
  EXPECT_LT(diverged["steps"].get<int>(), 200);
}

TEST(LiveSession, CanBeInterruptedBetweenAndWithinSteps) {
  int calls = 0;
  bool stop = false;
  live::Session session = session_of(live_scene, {.before_step =
                                                      [&](double time) {
                                                        EXPECT_GT(time, 0.0);
                                                        return ++calls <= 5;
                                                      },
                                                  .stop = [&] { return stop; }});
  json ended = done(session, R"({"type":"step","count":10})");
  EXPECT_EQ(ended["ended"], "interrupted");
  EXPECT_EQ(ended["steps"], 5);
  calls = 0;
  stop = true;
  const std::uint64_t before = hash_of(session);
  ended = done(session, R"({"type":"step","count":10})");
  EXPECT_EQ(ended["ended"], "interrupted");
  EXPECT_EQ(ended["steps"], 0);
  EXPECT_EQ(hash_of(session), before);
}

TEST(LiveSession, RunsByItself) {
  std::vector<json> events;
  live::Session session =
      session_of(live_scene, {.event = [&](const std::string& line, bool needed) {
                   events.push_back(json::parse(line));
                   EXPECT_TRUE(needed);
                 }});
  EXPECT_FALSE(session.is_running());
  done(session, R"({"type":"run","pace":2})");
  EXPECT_TRUE(session.is_running());
  EXPECT_EQ(session.pace(), 2.0);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(session.advance());
  done(session, R"({"type":"pause"})");
  EXPECT_FALSE(session.is_running());
  EXPECT_EQ(session.world().state().steps, 10);
  done(session,
       R"({"type":"set","controls":[{"type":"angle","body":"dial","value":10,"over":0.01}]})");
  done(session, R"({"type":"run"})");
  for (int i = 0; i < 10 && session.is_running(); ++i) EXPECT_TRUE(session.advance());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0]["event"], "ended");
  EXPECT_EQ(events[0]["ended"], "trigger");
  done(session, R"({"type":"quit"})");
  EXPECT_TRUE(session.has_quit());
}

TEST(LiveSession, DescribesTheControls) {
  live::Session session = session_of(live_scene);
  const std::uint64_t before = hash_of(session);
  const json told = done(session, R"({"type":"describe","quantities":true})");
  EXPECT_EQ(hash_of(session), before);
  EXPECT_EQ(told["bodies"][0], json({{"name", "drum"}, {"mobility", "rotor"}, {"drive", "speed"}}));
  EXPECT_EQ(told["joints"][0]["coordinates"], json({"angle"}));
  EXPECT_EQ(told["cables"][0]["spans"], 1);
  EXPECT_EQ(told["cables"][2]["links"][1], json({{"type", "rolling"}, {"body", "post"}}));
  EXPECT_EQ(told["controllers"], json({"blower"}));
  EXPECT_EQ(told["triggers"], json({"end"}));
  EXPECT_THAT(told["quantities"], testing::Contains("rope.0.tension"));
  const auto can = [&](const json& control) {
    return std::find(told["controls"].begin(), told["controls"].end(), control) !=
           told["controls"].end();
  };
  EXPECT_TRUE(can({{"type", "speed"}, {"body", "drum"}}));
  EXPECT_FALSE(can({{"type", "angle"}, {"body", "drum"}}));
  EXPECT_FALSE(can({{"type", "force"}, {"body", "drum"}}));
  EXPECT_TRUE(can({{"type", "force"}, {"body", "load"}}));
  EXPECT_TRUE(can({{"type", "motion"}, {"body", "hand"}}));
  EXPECT_FALSE(can({{"type", "motion"}, {"body", "load"}}));
  EXPECT_TRUE(can({{"type", "joint_drive_limit"}, {"joint", "hinge"}, {"coordinate", "angle"}}));
  EXPECT_TRUE(can({{"type", "compliance"}, {"cable", "rope"}}));
  EXPECT_FALSE(can({{"type", "compliance"}, {"cable", "line"}}));
  EXPECT_TRUE(can({{"type", "friction"}, {"cable", "line"}, {"link", 1}}));
  EXPECT_TRUE(can({{"type", "feed_speed"}, {"cable", "line"}, {"link", 2}}));
  EXPECT_FALSE(can({{"type", "feed_speed"}, {"cable", "line"}, {"link", 0}}));
}

}  // namespace
}  // namespace sheave::test
