#pragma once
// How errors against a reference, and times, are told to people.

#include <string>

namespace sheave::command {

/// Relative errors below this are rounding, which no reference tells from none.
inline constexpr double rounding_error = 1e-11;

/// "1.2e-03"; "< 3.0e-06" for one that is not well above its reference's own error `doubt`, or that
/// is rounding; "-" for NaN.
[[nodiscard]] std::string error_text(double error, double doubt);

/// [us] with three digits, and all digits before the point: "12.3", "4567".
[[nodiscard]] std::string microseconds_text(double seconds);

}  // namespace sheave::command
