#include "scenes/unit_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheave {
namespace {

/// Whether the first factor of the unit is usual with a prefix.
bool takes_prefix(std::string_view unit) {
  constexpr std::array<std::string_view, 7> with{"N", "J", "W", "Pa", "Hz", "m", "s"};
  const std::string_view first = unit.substr(0, unit.find_first_of(" /,"));
  // "N, N m" is a number of one unit or of the other.
  return unit.find(',') == std::string_view::npos &&
         std::find(with.begin(), with.end(), first) != with.end();
}

}  // namespace

UnitScale unit_scale(double reference) {
  const double size = std::abs(reference);
  if (size >= 1e10) return {1e9, "G"};
  if (size >= 1e7) return {1e6, "M"};
  if (size >= 1e4) return {1e3, "k"};
  if (size >= 0.1 || !(size > 0.0)) return {1.0, ""};
  if (size >= 1e-4) return {1e-3, "m"};
  return {1e-6, "\u00b5"};
}

UnitScale unit_scale(double reference, std::string_view unit) {
  if (!takes_prefix(unit)) return {};
  const UnitScale scale = unit_scale(reference);
  return unit == "s" && scale.factor > 1.0 ? UnitScale{} : scale;
}

}  // namespace sheave
