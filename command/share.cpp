#include "command/share.h"

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "command/failure.h"

namespace sheave::command {

double positive_share(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool percent = std::string_view(end) == "%";
  if (end == text.c_str() || !(percent || *end == '\0') || !(value > 0.0) ||
      !std::isfinite(value)) {
    throw Failure(ExitCode::usage,
                  option + " " + text + ": must be a positive share, e.g. 0.1% or 1e-3");
  }
  return percent ? 0.01 * value : value;
}

}  // namespace sheave::command
