#include "cable/span_geometry.h"

#include <algorithm>
#include <limits>

namespace sheave {
namespace {

/// Where a cable that runs from `circle` to the point `target` leaves the circle (or, with
/// `incoming`, where one that comes from there meets it). False if the target, seen along the
/// normal, is not outside the circle.
bool tangent_point(const LinkCircle& circle, const Vector3& target, bool incoming, Vector3& point) {
  const double off_plane = circle.normal.dot(target - circle.center);
  const Vector3 projected = target - off_plane * circle.normal;
  const SpanGeometry span =
      incoming ? planar_span(projected, 0.0, circle.center, circle.signed_radius, circle.normal)
               : planar_span(circle.center, circle.signed_radius, projected, 0.0, circle.normal);
  point = incoming ? span.end : span.start;
  return span.has_tangent;
}

/// An end on its circle: `radial` from the centre to the tangent point and `tangent`
/// counter-clockwise along the circle, unit vectors in its plane.
struct RimPoint {
  Vector3 radial;
  Vector3 tangent;

  /// The point of the circle that is nearest to the direction of `radial`.
  void settle(const Vector3& normal) {
    tangent = cross(normal, radial);
    tangent *= 1.0 / std::sqrt(dot(tangent, tangent));
    radial = cross(tangent, normal);
  }
};

/// How far Newton's method may go.
struct NewtonLimits {
  int rounds;
  double step;  ///< of an end in one round [rad]
  /// Of the share of an error that solving for the ends in turn leaves per round: below 1 that
  /// would find this solution.
  double contraction;
  /// Whether a longer step tells that there is no solution near; otherwise it is shortened
  bool from_near;
};
/// From anywhere near: the ends have been solved for in turn before.
constexpr NewtonLimits anywhere{30, 0.5, std::numeric_limits<double>::infinity(), false};
/// From where the span was: only to the solution that the search from anywhere would find, too.
constexpr NewtonLimits nearby{6, 0.1, 0.5, true};

/// Newton's method on the tangency conditions G1 = e1.(a2 - c1) - r1 and G2 = e2.(a1 - c2) - r2
/// (matrix: cable/span_row.h). Moves `start` and `end` to a solution; false if there is none near
/// them that runs the way the windings ask for.
bool refine_tangents(const LinkCircle& first, const LinkCircle& second, const NewtonLimits& limits,
                     Vector3& start, Vector3& end) {
  constexpr double tolerance = 1e-14;
  // The step after one of this size is smaller than rounding.
  constexpr double last_step = 3e-8;
  const double r1 = std::abs(first.signed_radius);
  const double r2 = std::abs(second.signed_radius);
  RimPoint rim1{start - first.center, {}};
  RimPoint rim2{end - second.center, {}};
  bool solved = false;
  for (int round = 0; round <= limits.rounds; ++round) {
    rim1.settle(first.normal);
    rim2.settle(second.normal);
    start = sum(first.center, r1, rim1.radial);
    end = sum(second.center, r2, rim2.radial);
    if (solved) break;
    const Vector3 to_end = end - first.center;
    const Vector3 to_start = start - second.center;
    const double g1 = dot(rim1.radial, to_end) - r1;
    const double g2 = dot(rim2.radial, to_start) - r2;
    const double a = dot(rim1.tangent, to_end);
    const double b = r2 * dot(rim1.radial, rim2.tangent);
    const double c = r1 * dot(rim2.radial, rim1.tangent);
    const double d = dot(rim2.tangent, to_start);
    const double determinant = a * d - b * c;
    if (std::abs(b * c) > limits.contraction * std::abs(a * d)) return false;
    const double largest = std::max(std::abs(g1), std::abs(g2));
    const double size_squared = dot(to_end, to_end) + dot(to_start, to_start);
    if (largest * largest <= tolerance * tolerance * size_squared) {
      solved = true;
      break;
    }
    if (!(std::abs(determinant) > 0.0)) return false;
    const double step1 = (b * g2 - d * g1) / determinant;
    const double step2 = (c * g1 - a * g2) / determinant;
    const double larger = std::max(std::abs(step1), std::abs(step2));
    solved = larger <= last_step;
    if (larger > limits.step && limits.from_near) return false;
    // No more, so that a nearly singular step cannot jump to the other tangent.
    rim1.radial = sum(rim1.radial, std::clamp(step1, -limits.step, limits.step), rim1.tangent);
    rim2.radial = sum(rim2.radial, std::clamp(step2, -limits.step, limits.step), rim2.tangent);
  }
  const Vector3 direction = end - start;
  return solved && first.signed_radius * dot(direction, rim1.tangent) >= 0.0 &&
         second.signed_radius * dot(direction, rim2.tangent) >= 0.0;
}

/// What the last round left where there is no tangent: the straight line between the points of the
/// rims, which is where the tangent's ends go as it ceases to exist.
SpanGeometry line_between(const Vector3& start, const Vector3& end, bool has_tangent) {
  SpanGeometry span = straight_span(start, end);
  span.has_tangent = has_tangent;
  return span;
}

/// The span between two circles, neither of which is a point.
SpanGeometry span_of_circles(const LinkCircle& first, const LinkCircle& second) {
  // Each round shrinks the error by about (r1/d)(r2/d); once it is small, or where the rounds
  // circle round the solution, Newton's method takes over.
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
    // Small changes do not mean a small error where the rounds converge slowly, but there Newton's
    // method has been tried.
    if (change <= tolerance * allowed) {
      return line_between(start, end, both);
    }
  }
  Vector3 refined_start = start;
  Vector3 refined_end = end;
  if (refine_tangents(first, second, anywhere, refined_start, refined_end)) {
    return line_between(refined_start, refined_end, true);
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
  // Circles that overlap may have several tangents, or one that the search from anywhere does not
  // find; which one counts must not depend on where the span was.
  const double reach = std::abs(first.signed_radius) + std::abs(second.signed_radius);
  const Vector3 apart = second.center - first.center;
  if (guess != nullptr && dot(apart, apart) > reach * reach) {
    start = guess->start;
    end = guess->end;
    if (refine_tangents(first, second, nearby, start, end)) {
      return line_between(start, end, true);
    }
  }
  return span_of_circles(first, second);
}

}  // namespace sheave
