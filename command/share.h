#pragma once
// Shares on the command line.

#include <string>

namespace sheave::command {

/// "0.1%" or "1e-3" as a number, > 0; a Failure (2) that names the option if it is no such thing.
[[nodiscard]] double positive_share(const std::string& option, const std::string& text);

}  // namespace sheave::command
