#include "command/text/one_line.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "scenes/json/text.h"

namespace sheave::command {
namespace {

constexpr std::string_view no_character = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view ellipsis = "\xE2\x80\xA6";

/// The code point of a well-formed character.
std::uint32_t code_point(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  constexpr std::uint32_t low_six = 0x3f;
  if (character.size() == 1) return byte(0);
  std::uint32_t code = byte(0) & (0x7fU >> character.size());
  for (std::size_t i = 1; i < character.size(); ++i) code = code << 6U | (byte(i) & low_six);
  return code;
}

bool parts_words(std::uint32_t code) {
  return code == '\t' || code == '\n' || code == '\r' || code == 0x85 || code == 0x2028 ||
         code == 0x2029;
}

bool cannot_be_shown_code(std::uint32_t code) {
  const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool turns = code == 0x061c || code == 0x200e || code == 0x200f ||
                     (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  // XML excludes U+FFFE and U+FFFF; the last two code points of every plane are no characters.
  return control || turns || (code & 0xfffeU) == 0xfffeU;
}

}  // namespace

std::string one_line(std::string_view text, std::size_t most) {
  std::string line;
  std::size_t shown = 0;
  std::size_t last = 0;  // start of the last character
  while (!text.empty()) {
    if (shown == most) {
      line.replace(last, std::string::npos, ellipsis);
      break;
    }
    const std::size_t length = json::character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    const std::uint32_t code = length == 0 ? 0 : code_point(character);
    last = line.size();
    if (parts_words(code)) {
      line += ' ';
    } else {
      line += cannot_be_shown_code(code) ? no_character : character;
    }
    ++shown;
    text.remove_prefix(character.size());
  }
  return line;
}

bool cannot_be_shown(std::string_view character) {
  return cannot_be_shown_code(code_point(character));
}

std::string showable_json(std::string_view json) {
  std::string result;
  while (!json.empty()) {
    const std::size_t length = std::max<std::size_t>(json::character_length(json), 1);
    const std::string_view character = json.substr(0, length);
    const std::uint32_t code = code_point(character);
    // Line breaks part the lines of JSON; in its strings they are escapes already. Beyond U+FFFF
    // only characters that mean nothing are of the kind.
    if (code >= 0x7f && code <= 0xffff && cannot_be_shown_code(code)) {
      result += fmt::format("\\u{:04x}", code);
    } else {
      result += character;
    }
    json.remove_prefix(length);
  }
  return result;
}

std::string markdown_text(std::string_view text) {
  std::string result;
  for (const char c : one_line(text, text.size())) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '\\':
      case '`':
      case '[':
      case ']':
      case '|':
        result += '\\';
        [[fallthrough]];
      default:
        result += c;
    }
  }
  return result;
}

std::string markdown_code(std::string_view text) {
  std::size_t longest = 2;
  std::size_t run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const std::string fence(longest + 1, '`');
  return fence + "\n" + std::string(text) + fence + "\n";
}

}  // namespace sheave::command
