// With s' = s - s0 measured from the lowest point and a the radius of curvature there, a catenary
// is
//   x = a asinh(s'/a),   z = sqrt(a^2 + s'^2).
// This form needs no cosh, so it cannot overflow however slack the cable is. For ends that are w
// apart horizontally and v vertically, and the length L:
//   sinh(q)/q = sqrt(L^2 - v^2)/w  with q = w/(2a)   (one equation for the shape),
//   s0 = (L - v coth q)/2                            (from z1^2 - z0^2 = s1'^2 - s0'^2).
#include "render/catenary.h"

#include <algorithm>
#include <cmath>

namespace sheave::render {
namespace {

/// ln(sinh(q)/q) without overflow.
double log_sinhc(double q) {
  if (q < 0.1) {
    const double t = q * q;
    return t / 6.0 - t * t / 180.0 + t * t * t / 2835.0 - t * t * t * t / 37800.0;
  }
  return q + std::log1p(-std::exp(-2.0 * q)) - std::log(2.0 * q);
}

/// Derivative of log_sinhc(): coth(q) - 1/q.
double log_sinhc_slope(double q) {
  if (q < 0.1) {
    const double t = q * q;
    return q * (1.0 / 3.0 - t / 45.0 + 2.0 * t * t / 945.0 - t * t * t / 4725.0);
  }
  return 1.0 / std::tanh(q) - 1.0 / q;
}

/// The q > 0 with ln(sinh(q)/q) = target > 0. The function is convex near 0 and nearly linear
/// beyond, so Newton from the larger of the two asymptotes converges in a few rounds.
double solve_shape(double target) {
  double q = target < 1.0 ? std::sqrt(6.0 * target) : target + std::log(2.0 * (target + 1.0));
  for (int round = 0; round < 40; ++round) {
    const double next = q - (log_sinhc(q) - target) / log_sinhc_slope(q);
    const double safe = next > 0.0 ? next : 0.5 * q;
    const bool done = std::abs(safe - q) <= 4e-16 * q;
    q = safe;
    if (done) break;
  }
  return q;
}

/// asinh(b) - asinh(c) without cancellation.
double asinh_difference(double b, double c) {
  if (b > 0.0 && c < 0.0) return std::asinh(b) - std::asinh(c);
  if (c < 0.0) return asinh_difference(-c, -b);
  const double rb = std::sqrt(1.0 + b * b);
  const double rc = std::sqrt(1.0 + c * c);
  return std::log1p((b - c) * (1.0 + (b + c) / (rb + rc)) / (c + rc));
}

}  // namespace

Catenary::Catenary(const Vector3& start, const Vector3& end, double length, const Vector3& gravity)
    : start_(start), end_(end) {
  const Vector3 d = end - start;
  const double distance = d.norm();
  const double strength = gravity.norm();
  if (strength > 0.0) up_ = -gravity / strength;
  rise_ = d.dot(up_);
  const Vector3 level = d - up_ * rise_;
  width_ = level.norm();
  length_ = std::max(length, distance);
  across_ = width_ > 0.0 ? Vector3(level / width_) : any_perpendicular(up_);
  // A smaller excess of length is lost in rounding.
  if (!(length_ > distance * (1.0 + 1e-14))) {
    length_ = distance;
    return;
  }
  straight_ = false;
  if (width_ <= 1e-12 * length_) {
    // The cable hangs straight down and up again.
    radius_ = 0.0;
    lowest_ = 0.5 * (length_ - rise_);
    return;
  }
  // ln(spare/width), exact also for a cable that is almost taut: spare^2 - width^2 = L^2 - d^2.
  const double excess = (length_ - distance) * (length_ + distance) / (width_ * width_);
  const double q = solve_shape(0.5 * std::log1p(excess));
  radius_ = 0.5 * width_ / q;
  lowest_ = 0.5 * (length_ - rise_ / std::tanh(q));
}

Vector3 Catenary::point(double s) const {
  if (!(s > 0.0)) return start_;
  if (s >= length_) return end_;
  const double share = s / length_;
  if (straight_) return start_ + (end_ - start_) * share;
  const double from = -lowest_;
  const double to = s - lowest_;
  const double z_from = std::hypot(radius_, from);
  const double z_to = std::hypot(radius_, to);
  // (z_to - z_from) in a form that loses no digits if the cable is nearly straight (a huge a).
  const double height = (to - from) * (to + from) / (z_to + z_from);
  double x = width_ * share;
  if (radius_ > 0.0) x = radius_ * asinh_difference(to / radius_, from / radius_);
  return start_ + across_ * x + up_ * height;
}

std::vector<Vector3> Catenary::points(int count) const {
  const int n = std::max(count, 2);
  std::vector<double> places;
  const int even = straight_ ? n : n / 2 + 1;
  for (int k = 0; k < even; ++k) places.push_back(length_ * k / (even - 1));
  const double from = std::atan2(-lowest_, radius_);
  const double to = std::atan2(length_ - lowest_, radius_);
  const int turning = n - even;
  for (int k = 1; k <= turning; ++k) {
    // With radius 0 all directions fall on the lowest point; the lowest point must be among the
    // places.
    const double angle = from + (to - from) * k / (turning + 1);
    places.push_back(std::clamp(lowest_ + radius_ * std::tan(angle), 0.0, length_));
  }
  std::sort(places.begin(), places.end());
  std::vector<Vector3> result;
  result.reserve(places.size());
  for (const double s : places) result.push_back(point(s));
  return result;
}

}  // namespace sheave::render
