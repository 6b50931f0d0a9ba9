#pragma once
// The command's own files (journals, baselines) are checked as strictly as scenes: the same parser
// reads them, and every value has a rule. A reader can therefore rely on the structure. Faults have
// a line and a column.

#include <cstdint>
#include <functional>
#include <span>
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

/// Reports the faults of a value.
using JsonRule = std::function<void(const JsonCheck&, json::NodeId)>;

/// A key of an object.
struct JsonKey {
  std::string_view name;
  JsonRule rule;
  bool required = true;
};

/// A number within [low, high]. With `any` also the words "inf", "-inf" and "nan", which JSON
/// cannot express as numbers.
[[nodiscard]] JsonRule json_number(double low, double high, bool any = false);
/// An integer within [low, high].
[[nodiscard]] JsonRule json_integer(std::int64_t low, std::int64_t high);
[[nodiscard]] JsonRule json_text();
/// One of these texts, which must outlive the rule.
[[nodiscard]] JsonRule json_word(std::span<const std::string_view> words);
[[nodiscard]] JsonRule json_boolean();
/// Null, or a value that satisfies the rule.
[[nodiscard]] JsonRule json_optional(JsonRule rule);
/// A list of any length whose elements satisfy the rule.
[[nodiscard]] JsonRule json_list(JsonRule element);
/// A list with exactly one element for each rule.
[[nodiscard]] JsonRule json_tuple(std::vector<JsonRule> elements);
/// An object with exactly these keys.
[[nodiscard]] JsonRule json_object(std::vector<JsonKey> keys);
/// An object with any keys whose values satisfy the rule.
[[nodiscard]] JsonRule json_map(JsonRule value);

/// Parses a text, which errors call `name`. Throws a Failure (65) that lists all faults.
[[nodiscard]] json::Document read_json(std::string_view text, const std::string& name,
                                       const json::Limits& limits = {});

/// Checks a text, which errors call `name`. Throws a Failure (65) that lists all faults. `format`
/// is the required value of the key "format". If the text's value differs only in the number at its
/// end, the text is of another version, and the Failure names both versions.
void check_json(std::string_view text, const std::string& name, std::string_view format,
                const JsonRule& rule, const json::Limits& limits = {});

}  // namespace sheave::command
