// What is wrong is told, and changes nothing.

#include <gmock/gmock.h>

#include "tests/live/live_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using namespace std::string_literals;

struct Bad {
  std::string line;
  const char* code;     // of its first error
  const char* pointer;  // likewise
  const char* part;     // of the message or of what is allowed
};

const std::vector<Bad>& bad_requests() {
  static const std::vector<Bad> list{
      // What is no request at all.
      {"", "syntax", "", "expected"},
      {"   ", "syntax", "", "expected"},
      {"step", "syntax", "", "invalid"},
      {"{", "syntax", "", "expected"},
      {R"({"type":"step"} {"type":"step"})", "syntax", "", "expected"},
      {"{\"type\":\n\"step\"}", "syntax", "", "one line"},
      {"{\"type\":\"st\xff\"}", "encoding", "", "UTF-8"},
      {"{\"type\":\"step\"}\0"s, "encoding", "", "null"},
      {"[]", "wrong-type", "", "object"},
      {"3", "wrong-type", "", "object"},
      {"null", "wrong-type", "", "object"},
      {"{}", "missing-key", "/type", "required key"},
      {R"({"type":3})", "wrong-type", "/type", "must be one of"},
      {R"({"type":"setp"})", "unknown-choice", "/type", "did you mean \"step\"?"},
      {R"({"type":"edit"})", "missing-key", "/changes", "a list of objects"},
      {R"({"type":"step","cuont":3})", "unknown-key", "/cuont", "did you mean \"count\"?"},
      {R"({"type":"step","count":3,"count":4})", "duplicate-key", "/count", "first given"},
      {R"({"type":"step","count":3,"controls":[]})", "unknown-key", "/controls", "unknown key"},
      {R"({"id":"seven","type":"step"})", "wrong-type", "/id", "a number"},
      {R"({"type":"step","at_step":1})", "meaning", "/at_step", "the world is at step 3"},
      {R"({"type":"step","at_step":2.5})", "meaning", "/at_step", "the world is at step 3"},
      {R"({"type":"hello","protocol":"sheave-live/0"})", "unknown-choice", "/protocol", "sheave"},
      // Steps.
      {R"({"type":"step","count":0})", "out-of-range", "/count", ">= 1"},
      {R"({"type":"step","count":-1})", "out-of-range", "/count", ">= 1"},
      {R"({"type":"step","count":1.5})", "wrong-type", "/count", "an integer"},
      {R"({"type":"step","count":"3"})", "wrong-type", "/count", "an integer"},
      {R"({"type":"step","count":1e400})", "number-range", "/count", "too large"},
      {R"({"type":"step","count":21})", "meaning", "/count", "at most 20"},
      {R"({"type":"step","until":1e9})", "meaning", "/until", "at most 20"},
      {R"({"type":"step","until":-1e300})", "meaning", "/until", "is over"},
      {R"({"type":"step","until":NaN})", "syntax", "/until", "invalid"},
      {R"({"type":"step","count":1,"until":1})", "exclusive-keys", "/until", "exclude"},
      {R"({"type":"run","pace":0})", "out-of-range", "/pace", "> 0"},
      // Controls.
      {R"({"type":"set"})", "missing-key", "/controls", "required"},
      {R"({"type":"set","controls":{}})", "wrong-type", "/controls", "list"},
      {R"({"type":"set","controls":[3]})", "wrong-type", "/controls/0", "object"},
      {R"({"type":"set","controls":[{}]})", "missing-key", "/controls/0/type", "required"},
      {R"({"type":"set","controls":[{"type":"sped"}]})", "unknown-choice", "/controls/0/type",
       "did you mean \"speed\"?"},
      {R"({"type":"set","controls":[{"type":"drive","body":"drum"}]})", "unknown-choice",
       "/controls/0/type", "speed"},
      {R"({"type":"set","controls":[{"type":"speed","value":1}]})", "missing-key",
       "/controls/0/body", "required"},
      {R"({"type":"set","controls":[{"type":"speed","body":3,"value":1}]})", "wrong-type",
       "/controls/0/body", "string"},
      {R"({"type":"set","controls":[{"type":"speed","body":"drum","value":[1]}]})", "wrong-type",
       "/controls/0/value", "a number [rad/s]"},
      {R"({"type":"set","controls":[{"type":"speed","body":"drum","value":null}]})", "wrong-type",
       "/controls/0/value", "a number"},
      {R"({"type":"set","controls":[{"type":"speed","body":"drum","value":1,"over":-1}]})",
       "out-of-range", "/controls/0/over", ">= 0"},
      {R"({"type":"set","controls":[{"type":"speed","body":"","value":1}]})", "meaning",
       "/controls/0/body", "no body"},
      {R"({"type":"set","controls":[{"type":"speed","body":"load","value":1}]})", "meaning",
       "/controls/0", "drive"},
      {R"({"type":"set","controls":[{"type":"torque","body":"drum","value":1}]})", "meaning",
       "/controls/0", "has a speed"},
      {R"({"type":"set","controls":[{"type":"force","body":"hand","force":[1,0,0]}]})", "meaning",
       "/controls/0", "hand"},
      {R"({"type":"set","controls":[{"type":"force","body":"load","force":[1,0]}]})", "wrong-type",
       "/controls/0/force", "[x, y, z]"},
      {R"({"type":"set","controls":[{"type":"force","body":"load","frame":"own"}]})",
       "unknown-choice", "/controls/0/frame", "body"},
      {R"({"type":"set","controls":[{"type":"motion","body":"load","position":[0,0,0]}]})",
       "meaning", "/controls/0", "kinematic"},
      {R"({"type":"set","controls":[{"type":"motion","body":"hand","position":[0,0,0],"orientation":[0,0,0,0]}]})",
       "out-of-range", "/controls/0/orientation", "unit quaternion"},
      {R"({"type":"set","controls":[{"type":"motion","body":"hand","position":[0,0,0],"angular_velocity":[1,0,0]}]})",
       "meaning", "/controls/0", "velocity"},
      {R"({"type":"set","controls":[{"type":"joint_drive","joint":"hing","value":1}]})", "meaning",
       "/controls/0/joint", "did you mean \"hinge\"?"},
      {R"({"type":"set","controls":[{"type":"joint_drive","joint":"hinge","coordinate":"travel","value":1}]})",
       "meaning", "/controls/0/coordinate", "angle"},
      {R"({"type":"set","controls":[{"type":"joint_drive_limit","joint":"hinge","value":0}]})",
       "out-of-range", "/controls/0/value", "> 0"},
      {R"({"type":"set","controls":[{"type":"compliance","cable":"line","value":1}]})", "meaning",
       "/controls/0", "compliance"},
      {R"({"type":"set","controls":[{"type":"compliance","cable":"rpoe","value":1}]})", "meaning",
       "/controls/0/cable", "did you mean \"rope\"?"},
      {R"({"type":"set","controls":[{"type":"friction","cable":"line","link":0,"value":1}]})",
       "meaning", "/controls/0", "friction"},
      {R"({"type":"set","controls":[{"type":"friction","cable":"line","link":-1,"value":1}]})",
       "out-of-range", "/controls/0/link", ">= 0"},
      {R"({"type":"set","controls":[{"type":"feed_speed","cable":"line","link":99,"value":1}]})",
       "meaning", "/controls/0", "line"},
      {R"({"type":"clear","controls":[{"type":"speed","body":"drum"}]})", "unknown-choice",
       "/controls/0/type", "drive"},
      {R"({"type":"clear","controls":[{"type":"drive","body":"load"}]})", "meaning", "/controls/0",
       "drive"},
      // Parts that edits add.
      {R"({"type":"edit","changes":[{"type":"add_body"}]})", "missing-key", "/changes/0/body",
       "an object (as in scenes"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":[]}]})", "wrong-type",
       "/changes/0/body", "a rigid body"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mas":1}}]})",
       "unknown-key", "/changes/0/body/mas", "did you mean \"mass\"?"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"mass":1}}]})", "missing-key",
       "/changes/0/body/name", "required"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"world"}}]})", "bad-name",
       "/changes/0/body/name", "belongs to"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":0}}]})",
       "out-of-range", "/changes/0/body/mass", "> 0"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":"1"}}]})",
       "wrong-type", "/changes/0/body/mass", "a number"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mobility":"fre"}}]})",
       "unknown-choice", "/changes/0/body/mobility", "did you mean \"free\"?"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","shape":{"type":"bux"}}}]})",
       "unknown-choice", "/changes/0/body/shape/type", "did you mean \"box\"?"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","shapes":[{"type":"box"}]}}]})",
       "missing-key", "/changes/0/body/shapes/0/size", "required"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","shape":{"type":"sphere","radius":1},"shapes":[]}}]})",
       "exclusive-keys", "/changes/0/body/shapes", "exclude"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":1,"mobility":"rotor","mount":"bra"}}]})",
       "unknown-body", "/changes/0/body/mount", "did you mean \"bar\"?"},
      {R"({"type":"edit","changes":[{"type":"add_joint","joint":{"type":"hinj"}}]})",
       "unknown-choice", "/changes/0/joint/type", "did you mean \"hinge\"?"},
      {R"({"type":"edit","changes":[{"type":"add_joint","joint":{"type":"hinge","name":"h","body_b":"laod","anchor":[0,0,0],"axis":[0,0,1]}}]})",
       "unknown-body", "/changes/0/joint/body_b", "did you mean \"load\"?"},
      {R"({"type":"edit","changes":[{"type":"add_cable","cable":{"name":"c"}}]})", "meaning",
       "/changes/0/cable/links", "at least 2 links"},
      {R"({"type":"edit","changes":[{"type":"add_cable","cable":{"name":"c","links":[{"type":"attachment","body":"world"},{"type":"attachment","body":"x"}]}}]})",
       "unknown-body", "/changes/0/cable/links/1/body", "no body of this name"},
      {R"({"type":"edit","changes":[{"type":"add_collider","collider":{"body":"load","frction":1}}]})",
       "unknown-key", "/changes/0/collider/frction", "did you mean \"friction\"?"},
      {R"({"type":"edit","changes":[{"type":"insert_link","cable":"rope","link":{"type":"rolling","body":"drum"}}]})",
       "missing-key", "/changes/0/span", "required"},
      {R"({"type":"edit","changes":[{"type":"change_body","body":"load","settings":{"position":[0,0,0]}}]})",
       "unknown-key", "/changes/0/settings/position", "mass"},
      {R"({"type":"edit","changes":[{"type":"change_body","body":"load","settings":{"mass":0}}]})",
       "out-of-range", "/changes/0/settings/mass", "> 0"},
      {R"({"type":"edit","changes":[{"type":"change_body","body":"lod","settings":{}}]})",
       "meaning", "/changes/0/body", "did you mean \"load\"?"},
      {R"({"type":"edit","changes":[{"type":"set_step","step":{"dt":0.1}}]})", "unknown-key",
       "/changes/0/step/dt", "substeps"},
      {R"({"type":"edit","changes":[{"type":"set_step","step":{"substeps":null,"iterations":0}}]})",
       "out-of-range", "/changes/0/step/iterations", "1 ... 1000000"},
      // What they mean together.
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"load","mass":1}}]})",
       "meaning", "/changes/0/body/name", "two bodies"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":1,"density":2,"shape":{"type":"sphere","radius":1}}}]})",
       "meaning", "/changes/0/body/density", "exclude"},
      {R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":1,"shapes":[{"type":"half-space"}]}}]})",
       "meaning", "/changes/0/body/shapes/0", "has no mass"},
      {R"({"type":"edit","changes":[{"type":"add_joint","joint":{"type":"hinge","name":"hinge","body_b":"load","anchor":[0,0,0],"axis":[0,0,1]}}]})",
       "meaning", "/changes/0/joint/name", "two joints"},
      {R"({"type":"edit","changes":[{"type":"add_joint","joint":{"type":"hinge","name":"drum","body_b":"bar","anchor":[0,0,0],"axis":[0,0,1]}}]})",
       "meaning", "/changes/0/joint/name", "drum.drive_power"},
      {R"({"type":"edit","changes":[{"type":"remove_joint","joint":"hinge"},{"type":"add_joint","joint":{"type":"hinge","name":"h","body_b":"bar","anchor":[0,0,0],"axis":[0,0,0]}}]})",
       "meaning", "/changes/1/joint/axis", "direction"},
      {R"({"type":"edit","changes":[{"type":"add_cable","cable":{"name":"rope","links":[{"type":"attachment","body":"world"},{"type":"attachment","body":"load"}]}}]})",
       "meaning", "/changes/0/cable/name", "two cables"},
      {R"({"type":"edit","changes":[{"type":"add_cable","cable":{"name":"c","links":[{"type":"rolling","body":"bar","winding":"clockwise"},{"type":"attachment","body":"load"}]}}]})",
       "meaning", "/changes/0/cable/links/0", "cable \"c\""},
      {R"({"type":"edit","changes":[{"type":"remove_cable","cable":"string"},{"type":"add_cable","cable":{"name":"c","links":[{"type":"rolling","body":"bar","winding":"clockwise"},{"type":"attachment","body":"load"}]}}]})",
       "meaning", "/changes/1/cable/links/0", "cable \"c\""},
      {R"({"type":"edit","changes":[{"type":"add_collider","collider":{"body":"load"}},{"type":"add_collider","collider":{"body":"load"}}]})",
       "meaning", "/changes/1/collider/body", "has a collider already"},
      {R"({"type":"edit","changes":[{"type":"remove_collider","body":"load"}]})", "meaning",
       "/changes/0", "has no collider"},
      {R"({"type":"edit","changes":[{"type":"insert_link","cable":"rope","span":3,"link":{"type":"rolling","body":"post","winding":"clockwise"}}]})",
       "meaning", "/changes/0", "no span number 3"},
      {R"({"type":"edit","changes":[{"type":"change_body","body":"load","settings":{"density":3}}]})",
       "meaning", "/changes/0/settings/density", "exclude"},
      {R"({"type":"edit","changes":[{"type":"remove_cable","cable":"string"},{"type":"remove_body","body":"weight"},{"type":"add_joint","joint":{"type":"hinge","name":"h","body_b":"weight","anchor":[0,0,0],"axis":[0,0,1]}}]})",
       "unknown-body", "/changes/2/joint/body_b", "no body of this name"},
      // Places, readings, names.
      {R"({"type":"place","body":"load"})", "missing-key", "/position", "required"},
      {R"({"type":"place","body":"load","position":[0,0,1]})", "meaning", "", "plane"},
      {R"({"type":"place","body":"drum","position":[0,0,1]})", "meaning", "", "rotor"},
      {R"({"type":"place","body":"load","position":[0,0,0],"keep":"slack"})", "unknown-choice",
       "/keep", "tension"},
      {R"({"type":"release","joint":"hnige"})", "meaning", "/joint", "did you mean \"hinge\"?"},
      {R"({"type":"cut","cable":"roppe"})", "meaning", "/cable", "did you mean \"rope\"?"},
      {R"({"type":"cut"})", "missing-key", "/cable", "required"},
      {R"({"type":"lock"})", "missing-key", "/joint", "required"},
      {R"({"type":"observe"})", "meaning", "", "the request names nothing"},
      {R"({"type":"observe","quantities":"load.y"})", "wrong-type", "/quantities", "strings"},
      {R"({"type":"observe","quantities":["load.yy"]})", "meaning", "/quantities/0",
       "did you mean"},
      {R"({"type":"observe","quantities":["load.y + t"]})", "meaning", "/quantities/0",
       "+ needs one unit"},
      {R"({"type":"observe","quantities":["t","t"]})", "meaning", "/quantities/1", "twice"},
      {R"({"type":"observe","poses":["load","world"]})", "meaning", "/poses/1", "no body"},
      {R"({"type":"subscribe","quantities":["t"]})", "missing-key", "/name", "required"},
      {R"({"type":"subscribe","name":"a"})", "meaning", "", "the request names nothing"},
      {R"({"type":"subscribe","name":"known","events":true})", "meaning", "/name", "unsubscribe"},
      {R"({"type":"subscribe","name":"a\nb","events":true})", "meaning", "/name", "must consist"},
      {R"({"type":"subscribe","name":"b","every":0,"events":true})", "out-of-range", "/every",
       ">= 1"},
      {R"({"type":"unsubscribe","name":"knwon"})", "meaning", "/name", "did you mean \"known\"?"},
      {R"({"type":"snapshot","name":"start"})", "meaning", "/name", "belongs"},
      {R"({"type":"snapshot","name":""})", "meaning", "/name", "must consist"},
      {R"({"type":"restore","name":"strat"})", "meaning", "/name", "did you mean \"start\"?"},
      {R"({"type":"forget","name":"start"})", "meaning", "/name", "always kept"},
  };
  return list;
}

