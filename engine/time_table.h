#pragma once
// A function of time given by a few points.

#include <array>
#include <string_view>
#include <vector>

namespace sheave {

/// The function between the points of a table.
enum class Interpolation {
  linear,
  /// A cubic spline, twice continuously differentiable. At the ends, its pieces are those of cubic
  /// polynomials through the four nearest points ("not a knot"). Values are therefore right to the
  /// fourth order of the spacing and second derivatives to the second, up to the ends: for a motion
  /// that was sampled. The rate jumps at the ends of the table, unless the table ends at rest.
  cubic,
  /// A cubic spline with rate 0 at both ends: for a motion from rest to rest.
  clamped,
  /// Cubic pieces with a continuous rate that stay within the range of the two points around them:
  /// rising values give a rising function, and its peaks are at points. Fritsch and Butland's rates
  /// (SIAM J. Sci. Stat. Comput. 5, 1984). Second derivatives jump at points.
  monotone,
};
inline constexpr std::array<std::string_view, 4> interpolation_names{"linear", "cubic", "clamped",
                                                                     "monotone"};
inline constexpr std::string_view interpolation_meaning =
    "of the values between their times; cubic: a smooth spline, which may overshoot the values and "
    "may start backwards; clamped: a spline with rate 0 at both ends; monotone: smooth, and within "
    "the range of the two values around a time";

/// A function through (times[i], values[i]), constant before the first and after the last point.
/// Times increase strictly. Without times the function is the constant values[0]; without values it
/// is 0.
struct TimeTable {
  std::vector<double> times;  ///< [s]
  std::vector<double> values;
  /// The second derivatives [per s2] of one piece, a cubic between two points, at its ends.
  struct Bend {
    double first = 0.0;
    double last = 0.0;
  };
  /// Per piece, one less than points; empty: the table is piecewise linear. of() computes them.
  std::vector<Bend> bends{};

  /// A table with these points: as many values as times, or a single value without times.
  [[nodiscard]] static TimeTable of(std::vector<double> times, std::vector<double> values,
                                    Interpolation interpolation);

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] double at(double time) const;
  /// The derivative [per s]; at a corner the one of the piece that ends there.
  [[nodiscard]] double rate(double time) const;
  /// Integral from `from` to `to` [s], from <= to; exact.
  [[nodiscard]] double integral(double from, double to) const;
  /// Integral of (middle - t) times the function from `from` to `to` [s], from <= to; exact. A force
  /// moves a mass further by this over the mass than its mean does.
  [[nodiscard]] double moment(double from, double to) const;
  /// The first point of a table with corners later than `time` [s]; infinite if there is none.
  [[nodiscard]] double next_corner(double time) const;
};

}  // namespace sheave
