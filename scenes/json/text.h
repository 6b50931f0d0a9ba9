#pragma once
// What a text file is made of, before anybody asks what it means.

#include <cstddef>
#include <string>
#include <string_view>

namespace sheave::json {

/// Bytes of the UTF-8 character that `text` begins with (1 to 4); 0 if it begins with none: a stray
/// or missing continuation, an overlong form, a surrogate, or beyond U+10FFFF.
[[nodiscard]] std::size_t character_length(std::string_view text);

/// The first thing that makes a text no UTF-8.
struct TextFault {
  std::size_t offset = 0;  ///< in the text
  std::string message;     ///< empty: there is none
};

/// Names UTF-16 and UTF-32, by their byte order mark or by the null characters they are full of. A
/// null character is a fault, too.
[[nodiscard]] TextFault find_text_fault(std::string_view text);

}  // namespace sheave::json
