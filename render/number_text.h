#pragma once
// Numbers as text in a figure, independent of the process's locale.

#include <string>
#include <string_view>
#include <vector>

#include "scenes/unit_scale.h"

namespace sheave::render {

/// `value` with `decimals` digits after the point (0 to 15); never "-0.0". "nan" and "inf" for
/// those.
[[nodiscard]] std::string fixed_text(double value, int decimals);

/// "20.0 N": three significant digits relative to `reference` (a typical largest value), with its
/// unit prefix, so that the numbers of one picture have the same form.
[[nodiscard]] std::string quantity_text(double value, double reference, std::string_view unit);

/// Round numbers in [low, high], about `count` of them; low < high, both finite.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;  ///< number of decimals needed to write them exactly
};
[[nodiscard]] Ticks round_ticks(double low, double high, int count);

/// The largest of 1, 2, 5 times a power of ten that is at most `value` > 0.
[[nodiscard]] double round_down(double value);

}  // namespace sheave::render
