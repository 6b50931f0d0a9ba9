#pragma once
// A value that moves to a target in a given time.

#include <cmath>
#include <type_traits>

namespace sheave {

/// A cubic from one value to another with given rates at both ends, continued at a steady rate. The
/// cubic is a straight line if both rates equal (end - start) / (to - from). `Value` is a number or
/// a vector.
template <class Value>
struct RampOf {
  double from = 0.0;             ///< time of the start [s]; the value is `start` before
  double to = 0.0;               ///< time of arrival [s], >= from; equal: at once
  Value start = nothing();       ///< at `from`
  Value start_rate = nothing();  ///< [per s]
  Value end = nothing();         ///< at `to`
  Value end_rate = nothing();    ///< rate on arrival [per s]
  Value rate_after = nothing();  ///< rate after `to` [per s]

  /// Whether the numbers are finite and the ramp's rates, too. Functions that make a ramp and
  /// functions that accept a state with one both ask.
  [[nodiscard]] bool is_sound() const {
    const double span = to - from;
    const bool in_time =
        std::isfinite(from) && std::isfinite(to) && (span == 0.0 || std::isfinite(1.0 / span));
    return in_time && span >= 0.0 && finite(Value(end - start)) && finite(start_rate) &&
           finite(end_rate) && finite(rate_after) && finite(start) && finite(end);
  }
  /// Whether `time` is after the ramp's end. A time that equals the end but for rounding, as times
  /// of steps do, counts as the end.
  [[nodiscard]] bool past(double time) const {
    constexpr double rounding = 1e-9;
    return time - to > rounding * (to - from) || !(to > from);
  }
  [[nodiscard]] Value at(double time) const {
    if (past(time)) return Value(end + rate_after * (time - to));
    return within((time - from) / (to - from));
  }
  /// The derivative [per s]; at `to` the rate on arrival.
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
  /// The value after the share `s` of the ramp's time.
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

/// The ramp of a number.
using Ramp = RampOf<double>;

}  // namespace sheave
