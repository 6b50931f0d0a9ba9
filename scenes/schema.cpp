// JSON Schema (draft-07) of the format, from the tables.

#include "scenes/schema.h"

#include <cmath>

#include <fmt/format.h>

#include "scenes/field_json.h"
#include "scenes/format.h"
#include "scenes/json/pretty.h"
#include "scenes/reference.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using Json = nlohmann::ordered_json;

Json number_schema(const Range& range, const char* type) {
  Json schema{{"type", type}};
  if (std::isfinite(range.minimum)) {
    schema[range.minimum_allowed ? "minimum" : "exclusiveMinimum"] = range.minimum;
  }
  if (std::isfinite(range.maximum)) {
    schema[range.maximum_allowed ? "maximum" : "exclusiveMaximum"] = range.maximum;
  }
  return schema;
}

Json tuple_schema(Json items, int count) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", count}, {"maxItems", count}};
}

Json list_schema(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}, {"maxItems", max_list_length}};
}

/// One overload per type of slot.
struct SlotSchema {
  const Field& field;

  [[nodiscard]] Json number() const { return number_schema(field.range, "number"); }
  [[nodiscard]] Json vector() const { return tuple_schema(number(), 3); }
  Json operator()(const double*) const { return number(); }
  Json operator()(const std::optional<double>*) const { return number(); }
  Json operator()(const int*) const { return number_schema(field.range, "integer"); }
  Json operator()(const bool*) const { return {{"type", "boolean"}}; }
  Json operator()(const std::string*) const { return {{"type", "string"}}; }
  Json operator()(const Vector3*) const { return vector(); }
  Json operator()(const std::optional<Vector3>*) const { return vector(); }
  Json operator()(const Quaternion*) const {
    return tuple_schema({{"type", "number"}, {"minimum", -1.000001}, {"maximum", 1.000001}}, 4);
  }
  Json operator()(const BodyId*) const { return {{"type", "string"}}; }
  Json operator()(const std::optional<BodyId>*) const { return {{"type", "string"}}; }
  Json operator()(const std::vector<double>*) const { return list_schema(number()); }
  Json operator()(const std::vector<Vector3>*) const { return list_schema(vector()); }
  Json operator()(const std::vector<std::string>*) const {
    return list_schema({{"type", "string"}});
  }
  Json operator()(const ChoiceSlot&) const {
    Json names = Json::array();
    for (const std::string_view choice : field.choices) {
      names.push_back(choice);
      for (const auto& [longer, shorter] : longer_choices) {
        if (shorter == choice) names.push_back(longer);
      }
    }
    return {{"enum", std::move(names)}};
  }
};

Json field_schema(const Field& field, const TableFormat& table, bool is_entity_name, bool partial) {
  const FieldSlot slot = slot_of(field, table.defaults.get());
  Json schema = std::visit([&](const auto& s) { return SlotSchema{field}(s); }, slot);
  if (partial) {
    schema = {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}};
  }
  std::string description(field.meaning);
  if (!field.unit.empty()) description += fmt::format(" [{}]", field.unit);
  schema["description"] = description;
  if (is_entity_name) {
    schema["pattern"] = name_pattern;
    schema["not"] = {{"const", "world"}};
  }
  if (field.presence == Presence::optional && !is_absent(slot)) {
    schema["default"] = field_json(field, slot, [](BodyId) { return std::string("world"); });
  }
  return schema;
}

/// References must not contain spaces.
std::string definition_name(const ObjectFormat& format) { return anchor_of(format.name); }

/// The schema of an object of `format`, of the given type if it has several.
Json object_schema(const ObjectFormat& format, const Variant* variant) {
  Json properties = Json::object();
  Json required = Json::array();
  if (variant != nullptr) {
    properties["type"] = {{"const", variant->name}, {"description", variant->meaning}};
    required.push_back("type");
  }
  const auto add_table = [&](const TableFormat& table) {
    for (const Field& field : table.fields) {
      const bool is_entity_name = format.named && field.name == "name";
      properties[std::string(field.name)] =
          field_schema(field, table, is_entity_name, format.partial);
      if (field.presence == Presence::required) required.push_back(field.name);
    }
  };
  const auto add_member = [&](const Member& member) {
    Json reference{{"$ref", fmt::format("#/definitions/{}", definition_name(*member.format))}};
    // Draft-07 ignores keys next to a $ref, so the description needs a level of its own.
    properties[std::string(member.name)] =
        member.list ? list_schema(std::move(reference))
                    : Json{{"allOf", Json::array({std::move(reference)})}};
    properties[std::string(member.name)]["description"] = member.meaning;
    if (member.required) required.push_back(member.name);
  };
  for (const TableFormat& table : format.tables) add_table(table);
  if (variant != nullptr) add_table(variant->table);
  for (const Member& member : format.members) add_member(member);
  if (variant != nullptr) {
    for (const Member& member : variant->members) add_member(member);
  }
  Json schema{{"type", "object"},
              {"description", variant != nullptr ? variant->meaning : format.meaning},
              {"properties", std::move(properties)},
              {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  if (!format.exclusive.empty()) {
    Json both = Json::array();
    for (const auto& [one, other] : format.exclusive) both.push_back({{"required", {one, other}}});
    schema["not"] = both.size() == 1 ? both.front() : Json{{"anyOf", both}};
  }
  return schema;
}

}  // namespace

Json format_schema(const ObjectFormat& format) {
  if (format.variants.empty()) return object_schema(format, nullptr);
  Json types = Json::array();
  for (const Variant& variant : format.variants) types.push_back(object_schema(format, &variant));
  return {{"description", format.meaning}, {"oneOf", std::move(types)}};
}

void add_definitions(const ObjectFormat& format, Json& definitions) {
  const auto add = [&](const Member& member) {
    const std::string name = definition_name(*member.format);
    if (definitions.contains(name)) return;
    definitions[name] = format_schema(*member.format);
    add_definitions(*member.format, definitions);
  };
  for (const Member& member : format.members) add(member);
  for (const Variant& variant : format.variants) {
    for (const Member& member : variant.members) add(member);
  }
}

std::string scene_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Sheave scene"}};
  schema.update(format_schema(scene_format()));
  Json definitions = Json::object();
  add_definitions(scene_format(), definitions);
  schema["definitions"] = std::move(definitions);
  return json::pretty(schema);
}

}  // namespace sheave
