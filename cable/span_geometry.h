#pragma once
// The free span between two links: the points where it leaves the first and meets the second.
//
// Coplanar circles (design 5.1). With signed radii q (> 0: the cable runs counter-clockwise round
// the circle, seen against the plane normal n; 0: a point), D = p2 - p1, d = |D|, q = q2 - q1, the
// tangent has the length l = sqrt(d^2 - q^2) and the unit direction
//   u = D/d turned by -b about n, sin b = q/d:   u = (l D - q n x D) / d^2,
// and its ends are a_i = p_i - q_i n x u. These formulas cover points and all four common tangents
// without branches or inverse trigonometry. There is no tangent for d <= |q| (nested circles, or
// the crossing tangent of overlapping ones); the length is then 0, and u is the limit direction,
// -sign(q) n x D / d.
//
// Circles in different planes. A wheel without friction on the rope's sides is a surface of
// revolution, so it exerts no moment about its axle on rope at rest in its groove. The rope
// therefore leaves with the moment that it has in the groove: per unit of tension the line of the
// span has the moment q about the axle, whatever its lean b out of the wheel's plane (Clairaut's
// law). The rope leaves in the wheel's plane, perpendicular to the radius there, and so at the
// radius |q| / cos b: it has climbed the groove's flank by the difference. With the unit direction
// u of the span and cos^2 b = 1 - (n.u)^2,
//   a_i = c_i + q_i u x n_i / cos^2 b_i,   u = (a_2 - a_1) / l.
// In one plane these ends are those of the tangent above. With these ends the length arc + span is
// stationary: for the angle f of the end about the axle u.da = q df holds for any motion. So only
// the motion of the bodies' material counts (cable/span_row.h), and a span exerts only a pull along
// itself. (In section 3.4 of the paper the span leaves at |q| itself. Such lines have the moment q
// cos b; the missing moment would need a transverse force at the span's other end, which no rope
// exerts.)
//
// From a circle to a point at the distance d from the axle and z from the plane, m = l cos b solves
// m^4 - (d^2 - q^2) m^2 + q^2 z^2 = 0; the rope leaves on the branch that is the tangent at z = 0.
// There is no solution for |z| > (d^2 - q^2) / 2 |q|: no depth of groove holds a rope with such a
// lean. Between two circles the ends are computed in turn, each for the present position of the
// other, from any start. Newton's method for u finishes the computation; it can also begin at the
// span of a moment ago.

#include "engine/math/portable.h"
#include "engine/vector.h"

namespace sheave {

/// A circle in the world frame; signed_radius 0 is a point and has no normal.
struct LinkCircle {
  Vector3 center = Vector3::Zero();   ///< [m]
  Vector3 normal = Vector3::UnitZ();  ///< unit normal of its plane
  double signed_radius = 0.0;         ///< [m]
};

/// A span as geometry.
struct SpanGeometry {
  Vector3 start = Vector3::Zero();      ///< where it leaves the first link [m]
  Vector3 end = Vector3::Zero();        ///< where it meets the second link [m]
  Vector3 direction = Vector3::Zero();  ///< unit vector from start to end; 0 if they coincide
  double length = 0.0;                  ///< [m]
  bool has_tangent = true;              ///< false: the fallback of the head of this file
  int first_corner = 0;  ///< corner of the first link's outline where the span leaves it
  int second_corner = 0;
};

/// Approximate positions of the ends of a span.
struct SpanGuess {
  Vector3 start = Vector3::Zero();  ///< [m]
  Vector3 end = Vector3::Zero();    ///< [m]
};

/// The span between two points.
[[nodiscard, gnu::always_inline]] inline SpanGeometry straight_span(const Vector3& start,
                                                                    const Vector3& end) {
  SpanGeometry span{start, end, end - start, 0.0, true};
  span.length = span.direction.norm();
  if (span.length > 0.0) span.direction /= span.length;
  return span;
}

/// The span between two coplanar circles with the common unit normal `normal`.
[[nodiscard, gnu::always_inline]] inline SpanGeometry planar_span(const Vector3& center1,
                                                                  double signed_radius1,
                                                                  const Vector3& center2,
                                                                  double signed_radius2,
                                                                  const Vector3& normal) {
  SpanGeometry span;
  const Vector3 apart = center2 - center1;
  const Vector3 across = cross(normal, apart);
  const double difference = signed_radius2 - signed_radius1;
  const double distance_squared = dot(apart, apart);
  const double length_squared = distance_squared - difference * difference;
  if (length_squared > 0.0) {
    span.length = std::sqrt(length_squared);
    const double scale = 1.0 / distance_squared;
    span.direction = sum(span.length * scale * apart, -difference * scale, across);
  } else {
    // Touching circles have a tangent of length 0, up to rounding.
    constexpr double rounding = 1e-14;
    span.has_tangent = length_squared >= -rounding * difference * difference;
    if (distance_squared > 0.0) {
      span.direction = across * ((difference > 0.0 ? -1.0 : 1.0) / std::sqrt(distance_squared));
    }
  }
  const Vector3 left = cross(normal, span.direction);
  span.start = sum(center1, -signed_radius1, left);
  span.end = sum(center2, -signed_radius2, left);
  return span;
}

/// The span between two circles in any planes; points may take either place. `guess` is a span
/// between the same links a moment ago. A guess shortens the search; with or without one the
/// results agree to rounding. Null: no guess.
[[nodiscard]] SpanGeometry spatial_span(const LinkCircle& first, const LinkCircle& second,
                                        const SpanGuess* guess = nullptr);

/// The angle [rad, (-pi, pi]] with this sine and cosine. Small angles are the usual case between
/// two evaluations in one substep; the series of the arc sine gives them to full precision. Large
/// ones come from atan2.
[[nodiscard, gnu::always_inline]] inline double angle_of(double sine, double cosine) {
  const double s = sine * sine;
  if (s < 1e-3 && cosine > 0.0) {
    // The first omitted term is 63/2816 s^5 < 3e-17.
    return sine *
           (1.0 + s * (1.0 / 6.0 + s * (3.0 / 40.0 + s * (15.0 / 336.0 + s * (105.0 / 3456.0)))));
  }
  return portable::atan2(sine, cosine);
}

/// The angle from unit vector `from` to unit vector `to`, both perpendicular to the unit vector
/// `normal`, about it, in (-pi, pi].
[[nodiscard]] inline double angle_between(const Vector3& from, const Vector3& to,
                                          const Vector3& normal) {
  return angle_of(dot(normal, cross(from, to)), dot(from, to));
}

/// `angle` plus the multiple of 2 pi that brings it closest to `expected` [rad].
[[nodiscard]] inline double unwrapped(double angle, double expected) {
  if (std::abs(expected - angle) < pi) return angle;
  return angle + 2.0 * pi * std::round((expected - angle) / (2.0 * pi));
}

}  // namespace sheave
