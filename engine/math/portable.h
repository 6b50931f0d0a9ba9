#pragma once
// Functions that give the same bits wherever they run: of the standard's operations only +, -, x, /,
// the square root and the remainder are exact by IEEE 754; the sine of one C library differs from
// another's in the last place, and after a second of simulated time so does everything.
//
// The methods are those of FreeBSD's msun (Sun Microsystems 1993). Errors are relative, over all
// arguments whose results are normal numbers; what is not a number gives what is not a number.

#include "engine/math/sine_cosine.h"

namespace sheave::portable {

/// Of an angle [rad], within 1e-15, absolute.
[[nodiscard]] inline double sin(double angle) { return sine_cosine(angle).sine; }
[[nodiscard]] inline double cos(double angle) { return sine_cosine(angle).cosine; }
/// The angle of (x, y) from the x axis [rad], in [-pi, pi], within 4e-16 of it; 0 of (0, 0). The
/// sign of a zero counts as with std::atan2.
[[nodiscard]] double atan2(double y, double x);
/// Within 3e-16.
[[nodiscard]] double exp(double x);
/// exp(x) - 1, within 1e-15.
[[nodiscard]] double expm1(double x);
/// Within 3e-16.
[[nodiscard]] double log(double x);
/// The length of (x, y), within 5e-16.
[[nodiscard]] double hypot(double x, double y);

}  // namespace sheave::portable
