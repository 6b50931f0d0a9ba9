#include "cable/span_geometry.h"

#include <algorithm>
#include <limits>

namespace sheave {
namespace {

/// The point where a cable from `circle` to the point `target` leaves the circle, or, with
/// `incoming`, where a cable from `target` meets it. False if the groove cannot hold such a rope;
/// `point` is then the limit at the bound of the held range.
bool tangent_point(const LinkCircle& circle, const Vector3& target, bool incoming, Vector3& point) {
  const double off_plane = circle.normal.dot(target - circle.center);
  const Vector3 projected = target - off_plane * circle.normal;
  double radius = circle.signed_radius;
  bool held = true;
  if (off_plane != 0.0) {
    const double distance_squared = (projected - circle.center).squaredNorm();
    const double planar = distance_squared - radius * radius;
    const double across = 2.0 * radius * off_plane;
    const double discriminant = planar * planar - across * across;
    held = planar > 0.0 && discriminant >= 0.0;
    const double seen_squared =
        0.5 * (std::max(planar, 0.0) + std::sqrt(std::max(discriminant, 0.0)));
    radius = held
                 ? radius * std::sqrt(1.0 + off_plane * off_plane / seen_squared)
                 : std::copysign(std::sqrt(distance_squared - 0.5 * std::max(planar, 0.0)), radius);
  }
  const SpanGeometry span = incoming
                                ? planar_span(projected, 0.0, circle.center, radius, circle.normal)
                                : planar_span(circle.center, radius, projected, 0.0, circle.normal);
  point = incoming ? span.end : span.start;
  return held && span.has_tangent;
}

/// Limits of Newton's method.
struct NewtonLimits {
  int rounds;
  double step;  ///< largest change of the direction in a round [rad]
  /// Largest contraction factor of the iteration that takes the direction from its own ends. Below
  /// 1 that iteration would find the same solution.
  double contraction;
  /// Whether a longer step means that there is no solution near; otherwise the step is shortened.
  bool from_near;
};
/// From anywhere near a solution: the ends have been solved for in turn before.
constexpr NewtonLimits anywhere{30, 0.5, std::numeric_limits<double>::infinity(), false};
/// From the last span, or from that in one plane: accepts only the solution that the search from
/// anywhere would find, too.
constexpr NewtonLimits nearby{6, 0.1, 0.5, true};

/// The arm from a wheel's centre to the point where a rope of the direction u leaves the wheel [m].
struct RimArm {
  double radius;     ///< q / cos^2 b [m]
  double lean;       ///< n.u
  double share;      ///< cos^2 b
  Vector3 outwards;  ///< u x n
  Vector3 normal;

