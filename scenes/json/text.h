#pragma once
// Checks the characters of a text file before it is parsed.

#include <cstddef>
#include <string>
#include <string_view>

namespace sheave::json {

/// Bytes of the UTF-8 character at the start of `text` (1 to 4); 0 if it is not valid: a stray or
/// missing continuation, an overlong form, a surrogate, or beyond U+10FFFF.
[[nodiscard]] std::size_t character_length(std::string_view text);

/// The first fault by which a text is not UTF-8.
struct TextFault {
  std::size_t offset = 0;  ///< position in the text
  std::string message;     ///< empty: no fault
};

/// Recognises UTF-16 and UTF-32 by their byte order mark or their many null characters. A null
/// character is a fault, too.
[[nodiscard]] TextFault find_text_fault(std::string_view text);

}  // namespace sheave::json
