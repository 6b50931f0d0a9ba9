// The way of a cable through an opening, a ball or an endless cylinder B.
//
// The cable between the points a and b has the least length of all ways that pass B:
//
//   l(a, b) = min over p in B of |a - p| + |p - b|.
//
// |a - p| + |p - b| is convex in (a, p, b), and B is convex, so l is convex. If the straight line
// meets B, l = |a - b|, and any point p of the line in B will do. The middle of the part inside
// moves continuously with a and b. If the line misses B, the minimum is on the surface, and is the
// only one. There the gradient of the sum is along the normal: both spans make the same angle with
// it, as light does at a mirror. At the limit between both cases, a line that touches, the two
// points p are the same.
//
// By the envelope theorem the derivative of l does not contain that of p. The forces on a, on b and
// on the body at p are those of a rope through a hole at p. So the link is a pinhole whose place is
// a function of the positions. The place and the length have no memory, and no event separates the
// cases.
//
// The surface. In the plane of the centre, a and b (on a cylinder: seen along the axis), a and b
// have the distances A, B > r from the centre and the angle g < pi between them. From a point of
// the circle at the angle f from a, the point a is seen at the angle
//
//   i(A, f) = atan2(A sin f, A cos f - r)
//
// from the normal, which increases with f at the rate (A^2 - A r cos f) / |a - p|^2 > 0. So
//
//   i(A, f) - i(B, g - f) = 0
//
// has exactly one solution in [0, g]. Newton's method finds it between bounds that bisection
// narrows. A line that touches, i = pi / 2, is no special case. (MuJoCo solves an equation for
// the sine of i, whose slope is infinite there; it takes the middle direction where its own method
// does not begin.)
//
// On a cylinder the way rises evenly along its length in the plane: unrolled about the generatrix
// at p, it is a straight line.
//
// l has a kink where a itself comes through the surface and the way to b leads outwards, because
// then p meets a. On both sides of the surface the cable pulls a towards it.

#include "cable/opening.h"

#include <algorithm>
#include <cmath>

#include "cable/link_contact.h"
#include "cable/wrap_candidate.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// A point outside a circle as a point of the circle sees it.
struct Sight {
  double angle = 0.0;  ///< from the normal [rad]
  double rate = 0.0;   ///< its derivative by the angle at the centre
};

Sight sight_of(double distance, double radius, double angle) {
  const double across = distance * portable::sin(angle);
  const double along = distance * portable::cos(angle);
  const double outward = along - radius;
  const double square = across * across + outward * outward;
  if (!(square > 0.0)) return {};
  return {portable::atan2(across, outward),
          (distance * distance - distance * portable::cos(angle) * radius) / square};
}

/// Angle at the centre from the first point to the point of the circle at which the way turns.
double turning_angle(double first, double second, double radius, double between) {
  constexpr int most_rounds = 100;
  double low = 0.0;
  double high = between;
  // The image in a flat mirror is a guess.
  const double first_height = std::max(first - radius, 0.0);
  const double heights = first_height + std::max(second - radius, 0.0);
  double angle = heights > 0.0 ? between * first_height / heights : 0.5 * between;
  for (int round = 0; round < most_rounds; ++round) {
    const Sight from = sight_of(first, radius, angle);
    const Sight to = sight_of(second, radius, between - angle);
    const double off = from.angle - to.angle;
    if (off == 0.0) break;
    (off > 0.0 ? high : low) = angle;
    double next = angle - off / (from.rate + to.rate);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool settled = std::abs(next - angle) <= 1e-16 * between;
    angle = next;
    if (settled) break;
  }
  return angle;
}

/// The middle of the part of a line from p to p + way, 0 to 1, within the ball about the origin
/// that it meets.
double middle_inside(const Vector3& p, const Vector3& way, double radius) {
  const double square = way.squaredNorm();
  if (!(square > 0.0)) return 0.5;
  const double half = dot(p, way);
  const double root =
      std::sqrt(std::max(half * half - square * (p.squaredNorm() - radius * radius), 0.0));
  const double enters = std::clamp((-half - root) / square, 0.0, 1.0);
  const double leaves = std::clamp((-half + root) / square, 0.0, 1.0);
  return 0.5 * (enters + leaves);
}

}  // namespace

Vector3 opening_point(const SmoothSurface& surface, const Vector3& from, const Vector3& to) {
  const bool is_ball = surface.is_ball();
  const double radius = surface.radius;
  const auto across = [&](const Vector3& point) -> Vector3 {
    const Vector3 arm = point - surface.center;
    return is_ball ? arm : Vector3(arm - dot(surface.axis, arm) * surface.axis);
  };
  const Vector3 p = across(from);
  const Vector3 q = across(to);
  const Vector3 way = q - p;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp(-dot(p, way) / square, 0.0, 1.0) : 0.0;
  if ((p + share * way).norm() <= radius) {
    return from + middle_inside(p, way, radius) * (to - from);
  }
  const double between = portable::atan2(cross(p, q).norm(), dot(p, q));
  const double angle = turning_angle(p.norm(), q.norm(), radius, between);
  const Vector3 first = p.normalized();
  Vector3 second = q - dot(q, first) * first;
  const double size = second.norm();
  second = size > 0.0 ? Vector3(second / size) : Vector3(Vector3::Zero());
  const Vector3 turn = radius * (portable::cos(angle) * first + portable::sin(angle) * second);
  if (is_ball) return surface.center + turn;
  const double before = (turn - p).norm();
  const double whole = before + (q - turn).norm();
  const double rise = dot(surface.axis, to - from);
  const double height = surface.height(from) + (whole > 0.0 ? rise * before / whole : 0.5 * rise);
  return surface.center + turn + height * surface.axis;
}

void settle_opening(const Substep& substep, const LinkGeometry& before, const LinkGeometry& after,
                    LinkGeometry& opening) {
  const SmoothSurface surface = surface_now(substep, opening.carrier, *opening.opening);
  const Vector3 point =
      opening_point(surface, center_of(substep, before, 0), center_of(substep, after, 0));
  opening.center = substep.orientation(opening.carrier).conjugate() *
                   (point - substep.position(opening.carrier));
}

}  // namespace sheave
