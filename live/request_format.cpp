#include "live/request_format.h"

#include <algorithm>

#include "live/protocol.h"
#include "live/request.h"
#include "scenes/format_tables.h"
#include "scenes/json/pretty.h"
#include "scenes/reference.h"
#include "scenes/schema.h"

namespace sheave::live {
namespace {

std::vector<ObjectFormat> make_formats() {
  std::vector<ObjectFormat> formats;
  for (const TypeEntry<Request>& type : request_types()) {
    const std::shared_ptr<const Request> made = type.make();
    ObjectFormat format = any_request_format();
    std::erase_if(format.variants, [&](const Variant& v) { return v.name != type.name; });
    format.members.assign(made->members().begin(), made->members().end());
    format.exclusive.assign(made->exclusive().begin(), made->exclusive().end());
    formats.push_back(std::move(format));
  }
  return formats;
}

constexpr std::string_view scene_page = "../../scenes/REFERENCE.md";  // from docs/reference/

/// Collects a format and its members' formats that are not on the page of scenes.
void collect(const ObjectFormat& format, std::vector<const ObjectFormat*>& formats) {
  if (is_in_scenes(format) || std::find(formats.begin(), formats.end(), &format) != formats.end()) {
    return;
  }
  formats.push_back(&format);
  for (const Member& member : format.members) collect(*member.format, formats);
  for (const Variant& variant : format.variants) {
    for (const Member& member : variant.members) collect(*member.format, formats);
  }
}

}  // namespace

const ObjectFormat& any_request_format() {
  static const ObjectFormat format{
      "request",
      "a request: its `type`, one of those below, with the keys of that type and these",
      false,
      {common_table(request_types())},
      variants_of(request_types()),
      {},
      {}};
  return format;
}

std::span<const ObjectFormat> request_formats() {
  static const std::vector<ObjectFormat> formats = make_formats();
  return formats;
}

std::string protocol_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "Request of the protocol " + std::string(protocol_names[0])}};
  Json types = Json::array();
  Json definitions = Json::object();
  for (const ObjectFormat& format : request_formats()) {
    const Json schemas = format_schema(format);
    for (const Json& type : schemas["oneOf"]) types.push_back(type);
    add_definitions(format, definitions);
  }
  schema["oneOf"] = std::move(types);
  schema["definitions"] = std::move(definitions);
  return json::pretty(schema);
}

std::string protocol_reference() {
  std::string text;
  ObjectFormat all = any_request_format();
  all.variants.clear();
  append_reference(all, text);
  std::vector<const ObjectFormat*> inner;
  for (const ObjectFormat& format : request_formats()) {
    const Variant& type = format.variants.front();
    append_reference({type.name, type.meaning, false, {type.table}, {}, format.members, {}}, text);
    for (const Member& member : format.members) collect(*member.format, inner);
  }
  for (const ObjectFormat* format : inner) append_reference(*format, text, scene_page);
  return text + answer_reference();
}

}  // namespace sheave::live
