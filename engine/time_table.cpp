// Splines by their second derivatives M. With h the length of a piece and s its slope from point to
// point, continuity of the first derivatives requires
//   h0 M0 + 2 (h0 + h1) M1 + h1 M2 = 6 (s1 - s0)
// at each inner point. The conditions at the ends are
//   clamped       2 h0 M0 + h0 M1 = 6 s0,            likewise at the other end
//   not a knot    (M1 - M0) / h0 = (M2 - M1) / h1:   the first two pieces are one polynomial
// In both cases the system is tridiagonal with a dominant diagonal and needs no pivoting.
//
// A monotone table is given by the rates r at its points. A rate is 0 where the slopes on both
// sides differ in sign, else a weighted harmonic mean of the slopes. The mean never exceeds three
// times the smaller slope, which is sufficient for a cubic piece without a turning point (Fritsch
// and Carlson 1980). A piece with the slope s, the length h and the rates r0 and r1 has the second
// derivatives
//   M0 = (6 s - 4 r0 - 2 r1) / h,   M1 = (2 r0 + 4 r1 - 6 s) / h.

#include "engine/time_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace sheave {
namespace {

/// The sum of piece(left, right) over the parts of an interval between the points of a table.
template <class Piece>
double sum_between_corners(std::span<const double> times, double from, double to, Piece piece) {
  double sum = 0.0;
  double left = from;
  for (auto corner = std::upper_bound(times.begin(), times.end(), from);
       corner != times.end() && *corner < to; ++corner) {
    sum += piece(left, *corner);
    left = *corner;
  }
  return sum + piece(left, to);
}

using Bend = TimeTable::Bend;

/// The system lower[i] x[i - 1] + diagonal[i] x[i] + upper[i] x[i + 1] = right[i].
struct Tridiagonal {
  explicit Tridiagonal(std::size_t n) : lower(n), diagonal(n), upper(n), right(n) {}
  std::vector<double> lower, diagonal, upper, right;

  [[nodiscard]] std::vector<double> solve() {
    const std::size_t n = right.size();
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      right[i] -= factor * right[i - 1];
    }
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) right[i] -= upper[i] * right[i + 1];
      right[i] /= diagonal[i];
    }
    return right;
  }
};

class Spline {
 public:
  Spline(const std::vector<double>& times, const std::vector<double>& values) {
    for (std::size_t i = 1; i < times.size(); ++i) {
      lengths_.push_back(times[i] - times[i - 1]);
      slopes_.push_back((values[i] - values[i - 1]) / lengths_.back());
    }
  }

  [[nodiscard]] std::vector<Bend> clamped() const {
    Tridiagonal system = inner();
    const std::size_t last = lengths_.size();
    system.diagonal[0] = 2.0 * lengths_[0];
    system.upper[0] = lengths_[0];
    system.right[0] = 6.0 * slopes_[0];
    system.lower[last] = lengths_[last - 1];
    system.diagonal[last] = 2.0 * lengths_[last - 1];
    system.right[last] = -6.0 * slopes_[last - 1];
    return pieces(system.solve());
  }

  [[nodiscard]] std::vector<Bend> not_a_knot() const {
    const std::size_t last = lengths_.size();
    if (last == 1) return {{}};
    if (last == 2) {  // one parabola
      const double bend = 2.0 * (slopes_[1] - slopes_[0]) / (lengths_[0] + lengths_[1]);
      return pieces({bend, bend, bend});
    }
    // Eliminate the unknowns at the ends: M0 = ((h0 + h1) M1 - h0 M2) / h1.
    Tridiagonal system = inner();
    const double h0 = lengths_[0] / lengths_[1];
    system.diagonal[1] += system.lower[1] * (1.0 + h0);
    system.upper[1] -= system.lower[1] * h0;
    const double hn = lengths_[last - 1] / lengths_[last - 2];
    system.diagonal[last - 1] += system.upper[last - 1] * (1.0 + hn);
    system.lower[last - 1] -= system.upper[last - 1] * hn;
    system.lower[1] = system.upper[last - 1] = 0.0;
    system.diagonal[0] = system.diagonal[last] = 1.0;
    std::vector<double> bends = system.solve();
    bends[0] = (1.0 + h0) * bends[1] - h0 * bends[2];
    bends[last] = (1.0 + hn) * bends[last - 1] - hn * bends[last - 2];
    return pieces(bends);
  }

