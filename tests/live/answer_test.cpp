// What comes out, against the tables that its schema and its reference are made from.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "live/protocol.h"
#include "live/request.h"
#include "tests/live/live_scenes.h"
#include "tests/support/schema_validator.h"

namespace sheave::test {
namespace {

using nlohmann::json;

/// The schema, but with no keys beyond those that it tells. Programs must take further keys; ours
/// must not have any untold.
json strict_schema() {
  json schema = json::parse(live::answer_schema());
  for (json& definition : schema["definitions"]) definition["additionalProperties"] = false;
  return schema;
}

/// Lines that came out, with the definitions that they should follow.
struct Line {
  std::string definition;
  json content;
};

/// Collects what sessions say.
class Lines {
 public:
  explicit Lines(const std::string& scene, const live::Limits& limits = {})
      : session_(session_of(scene,
                            {.event =
                                 [this](const std::string& line, bool) {
                                   const json event = json::parse(line);
                                   lines.push_back(
                                       {live::event_definition(event["event"].get<std::string>()),
                                        event});
                                 }},
                            limits)) {}
  void ask(const std::string& request) {
    const json answer = json::parse(session_.answer(request));
    const bool ok = answer["ok"].get<bool>();
    const json parsed = json::parse(request, nullptr, false);
    lines.push_back(
        {ok ? live::answer_definition(parsed["type"].get<std::string>()) : "refusal", answer});
  }
  void run() {
    while (session_.is_running()) session_.advance();
  }
  std::vector<Line> lines;

 private:
  live::Session session_;
};

/// 70 strings that are cut at once: more than a step tells.
std::string many_strings() {
  std::string links;
  for (int i = 0; i < 70; ++i) {
    links += fmt::format(
        R"({}{{"name":"c{}","cut_time":0.005,"links":[{{"type":"attachment","body":"world"}},)"
        R"({{"type":"attachment","body":"stone"}}]}})",
        i == 0 ? "" : ",", i);
  }
  return R"({"format":"sheave-scene/1","gravity":[0,-10,0],"duration":1,"step":{"dt":0.01},
             "bodies":[{"name":"stone","mass":1,"position":[0,-1,0],"shape":{"type":"sphere","radius":0.1}}],
             "cables":[)" +
         links + "]}";
}

/// A winch that pays out a rigid rope and draws it in, or the other way round: once it draws what
/// nothing can give.
std::string stalled_winch() {
  return R"({"format":"sheave-scene/1","gravity":[0,0,0],"duration":1,"step":{"dt":0.01},
             "bodies":[{"name":"winch","mobility":"rotor","axis":[0,0,1],"mass":1,
                        "shape":{"type":"cylinder","radius":0.1,"length":0.1},
                        "drive":"speed","drive_times":[0,0.02,0.03],"drive_values":[1,1,-1]}],
             "cables":[{"name":"rope","links":[
               {"type":"spool","body":"winch","winding":"clockwise","stored_length":1},
               {"type":"attachment","body":"world","point":[0,-2,0]}]}]})";
}

/// A light cart that stops the bob below it, which has 0.35 s to fall
/// (tests/cable/run_check_test.cpp): all energy of the swing goes nowhere.
std::string light_cart() {
  return R"({"format":"sheave-scene/1","gravity":[0,-9.81,0],"duration":1,
             "step":{"substeps":8,"iterations":20,"solver":"gauss-seidel","integrator":"xpbd"},
             "bodies":[{"name":"cart","mobility":"slider","axis":[1,0,0],"mass":0.0001},
                       {"name":"bob","mass":1,"inertia":[0.1,0.1,0.1],"position":[0.841,-0.54,0]}],
             "cables":[{"name":"rope","links":[{"type":"attachment","body":"cart"},
                                               {"type":"attachment","body":"bob"}]}]})";
}