live::Session started() {
  live::Limits limits;
  limits.steps = 20;
  live::Session session = session_of(live_scene, {}, limits);
  done(session, R"({"type":"subscribe","name":"known","quantities":["load.y"]})");
  done(session, R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.3}]})");
  done(session, R"({"type":"step","count":3})");
  return session;
}

TEST(LiveFaults, AreReportedWithTheirPlacesAndChangeNothing) {
  live::Session session = started();
  const std::uint64_t before = hash_of(session);
  for (const Bad& bad : bad_requests()) {
    const json answer = ask(session, bad.line);
    EXPECT_EQ(answer["ok"], false) << bad.line;
    if (!answer.contains("errors")) continue;
    const json& fault = answer["errors"][0];
    EXPECT_EQ(fault["code"], bad.code) << bad.line << '\n' << fault;
    EXPECT_EQ(fault["pointer"], bad.pointer) << bad.line << '\n' << fault;
    const std::string told = std::string(fault["message"]) + " " + fault.value("allowed", "");
    EXPECT_THAT(told, HasSubstr(bad.part)) << bad.line;
    EXPECT_GE(fault["column"].get<int>(), 1);
    EXPECT_LE(fault["column"].get<std::size_t>(), bad.line.size() + 1);
    ASSERT_EQ(hash_of(session), before) << bad.line;
  }
  // As one that has never been asked any of that.
  live::Session other = started();
  done(session, R"({"type":"step","count":20})");
  done(other, R"({"type":"step","count":20})");
  EXPECT_EQ(hash_of(session), hash_of(other));
}

