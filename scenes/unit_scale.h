#pragma once
// Prefixes of units, for figures: one choice for legends, labels and charts.

#include <string_view>

namespace sheave {

/// Unit prefix for short numbers up to a reference.
struct UnitScale {
  double factor = 1.0;      ///< divide numbers by this
  std::string_view prefix;  ///< "k", "M", "m", ...; empty from 0.1 to 10 000
};
[[nodiscard]] UnitScale unit_scale(double reference);

/// The same for numbers of a unit. Only units that are usual with a prefix have one: N, J, W, Pa,
/// Hz, m, s and products and quotients that begin with one of these; s has no prefix above 1.
[[nodiscard]] UnitScale unit_scale(double reference, std::string_view unit);

}  // namespace sheave
