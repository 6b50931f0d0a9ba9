#include "cable/certificate/rope_law.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"

namespace sheave::certify {
namespace {

/// Slope at a point between two chords, Fritsch and Butland (1984); `a` and `b` are the lengths of
/// the pieces before and behind the point.
double slope_between(double chord_a, double a, double chord_b, double b) {
  const double weight_a = a + 2.0 * b;
  const double weight_b = 2.0 * a + b;
  return 3.0 * (a + b) * chord_a * chord_b / (weight_a * chord_b + weight_b * chord_a);
}

/// Slope at an end: that of the parabola through three points, from 0 to three chords.
double slope_at_end(double chord, double length, double next_chord, double next_length) {
  const double parabola =
      ((2.0 * length + next_length) * chord - length * next_chord) / (length + next_length);
  return std::clamp(parabola, 0.0, 3.0 * chord);
}

}  // namespace

RopeLaw::RopeLaw(const CableDef& cable) {
  const std::size_t count = cable.strain_table.size();
  for (std::size_t i = 0; i < count; ++i) {
    points_.push_back({cable.strain_table[i], cable.tension_table[i], 0.0, 0.0});
  }
  const auto length = [&](std::size_t i) { return points_[i + 1].strain - points_[i].strain; };
  const auto chord = [&](std::size_t i) {
    return (points_[i + 1].tension - points_[i].tension) / length(i);
  };
  if (count == 2) {
    points_[0].slope = points_[1].slope = chord(0);
  } else {
    points_[0].slope = slope_at_end(chord(0), length(0), chord(1), length(1));
    points_[count - 1].slope =
        slope_at_end(chord(count - 2), length(count - 2), chord(count - 3), length(count - 3));
  }
  for (std::size_t i = 1; i + 1 < count; ++i) {
    points_[i].slope = slope_between(chord(i - 1), length(i - 1), chord(i), length(i));
  }
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double way = length(i);
    points_[i + 1].energy = points_[i].energy +
                            0.5 * way * (points_[i].tension + points_[i + 1].tension) +
                            way * way / 12.0 * (points_[i].slope - points_[i + 1].slope);
  }
}

std::size_t RopeLaw::piece_of(double strain) const {
  const auto behind =
      std::upper_bound(points_.begin(), points_.end(), strain,
                       [](double value, const Point& point) { return value < point.strain; });
  return behind == points_.begin() ? 0 : at(static_cast<int>(behind - points_.begin()) - 1);
}

double RopeLaw::tension(double strain) const {
  if (!(strain > 0.0)) return 0.0;
  const std::size_t i = piece_of(strain);
  const Point& from = points_[i];
  if (i + 1 == points_.size()) return from.tension + from.slope * (strain - from.strain);
  const Point& to = points_[i + 1];
  const double way = to.strain - from.strain;
  const double s = (strain - from.strain) / way;
  const double r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * from.tension + s * s * (3.0 - 2.0 * s) * to.tension +
         way * s * r * (r * from.slope - s * to.slope);
}

double RopeLaw::energy(double strain) const {
  if (!(strain > 0.0)) return 0.0;
  const std::size_t i = piece_of(strain);
  const Point& from = points_[i];
  const double way = strain - from.strain;
  if (i + 1 == points_.size()) {
    return from.energy + way * (from.tension + 0.5 * from.slope * way);
  }
  const Point& to = points_[i + 1];
  const double whole = to.strain - from.strain;
  const double s = way / whole;
  // the integrals of the four polynomials of tension()
  const double a = s - s * s * s + 0.5 * s * s * s * s;
  const double b = s * s * s - 0.5 * s * s * s * s;
  const double c = s * s * (0.5 - 2.0 / 3.0 * s + 0.25 * s * s);
  const double d = s * s * s * (-1.0 / 3.0 + 0.25 * s);
  return from.energy + whole * (a * from.tension + b * to.tension) +
         whole * whole * (c * from.slope + d * to.slope);
}

double RopeLaw::mean(double from, double to) const {
  // Where the quotient is rounding, the tension in the middle is as good.
  constexpr double small = 1e-4;
  const double first = std::max(from, 0.0);
  const double last = std::max(to, 0.0);
  if (std::abs(last - first) > small * std::max(first, last)) {
    return (energy(last) - energy(first)) / (last - first);
  }
  return (tension(first) + 4.0 * tension(0.5 * (first + last)) + tension(last)) / 6.0;
}

double RopeLaw::stiffness(double strain) const {
  const std::size_t i = std::min(piece_of(std::max(strain, 0.0)), points_.size() - 2);
  double least = 0.0;
  for (std::size_t k = i == 0 ? 0 : i - 1; k <= std::min(i + 1, points_.size() - 2); ++k) {
    const double chord =
        (points_[k + 1].tension - points_[k].tension) / (points_[k + 1].strain - points_[k].strain);
    if (least == 0.0 || chord < least) least = chord;
  }
  return least;
}

}  // namespace sheave::certify