std::vector<Line> all_lines() {
  live::Limits limits;
  limits.faults = 2;
  Lines workshop(live_scene, limits);
  for (
      const char* request : {
          R"({"id":1,"type":"hello"})",
          R"({"type":"describe","quantities":true})",
          R"({"type":"subscribe","name":"s","every":2,"quantities":["load.y","hinge.fx"],"poses":["load","weight"],"events":true})",
          R"({"type":"observe","quantities":["rope.0.tension"],"poses":["hand"]})",
          R"({"type":"snapshot","name":"a"})",
          R"({"type":"step","count":4})",
          R"({"type":"edit","changes":[{"type":"split","cable":"string","span":0,"name":"rest"}]})",
          R"({"type":"describe"})",
          R"({"type":"edit","changes":[{"type":"remove_cable","cable":"string"},{"type":"remove_cable","cable":"rest"},{"type":"remove_body","body":"weight"}]})",
          R"({"type":"set","controls":[{"type":"breaking_tension","cable":"rope","value":1},{"type":"force","body":"bar","force":[500,0,0]}]})",
          R"({"type":"step","count":3})",
          R"({"type":"restore","name":"a"})",
          R"({"type":"forget","name":"a"})",
          R"({"type":"place","body":"load","position":[0,-3.5,0],"keep":"tension"})",
          R"({"type":"release","joint":"hinge"})",
          R"({"type":"lock","joint":"hinge"})",
          R"({"type":"cut","cable":"rope"})",
          R"({"type":"clear","controls":[{"type":"gravity"}]})",
          R"({"type":"hash"})",
          R"({"type":"unsubscribe","name":"s"})",
          R"({"type":"set","controls":[{"type":"angle","body":"dial","value":10,"over":0.1}]})",
          R"({"type":"snapshot","name":"b"})",
          R"({"type":"step","count":100})",
          R"({"type":"restore","name":"b"})",
          R"({"type":"run"})",
      }) {
    workshop.ask(request);
  }
  workshop.run();
  for (const char* request :
       {R"({"type":"pause"})", "nonsense", R"({"type":"step","count":-1})",
        R"({"type":"observe","quantities":["a","b","c"]})",
        R"({"type":"set","controls":[{"type":"nothing"}]})", R"({"type":"quit"})"}) {
    workshop.ask(request);
  }
  Lines cut(many_strings());
  cut.ask(R"({"type":"subscribe","name":"s","events":true})");
  cut.ask(R"({"type":"step"})");
  Lines winch(stalled_winch());
  winch.ask(R"({"type":"subscribe","name":"s","events":true})");
  winch.ask(R"({"type":"step","count":20})");
  Lines cart(light_cart());
  cart.ask(R"({"type":"step","count":36})");
  std::vector<Line> lines = workshop.lines;
  lines.insert(lines.end(), cart.lines.begin(), cart.lines.end());
  lines.insert(lines.end(), winch.lines.begin(), winch.lines.end());
  lines.insert(lines.end(), cut.lines.begin(), cut.lines.end());
  lines.push_back({live::event_definition("dropped"), json::parse(live::dropped_event(3))});
  return lines;
}

/// Notes every key of every definition that occurs.
void note_keys(const json& schema, const json& part, const json& content,
               std::set<std::string>& seen) {
  if (part.contains("allOf")) return note_keys(schema, part["allOf"][0], content, seen);
  if (part.contains("$ref")) {
    const std::string name = part["$ref"].get<std::string>().substr(14);  // "#/definitions/"
    for (const auto& [key, value] : content.items()) {
      seen.insert(name + "/" + key);
      const json& properties = schema["definitions"][name]["properties"];
      EXPECT_TRUE(properties.contains(key)) << name << " has " << key << ", which no table tells";
      if (properties.contains(key)) note_keys(schema, properties[key], value, seen);
    }
  } else if (part.contains("items")) {
    for (const json& element : content) note_keys(schema, part["items"], element, seen);
  } else if (part.contains("additionalProperties")) {
    for (const json& element : content) {
      if (element.is_null()) continue;
      note_keys(schema, part["additionalProperties"]["anyOf"][0], element, seen);
    }
  }
}

TEST(LiveAnswers, AnIndependentValidatorAcceptsAll) {
  if (!SchemaValidator::available()) GTEST_SKIP() << "python3-jsonschema is not installed";
  const json schema = strict_schema();
  SchemaValidator validator(schema.dump());
  for (const Line& line : all_lines()) {
    const std::string text = line.content.dump();
    validator.add(text, text, true, line.definition);
    validator.add(text, text, true);
    // And it is not one that takes everything.
    const json& definition = schema["definitions"][line.definition];
    for (const json& key : definition["required"]) {
      json without = line.content;
      without.erase(key.get<std::string>());
      validator.add("without " + key.dump() + ": " + text, without.dump(), false, line.definition);
    }
    json more = line.content;
    more["further"] = 1;
    validator.add("more: " + text, more.dump(), false, line.definition);
  }
  EXPECT_EQ(validator.disagreements(), "");
}

TEST(LiveAnswers, EveryFieldOfTheTablesOccurs) {
  const json schema = json::parse(live::answer_schema());
  std::set<std::string> seen;
  for (const Line& line : all_lines()) {
    note_keys(schema, {{"$ref", "#/definitions/" + line.definition}}, line.content, seen);
  }
  for (const auto& [name, definition] : schema["definitions"].items()) {
    for (const auto& [key, value] : definition["properties"].items()) {
      const bool any_id = key == "id";  // of all answers alike
      EXPECT_TRUE(any_id || seen.contains(name + "/" + key)) << name << " never has " << key;
      EXPECT_TRUE(value.contains("description") || key == "ok" || key == "event") << name << key;
    }
  }
  EXPECT_EQ(schema["anyOf"].size(), live::request_types().size() + 1 + 7);
}

}  // namespace
}  // namespace sheave::test