TEST(LiveFaults, RepeatTheId) {
  live::Session session = started();
  EXPECT_EQ(ask(session, R"({"id":12,"type":"nonsense"})")["id"], 12);
  EXPECT_EQ(ask(session, R"({"id":-0.5})")["id"], -0.5);
  EXPECT_EQ(session.answer(R"({"id":9007199254740992,"type":"hash"})")
                .find(R"({"id":9007199254740992,"ok":true,"step":3,)"),
            0U);
  EXPECT_FALSE(ask(session, "{").contains("id"));
}

TEST(LiveFaults, KeepToTheirLimits) {
  live::Limits limits;
  limits.line_bytes = 1000;
  limits.snapshots = 3;
  limits.subscriptions = 2;
  limits.faults = 5;
  live::Session session = session_of(live_scene, {}, limits);
  const auto message = [&](const std::string& line) {
    const json answer = ask(session, line);
    EXPECT_EQ(answer["ok"], false) << line;
    return answer["errors"][0]["message"].get<std::string>();
  };
  EXPECT_THAT(message(std::string(1001, ' ')), HasSubstr("at most 1000"));
  EXPECT_THAT(json::parse(session.answer_to_long_line())["errors"][0]["message"],
              HasSubstr("at most 1000"));
  EXPECT_THAT(message(std::string(400, '[') + std::string(400, ']')), HasSubstr("16"));
  done(session, R"({"type":"snapshot","name":"a"})");
  done(session, R"({"type":"snapshot","name":"b"})");
  EXPECT_THAT(message(R"({"type":"snapshot","name":"c"})"), HasSubstr("there are 3"));
  done(session, R"({"type":"snapshot","name":"b"})");  // in its place
  done(session, R"({"type":"subscribe","name":"a","events":true})");
  done(session, R"({"type":"subscribe","name":"b","events":true})");
  EXPECT_THAT(message(R"({"type":"subscribe","name":"c","events":true})"),
              HasSubstr("there are 2"));
  std::string many = R"({"type":"observe","quantities":["x")";
  for (int i = 0; i < 30; ++i) many += ",\"x" + std::to_string(i) + "\"";
  const json answer = ask(session, many + "]}");
  EXPECT_EQ(answer["errors"].size(), 5U);
  EXPECT_GT(answer["omitted"].get<int>(), 0);
  limits.parts = 30;
  live::Session crowded = session_of(live_scene, {}, limits);
  const json more =
      ask(crowded, R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"x","mass":1,)"
                   R"("shape":{"type":"sphere","radius":1}}}]})");
  // 9 bodies, as many shapes, a joint, 3 cables with 7 links, and these two.
  EXPECT_THAT(more["errors"][0]["message"].get<std::string>(),
              HasSubstr("31 parts: at most 30 are allowed"));
  limits.snapshot_bytes = 10;
  live::Session small = session_of(live_scene, {}, limits);
  EXPECT_EQ(ask(small, R"({"type":"snapshot","name":"a"})")["ok"], false);
}

