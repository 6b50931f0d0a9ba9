#pragma once
// Files of the command's own (journals, baselines) are read as strictly as scenes: by the same
// parser, and against rules for every value, so that whoever reads them finds what he expects.
// Faults have a line and a column.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/json/document.h"

namespace sheave::command {

/// Collects the faults of one document.
struct JsonCheck {
  const json::Document& document;
  json::Faults& faults;

  void fault(json::NodeId node, std::string message, std::string allowed) const;
};

/// Says of a value what is wrong with it.
using JsonRule = std::function<void(const JsonCheck&, json::NodeId)>;

/// A key of an object.
struct JsonKey {
  std::string_view name;
  JsonRule rule;
  bool required = true;
};

/// A number within [low, high]; with `any` also the words "inf", "-inf" and "nan", which JSON has
/// no numbers for.
[[nodiscard]] JsonRule json_number(double low, double high, bool any = false);
/// The same without a fraction.
[[nodiscard]] JsonRule json_integer(std::int64_t low, std::int64_t high);
[[nodiscard]] JsonRule json_text();
[[nodiscard]] JsonRule json_boolean();
/// Null, or what the rule says.
[[nodiscard]] JsonRule json_optional(JsonRule rule);
/// Any number of such elements.
[[nodiscard]] JsonRule json_list(JsonRule element);
/// One element for each rule.
[[nodiscard]] JsonRule json_tuple(std::vector<JsonRule> elements);
/// These keys and no others.
[[nodiscard]] JsonRule json_object(std::vector<JsonKey> keys);
/// Any keys, with such values.
[[nodiscard]] JsonRule json_map(JsonRule value);

/// Checks a text, which errors call `name`. Throws a Failure (65) that lists all faults. `format`
/// is what the key "format" must be; a text with another number at its end is of another version,
/// and the Failure names both.
void check_json(std::string_view text, const std::string& name, std::string_view format,
                const JsonRule& rule, const json::Limits& limits = {});

}  // namespace sheave::command
