#pragma once
// Standard output and standard error: data goes to the first, everything said to a person to the
// second.

#include <string>
#include <string_view>

namespace sheave::command {

/// Writes to standard output at once; throws a Failure (74) if that is closed or full.
void print(std::string_view text);

/// `text` as it may be shown on a terminal: bytes that are no UTF-8 and control characters other
/// than line breaks and tabs, which a file's name may hold, become "\x1b" and alike.
[[nodiscard]] std::string printable(std::string_view text);

/// Writes "sheave: error: <text>" and alike to standard error. Only the first line gets that head:
/// further ones may be of a form that editors understand ("file:line:column: ..."). All of them
/// make the text printable.
void print_error(std::string_view text);
void print_warning(std::string_view text);
void print_note(std::string_view text);

/// Whether somebody watches standard error.
[[nodiscard]] bool stderr_is_terminal();
/// Whether that somebody wants colours there (https://no-color.org).
[[nodiscard]] bool stderr_has_color();

/// From now on writing to a closed pipe, or beyond the limit of a file's size (`ulimit -f`), is an
/// error like any other, not the end of the process.
void turn_signals_into_errors();

}  // namespace sheave::command
