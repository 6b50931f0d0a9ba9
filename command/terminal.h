#pragma once
// Standard output is for data, standard error for messages to people.

#include <string>
#include <string_view>

namespace sheave::command {

/// Writes to standard output without delay; throws a Failure (74) if standard output is closed or
/// full.
void print(std::string_view text);

/// `text` in a form that is safe for a terminal. Invalid UTF-8 and control characters other than
/// line breaks and tabs, which file names may contain, are written as "\x1b" and alike, as are
/// characters that turn the direction of writing.
[[nodiscard]] std::string printable(std::string_view text);
/// printable() for a text from outside within a message or a table. Line breaks are written as
/// "\x0a" too, because the text could otherwise forge lines of the output.
[[nodiscard]] std::string printable_line(std::string_view text);

/// Writes "sheave: error: <text>" and alike to standard error. Only the first line gets that
/// prefix: further lines may have a form that editors parse ("file:line:column: ..."). All these
/// functions make the text printable.
void print_error(std::string_view text);
void print_warning(std::string_view text);
void print_note(std::string_view text);

/// Whether standard error is a terminal.
[[nodiscard]] bool stderr_is_terminal();
/// Whether standard error is a terminal that shall show colours (https://no-color.org).
[[nodiscard]] bool stderr_has_color();

/// From now on a write to a closed pipe, or beyond the limit of a file's size (`ulimit -f`),
/// returns an error instead of ending the process.
void turn_signals_into_errors();

}  // namespace sheave::command
