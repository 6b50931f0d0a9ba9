// What requests change of what the world is made of.

#include <gmock/gmock.h>

#include "tests/live/live_scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(LiveEdit, EndsAreTiedElsewhereAndTheAnswerReportsTheChange) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"step","count":20})");
  const json answer = done(session, edit_of(R"({"type":"detach","cable":"string","end":"last"},
      {"type":"attach","cable":"string","end":"last","body":"weight","point":[0,0.1,0]},
      {"type":"pay_out","cable":"string","span":0,"length":0.5})"));
  EXPECT_EQ(answer["energy"], 0.0);
  ASSERT_EQ(answer["cables"].size(), 1U);
  EXPECT_EQ(answer["cables"][0]["cable"], "string");
  EXPECT_NEAR(answer["cables"][0]["added"].get<double>(), 0.5, 1e-12);
  done(session, R"({"type":"step","count":300})");
  const json seen = done(session, R"({"type":"observe","poses":["weight"]})");
  // 2 m and a half from the hand, hung by a point 0.1 m above its middle.
  EXPECT_NEAR(seen["poses"]["weight"]["position"][1].get<double>(), -2.6, 1e-2);
}

TEST(LiveEdit, RemovedPartsAreNullUntilTheSnapshotIsRestored) {
  live::Session session = session_of(live_scene);
  std::vector<json> events;
  live::Session told = session_of(live_scene, {.event = [&](const std::string& line, bool) {
                                    events.push_back(json::parse(line));
                                  }});
  done(
      told,
      R"({"type":"subscribe","name":"s","quantities":["string.0.tension","load.y"],"poses":["weight"]})");
  done(told, R"({"type":"step","count":5})");
  done(told, R"({"type":"snapshot","name":"before"})");
  const json edited = done(told, edit_of(R"({"type":"remove_cable","cable":"string"},
                                            {"type":"remove_body","body":"weight"})"));
  EXPECT_EQ(edited["cables"][0]["cable"], "string");
  done(told, R"({"type":"step"})");
  EXPECT_TRUE(events.back()["values"]["string.0.tension"].is_null());
  EXPECT_TRUE(events.back()["values"]["load.y"].is_number());
  EXPECT_TRUE(events.back()["poses"]["weight"].is_null());
  const json described = done(told, R"({"type":"describe"})");
  for (const json& body : described["bodies"]) EXPECT_NE(body["name"], "weight");
  EXPECT_EQ(described["bodies"].size(), 8U);
  done(told, R"({"type":"restore","name":"before"})");
  done(told, R"({"type":"step"})");
  EXPECT_TRUE(events.back()["values"]["string.0.tension"].is_number());
  EXPECT_TRUE(events.back()["poses"]["weight"].is_object());
  done(session, R"({"type":"step","count":6})");
  EXPECT_EQ(hash_of(told), hash_of(session));
}

TEST(LiveEdit, FaultsHavePointersAndNothingIsDone) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"step","count":3})");
  const std::uint64_t before = hash_of(session);
  const json answer = ask(session, edit_of(R"({"type":"detach","cable":"string","end":"last"},
      {"type":"remove_body","body":"wieght"},
      {"type":"attach","cable":"rope","end":"first","body":"world"},
      {"type":"split","cable":"line","span":7,"name":"x"})"));
  EXPECT_EQ(answer["ok"], false);
  ASSERT_EQ(answer["errors"].size(), 3U) << answer;
  EXPECT_EQ(answer["errors"][0]["pointer"], "/changes/1/body");
  EXPECT_THAT(answer["errors"][0]["message"].get<std::string>(), HasSubstr("\"weight\""));
  EXPECT_EQ(answer["errors"][1]["pointer"], "/changes/2");
  EXPECT_EQ(answer["errors"][2]["pointer"], "/changes/3");
  EXPECT_EQ(hash_of(session), before);
  // A trigger of the scene looks at the dial.
  const json needed = ask(session, edit_of(R"({"type":"remove_body","body":"dial"})"));
  EXPECT_EQ(needed["ok"], false);
  EXPECT_THAT(needed["errors"][0]["message"].get<std::string>(), HasSubstr("dial"));
  EXPECT_EQ(hash_of(session), before);
}

