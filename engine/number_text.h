#pragma once
// Numbers in messages.

#include <string>

namespace sheave {

/// A number as people write it: shortest text that reads back as the same double.
[[nodiscard]] std::string number_text(double value);
/// With so many significant digits, 1 to 17, less the zeros at their end.
[[nodiscard]] std::string number_text(double value, int digits);
/// With so many decimals, 0 to 15, and no exponent.
[[nodiscard]] std::string fixed_number_text(double value, int decimals);

}  // namespace sheave
