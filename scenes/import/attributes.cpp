#include "scenes/import/attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sheave::import {

std::optional<std::vector<double>> parse_numbers(std::string_view text, std::size_t most) {
  constexpr std::string_view blanks = " \t\r\n";
  // Neither hexadecimal digits nor words such as "nan".
  constexpr std::string_view allowed = "0123456789+-.eE";
  constexpr std::size_t longest = 400;
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return numbers;
    text.remove_prefix(begin);
    const std::string word(text.substr(0, text.find_first_of(blanks)));
    text.remove_prefix(word.size());
    if (word.size() > longest || word.find_first_not_of(allowed) != std::string::npos) return {};
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() + word.size() || !std::isfinite(value)) return {};
    if (numbers.size() == most) return {};
    numbers.push_back(value);
  }
}

const std::string* Attributes::find(std::string_view name) {
  read_.emplace(name);
  if (const std::string* own = element_.value(name)) return own;
  if (defaults_ == nullptr) return nullptr;
  const auto found = defaults_->find(name);
  return found == defaults_->end() ? nullptr : &found->second;
}

void Attributes::error(std::string_view name, const std::string& rule, FaultCode code) {
  const std::string* const value = find(name);
  log_.error(element_, fmt::format("{} must be {}", name, rule), value == nullptr ? "" : *value,
             code);
}

std::optional<std::string> Attributes::text(std::string_view name) {
  const std::string* const value = find(name);
  return value == nullptr ? std::optional<std::string>() : *value;
}

std::vector<double> Attributes::numbers(std::string_view name, std::size_t least,
                                        std::size_t most) {
  const std::string* const value = find(name);
  if (value == nullptr) return {};
  std::optional<std::vector<double>> list = parse_numbers(*value, most);
  if (list && list->size() >= least) return std::move(*list);
  const std::string count =
      least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  error(name, fmt::format("{} finite number{} with blanks between", count, most == 1 ? "" : "s"),
        FaultCode::wrong_type);
  return {};
}

std::optional<double> Attributes::number(std::string_view name) {
  const std::vector<double> list = numbers(name, 1, 1);
  return list.empty() ? std::optional<double>() : list.front();
}

std::optional<double> Attributes::positive_or_zero(std::string_view name) {
  const std::optional<double> value = number(name);
  if (!value || *value >= 0.0) return value;
  error(name, ">= 0", FaultCode::out_of_range);
  return {};
}

std::optional<Vector3> Attributes::vector(std::string_view name) {
  const std::vector<double> list = numbers(name, 3, 3);
  if (list.empty()) return {};
  return Vector3(list[0], list[1], list[2]);
}

std::optional<std::string> Attributes::choice(std::string_view name,
                                              std::initializer_list<std::string_view> words) {
  const std::string* const value = find(name);
  if (value == nullptr) return {};
  if (std::find(words.begin(), words.end(), *value) != words.end()) return *value;
  error(name, fmt::format("one of {}", fmt::join(words, ", ")), FaultCode::unknown_choice);
  return {};
}

std::optional<bool> Attributes::flag(std::string_view name) {
  const auto word = choice(name, {"true", "false"});
  return word ? std::optional<bool>(*word == "true") : std::nullopt;
}

void Attributes::finish(std::initializer_list<std::string_view> silent) {
  std::string unread;
  const auto look_at = [&](const std::string& name) {
    if (name == "name" || name == "class" || read_.contains(name)) return;
    if (std::find(silent.begin(), silent.end(), name) != silent.end()) return;
    unread += (unread.empty() ? "" : ", ") + name;
  };
  for (const xml::Attribute& attribute : element_.attributes) look_at(attribute.name);
  if (defaults_ != nullptr) {
    for (const auto& [name, value] : *defaults_) {
      if (element_.value(name) == nullptr) look_at(name);
    }
  }
  if (!unread.empty()) log_.changed(element_, "not taken: " + unread);
}

}  // namespace sheave::import
