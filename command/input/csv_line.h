#pragma once
// Lines of CSV files (RFC 4180), whose cells have no line breaks.

#include <string>
#include <string_view>
#include <vector>

namespace sheave::command {

/// The cells of a line. A quoted cell may contain commas, and a doubled quote is a quote in it.
[[nodiscard]] std::vector<std::string> csv_cells(std::string_view line);

}  // namespace sheave::command
