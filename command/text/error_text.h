#pragma once
// Texts for errors against a reference and for times.

#include <string>

namespace sheave::command {

/// Relative errors below this are rounding: a reference cannot distinguish them from 0.
inline constexpr double rounding_error = 1e-11;

/// "1.2e-03". "< 3.0e-06" for an error that is not well above the reference's own error `doubt`, or
/// that is rounding. "-" for NaN.
[[nodiscard]] std::string error_text(double error, double doubt);

/// [us] with three significant digits, and all digits before the decimal point: "12.3", "4567".
[[nodiscard]] std::string microseconds_text(double seconds);

}  // namespace sheave::command
