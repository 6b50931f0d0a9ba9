#pragma once
// Makes texts from outside, such as names in scenes and of files, safe for pictures and pages.

#include <cstddef>
#include <string>
#include <string_view>

namespace sheave::command {

/// Whether a well-formed character is a control character, turns the direction of writing or is no
/// character of XML.
[[nodiscard]] bool cannot_be_shown(std::string_view character);

/// JSON in which such characters are \u escapes. In valid JSON these characters are within strings
/// only; a terminal that shows the JSON acts on none of them.
[[nodiscard]] std::string showable_json(std::string_view json);

/// `text` as one line of UTF-8 that every program can show. Tabs and line breaks become spaces.
/// Invalid UTF-8, characters that XML does not allow, control characters, and characters that
/// change the direction of writing become U+FFFD, one for each byte or character. A text of more
/// than `most` characters is cut, and its last character becomes "…", because no picture has room
/// for more.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t most = 300);

/// one_line() of any length for a page in Markdown: characters that would begin a link, code, an
/// HTML element, a character reference or a table cell are escaped.
[[nodiscard]] std::string markdown_text(std::string_view text);

/// `text` between fences that no line of `text` ends. The last line must have its line break.
[[nodiscard]] std::string markdown_code(std::string_view text);

}  // namespace sheave::command
