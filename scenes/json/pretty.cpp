#include "scenes/json/pretty.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/field_check.h"

namespace sheave::json {
namespace {

using Value = nlohmann::ordered_json;

constexpr std::size_t width = 100;

std::string text_of(const std::string& string) {
  return Value(string).dump(-1, ' ', false, Value::error_handler_t::replace);
}

std::string scalar(const Value& value) {
  if (value.is_string()) return text_of(value.get_ref<const std::string&>());
  if (!value.is_number_float()) return value.dump();
  const double number = value.get<double>();
  if (!std::isfinite(number)) return "null";
  // In JSON, -0 is an integer, which has no negative zero.
  return number == 0.0 && std::signbit(number) ? "-0.0" : number_text(number);
}

/// Appends the value on one line. False if the line would need more than `room` characters or
/// contain several objects of a list.
bool append_line(const Value& value, std::size_t room, std::string& line) {
  if (!value.is_structured()) {
    line += scalar(value);
    return line.size() <= room;
  }
  const bool object = value.is_object();
  line += object ? '{' : '[';
  bool first = true;
  for (const auto& item : value.items()) {
    if (!object && value.size() > 1 && item.value().is_object()) return false;
    if (!first) line += ", ";
    first = false;
    if (object) line += text_of(item.key()) + ": ";
    if (!append_line(item.value(), room, line)) return false;
  }
  line += object ? '}' : ']';
  return line.size() <= room;
}

void append(const Value& value, std::size_t indent, std::size_t used, std::string& text) {
  std::string line;
  const bool outermost = indent == 0 && value.is_object();
  const std::size_t room = width > used + 1 ? width - used - 1 : 0;  // 1: the comma behind it
  if (!value.is_structured() || value.empty()) {
    append_line(value, std::string::npos, line);
    text += line;
    return;
  }
  if (!outermost && append_line(value, room, line)) {
    text += line;
    return;
  }
  const bool object = value.is_object();
  text += object ? "{\n" : "[\n";
  bool first = true;
  for (const auto& item : value.items()) {
    if (!first) text += ",\n";
    first = false;
    const std::size_t start = text.size();
    text.append(indent + 2, ' ');
    if (object) text += text_of(item.key()) + ": ";
    append(item.value(), indent + 2, text.size() - start, text);
  }
  text += '\n';
  text.append(indent, ' ');
  text += object ? '}' : ']';
}

}  // namespace

std::string pretty(const nlohmann::ordered_json& value) {
  std::string text;
  append(value, 0, 0, text);
  text += '\n';
  return text;
}

}  // namespace sheave::json
