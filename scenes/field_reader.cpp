#include "scenes/field_reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/suggestion.h"

namespace sheave {
namespace {

using json::Kind;
using json::no_node;
using json::NodeId;

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

}  // namespace

void FieldReader::fail(NodeId node, FaultCode code, std::string message, std::string allowed) {
  report(document_, faults_, node, code, std::move(message), std::move(allowed));
}

bool FieldReader::read_object(NodeId node, const ObjectFormat& format,
                              std::span<void* const> objects, const Variant* variant,
                              void* settings) {
  if (document_.kind(node) != Kind::object) {
    fail(node, FaultCode::wrong_type, fmt::format("must be an object ({})", format.meaning),
         "an object");
    return false;
  }
  check_keys(node, format, variant);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    read_table(node, format.tables[i].fields, objects[i], format.partial);
  }
  if (variant != nullptr) read_table(node, variant->table.fields, settings, format.partial);
  if (format.named) check_name(document_.member(node, "name"));
  return true;
}

void FieldReader::check_keys(NodeId node, const ObjectFormat& format, const Variant* variant) {
  std::vector<std::string_view> known;
  if (!format.variants.empty()) known.emplace_back("type");
  const auto add_fields = [&](std::span<const Field> fields) {
    for (const Field& field : fields) known.push_back(field.name);
  };
  for (const TableFormat& table : format.tables) add_fields(table.fields);
  for (const Member& member : format.members) known.push_back(member.name);
  if (variant != nullptr) {
    add_fields(variant->table.fields);
    for (const Member& member : variant->members) known.push_back(member.name);
  }
  for (const auto& [one, other] : format.exclusive) {
    const NodeId second = document_.member(node, other);
    if (document_.member(node, one) == no_node || second == no_node) continue;
    fail(second, FaultCode::exclusive_keys,
         fmt::format("{} and {} exclude each other; leave one out", one, other));
  }
  for (const NodeId child : document_.children(node)) {
    const std::string& key = document_.key(child);
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    Suggestion suggestion(key);
    for (const std::string_view candidate : known) suggestion.consider(candidate);
    faults_.add(
        {document_.key_offset(child),
         document_.pointer(child),
         fmt::format("unknown key in a {}{}", variant != nullptr ? variant->name : format.name,
                     suggestion.question()),
         {},
         fmt::format("{}", fmt::join(known, ", ")),
         FaultCode::unknown_key});
  }
}

void FieldReader::read_table(NodeId node, std::span<const Field> fields, void* object,
                             bool partial) {
  for (const Field& field : fields) {
    const NodeId value = document_.member(node, field.name);
    if (partial && (value == no_node || document_.kind(value) == Kind::null)) continue;
    if (value != no_node) {
      read_value(document_, faults_, bodies_, field, value, field.slot(object));
    } else if (field.presence == Presence::required) {
      report_missing(node, field.name, describe(field, field.slot(object)));
    }
  }
}

void FieldReader::report_missing(NodeId node, std::string_view key, std::string allowed) {
  faults_.add({document_.offset(node),
               fmt::format("{}/{}", document_.pointer(node), key),
               "required key is missing",
               {},
               std::move(allowed),
               FaultCode::missing_key});
}

void FieldReader::check_name(NodeId node) {
  if (node == no_node || document_.kind(node) != Kind::string) return;  // reported already
  const std::string& name = document_.string(node);
  if (!is_name(name)) {
    fail(node, FaultCode::bad_name, fmt::format("a name must consist of {}", name_rule));
  } else if (name == "world") {
    fail(node, FaultCode::bad_name, "the name \"world\" belongs to the immovable world");
  }
}

const Variant* FieldReader::read_type(NodeId node, const ObjectFormat& format) {
  if (document_.kind(node) != Kind::object) {
    fail(node, FaultCode::wrong_type, fmt::format("must be an object ({})", format.meaning),
         "an object");
    return nullptr;
  }
  std::string allowed;
  for (const Variant& variant : format.variants) {
    allowed += (allowed.empty() ? "" : ", ") + quoted(variant.name);
  }
  const NodeId type = document_.member(node, "type");
  if (type == no_node) {
    report_missing(node, "type", allowed);
    return nullptr;
  }
  if (document_.kind(type) != Kind::string) {
    fail(type, FaultCode::wrong_type, "must be one of " + allowed, allowed);
    return nullptr;
  }
  const Variant* variant = format.variant(document_.string(type));
  if (variant == nullptr) {
    Suggestion suggestion(document_.string(type));
    for (const Variant& candidate : format.variants) suggestion.consider(candidate.name);
    fail(type, FaultCode::unknown_choice,
         fmt::format("unknown type of {}{}", format.name, suggestion.question()), allowed);
  }
  return variant;
}

NodeId FieldReader::member(NodeId object, const Member& member) {
  const NodeId node = document_.member(object, member.name);
  if (node == no_node && member.required && document_.kind(object) == Kind::object) {
    report_missing(object, member.name, fmt::format("an object ({})", member.meaning));
  }
  return node;
}

std::span<const NodeId> FieldReader::list(NodeId object, const Member& member) {
  const NodeId node = document_.member(object, member.name);
  const std::string wanted = fmt::format("a list of objects ({})", member.meaning);
  if (node == no_node) {
    if (member.required && document_.kind(object) == Kind::object)
      report_missing(object, member.name, wanted);
    return {};
  }
  if (document_.kind(node) != Kind::array) {
    fail(node, FaultCode::wrong_type, "must be " + wanted, wanted);
    return {};
  }
  const auto elements = document_.children(node);
  if (elements.size() > max_list_length) {
    fail(node, FaultCode::too_large,
         fmt::format("must not have more than {} elements, has {}", max_list_length,
                     elements.size()));
    return {};
  }
  return elements;
}

std::unordered_map<std::string_view, int> FieldReader::unique_names(
    std::span<const NodeId> entities, std::string_view what) {
  std::unordered_map<std::string_view, int> first;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const NodeId name = document_.member(entities[i], "name");
    if (name == no_node || document_.kind(name) != Kind::string) continue;
    const auto [entry, is_new] = first.emplace(document_.string(name), static_cast<int>(i));
    if (is_new) continue;
    const NodeId other =
        document_.member(entities[static_cast<std::size_t>(entry->second)], "name");
    fail(name, FaultCode::duplicate_name,
         fmt::format("names of {} must differ; this one is first given in line {}", what,
                     document_.location(document_.offset(other)).line));
  }
  return first;
}

void FieldReader::declare_body(std::string_view name, int number) {
  bodies_.indices.insert_or_assign(name, number);
  bodies_.in_order.push_back(name);
}

void FieldReader::forget_body(std::string_view name) { bodies_.indices.erase(name); }

}  // namespace sheave
