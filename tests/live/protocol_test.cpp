// The schema and the page, against the tables and against what happens.

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "live/change.h"
#include "live/control.h"
#include "live/request.h"
#include "tests/live/live_scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;

TEST(LiveSchema, KnowsEveryRequestAndControl) {
  const json schema = json::parse(live::protocol_schema());
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  const auto expect_types = [](const json& variants, auto types) {
    ASSERT_EQ(variants.size(), types.size());
    for (std::size_t i = 0; i < types.size(); ++i) {
      EXPECT_EQ(variants[i]["properties"]["type"]["const"], types[i].name);
      EXPECT_EQ(variants[i]["additionalProperties"], false);
      for (const Field& field : types[i].fields()) {
        EXPECT_TRUE(variants[i]["properties"].contains(field.name))
            << types[i].name << ' ' << field.name;
      }
    }
  };
  expect_types(schema["oneOf"], live::request_types());
  expect_types(schema["definitions"]["control"]["oneOf"], live::set_types());
  expect_types(schema["definitions"]["cleared-control"]["oneOf"], live::clear_types());
  expect_types(schema["definitions"]["change"]["oneOf"], live::change_types());
  for (const json& request : schema["oneOf"]) {
    EXPECT_TRUE(request["properties"].contains("id"));
    const bool changes = request["properties"]["type"]["const"] == "set" ||
                         request["properties"]["type"]["const"] == "clear";
    EXPECT_EQ(request["properties"].contains("controls"), changes);
    EXPECT_EQ(request["required"].size() > 1 && request["required"][1] == "controls", changes);
  }
  EXPECT_FALSE(schema["definitions"]["control"]["oneOf"][4].dump().empty());
}

std::string page() {
  std::ifstream file(std::string(SHEAVE_SOURCE_DIR) + "/docs/reference/live.md");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Whether what happened is what the page says: numbers within their last printed digits, for
/// libraries of mathematics differ; a string "..." stands for anything.
bool is_as_told(const json& told, const json& happened) {
  if (told == "...") return true;
  if (told.is_number() && happened.is_number()) {
    const double a = told.get<double>();
    const double b = happened.get<double>();
    return std::abs(a - b) <= 1e-9 * std::max(1.0, std::abs(a));
  }
  if (told.type() != happened.type() || told.size() != happened.size()) return false;
  if (told.is_object()) {
    for (const auto& [key, value] : told.items()) {
      if (!happened.contains(key) || !is_as_told(value, happened[key])) return false;
    }
    return true;
  }
  if (!told.is_array()) return told == happened;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!is_as_told(told[i], happened[i])) return false;
  }
  return true;
}

TEST(LivePage, ItsExamplesGiveThePrintedAnswers) {
  const std::string scene = std::string(SHEAVE_SOURCE_DIR) + "/scenes/machines/brake-failure.json";
  std::vector<std::string> told;
  std::vector<std::string> lines;
  const auto start = [&] {
    const SceneResult loaded = load_scene(scene);
    Result<Simulation> simulation = create_simulation(*loaded);
    live::Hooks hooks;
    hooks.event = [&](const std::string& line, bool) { lines.push_back(line); };
    return live::Session(*loaded, std::move(*simulation), hooks);
  };
  live::Session session = start();
  std::istringstream text(page());
  std::set<std::string> tried;
  std::size_t compared = 0;
  const auto compare = [&](const std::string& request) {
    ASSERT_EQ(told.size(), lines.size()) << request << '\n' << testing::PrintToString(lines);
    for (std::size_t i = 0; i < told.size(); ++i, ++compared) {
      EXPECT_TRUE(is_as_told(json::parse(told[i]), json::parse(lines[i])))
          << "the page:    " << told[i] << "\nwhat happens: " << lines[i];
    }
  };
  std::string request;
  for (std::string line; std::getline(text, line);) {
    const bool asks = line.starts_with("> ");
    if (line.starts_with("< ")) told.push_back(line.substr(2));
    if ((asks || line.starts_with("```")) && !request.empty()) {
      compare(request);
      request.clear();
    }
    if (!asks) continue;
    request = line.substr(2);
    told.clear();
    lines.clear();
    if (session.has_quit()) session = start();
    lines.push_back(session.answer(request));
    const json parsed = json::parse(request, nullptr, false);
    if (parsed.is_object()) tried.insert(parsed.value("type", ""));
  }
  for (const auto& type : live::request_types()) {
    EXPECT_TRUE(tried.contains(std::string(type.name))) << "no example of " << type.name;
  }
  EXPECT_GT(compared, live::request_types().size());
}

TEST(LivePage, HasTheReferenceGeneratedFromTheTables) {
  EXPECT_NE(page().find(live::protocol_reference()), std::string::npos)
      << "put this at the end of docs/reference/live.md:\n"
      << live::protocol_reference();
}

}  // namespace
}  // namespace sheave::test
