// JSON Schema and reference of the output, from the tables.

#include <algorithm>

#include <fmt/format.h>

#include "live/answer_format.h"
#include "live/protocol.h"
#include "live/request.h"
#include "live/request_format.h"
#include "scenes/json/pretty.h"
#include "scenes/reference.h"

namespace sheave::live {
namespace {

using ValueKind = AnswerValue::Kind;

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json tuple_of(int count) {
  Json schema = list_of({{"type", "number"}});
  schema["minItems"] = schema["maxItems"] = count;
  return schema;
}

Json reference_to(const AnswerFormat& format) {
  return {{"$ref", "#/definitions/" + anchor_of(format.name)}};
}

Json text_schema(std::span<const std::string_view> words) {
  if (words.empty()) return {{"type", "string"}};
  Json names = Json::array();
  for (const std::string_view word : words) names.push_back(word);
  return {{"enum", std::move(names)}};
}

Json by_name(Json value) {
  Json values = Json::array({std::move(value), {{"type", "null"}}});
  return {{"type", "object"}, {"additionalProperties", {{"anyOf", std::move(values)}}}};
}

Json value_schema(const AnswerValue& value) {
  switch (value.kind) {
    case ValueKind::number:
      return {{"type", "number"}};
    case ValueKind::number_or_null:
      return {{"type", Json::array({"number", "null"})}};
    case ValueKind::integer:
      return {{"type", "integer"}};
    case ValueKind::boolean:
      return {{"type", "boolean"}};
    case ValueKind::text:
      return text_schema(value.words);
    case ValueKind::vector:
      return tuple_of(3);
    case ValueKind::quaternion:
      return tuple_of(4);
    case ValueKind::texts:
      return list_of({{"type", "string"}});
    case ValueKind::object:
      return {{"allOf", Json::array({reference_to(*value.format)})}};
    case ValueKind::objects:
      return list_of(reference_to(*value.format));
    case ValueKind::numbers_by_name:
      return by_name({{"type", "number"}});
    case ValueKind::objects_by_name:
      return by_name(reference_to(*value.format));
  }
  return {};
}

/// An object with at least the required ones of these keys.
class ObjectSchema {
 public:
  explicit ObjectSchema(std::string_view meaning) : meaning_(meaning) {}
  void add(std::span<const AnswerKey> keys) {
    for (const AnswerKey& key : keys) {
      Json schema = value_schema(key.value);
      std::string description(key.meaning);
      if (!key.value.unit.empty()) description += fmt::format(" [{}]", key.value.unit);
      schema["description"] = description;
      put(key.name, std::move(schema), key.presence);
    }
  }
  void put(std::string_view name, Json schema, Presence presence) {
    properties_[std::string(name)] = std::move(schema);
    if (presence == required) required_.push_back(name);
  }
  Json schema() {
    return {{"type", "object"},
            {"description", meaning_},
            {"properties", std::move(properties_)},
            {"required", std::move(required_)}};
  }

