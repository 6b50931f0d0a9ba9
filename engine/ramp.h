#pragma once
// A value on its way to a target.

#include <cmath>
#include <type_traits>

namespace sheave {

/// From one value to another as a cubic with given rates at both ends, and from there on at a
/// steady rate. With equal rates of (end - start) / (to - from) it is a straight line. `Value` is a
/// number or a vector.
template <class Value>
struct RampOf {
  double from = 0.0;             ///< when it begins [s]; before that it has its first value
  double to = 0.0;               ///< when it is there [s], >= from; equal: at once
  Value start = nothing();       ///< at `from`
  Value start_rate = nothing();  ///< [per s]
  Value end = nothing();         ///< at `to`
  Value end_rate = nothing();    ///< as it arrives [per s]
  Value rate_after = nothing();  ///< from then on [per s]

  /// Whether a world can go along it: its numbers are finite, and what it does within its time has
  /// finite rates. What makes a ramp asks this, and what takes a state with one.
  [[nodiscard]] bool is_sound() const {
    const double span = to - from;
    const bool in_time =
        std::isfinite(from) && std::isfinite(to) && (span == 0.0 || std::isfinite(1.0 / span));
    return in_time && span >= 0.0 && finite(Value(end - start)) && finite(start_rate) &&
           finite(end_rate) && finite(rate_after) && finite(start) && finite(end);
  }
  /// Whether it is beyond its end at `time`. Times of steps are rounded; at the end it still
  /// arrives.
  [[nodiscard]] bool past(double time) const {
    constexpr double rounding = 1e-9;
    return time - to > rounding * (to - from) || !(to > from);
  }
  [[nodiscard]] Value at(double time) const {
    if (past(time)) return Value(end + rate_after * (time - to));
    return within((time - from) / (to - from));
  }
  /// Its derivative [per s]; at `to` that with which it arrives.
  [[nodiscard]] Value rate(double time) const {
    if (past(time)) return rate_after;
    const double span = to - from;
    const double s = time > from ? (time - from) / span : 0.0;
    const double left = 1.0 - s;
    return (end - start) * (6.0 * s * left / span) + start_rate * (left * (1.0 - 3.0 * s)) -
           end_rate * (s * (2.0 - 3.0 * s));
  }
  /// Integral from `begin` to `finish` [s], begin <= finish; exact.
  [[nodiscard]] Value integral(double begin, double finish) const {
    if (begin >= to) return at(0.5 * (begin + finish)) * (finish - begin);
    if (to < finish) {
      return simpson(begin, to) + (end + rate_after * (0.5 * (finish - to))) * (finish - to);
    }
    return simpson(begin, finish);
  }

 private:
  static bool finite(const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      return std::isfinite(value);
    } else {
      return value.allFinite();
    }
  }
  static Value nothing() {
    if constexpr (std::is_arithmetic_v<Value>) {
      return 0.0;
    } else {
      return Value::Zero();
    }
  }
  /// Its value when it has done the share `s` of its time.
  [[nodiscard]] Value within(double s) const {
    const double span = to - from;
    if (!(s > 0.0)) s = 0.0;
    const double left = 1.0 - s;
    const double late = s * s * (3.0 - 2.0 * s);
    return start + (end - start) * late + start_rate * (span * s * left * left) -
           end_rate * (span * s * s * left);
  }
  /// Exact for cubics; both times within the ramp.
  [[nodiscard]] Value simpson(double begin, double finish) const {
    const double inverse = 1.0 / (to - from);
    const double first = (begin - from) * inverse;
    const double last = (finish - from) * inverse;
    return (within(first) + within(0.5 * (first + last)) * 4.0 + within(last)) *
           ((finish - begin) / 6.0);
  }
};

/// Of a number.
using Ramp = RampOf<double>;

}  // namespace sheave
