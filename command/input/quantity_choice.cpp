#include "command/input/quantity_choice.h"

#include <fnmatch.h>

#include <fmt/format.h>

namespace sheave::command {
namespace {

std::string_view without_spaces(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::vector<std::string> split_quantities(std::string_view list) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  int open = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= list.size(); ++i) {
    const char c = i < list.size() ? list[i] : ',';
    if (c == '\'') quoted = !quoted;
    if (!quoted && (c == '(' || c == '[')) ++open;
    if (!quoted && (c == ')' || c == ']') && open > 0) --open;
    const bool separates = c == ',' && !quoted && open == 0;
    if (!separates && i < list.size()) continue;
    parts.emplace_back(without_spaces(list.substr(begin, i - begin)));
    begin = i + 1;
  }
  return parts;
}

std::vector<std::string> split_quantities(const std::vector<std::string>& lists) {
  std::vector<std::string> all;
  for (const std::string& list : lists) {
    for (std::string& part : split_quantities(list)) all.push_back(std::move(part));
  }
  return all;
}

Result<ChosenQuantities> chosen_quantities(const std::string& text,
                                           const std::vector<std::string>& names,
                                           const QuantityNames& index) {
  if (const std::optional<int> only = index.find(text)) return ChosenQuantities{{*only}, {}};
  const bool is_pattern = text.find_first_of("*?[\\") != std::string::npos;
  ChosenQuantities chosen;
  for (std::size_t i = 0; is_pattern && i < names.size(); ++i) {
    if (::fnmatch(text.c_str(), names[i].c_str(), 0) != 0) continue;
    chosen.indices.push_back(static_cast<int>(i));
  }
  if (!chosen.indices.empty()) return chosen;
  Result<Expression> expression = Expression::compile(text, index);
  if (expression) return ChosenQuantities{{}, std::move(*expression)};
  if (!is_pattern) return expression.errors();
  return Error{"", fmt::format("no quantity matches \"{}\"; nor is it an expression: {}", text,
                               expression.errors().front().message)};
}

}  // namespace sheave::command