 private:
  std::string meaning_;
  Json properties_ = Json::object();
  Json required_ = Json::array();
};

/// Collects the formats of objects in these keys, recursively, that are not in the list yet.
void collect(std::span<const AnswerKey> keys, std::vector<const AnswerFormat*>& formats) {
  for (const AnswerKey& key : keys) {
    const AnswerFormat* format = key.value.format;
    if (format == nullptr || std::find(formats.begin(), formats.end(), format) != formats.end()) {
      continue;
    }
    formats.push_back(format);
    collect(format->keys, formats);
  }
}

std::vector<const AnswerFormat*> inner_formats() {
  std::vector<const AnswerFormat*> formats;
  for (const TypeEntry<Request>& type : request_types()) {
    collect(type.make()->answer_keys(), formats);
  }
  collect(refusal_format().keys, formats);
  for (const AnswerFormat& event : event_formats()) collect(event.keys, formats);
  return formats;
}

Json answer_object(std::string_view meaning, std::span<const AnswerKey> keys, bool ok) {
  ObjectSchema schema(meaning);
  schema.add(answer_head_format().keys);
  schema.put("ok", {{"const", ok}}, optional);  // already required
  schema.add(keys);
  return schema.schema();
}

Json event_object(const AnswerFormat& event) {
  ObjectSchema schema(event.meaning);
  schema.put("event", {{"const", event.name}}, required);
  schema.add(event.keys);
  return schema.schema();
}

std::string value_text(const AnswerValue& value) {
  const auto with_unit = [&](std::string text) {
    return value.unit.empty() ? text : text + fmt::format(" [{}]", value.unit);
  };
  const auto linked = [&] {
    return fmt::format("[{}](#{})", value.format->name, anchor_of(value.format->name));
  };
  switch (value.kind) {
    case ValueKind::number:
      return with_unit("a number");
    case ValueKind::number_or_null:
      return value.unit.empty() ? "a number or null" : with_unit("a number") + " or null";
    case ValueKind::integer:
      return "an integer";
    case ValueKind::boolean:
      return "true or false";
    case ValueKind::text: {
      std::string text;
      for (const std::string_view word : value.words) {
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
      }
      return text.empty() ? "a string" : text;
    }
    case ValueKind::vector:
      return with_unit("[x, y, z], numbers");
    case ValueKind::quaternion:
      return "a unit quaternion [w, x, y, z]";
    case ValueKind::texts:
      return "a list of strings";
    case ValueKind::object:
      return "a " + linked();
    case ValueKind::objects:
      return "a list of " + linked();
    case ValueKind::numbers_by_name:
      return "an object: by names, numbers or null";
    case ValueKind::objects_by_name:
      return "an object: by names, a " + linked() + " or null";
  }
  return {};
}

void append_keys(std::span<const AnswerKey> keys, std::string& text) {
  text += "\n| key | value | there | meaning |\n|---|---|---|---|\n";
  for (const AnswerKey& key : keys) {
    text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, value_text(key.value),
                        key.presence == required ? "always" : "", key.meaning);
  }
}

void append_format(const AnswerFormat& format, std::string& text) {
  text += fmt::format("\n## {}\n\n{}.\n", format.name, format.meaning);
  append_keys(format.keys, text);
}

}  // namespace

std::string answer_definition(std::string_view request) {
  return "answer-to-" + std::string(request);
}

std::string event_definition(std::string_view event) { return std::string(event) + "-event"; }

std::string answer_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "Answers and events of the protocol " + std::string(protocol_names[0])}};
  Json any = Json::array();
  Json definitions = Json::object();
  const auto define = [&](const std::string& name, Json definition) {
    any.push_back({{"$ref", "#/definitions/" + name}});
    definitions[name] = std::move(definition);
  };
  for (const TypeEntry<Request>& type : request_types()) {
    const std::string name = answer_definition(type.name);
    define(name,
           answer_object(fmt::format("answer to {}", type.name), type.make()->answer_keys(), true));
  }
  define(std::string(refusal_format().name),
         answer_object("a request that was refused", refusal_format().keys, false));
  for (const AnswerFormat& event : event_formats()) {
    define(event_definition(event.name), event_object(event));
  }
  schema["anyOf"] = std::move(any);
  for (const AnswerFormat* format : inner_formats()) {
    ObjectSchema object(format->meaning);
    object.add(format->keys);
    definitions[anchor_of(format->name)] = object.schema();
  }
  schema["definitions"] = std::move(definitions);
  return json::pretty(schema);
}

std::string answer_reference() {
  std::string text;
  append_format(answer_head_format(), text);
  for (const TypeEntry<Request>& type : request_types()) {
    const std::vector<AnswerKey> keys = type.make()->answer_keys();
    if (keys.empty()) continue;
    text += fmt::format("\n### answer to `{}`\n", type.name);
    append_keys(keys, text);
  }
  append_format(refusal_format(), text);
  for (const AnswerFormat* format : inner_formats()) append_format(*format, text);
  text += "\n## event\n\na line that is no answer; `event` is its name.\n";
  for (const AnswerFormat& event : event_formats()) {
    text += fmt::format("\n### event `\"{}\"`\n\n{}.\n", event.name, event.meaning);
    append_keys(event.keys, text);
  }
  return text;
}

}  // namespace sheave::live
