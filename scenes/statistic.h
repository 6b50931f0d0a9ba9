#pragma once
// Statistics of a number over time: of checks, measures and expressions.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace sheave {

/// A number that is computed from an observable over time.
enum class Statistic {
  at,    ///< value at the step nearest to the time `at`
  mean,  ///< mean of the values in the window
  rate,  ///< (last - first value) / (their times' difference)
  minimum,
  maximum,
  range,  ///< maximum - minimum
  drift,  ///< last - first value
  /// Integral over the time in the window. If there is no value at its start, the first value also
  /// counts for the time before it.
  integral,
};
inline constexpr std::array<std::string_view, 8> statistic_names{
    "at", "mean", "rate", "minimum", "maximum", "range", "drift", "integral"};

/// The statistic with this name, also with the short names "min" and "max"; not `at`.
[[nodiscard]] std::optional<Statistic> statistic_over_time(std::string_view name);

/// The values of a number up to now, in sums. All members are numbers, so that a course can be part
/// of a state.
struct Course {
  double begin = -1.0;  ///< time from which the course counts [s]; < 0: it has not begun
  double count = 0.0;   ///< number of values
  double first = 0.0, first_time = 0.0;
  double last = 0.0, last_time = 0.0;
  double minimum = 0.0, maximum = 0.0;
  double sum = 0.0;
  double area = 0.0;    ///< by the trapezium rule [s x unit]
  double finite = 1.0;  ///< 0 once a value was not finite; then the sums are of the values before

  /// Number of members.
  static constexpr std::size_t size = 11;

  /// Adds the value at a time, which must not be before the last one. Of two values at one time
  /// the second one replaces the last value and widens the extremes alone.
  void add(double time, double value);
  /// NaN without a value, for `at`, and where a value was not finite; for `rate` also with one.
  [[nodiscard]] double value(Statistic statistic) const;

  /// The members in their order.
  static Course from(std::span<const double, size> numbers);
  void store(std::span<double, size> numbers) const;
};

}  // namespace sheave
