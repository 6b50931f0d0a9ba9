#pragma once
// Shares (percentages or fractions) on the command line.

#include <string>

namespace sheave::command {

/// The value of "0.1%" or "1e-3", > 0; a Failure (2) that names the option for any other text.
[[nodiscard]] double positive_share(const std::string& option, const std::string& text);

}  // namespace sheave::command