TEST(LiveFaults, SnapshotsOfEditedWorldsCountTheirPartsInTheLimit) {
  live::Limits limits;
  // Two worlds of 29 and 31 parts of 1 KiB are more, one of them with a few states of some kB is
  // less.
  limits.snapshot_bytes = 60'000;
  live::Session session = session_of(live_scene, {}, limits);
  const auto add = [&](const std::string& name) {
    done(session, edit_of(R"({"type":"add_body","body":{"name":")" + name +
                          R"(","mass":1,"shape":{"type":"sphere","radius":1}}})"));
  };
  done(session, R"({"type":"snapshot","name":"a"})");
  add("x");
  done(session, R"({"type":"snapshot","name":"b"})");
  add("y");
  EXPECT_THAT(ask(session, R"({"type":"snapshot","name":"c"})")["errors"][0]["message"],
              HasSubstr("at most 60000"));
  done(session, R"({"type":"restore","name":"b"})");
  done(session, R"({"type":"snapshot","name":"c"})");
}

/// One of them, with some bytes changed, taken out, doubled, or taken from another one.
std::string mutated(const std::vector<std::string>& lines, Random& random) {
  const auto any = [&](std::size_t count) {
    return static_cast<std::size_t>(random.below(static_cast<int>(count)));
  };
  std::string line = lines[any(lines.size())];
  const int changes = 1 + random.below(3);
  for (int i = 0; i < changes && !line.empty(); ++i) {
    const std::size_t at = any(line.size());
    const std::size_t length = std::min(any(8) + 1, line.size() - at);
    const std::string& other = lines[any(lines.size())];
    constexpr std::string_view bytes = "{}[]\",:0123456789.eE+-\\ntrufalse \x80\xff\n";
    switch (random.below(12)) {
      case 0:
        line[at] = static_cast<char>(random.below(256) - 128);
        break;
      case 1:
        line[at] = bytes[any(bytes.size())];
        break;
      case 2:
        line.erase(at, length);
        break;
      case 3:
        line.insert(at, line.substr(at, length));
        break;
      case 4:
        if (!other.empty()) line.insert(at, other.substr(any(other.size()), length));
        break;
      case 5:
        line.insert(at, 1, bytes[any(bytes.size())]);
        break;
      default:
        // Another number.
        if (const std::size_t digit = line.find_first_of("0123456789", at);
            digit != std::string::npos) {
          line[digit] = static_cast<char>('0' + random.below(10));
        }
        break;
    }
  }
  return line;
}