  RimArm(const LinkCircle& circle, const Vector3& u)
      : lean(dot(circle.normal, u)),
        share(1.0 - lean * lean),
        outwards(cross(u, circle.normal)),
        normal(circle.normal) {
    radius = circle.signed_radius / share;
  }
  [[nodiscard, gnu::always_inline]] Vector3 arm() const { return radius * outwards; }
  /// Derivative of arm() when u changes along the unit vector s.
  [[nodiscard, gnu::always_inline]] Vector3 moved(const Vector3& s) const {
    return radius * (cross(s, normal) + (2.0 * lean * dot(normal, s) / share) * outwards);
  }
};

/// Newton's method on u = (a2(u) - a1(u)) / l. Moves `start` and `end` to a solution; false if
/// there is none near them.
bool refine_tangents(const LinkCircle& first, const LinkCircle& second, const NewtonLimits& limits,
                     Vector3& start, Vector3& end) {
  constexpr double tolerance = 1e-15;
  // Newton's method converges quadratically: the step after one of this size is below rounding.
  constexpr double last_step = 3e-8;
  const Vector3 apart = second.center - first.center;
  const double size =
      std::sqrt(dot(apart, apart)) + std::abs(first.signed_radius) + std::abs(second.signed_radius);
  Vector3 u = end - start;
  bool solved = false;
  for (int round = 0; round <= limits.rounds; ++round) {
    u *= 1.0 / std::sqrt(dot(u, u));
    const RimArm arm1(first, u);
    const RimArm arm2(second, u);
    start = first.center + arm1.arm();
    end = second.center + arm2.arm();
    const Vector3 line = end - start;
    const double length = dot(line, u);
    // A direction along an axle has no solution. The comparisons also refuse NaN.
    if (!(length > 0.0) || !(arm1.share > 0.0) || !(arm2.share > 0.0)) return false;
    const Vector3 s1 = any_perpendicular(u);
    const Vector3 s2 = cross(u, s1);
    const double f1 = dot(s1, line);
    const double f2 = dot(s2, line);
    // The residual decides, not the step: if the ends depend hardly or very strongly on u, a step
    // is short anywhere.
    const double off = std::abs(f1) + std::abs(f2);
    if (off <= tolerance * size || (solved && off <= 1e3 * tolerance * size)) return true;
    const Vector3 moved1 = arm2.moved(s1) - arm1.moved(s1);
    const Vector3 moved2 = arm2.moved(s2) - arm1.moved(s2);
    const double m11 = dot(s1, moved1);
    const double m12 = dot(s1, moved2);
    const double m21 = dot(s2, moved1);
    const double m22 = dot(s2, moved2);
    const double sizes = m11 * m11 + m12 * m12 + m21 * m21 + m22 * m22;
    if (sizes > limits.contraction * limits.contraction * length * length) return false;
    const double a = m11 - length;
    const double d = m22 - length;
    const double determinant = a * d - m12 * m21;
    if (!(std::abs(determinant) > 0.0)) return false;
    double step1 = (m12 * f2 - d * f1) / determinant;
    double step2 = (m21 * f1 - a * f2) / determinant;
    const double larger = std::max(std::abs(step1), std::abs(step2));
    solved = larger <= last_step;
    if (larger > limits.step) {
      if (limits.from_near) return false;
      // The limit keeps a nearly singular step from a jump to another solution.
      step1 *= limits.step / larger;
      step2 *= limits.step / larger;
    }
    u += step1 * s1 + step2 * s2;
  }
  return false;
}

/// The straight line between two ends: those of a tangent, or those of the last round if there is
/// no tangent.
SpanGeometry line_between(const Vector3& start, const Vector3& end, bool has_tangent) {
  SpanGeometry span = straight_span(start, end);
  span.has_tangent = has_tangent;
  return span;
}

/// The span between two circles, neither of which is a point.
SpanGeometry span_of_circles(const LinkCircle& first, const LinkCircle& second) {
  // Each round reduces the error by a factor of about (r1/d)(r2/d). Newton's method takes over when
  // the error is small, or if the rounds circle around the solution.
  constexpr int max_rounds = 30;
  constexpr double tolerance = 4e-15;
  constexpr double near = 0.02;
  Vector3 start = first.center;
  Vector3 end = second.center;
  const double size = std::max(std::abs(first.signed_radius), std::abs(second.signed_radius));
  bool tried = false;
  for (int round = 0; round < max_rounds; ++round) {
    const Vector3 last_start = start;
    const Vector3 last_end = end;
    const bool first_tangent = tangent_point(first, end, false, start);
    const bool second_tangent = tangent_point(second, start, true, end);
    const double change = std::max((start - last_start).norm(), (end - last_end).norm());
    const double allowed = size + (end - start).norm();
    const bool both = first_tangent && second_tangent;
    if (both && !tried && change <= near * size) {
      tried = true;
      Vector3 refined_start = start;
      Vector3 refined_end = end;
      if (refine_tangents(first, second, anywhere, refined_start, refined_end)) {
        return line_between(refined_start, refined_end, true);
      }
    }
    // If the rounds converge slowly, small changes do not imply a small error; but then Newton's
    // method has already been tried.
    if (change <= tolerance * allowed) {
      if (both) return line_between(start, end, true);
      break;
    }
  }
  // If the span leans far, an end may have no tangent for the present position of the other end,
  // although both ends together have one.
  for (const bool from_centers : {false, true}) {
    Vector3 refined_start = from_centers ? first.center : start;
    Vector3 refined_end = from_centers ? second.center : end;
    if (refine_tangents(first, second, anywhere, refined_start, refined_end)) {
      return line_between(refined_start, refined_end, true);
    }
  }
  return line_between(start, end, false);
}

}  // namespace

SpanGeometry spatial_span(const LinkCircle& first, const LinkCircle& second,
                          const SpanGuess* guess) {
  const bool first_is_point = first.signed_radius == 0.0;
  const bool second_is_point = second.signed_radius == 0.0;
  Vector3 start = first.center;
  Vector3 end = second.center;
  if (first_is_point || second_is_point) {
    bool has_tangent = true;
    if (!first_is_point) has_tangent = tangent_point(first, end, false, start);
    if (!second_is_point) has_tangent = tangent_point(second, start, true, end);
    return line_between(start, end, has_tangent);
  }
  // Overlapping circles may have several tangents, or one that the search from anywhere does not
  // find. No guess is used for them, because the result must not depend on the earlier span. The
  // first guess is the tangent of circles in one plane.
  const double reach = std::abs(first.signed_radius) + std::abs(second.signed_radius);
  const Vector3 apart = second.center - first.center;
  if (dot(apart, apart) > reach * reach) {
    if (guess != nullptr) {
      start = guess->start;
      end = guess->end;
    } else {
      const double sense = dot(first.normal, second.normal) < 0.0 ? -1.0 : 1.0;
      const SpanGeometry flat = planar_span(first.center, first.signed_radius, second.center,
                                            sense * second.signed_radius, first.normal);
      start = flat.start;
      end = flat.end;
    }
    if (refine_tangents(first, second, nearby, start, end)) {
      return line_between(start, end, true);
    }
  }
  return span_of_circles(first, second);
}

}  // namespace sheave
