#include "cable/damped_tension.h"

#include <algorithm>

#include "engine/index.h"

namespace sheave {
namespace {

/// Velocity [m/s] of the point of the link's body that is at `point`. The world stands behind the
/// last body.
Vector3 material_velocity(const LinkGeometry& link, const Vector3& point,
                          std::span<const BodyState> bodies) {
  if (at(link.body) >= bodies.size()) return Vector3::Zero();
  const BodyState& body = bodies[at(link.body)];
  return body.velocity + cross(body.angular_velocity, point - body.position);
}

}  // namespace

std::optional<double> damped_tension(const DampedSpan& damped, const SpanGeometry& geometry,
                                     const LinkGeometry& first, const LinkGeometry& second,
                                     std::span<const BodyState> bodies) {
  if (!geometry.has_tangent) return std::nullopt;
  for (const LinkGeometry* link : {&first, &second}) {
    if (link->passes() || link->feeds || link->geodesic) return std::nullopt;
    if (damped.material && link->wraps()) return std::nullopt;
  }
  if (!(damped.stretch > 0.0)) return 0.0;
  const double rate = dot(geometry.direction, material_velocity(second, geometry.end, bodies) -
                                                  material_velocity(first, geometry.start, bodies));
  return std::max(0.0, damped.spring + damped.damping * rate);
}

}  // namespace sheave
