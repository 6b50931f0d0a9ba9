#pragma once
// Numbers in messages.

#include <string>

namespace sheave {

/// The shortest text that reads back as the same double.
[[nodiscard]] std::string number_text(double value);
/// A number with `digits` significant digits, 1 to 17, without trailing zeros.
[[nodiscard]] std::string number_text(double value, int digits);
/// A number with `decimals` decimals, 0 to 15, and no exponent.
[[nodiscard]] std::string fixed_number_text(double value, int decimals);

}  // namespace sheave
