#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/generators.h"
#include "scenes/scene.h"
#include "tests/scenes/random_scene.h"
#include "tests/scenes/scene_files.h"
#include "tests/support/schema_validator.h"

namespace sheave::test {
namespace {

using Json = nlohmann::json;

const Json& schema() {
  static const Json parsed = Json::parse(scene_schema());
  return parsed;
}

/// Calls visit(schema) for every subschema that describes an object.
void for_each_object(const Json& node, const std::function<void(const Json&)>& visit) {
  if (node.is_object() && node.value("type", Json()) == "object") visit(node);
  if (!node.is_structured()) return;
  for (const Json& child : node) for_each_object(child, visit);
}

TEST(Schema, IsDraft07AndClosedEverywhere) {
  EXPECT_EQ(schema()["$schema"], "http://json-schema.org/draft-07/schema#");
  int objects = 0;
  for_each_object(schema(), [&](const Json& object) {
    ++objects;
    EXPECT_EQ(object["additionalProperties"], false);
    for (const Json& property : object["properties"]) {
      EXPECT_TRUE(property.contains("description")) << property;
    }
  });
  EXPECT_GT(objects, 15);
}

TEST(Schema, KnowsEveryTypeAndItsFields) {
  const auto expect_types = [&](const char* definition, auto types) {
    const Json& variants = schema()["definitions"][definition]["oneOf"];
    ASSERT_EQ(variants.size(), types.size());
    for (std::size_t i = 0; i < types.size(); ++i) {
      const Json& properties = variants[i]["properties"];
      EXPECT_EQ(properties["type"]["const"], types[i].name);
      for (const Field& field : types[i].fields()) {
        EXPECT_TRUE(properties.contains(field.name)) << types[i].name << ' ' << field.name;
      }
    }
  };
  expect_types("shape", shape_types());
  expect_types("joint", joint_types());
  expect_types("link", link_types());
  EXPECT_EQ(schema()["definitions"]["body"]["properties"]["mass"]["exclusiveMinimum"], 0.0);
  EXPECT_EQ(schema()["definitions"]["step"]["properties"]["substeps"]["maximum"], 100000);
  EXPECT_THAT(std::string(schema()["definitions"]["body"]["properties"]["mass"]["description"]),
              testing::HasSubstr("[kg]"));
  EXPECT_EQ(schema()["required"], Json({"format", "gravity", "duration"}));
}

/// A scene text without comments for validators that know none; empty if it is no JSON.
std::string plain_json(const std::string& text) {
  const Json parsed = Json::parse(text, nullptr, false, true);
  return parsed.is_discarded() ? "" : parsed.dump();
}

TEST(Schema, AnIndependentValidatorAgreesWithTheLoader) {
  if (!SchemaValidator::available()) GTEST_SKIP() << "python3-jsonschema is not installed";
  SchemaValidator validator(scene_schema());
  for (const auto& file : valid_scene_files()) {
    validator.add(file, plain_json(read_file(file)), true);
  }
  for (unsigned seed = 0; seed < 20; ++seed) {
    validator.add("random " + std::to_string(seed), write_scene(random_scene(seed)), true);
  }
  int rejected = 0;
  for (const auto& file : scene_files("invalid")) {
    const std::string text = read_file(file);
    const std::string json = plain_json(text);
    if (json.empty()) continue;  // no JSON at all
    const bool structural = text.find("\n// schema: rejects\n") != std::string::npos;
    rejected += structural ? 1 : 0;
    validator.add(file, json, !structural);
  }
  EXPECT_GE(rejected, 30);
  EXPECT_EQ(validator.disagreements(), "");
}

}  // namespace
}  // namespace sheave::test
