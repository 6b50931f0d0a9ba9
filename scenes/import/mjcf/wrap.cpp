#include "scenes/import/mjcf/wrap.h"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave::import::mjcf {
namespace {

using Vector2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;

double cross2(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Angle at the centre between a point outside a circle and its tangent point.
double tangent_angle(const Vector2& point, double radius) {
  return portable::atan2(std::sqrt(std::max(point.squaredNorm() - radius * radius, 0.0)), radius);
}

/// The way round a circle about the origin in one sense.
struct Round {
  double arc = 0.0;  ///< angle on the circle, < 2 pi; < 0: the tangents cross, so there is no way
  Vector2 middle = Vector2::Zero();
};

Round round_way(const Vector2& from, const Vector2& to, double radius, bool counter_clockwise) {
  const double sense = counter_clockwise ? 1.0 : -1.0;
  double between = sense * portable::atan2(cross2(from, to), from.dot(to));
  if (between < 0.0) between += 2.0 * pi;
  const double lost = tangent_angle(from, radius) + tangent_angle(to, radius);
  Round way;
  way.arc = between - lost;
  const double start = portable::atan2(from.y(), from.x()) + sense * tangent_angle(from, radius);
  const double half = start + sense * 0.5 * way.arc;
  way.middle = Vector2(portable::cos(half), portable::sin(half));
  return way;
}

/// The coordinates across and along an axis in which the way is drawn.
struct Plane {
  Vector3 x = Vector3::UnitX();
  Vector3 y = Vector3::UnitY();
  Vector3 normal = Vector3::UnitZ();

  [[nodiscard]] Vector2 of(const Vector3& point) const { return {x.dot(point), y.dot(point)}; }
};

Plane plane_of(const Geom& geom, const Vector3& from, const Vector3& to) {
  Plane plane;
  if (geom.type == GeomType::cylinder) return plane;
  const Vector3 across = from.cross(to);
  // Sites in line with the centre: any plane through them is as good.
  plane.normal = across.norm() > 1e-12 * from.norm() * to.norm() ? Vector3(across.normalized())
                                                                 : from.unitOrthogonal();
  plane.x = from.normalized();
  plane.y = plane.normal.cross(plane.x);
  return plane;
}

Wrap over_round(const Geom& geom, const Vector3& from, const Vector3& to,
                const std::optional<Vector3>& side) {
  const double radius = geom.size[0];
  Wrap wrap;
  wrap.before = (to - from).norm();
  const Plane plane = plane_of(geom, from, to);
  const Vector2 p = plane.of(from);
  const Vector2 q = plane.of(to);
  wrap.normal = plane.normal;
  wrap.counter_clockwise = cross2(p, q) >= 0.0;
  wrap.inside = p.norm() <= radius || q.norm() <= radius;
  const Vector2 way = q - p;
  if (wrap.inside || !(way.squaredNorm() > 1e-30)) return wrap;
  const Vector2 nearest = p + std::clamp(-p.dot(way) / way.squaredNorm(), 0.0, 1.0) * way;
  const Vector2 towards = side ? plane.of(*side) : Vector2(Vector2::Zero());
  if (nearest.norm() > radius && (!side || nearest.dot(towards) >= 0.0)) return wrap;
  if (side) {
    const Round ccw = round_way(p, q, radius, true);
    const Round cw = round_way(p, q, radius, false);
    wrap.counter_clockwise =
        cw.arc < 0.0 || (ccw.arc >= 0.0 && ccw.middle.dot(towards) > cw.middle.dot(towards));
  }
  const Round round = round_way(p, q, radius, wrap.counter_clockwise);
  if (round.arc < 0.0) return wrap;
  const double first = std::sqrt(std::max(p.squaredNorm() - radius * radius, 0.0));
  const double last = std::sqrt(std::max(q.squaredNorm() - radius * radius, 0.0));
  const double on = radius * round.arc;
  // On a cylinder the way rises evenly along its unrolled length.
  const double rise = geom.type == GeomType::cylinder ? to.z() - from.z() : 0.0;
  const double flat = first + on + last;
  const double slope = portable::hypot(1.0, rise / flat);
  wrap.touches = true;
  wrap.angle = round.arc;
  wrap.before = slope * first;
  wrap.on = slope * on;
  wrap.after = slope * last;
  const double sense = wrap.counter_clockwise ? 1.0 : -1.0;
  const double begin = portable::atan2(p.y(), p.x()) + sense * tangent_angle(p, radius);
  const auto on_circle = [&](double angle) -> Vector3 {
    return radius * (portable::cos(angle) * plane.x + portable::sin(angle) * plane.y);
  };
  wrap.arrives = on_circle(begin);
  wrap.leaves = on_circle(begin + sense * round.arc);
  if (geom.type == GeomType::cylinder) {
    wrap.arrives.z() = from.z() + rise * first / flat;
    wrap.leaves.z() = from.z() + rise * (first + on) / flat;
    wrap.height = std::max(std::abs(wrap.arrives.z()), std::abs(wrap.leaves.z()));
  }
  return wrap;
}

Wrap over_ellipsoid(const Geom& geom, const Vector3& from, const Vector3& to,
                    const std::optional<Vector3>& side) {
  const Vector3 scale = geom.size.cwiseInverse();
  const auto scaled = [&](const Vector3& point) -> Vector3 { return scale.cwiseProduct(point); };
  Geom ball = geom;
  ball.type = GeomType::sphere;
  ball.size = Vector3::Ones();
  Wrap wrap = over_round(ball, scaled(from), scaled(to),
                         side ? std::optional<Vector3>(scaled(*side)) : std::nullopt);
  wrap.normal = scaled(wrap.normal).normalized();
  wrap.before = (to - from).norm();
  if (!wrap.touches) return wrap;
  wrap.arrives = wrap.arrives.cwiseProduct(geom.size);
  wrap.leaves = wrap.leaves.cwiseProduct(geom.size);
  wrap.before = (wrap.arrives - from).norm();
  wrap.after = (to - wrap.leaves).norm();
  wrap.on = wrap.angle * geom.size.mean();
  return wrap;
}

}  // namespace

Wrap wrap_over(const Geom& geom, const Vector3& from, const Vector3& to,
               const std::optional<Vector3>& side) {
  return geom.type == GeomType::ellipsoid ? over_ellipsoid(geom, from, to, side)
                                          : over_round(geom, from, to, side);
}

std::vector<Wrap> wrap_over_all(std::span<const Obstacle> obstacles, const Vector3& from,
                                const Vector3& to) {
  std::vector<Wrap> wraps(obstacles.size());
  // Each way ends where its neighbours begin, which moves less from round to round.
  constexpr int most_rounds = 100;
  for (int round = 0; round < most_rounds; ++round) {
    double moved = 0.0;
    Vector3 before = from;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      const Frame& frame = obstacles[k].frame;
      const auto own = [&](const Vector3& world) -> Vector3 {
        return frame.orientation.conjugate() * (world - frame.position);
      };
      Vector3 after = to;
      for (std::size_t next = obstacles.size(); next-- > k + 1;) {
        if (wraps[next].touches) after = obstacles[next].frame.point(wraps[next].arrives);
      }
      const Wrap old = wraps[k];
      wraps[k] = wrap_over(*obstacles[k].geom, own(before), own(after), obstacles[k].side);
      moved += old.touches == wraps[k].touches ? 0.0 : 1.0;
      moved += (old.arrives - wraps[k].arrives).norm() + (old.leaves - wraps[k].leaves).norm();
      if (wraps[k].touches) before = frame.point(wraps[k].leaves);
    }
    if (obstacles.size() == 1 || moved < 1e-14) break;
  }
  return wraps;
}

}  // namespace sheave::import::mjcf