  [[nodiscard]] std::vector<Bend> monotone() const {
    std::vector<double> rates{end_rate(0, 1)};
    for (std::size_t i = 1; i < slopes_.size(); ++i) rates.push_back(inner_rate(i));
    rates.push_back(end_rate(slopes_.size() - 1, slopes_.size() - 2));
    std::vector<Bend> bends;
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      const double six = 6.0 * slopes_[i];
      bends.push_back({(six - 4.0 * rates[i] - 2.0 * rates[i + 1]) / lengths_[i],
                       (2.0 * rates[i] + 4.0 * rates[i + 1] - six) / lengths_[i]});
    }
    return bends;
  }

 private:
  /// The pieces of a spline whose second derivatives are continuous.
  [[nodiscard]] static std::vector<Bend> pieces(const std::vector<double>& bends) {
    std::vector<Bend> both;
    for (std::size_t i = 1; i < bends.size(); ++i) both.push_back({bends[i - 1], bends[i]});
    return both;
  }

  [[nodiscard]] double inner_rate(std::size_t i) const {
    const double before = slopes_[i - 1];
    const double after = slopes_[i];
    if (!(before * after > 0.0)) return 0.0;
    const double near = 2.0 * lengths_[i] + lengths_[i - 1];
    const double far = lengths_[i] + 2.0 * lengths_[i - 1];
    return (near + far) / (near / before + far / after);
  }

  /// The rate at an end: the one of the parabola through the last three points, limited to between
  /// 0 and 3 slopes. `end` is the piece at the end, `next` its neighbour.
  [[nodiscard]] double end_rate(std::size_t end, std::size_t next) const {
    const double slope = slopes_[end];
    if (slopes_.size() == 1) return slope;
    const double share = lengths_[end] / (lengths_[end] + lengths_[next]);
    const double rate = slope + share * (slope - slopes_[next]);
    if (!(rate * slope > 0.0)) return 0.0;
    return std::abs(rate) > 3.0 * std::abs(slope) ? 3.0 * slope : rate;
  }

  [[nodiscard]] Tridiagonal inner() const {
    Tridiagonal system(lengths_.size() + 1);
    for (std::size_t i = 1; i < lengths_.size(); ++i) {
      system.lower[i] = lengths_[i - 1];
      system.diagonal[i] = 2.0 * (lengths_[i - 1] + lengths_[i]);
      system.upper[i] = lengths_[i];
      system.right[i] = 6.0 * (slopes_[i] - slopes_[i - 1]);
    }
    return system;
  }

  std::vector<double> lengths_;  // of the pieces
  std::vector<double> slopes_;
};

}  // namespace

TimeTable TimeTable::of(std::vector<double> times, std::vector<double> values,
                        Interpolation interpolation) {
  TimeTable table{std::move(times), std::move(values)};
  // check_fields() and the types' own checks report points that do not match.
  const bool pairs = table.times.size() == table.values.size() && table.times.size() > 1;
  if (interpolation == Interpolation::linear || !pairs) return table;
  const Spline spline(table.times, table.values);
  table.bends = interpolation == Interpolation::clamped    ? spline.clamped()
                : interpolation == Interpolation::monotone ? spline.monotone()
                                                           : spline.not_a_knot();
  return table;
}

double TimeTable::at(double time) const {
  if (values.empty()) return 0.0;
  if (times.empty() || time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double length = times[i] - times[i - 1];
  const double share = (time - times[i - 1]) / length;
  const double chord = values[i - 1] + share * (values[i] - values[i - 1]);
  if (bends.empty()) return chord;
  const double rest = (times[i] - time) / length;
  return chord + length * length / 6.0 *
                     ((rest * rest - 1.0) * rest * bends[i - 1].first +
                      (share * share - 1.0) * share * bends[i - 1].last);
}

double TimeTable::rate(double time) const {
  if (times.empty() || time <= times.front() || time > times.back()) return 0.0;
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double length = times[i] - times[i - 1];
  const double slope = (values[i] - values[i - 1]) / length;
  if (bends.empty()) return slope;
  const double share = (time - times[i - 1]) / length;
  const double rest = (times[i] - time) / length;
  return slope + length / 6.0 *
                     ((1.0 - 3.0 * rest * rest) * bends[i - 1].first +
                      (3.0 * share * share - 1.0) * bends[i - 1].last);
}

double TimeTable::integral(double from, double to) const {
  // Between corners the trapezoidal rule is exact for lines, and Simpson's rule for cubics.
  const auto piece = [&](double left, double right) {
    const double ends = at(left) + at(right);
    if (bends.empty()) return 0.5 * ends * (right - left);
    return (ends + 4.0 * at(0.5 * (left + right))) / 6.0 * (right - left);
  };
  return sum_between_corners(times, from, to, piece);
}

double TimeTable::moment(double from, double to) const {
  if (times.empty()) return 0.0;
  const double middle = 0.5 * (from + to);
  // Gauss's rule with three points is exact up to the fifth power.
  const double offset = std::sqrt(0.6);
  const auto piece = [&](double left, double right) {
    const double half = 0.5 * (right - left);
    const double centre = 0.5 * (left + right);
    const auto term = [&](double time) { return (middle - time) * at(time); };
    return half / 9.0 *
           (5.0 * (term(centre - offset * half) + term(centre + offset * half)) +
            8.0 * term(centre));
  };
  return sum_between_corners(times, from, to, piece);
}

double TimeTable::next_corner(double time) const {
  const auto corner = std::upper_bound(times.begin(), times.end(), time);
  return corner == times.end() ? std::numeric_limits<double>::infinity() : *corner;
}

}  // namespace sheave
