#pragma once
// A function of time given by a few points.

#include <array>
#include <string_view>
#include <vector>

namespace sheave {

/// What a table is between its points.
enum class Interpolation {
  linear,
  /// A cubic spline, twice continuously differentiable. Its ends are those of cubic polynomials
  /// through the four nearest points ("not a knot"), so that values are right to the fourth order
  /// of the spacing and second derivatives to the second, up to the ends: of a motion that was
  /// sampled. Its rate jumps where the table ends on the move.
  cubic,
  /// The same with rate 0 at both ends: of a motion from rest to rest.
  clamped,
  /// Cubic pieces with a continuous rate that never leave the range of the two points around them:
  /// values that rise stay rising, and a peak of the points is a peak of the function. Fritsch and
  /// Butland's rates (SIAM J. Sci. Stat. Comput. 5, 1984). Second derivatives jump at points.
  monotone,
};
inline constexpr std::array<std::string_view, 4> interpolation_names{"linear", "cubic", "clamped",
                                                                     "monotone"};
inline constexpr std::string_view interpolation_meaning =
    "of the values between their times; cubic: a smooth spline through them, which may overshoot "
    "them and may start backwards; clamped: one from rest to rest; monotone: smooth, and never "
    "beyond the two values around it";

/// Through (times[i], values[i]), constant before the first and after the last point. Times
/// increase strictly. Without times it is the constant values[0]; without values it is 0.
struct TimeTable {
  std::vector<double> times;  ///< [s]
  std::vector<double> values;
  /// A piece from one point to the next is a cubic: its second derivatives at both of its ends
  /// [per s2].
  struct Bend {
    double first = 0.0;
    double last = 0.0;
  };
  /// Per piece, one less than points; empty: the table is piecewise linear. of() finds them.
  std::vector<Bend> bends{};

  /// A table with these points, as many values as times or a single one without.
  [[nodiscard]] static TimeTable of(std::vector<double> times, std::vector<double> values,
                                    Interpolation interpolation);

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] double at(double time) const;
  /// Slope [per s]; at a corner that of the piece which ends there.
  [[nodiscard]] double rate(double time) const;
  /// Integral from `from` to `to` [s], from <= to; exact.
  [[nodiscard]] double integral(double from, double to) const;
};

}  // namespace sheave
