#pragma once
// Reads the attributes of one element, with those of its default class behind them.

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/vector.h"
#include "scenes/import/log.h"
#include "scenes/import/xml.h"

namespace sheave::import {

/// Attributes of a default class for one kind of element.
using DefaultValues = std::map<std::string, std::string, std::less<>>;

/// The value of an attribute is that of the element, else that of its default class. Every reading
/// member reports a value that is not allowed, and then returns nullopt.
class Attributes {
 public:
  /// `defaults` may be null.
  Attributes(const xml::Element& element, const DefaultValues* defaults, Log& log)
      : element_(element), defaults_(defaults), log_(log) {}

  [[nodiscard]] bool has(std::string_view name) { return find(name) != nullptr; }
  /// Any text.
  [[nodiscard]] std::optional<std::string> text(std::string_view name);
  /// A finite number.
  [[nodiscard]] std::optional<double> number(std::string_view name);
  /// A number that is at least 0.
  [[nodiscard]] std::optional<double> positive_or_zero(std::string_view name);
  /// `least` to `most` finite numbers; empty if the attribute is not given or not allowed.
  [[nodiscard]] std::vector<double> numbers(std::string_view name, std::size_t least,
                                            std::size_t most);
  [[nodiscard]] std::optional<Vector3> vector(std::string_view name);
  /// One of the words.
  [[nodiscard]] std::optional<std::string> choice(std::string_view name,
                                                  std::initializer_list<std::string_view> words);
  [[nodiscard]] std::optional<bool> flag(std::string_view name);

  /// Ends reading: tells which attributes were not read. `silent` are those that concern looks or
  /// bookkeeping alone.
  void finish(std::initializer_list<std::string_view> silent);

  void error(std::string_view name, const std::string& rule, FaultCode code);

 private:
  [[nodiscard]] const std::string* find(std::string_view name);

  const xml::Element& element_;
  const DefaultValues* defaults_;
  Log& log_;
  std::set<std::string, std::less<>> read_;
};

/// The numbers of a text, separated by blanks; nullopt if one of them is no finite number or there
/// are more than `most`.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text,
                                                               std::size_t most);

}  // namespace sheave::import
