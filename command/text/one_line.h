#pragma once
// Texts from outside, such as names in scenes and of files, as pictures and pages can hold them.

#include <cstddef>
#include <string>
#include <string_view>

namespace sheave::command {

/// `text` as one line of UTF-8 that everything can show. Tabs and line breaks become spaces. What
/// is no UTF-8, no character of XML, a control character or turns the direction of writing becomes
/// U+FFFD, one for each byte or character. Of more than `most` characters the last is "…", and the
/// rest is left out: no picture has room for it.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t most = 300);

/// one_line(), of any length, for a page in Markdown: what would begin a link, code, an HTML
/// element, a character reference or a cell of a table stands for itself.
[[nodiscard]] std::string markdown_text(std::string_view text);

/// Lines between fences that nothing in them ends. The last line must have its line break.
[[nodiscard]] std::string markdown_code(std::string_view text);

}  // namespace sheave::command
