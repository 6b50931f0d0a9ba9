#include "command/input/json_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "command/failure.h"
#include "engine/field_check.h"
#include "scenes/suggestion.h"

namespace sheave::command {
namespace {

using json::Kind;
using json::no_node;
using json::NodeId;

bool is_kind(const JsonCheck& check, NodeId node, Kind kind) {
  if (check.document.kind(node) == kind) return true;
  check.fault(node, "must be " + std::string(json::name_of(kind)), {});
  return false;
}

void check_number(const JsonCheck& check, NodeId node, double low, double high, bool whole) {
  if (!is_kind(check, node, Kind::number)) return;
  const double value = check.document.number(node);
  if (value >= low && value <= high && !(whole && value != std::round(value))) return;
  constexpr double largest = std::numeric_limits<double>::max();
  std::string range = whole ? "a whole number" : "a number";
  if (low > -largest) range += " from " + number_text(low);
  if (high < largest) range += " to " + number_text(high);
  check.fault(node, "must be " + range, {});
}

void check_unknown_keys(const JsonCheck& check, NodeId node, const std::vector<JsonKey>& keys) {
  for (const NodeId child : check.document.children(node)) {
    const std::string& name = check.document.key(child);
    const bool known =
        std::any_of(keys.begin(), keys.end(), [&](const JsonKey& key) { return key.name == name; });
    if (known) continue;
    Suggestion suggestion(name);
    for (const JsonKey& key : keys) suggestion.consider(key.name);
    check.fault(child, "unknown key" + suggestion.question(), {});
  }
}

/// Reports a text of another version, or a text that is not a file of this program at all.
void check_format(const JsonCheck& check, const std::string& name, std::string_view format) {
  const NodeId root = check.document.root();
  const NodeId node =
      check.document.kind(root) == Kind::object ? check.document.member(root, "format") : no_node;
  const bool text = node != no_node && check.document.kind(node) == Kind::string;
  const std::string found = text ? check.document.string(node) : std::string();
  if (found == format) return;
  const std::string_view family = format.substr(0, format.rfind('/') + 1);
  const std::string why =
      found.starts_with(family)
          ? fmt::format("the file has the version \"{}\"; this program reads and writes \"{}\"",
                        found, format)
          : fmt::format("the file must be an object with \"format\": \"{}\"", format);
  throw Failure(ExitCode::bad_scene, name + ": " + why);
}

[[noreturn]] void fail_with(const json::Document& document, const json::Faults& faults,
                            const std::string& name) {
  std::string text;
  for (const json::Fault& fault : faults.in_order()) {
    const json::Location place = document.location(fault.offset);
    if (!text.empty()) text += '\n';
    text += fmt::format("{}:{}:{}: ", name, place.line, place.column);
    if (!fault.pointer.empty()) text += fault.pointer + ": ";
    if (!fault.value.empty()) text += "value " + fault.value + ": ";
    text += fault.message;
  }
  if (faults.omitted() > 0) {
    text += fmt::format("\n{}: {} further faults are not listed", name, faults.omitted());
  }
  throw Failure(ExitCode::bad_scene, text);
}

}  // namespace

void JsonCheck::fault(NodeId node, std::string message, std::string allowed) const {
  faults.add({document.offset(node), document.pointer(node), std::move(message),
              document.excerpt(node), std::move(allowed)});
}

JsonRule json_number(double low, double high, bool any) {
  return [=](const JsonCheck& check, NodeId node) {
    if (any && check.document.kind(node) == Kind::string) {
      const std::string& word = check.document.string(node);
      if (word == "inf" || word == "-inf" || word == "nan" || word == "-nan") return;
      check.fault(node, "must be a number, \"inf\", \"-inf\" or \"nan\"", {});
      return;
    }
    check_number(check, node, low, high, false);
  };
}

JsonRule json_integer(std::int64_t low, std::int64_t high) {
  return [=](const JsonCheck& check, NodeId node) {
    check_number(check, node, static_cast<double>(low), static_cast<double>(high), true);
  };
}

JsonRule json_text() {
  return [](const JsonCheck& check, NodeId node) { is_kind(check, node, Kind::string); };
}

JsonRule json_word(std::span<const std::string_view> words) {
  return [words](const JsonCheck& check, NodeId node) {
    if (!is_kind(check, node, Kind::string)) return;
    if (std::find(words.begin(), words.end(), check.document.string(node)) != words.end()) return;
    std::string allowed;
    for (const std::string_view word : words) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(word);
    }
    check.fault(node, "must be one of: " + allowed, {});
  };
}

JsonRule json_boolean() {
  return [](const JsonCheck& check, NodeId node) { is_kind(check, node, Kind::boolean); };
}

JsonRule json_optional(JsonRule rule) {
  return [rule = std::move(rule)](const JsonCheck& check, NodeId node) {
    if (check.document.kind(node) != Kind::null) rule(check, node);
  };
}

JsonRule json_list(JsonRule element) {
  return [element = std::move(element)](const JsonCheck& check, NodeId node) {
    if (!is_kind(check, node, Kind::array)) return;
    for (const NodeId child : check.document.children(node)) element(check, child);
  };
}

JsonRule json_tuple(std::vector<JsonRule> elements) {
  return [elements = std::move(elements)](const JsonCheck& check, NodeId node) {
    if (!is_kind(check, node, Kind::array)) return;
    const auto children = check.document.children(node);
    if (children.size() != elements.size()) {
      check.fault(node,
                  fmt::format("must have {} elements; it has {}", elements.size(), children.size()),
                  {});
      return;
    }
    for (std::size_t i = 0; i < children.size(); ++i) elements[i](check, children[i]);
  };
}

JsonRule json_object(std::vector<JsonKey> keys) {
  return [keys = std::move(keys)](const JsonCheck& check, NodeId node) {
    if (!is_kind(check, node, Kind::object)) return;
    check_unknown_keys(check, node, keys);
    for (const JsonKey& key : keys) {
      const NodeId child = check.document.member(node, key.name);
      if (child != no_node) {
        key.rule(check, child);
      } else if (key.required) {
        check.fault(node, fmt::format("the key \"{}\" is missing", key.name), {});
      }
    }
  };
}

JsonRule json_map(JsonRule value) {
  return [value = std::move(value)](const JsonCheck& check, NodeId node) {
    if (!is_kind(check, node, Kind::object)) return;
    for (const NodeId child : check.document.children(node)) value(check, child);
  };
}

json::Document read_json(std::string_view text, const std::string& name,
                         const json::Limits& limits) {
  json::Faults faults(limits.faults);
  json::Document document = json::Document::parse(text, name, limits, faults);
  if (!faults.empty() || document.root() == no_node) fail_with(document, faults, name);
  return document;
}

void check_json(std::string_view text, const std::string& name, std::string_view format,
                const JsonRule& rule, const json::Limits& limits) {
  json::Faults faults(limits.faults);
  const json::Document document = json::Document::parse(text, name, limits, faults);
  if (document.root() == no_node) fail_with(document, faults, name);
  const JsonCheck check{document, faults};
  check_format(check, name, format);
  rule(check, document.root());
  if (!faults.empty()) fail_with(document, faults, name);
}

}  // namespace sheave::command
