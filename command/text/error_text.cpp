#include "command/text/error_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sheave::command {

std::string error_text(double error, double doubt) {
  constexpr double well_above = 3.0;
  if (std::isnan(error)) return "-";
  if (!std::isfinite(doubt)) return fmt::format("{:.1e}, not verified", error);
  if (error > well_above * doubt && error > rounding_error) return fmt::format("{:.1e}", error);
  return fmt::format("< {:.1e}", std::max(error + doubt, rounding_error));
}

std::string microseconds_text(double seconds) {
  const double value = 1e6 * seconds;
  return value >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

}  // namespace sheave::command
