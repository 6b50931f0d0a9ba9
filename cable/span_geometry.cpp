#include "cable/span_geometry.h"

#include <algorithm>

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

/// The two ends as angles on their circles; refines them by Newton's method on the tangency
/// conditions G1 = e1.(a2 - c1) - r1 and G2 = e2.(a1 - c2) - r2 (matrix: cable/span_row.h).
class TangencySolver {
 public:
  TangencySolver(const LinkCircle& first, const LinkCircle& second)
      : first_(first),
        second_(second),
        r1_(std::abs(first.signed_radius)),
        r2_(std::abs(second.signed_radius)) {}

  /// Moves `start` and `end` to a solution; false if there is none near them that runs the way the
  /// windings ask for.
  bool refine(Vector3& start, Vector3& end) const {
    constexpr int max_rounds = 30;
    Vector3 e1 = (start - first_.center) / r1_;
    Vector3 e2 = (end - second_.center) / r2_;
    for (int round = 0; round < max_rounds; ++round) {
      const Vector3 to_end = end - first_.center;
      const Vector3 to_start = start - second_.center;
      const double g1 = e1.dot(to_end) - r1_;
      const double g2 = e2.dot(to_start) - r2_;
      if (std::max(std::abs(g1), std::abs(g2)) <= tolerance * (to_end.norm() + to_start.norm())) {
        return runs_along(start, end, e1, e2);
      }
      const Vector3 t1 = first_.normal.cross(e1);
      const Vector3 t2 = second_.normal.cross(e2);
      const double a = t1.dot(to_end);
      const double b = r2_ * e1.dot(t2);
      const double c = r1_ * e2.dot(t1);
      const double d = t2.dot(to_start);
      const double determinant = a * d - b * c;
      if (determinant == 0.0) return false;
      // Half a radian at most, so that a nearly singular step cannot jump to the other tangent.
      const auto limited = [](double angle) { return std::clamp(angle, -0.5, 0.5); };
      e1 = rotation_by(limited((b * g2 - d * g1) / determinant) * first_.normal) * e1;
      e2 = rotation_by(limited((c * g1 - a * g2) / determinant) * second_.normal) * e2;
      start = first_.center + r1_ * e1;
      end = second_.center + r2_ * e2;
    }
    return false;
  }

 private:
  static constexpr double tolerance = 1e-14;

  [[nodiscard]] bool runs_along(const Vector3& start, const Vector3& end, const Vector3& e1,
                                const Vector3& e2) const {
    const Vector3 direction = end - start;
    return first_.signed_radius * direction.dot(first_.normal.cross(e1)) >= 0.0 &&
           second_.signed_radius * direction.dot(second_.normal.cross(e2)) >= 0.0;
  }

  const LinkCircle& first_;
  const LinkCircle& second_;
  double r1_;
  double r2_;
};

}  // namespace

SpanGeometry spatial_span(const LinkCircle& first, const LinkCircle& second) {
  // Each round shrinks the error by about (r1/d)(r2/d); where that is slow, or where the rounds
  // circle round the solution, Newton's method takes over.
  constexpr int max_rounds = 30;
  constexpr double tolerance = 4e-15;
  Vector3 start = first.center;
  Vector3 end = second.center;
  bool first_tangent = true;
  bool second_tangent = true;
  const bool both = first.signed_radius != 0.0 && second.signed_radius != 0.0;
  const double size = std::max(std::abs(first.signed_radius), std::abs(second.signed_radius));
  bool converged = false;
  for (int round = 0; round < max_rounds && !converged; ++round) {
    const Vector3 last_start = start;
    const Vector3 last_end = end;
    if (first.signed_radius != 0.0) first_tangent = tangent_point(first, end, false, start);
    if (second.signed_radius != 0.0) second_tangent = tangent_point(second, start, true, end);
    const double change = std::max((start - last_start).norm(), (end - last_end).norm());
    converged = !both || change <= tolerance * (size + (end - start).norm());
  }
  bool has_tangent = first_tangent && second_tangent;
  // Small changes do not mean a small error where the rounds converge slowly, so look at it.
  const double residual =
      both ? std::abs((start - first.center).dot(end - first.center) / first.signed_radius -
                      first.signed_radius)
           : 0.0;
  if (!converged || (has_tangent && residual > tolerance * (size + (end - start).norm()))) {
    Vector3 refined_start = start;
    Vector3 refined_end = end;
    has_tangent = TangencySolver(first, second).refine(refined_start, refined_end);
    if (has_tangent) {
      start = refined_start;
      end = refined_end;
    }
  }
  // Without a tangent the span is the straight line between the points of the rims that the last
  // round left, which is where the tangent's ends go as it ceases to exist.
  SpanGeometry span = straight_span(start, end);
  span.has_tangent = has_tangent;
  return span;
}

}  // namespace sheave
