#include "scenes/json/text.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace sheave::json {
namespace {

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

/// Name of the UTF-16 or UTF-32 encoding of a text; empty if it looks like neither.
std::string_view wide_encoding(std::string_view text) {
  struct Mark {
    std::string_view bytes;
    std::string_view name;
  };
  // Byte order marks; then "{", "[" or blank at the start of such a text without a mark. Longer
  // marks come first.
  using namespace std::string_view_literals;
  static constexpr std::array<Mark, 4> marks{{{"\xff\xfe\0\0"sv, "UTF-32"},
                                              {"\0\0\xfe\xff"sv, "UTF-32"},
                                              {"\xff\xfe"sv, "UTF-16"},
                                              {"\xfe\xff"sv, "UTF-16"}}};
  for (const Mark& mark : marks) {
    if (text.starts_with(mark.bytes)) return mark.name;
  }
  if (text.size() < 4) return {};
  const auto null = [&](std::size_t i) { return text[i] == '\0'; };
  if (null(0) && null(1) && null(2) && !null(3)) return "UTF-32";
  if (!null(0) && null(1) && null(2) && null(3)) return "UTF-32";
  if (null(0) && !null(1) && null(2) && !null(3)) return "UTF-16";
  if (!null(0) && null(1) && !null(2) && null(3)) return "UTF-16";
  return {};
}

}  // namespace

std::size_t character_length(std::string_view text) {
  const unsigned first = text.empty() ? 0x80U : byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xc2   ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, i) & 0xc0U) != 0x80) return 0;
  }
  const unsigned second = byte_at(text, 1);
  if (first == 0xe0 && second < 0xa0) return 0;  // overlong
  if (first == 0xed && second > 0x9f) return 0;  // a surrogate
  if (first == 0xf0 && second < 0x90) return 0;  // overlong
  if (first == 0xf4 && second > 0x8f) return 0;  // beyond U+10FFFF
  return length;
}

TextFault find_text_fault(std::string_view text) {
  if (const std::string_view name = wide_encoding(text); !name.empty()) {
    return {0, fmt::format("the text is {}; it must be UTF-8", name)};
  }
  for (std::size_t at = 0; at < text.size();) {
    // This covers nearly all characters of most texts.
    if (text[at] != '\0' && byte_at(text, at) < 0x80) {
      ++at;
      continue;
    }
    if (text[at] == '\0') return {at, "null character in the text"};
    const std::size_t length = character_length(text.substr(at));
    if (length == 0) {
      return {at, fmt::format("the byte 0x{:02x} is no UTF-8 here", byte_at(text, at))};
    }
    at += length;
  }
  return {};
}

}  // namespace sheave::json