TEST(LiveFaults, JunkNeitherCrashesNorChangesAnything) {
  std::vector<std::string> lines{
      R"({"id":1,"type":"hello","protocol":"sheave-live/1"})",
      R"({"id":2,"type":"describe","quantities":true})",
      R"({"id":3,"type":"step","count":2})",
      R"({"type":"step","until":0.5})",
      R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.7,"over":0.2},{"type":"gravity","value":[0,-9,0.5]}]})",
      R"({"type":"set","controls":[{"type":"motion","body":"hand","position":[3,0.5,0],"orientation":[1,0,0,0],"velocity":[0,0,0]}]})",
      R"({"type":"set","controls":[{"type":"friction","cable":"line","link":1,"value":0.3},{"type":"joint_drive","joint":"hinge","coordinate":"angle","value":0.1}]})",
      R"({"type":"clear","controls":[{"type":"gravity"},{"type":"force","body":"load"}]})",
      R"({"type":"place","body":"load","position":[0,-3,0],"orientation":[1,0,0,0],"keep":"tension"})",
      R"({"type":"observe","quantities":["t","rope.0.tension"],"poses":["load"]})",
      R"({"type":"subscribe","name":"s","every":2,"quantities":["load.y"],"events":true})",
      R"({"type":"unsubscribe","name":"s"})",
      R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"crate","mass":3,"position":[0,-4,0],"shape":{"type":"box","size":[0.3,0.3,0.3]}}},{"type":"add_joint","joint":{"type":"slider","name":"rail","body_b":"crate","anchor":[0,-4,0],"axis":[0,1,0]}}]})",
      R"({"type":"edit","changes":[{"type":"add_body","body":{"name":"box","density":30,"position":[8,1,0],"shapes":[{"type":"sphere","radius":0.2}]}},{"type":"add_cable","cable":{"name":"sling","compliance":1e-4,"links":[{"type":"attachment","body":"world","point":[8,3,0]},{"type":"attachment","body":"box"}]}},{"type":"add_collider","collider":{"body":"box","friction":0.3}}]})",
      R"({"type":"edit","changes":[{"type":"pay_out","cable":"string","span":0,"length":2},{"type":"insert_link","cable":"string","span":0,"link":{"type":"pinhole","body":"post","point":[0,0.2,0]}}]})",
      R"({"type":"edit","changes":[{"type":"change_body","body":"load","settings":{"mass":5,"damping":null}},{"type":"set_step","step":{"substeps":3,"solver":"gauss-seidel"}}]})",
      R"({"type":"edit","changes":[{"type":"remove_joint","joint":"rail"},{"type":"remove_body","body":"crate"}]})",
      R"({"type":"edit","changes":[{"type":"remove_cable","cable":"sling"},{"type":"remove_collider","body":"box"},{"type":"remove_body","body":"box"}]})",
      R"({"type":"restore","name":"start"})",
      R"({"type":"snapshot","name":"a"})",
      R"({"type":"restore","name":"a"})",
      R"({"type":"run","pace":1})",
      R"({"type":"pause"})",
      R"({"type":"hash","at_step":0})"};
  // Most of them are right before they are changed.
  const std::vector<std::string> right_lines = lines;
  for (int i = 0; i < 4; ++i) {
    lines.insert(lines.end(), right_lines.begin(), right_lines.end());
  }
  for (const Bad& bad : bad_requests()) lines.push_back(bad.line);
  live::Limits limits;
  limits.steps = 5;
  limits.line_bytes = 2000;
  live::Session session = session_of(
      live_scene, {.event = [](const std::string& line, bool) { EXPECT_TRUE(json::accept(line)); }},
      limits);
  Random random(16);
  int right = 0;
  int wrong = 0;
  int added = 0;
  constexpr int rounds = test::instrumented ? 5'000 : 20'000;
  for (int i = 0; i < rounds; ++i) {
    const std::string line = mutated(lines, random);
    const std::uint64_t before = hash_of(session);
    const std::string text = session.answer(line);
    ASSERT_EQ(text.find('\n'), std::string::npos);
    const json answer = json::parse(text, nullptr, false);
    ASSERT_FALSE(answer.is_discarded()) << line << '\n' << text;
    const bool ok = answer["ok"].get<bool>();
    ASSERT_EQ(ok, !answer.contains("errors")) << text;
    if (!ok) {
      ASSERT_EQ(hash_of(session), before) << line;
      ASSERT_FALSE(answer["errors"].empty()) << line;
    }
    ++(ok ? right : wrong);
    if (ok && line.find("\"add_") != std::string::npos) ++added;
    // What was set may have made the world end.
    if (ok && answer.contains("ended")) done(session, R"({"type":"restore","name":"start"})");
  }
  // Both kinds must have been tried: the least part that a change of mutations would
  // leave is a hundredth.
  EXPECT_GT(right, rounds / 100);
  EXPECT_GT(wrong, rounds / 4);
  EXPECT_GT(added, rounds / 1000);
}

}  // namespace
}  // namespace sheave::test
