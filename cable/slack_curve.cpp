// With s' = s - s0 measured from the lowest point and a the radius of curvature there, a catenary
// is
//   x = a asinh(s'/a),   z = sqrt(a^2 + s'^2).
// This form needs no cosh, so it cannot overflow however slack the cable is. For ends that are w
// apart horizontally and v vertically, and the length L:
//   sinh(q)/q = sqrt(L^2 - v^2)/w  with q = w/(2a)   (one equation for the shape),
//   s0 = (L - v coth q)/2                            (from z1^2 - z0^2 = s1'^2 - s0'^2).
//
// A rope with weight lies along its tension, whose horizontal part H is constant and whose vertical
// part v grows by the weight. With u = asinh(v/H) = asinh(s'/a) both curves are
//   x = a (u - u0),   z = a (cosh u - cosh u0).
//
// A polyline has equal steps of u on either side of the lowest point. The sagitta of a step is
// ds^2 / (8 rho) with ds = a cosh u du and rho = a cosh^2 u, so it is a du^2 / 8 everywhere.
#include "cable/slack_curve.h"

#include <algorithm>
#include <cmath>

namespace sheave {
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

SlackCurve::SlackCurve(const Vector3& start, const Vector3& end, double length,
                       const Vector3& gravity)
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
  from_ = std::asinh(-lowest_ / radius_);
  to_ = std::asinh((length_ - lowest_) / radius_);
}

Vector3 SlackCurve::point(double s) const {
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

SlackCurve SlackCurve::of_forces(const Vector3& start, const Vector3& end,
                                 const Vector3& start_force, const Vector3& end_force,
                                 double length) {
  SlackCurve curve;
  const Vector3 chord = end - start;
  const Vector3 load = start_force + end_force;
  const double weight = load.norm();
  curve.start_ = start;
  curve.end_ = end;
  curve.up_ = -load / weight;
  curve.straight_ = false;
  const double before = start_force.dot(curve.up_);
  const Vector3 level = start_force - curve.up_ * before;
  const double horizontal = level.norm();
  curve.rise_ = chord.dot(curve.up_);
  curve.width_ = (chord - curve.up_ * curve.rise_).norm();
  curve.length_ = length;
  curve.lowest_ = -length * before / weight;
  if (!(horizontal > 1e-12 * weight)) return curve;
  curve.across_ = level / horizontal;
  curve.from_ = std::asinh(before / horizontal);
  curve.to_ = std::asinh((before + weight) / horizontal);
  // The chord sets the size, because the forces do not tell the stretch.
  curve.radius_ = 1.0;
  const double unit = curve.at_parameter(curve.to_).norm();
  const double by_length = length * horizontal / weight;
  curve.radius_ = unit * by_length > 1e-6 * length ? chord.norm() / unit : by_length;
  return curve;
}

Vector3 SlackCurve::at_parameter(double u) const {
  // 2 sinh(m) sinh(d) is a difference of two cosh without cancellation.
  const double half = 0.5 * (u - from_);
  return across_ * (2.0 * radius_ * half) +
         up_ * (2.0 * radius_ * std::sinh(from_ + half) * std::sinh(half));
}

Vector3 SlackCurve::fold() const { return -up_ * std::clamp(lowest_, 0.0, length_); }

std::size_t SlackCurve::steps(double from, double to, double tolerance) const {
  // Half of the tolerance, because long steps deviate by more than their sagitta for small ones.
  const double wanted = std::ceil((to - from) * std::sqrt(radius_ / (4.0 * tolerance)));
  constexpr double most = 1000.0;
  return wanted < most ? static_cast<std::size_t>(std::max(wanted, 1.0)) : std::size_t{1000};
}

std::size_t SlackCurve::point_count(double tolerance) const {
  if (straight_) return 2;
  if (radius_ == 0.0) return lowest_ > 0.0 && lowest_ < length_ ? 3 : 2;
  if (from_ < 0.0 && to_ > 0.0)
    return steps(from_, 0.0, tolerance) + steps(0.0, to_, tolerance) + 1;
  return steps(from_, to_, tolerance) + 1;
}

void SlackCurve::write(double tolerance, std::span<Vector3> points) const {
  const std::size_t count = point_count(tolerance);
  const std::size_t last = count - 1;
  if (!points.empty()) points[0] = start_;
  if (points.size() > last) points[last] = end_;
  const bool folded = straight_ || radius_ == 0.0;
  if (folded && last == 2 && points.size() > 1) points[1] = start_ + fold();
  if (folded) return;
  // The rest is rounding, and the stretch of a rope with weight.
  const Vector3 rest = end_ - start_ - at_parameter(to_);
  const bool turns = from_ < 0.0 && to_ > 0.0;
  const std::size_t before = turns ? steps(from_, 0.0, tolerance) : last;
  const double middle = turns ? 0.0 : to_;
  for (std::size_t k = 1; k < std::min(last, points.size()); ++k) {
    const bool first = k <= before;
    const auto share = first ? static_cast<double>(k) / static_cast<double>(before)
                             : static_cast<double>(k - before) / static_cast<double>(last - before);
    const double u = first ? from_ + (middle - from_) * share : middle + (to_ - middle) * share;
    points[k] = start_ + at_parameter(u) + rest * ((u - from_) / (to_ - from_));
  }
}

}  // namespace sheave
