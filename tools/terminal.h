#pragma once
// Standard output and standard error: data goes to the first, everything said to a person to the
// second.

#include <string_view>

namespace sheave::tools {

/// Writes to standard output at once; throws a Failure (74) if that is closed or full.
void print(std::string_view text);

/// Writes "sheave: error: <text>" and alike to standard error. Only the first line gets that head:
/// further ones may be of a form that editors understand ("file:line:column: ...").
void print_error(std::string_view text);
void print_warning(std::string_view text);
void print_note(std::string_view text);

/// Whether somebody watches standard error.
[[nodiscard]] bool stderr_is_terminal();
/// Whether that somebody wants colours there (https://no-color.org).
[[nodiscard]] bool stderr_has_color();

/// From now on writing to a closed pipe is an error like any other, not the end of the process.
void ignore_broken_pipes();

}  // namespace sheave::tools