TEST(LiveEdit, LooseCablesAreDescribedAndJoined) {
  live::Session session = session_of(live_scene);
  done(session, R"({"type":"step","count":3})");
  done(session,
       edit_of(R"({"type":"split","cable":"string","span":0,"share":0.25,"name":"rest"})"));
  const json loose = done(session, R"({"type":"describe"})")["loose_cables"];
  ASSERT_EQ(loose.size(), 2U);
  EXPECT_NEAR(loose[0]["length"].get<double>() + loose[1]["length"].get<double>(), 2.0, 0.3);
  done(session, edit_of(R"({"type":"join","cable":"string","next":"rest"})"));
  EXPECT_TRUE(done(session, R"({"type":"describe"})")["loose_cables"].empty());
}

TEST(LiveEdit, ABeltIsOpenedTiedAndClosedAgain) {
  const auto wheel = [](const char* name, const char* position) {
    return std::string(R"({"name":")") + name + R"(","mobility":"rotor","mass":1,"position":)" +
           position + R"(,"angular_velocity":[0,0,5],"spin_inertia":0.03,)" +
           R"("shape":{"type":"cylinder","radius":0.2,"length":0.1}},)";
  };
  live::Session session = session_of(
      R"({"format":"sheave-scene/1","gravity":[0,0,0],"duration":9,"step":{"dt":0.002},"bodies":[)" +
      wheel("a", "[0,0,0]") + wheel("b", "[2,0,0]") +
      R"({"name":"sled","mobility":"slider","axis":[1,0,0],"mass":2,"position":[1,0.2,0],
          "shape":{"type":"box","size":[0.1,0.1,0.1]}}],
        "cables":[{"name":"belt","closed":true,"links":[
          {"type":"rolling","body":"a","winding":"counter-clockwise"},
          {"type":"rolling","body":"b","winding":"counter-clockwise"}]}]})");
  done(session, edit_of(R"({"type":"open","cable":"belt","span":1},
      {"type":"attach","cable":"belt","end":"first","body":"sled"},
      {"type":"attach","cable":"belt","end":"last","body":"sled"})"));
  const json told = done(session, R"({"type":"describe"})");
  EXPECT_EQ(told["cables"][0]["closed"], false);
  EXPECT_EQ(told["cables"][0]["links"].size(), 4U);
  done(session, R"({"type":"step","count":5})");
  // The sled is pulled along: with J = 2 I / r^2 = 1.5 kg, J v / (J + m) of the belt's 1 m/s;
  // rounding and the solver's tolerance.
  const json seen = done(session, R"({"type":"observe","quantities":["sled.vx"]})");
  EXPECT_NEAR(seen["values"]["sled.vx"].get<double>(), -1.5 / 3.5, 1e-9);
  done(session, edit_of(R"({"type":"detach","cable":"belt","end":"first"},
      {"type":"detach","cable":"belt","end":"last"},
      {"type":"join","cable":"belt","next":"belt"})"));
  EXPECT_EQ(done(session, R"({"type":"describe"})")["cables"][0]["closed"], true);
  const json open = ask(session, edit_of(R"({"type":"open","cable":"belt","span":5})"));
  EXPECT_EQ(open["errors"][0]["pointer"], "/changes/0");
}

TEST(LiveEdit, ALogWithEditsReplays) {
  std::vector<std::string> log;
  live::Session session =
      session_of(live_scene, {.log = [&](const std::string& line) { log.push_back(line); }});
  done(session, R"({"type":"step","count":10})");
  done(session, edit_of(R"({"type":"split","cable":"string","span":0,"name":"rest"})"));
  done(session, R"({"type":"step","count":10})");
  done(
      session,
      edit_of(R"({"type":"remove_cable","cable":"rest"},{"type":"remove_joint","joint":"hinge"})"));
  done(session, R"({"type":"step","count":10})");
  session.finish_log();
  live::Session again = session_of(live_scene);
  for (const std::string& line : log) done(again, line);
  EXPECT_EQ(hash_of(again), hash_of(session));
}

}  // namespace
}  // namespace sheave::test
