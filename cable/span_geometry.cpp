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

}  // namespace

SpanGeometry spatial_span(const LinkCircle& first, const LinkCircle& second) {
  // Each round shrinks the error by about (r1/d)(r2/d) < 1, so 200 rounds reach rounding unless the
  // wheels almost touch; the tolerance is relative to the wheels.
  constexpr int max_rounds = 200;
  constexpr double tolerance = 1e-15;
  Vector3 start = first.center;
  Vector3 end = second.center;
  bool has_tangent = true;
  const bool both = first.signed_radius != 0.0 && second.signed_radius != 0.0;
  const double size = std::max(std::abs(first.signed_radius), std::abs(second.signed_radius));
  bool converged = false;
  for (int round = 0; round < max_rounds && !converged; ++round) {
    const Vector3 last_start = start;
    const Vector3 last_end = end;
    if (first.signed_radius != 0.0) has_tangent = tangent_point(first, end, false, start);
    if (second.signed_radius != 0.0) {
      const bool second_tangent = tangent_point(second, start, true, end);
      has_tangent = has_tangent && second_tangent;
    }
    const double change = std::max((start - last_start).norm(), (end - last_end).norm());
    converged = !both || change <= 4.0 * tolerance * (size + (end - start).norm());
  }
  SpanGeometry span = straight_span(start, end);
  span.has_tangent = has_tangent;
  if (!has_tangent) span.length = 0.0;
  return span;
}

}  // namespace sheave
