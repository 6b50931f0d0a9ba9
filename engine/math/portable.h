#pragma once
// Functions that give the same bits on all machines. Of the standard's operations, IEEE 754 defines
// only +, -, x, /, the square root and the remainder exactly. The sines of two C libraries differ
// in the last bit, and after a second of simulated time all results would differ.
//
// The methods are those of FreeBSD's msun (Sun Microsystems 1993). Errors are relative and hold for
// all arguments whose results are normal numbers. A NaN gives a NaN.

#include "engine/math/sine_cosine.h"

namespace sheave::portable {

/// Sine and cosine of an angle [rad], with an absolute error below 1e-15.
[[nodiscard]] inline double sin(double angle) { return sine_cosine(angle).sine; }
[[nodiscard]] inline double cos(double angle) { return sine_cosine(angle).cosine; }
/// The angle of (x, y) from the x axis [rad], in [-pi, pi], with an error below 4e-16; 0 for (0,
/// 0). The sign of a zero has the same effect as in std::atan2.
[[nodiscard]] double atan2(double y, double x);
/// Error below 3e-16.
[[nodiscard]] double exp(double x);
/// exp(x) - 1, error below 1e-15.
[[nodiscard]] double expm1(double x);
/// Error below 3e-16.
[[nodiscard]] double log(double x);
/// The length of (x, y), error below 5e-16.
[[nodiscard]] double hypot(double x, double y);

}  // namespace sheave::portable
