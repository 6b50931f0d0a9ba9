#include "scenes/json/pointer.h"

#include <algorithm>
#include <charconv>

namespace sheave::json {

std::string unescape(std::string_view token) {
  std::string result;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const bool escaped = token[i] == '~' && i + 1 < token.size();
    if (escaped && token[i + 1] == '1') {
      result += '/';
      ++i;
    } else if (escaped && token[i + 1] == '0') {
      result += '~';
      ++i;
    } else {
      result += token[i];
    }
  }
  return result;
}

std::string escape(std::string_view key) {
  std::string result;
  for (const char c : key) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::optional<std::vector<std::string>> split(std::string_view pointer) {
  std::vector<std::string> steps;
  if (pointer.empty()) return steps;
  if (pointer.front() != '/') return std::nullopt;
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    steps.push_back(unescape(pointer.substr(0, end)));
    pointer.remove_prefix(end);
  }
  return steps;
}

std::optional<std::size_t> array_index(std::string_view token) {
  std::size_t index = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  const bool leading_zero = token.size() > 1 && token.front() == '0';
  if (error != std::errc() || stop != end || leading_zero) return std::nullopt;
  return index;
}

}  // namespace sheave::json
