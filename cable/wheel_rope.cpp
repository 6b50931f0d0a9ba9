#include "cable/wheel_rope.h"

#include <cmath>

namespace sheave {
namespace {

/// The force at the point where its moment about the centre is `moment` about the normal.
EndForce placed_force(const WheelPlane& plane, std::size_t end, const Vector3& force,
                      double moment) {
  const double square = force.squaredNorm();
  Vector3 arm = Vector3::Zero();
  if (square > 0.0) arm = cross(force, plane.normal) * (moment / square);
  return {force, plane.centers[end] + arm};
}

/// Tensions at the tangent points, and at the points of the straight tangent [N].
struct EndTensions {
  std::array<Vector3, 2> free;
  std::array<double, 2> straight{};
};

EndTensions tensions_of(const WheelPlane& plane, const WheelCatenary& rope,
                        std::optional<double> length) {
  EndTensions ends{end_tensions(plane, rope), {rope.first_tension, rope.second_tension}};
  // The floor bears the difference.
  if (!length || rope.catenary.lies) return ends;
  const double more = 0.5 * plane.span.weight * (*length - rope.length());
  const double yield = plane.span.yield;
  for (const std::size_t end : {0U, 1U}) {
    const double before = ends.free[end].norm();
    ends.free[end] -= more * plane.up;
    // T + T^2 / 2 EA changes by the same at both ends of the additional arc.
    const double scale = (1.0 + yield * before) / (1.0 + yield * ends.straight[end]);
    ends.straight[end] += scale * (ends.free[end].norm() - before);
  }
  return ends;
}

}  // namespace

double WheelPlane::size() const {
  return std::abs(span.across) + std::abs(span.rise) + std::abs(radii[0]) + std::abs(radii[1]);
}

StoredLoad stored_load(double weight, double length, double arc, double radius,
                       const Vector3& turned) {
  StoredLoad load;
  load.weight = weight * length;
  // Along a circle the unit vector from the centre is minus the derivative of the direction.
  const double share = arc > 0.0 && length > 0.0 ? length / arc : 1.0;
  load.offset = weight * share * radius * radius * turned;
  return load;
}

WheelPlane wheel_plane(const SpanGeometry& span, const Vector3& normal,
                       const std::array<Vector3, 2>& centers, const std::array<double, 2>& radii,
                       const Vector3& gravity) {
  WheelPlane plane;
  plane.has_wheels = true;
  plane.normal = normal;
  plane.radii = radii;
  plane.centers = centers;
  plane.up = -gravity / gravity.norm();
  plane.level = cross(plane.up, normal).normalized();
  if (dot(plane.level, span.direction) < 0.0) plane.level = -plane.level;
  // +1 if the normal is x cross z, from x to z counter-clockwise.
  const double sense = dot(cross(plane.level, plane.up), normal) > 0.0 ? 1.0 : -1.0;
  const Vector3 apart = centers[1] - centers[0];
  plane.span.across = dot(apart, plane.level);
  plane.span.rise = dot(apart, plane.up);
  plane.span.first_radius = -sense * radii[0];
  plane.span.second_radius = -sense * radii[1];
  plane.span.slope = slope_of(dot(span.direction, plane.level), dot(span.direction, plane.up));
  return plane;
}

std::array<Vector3, 2> end_tensions(const WheelPlane& plane, const WheelCatenary& rope) {
  const Catenary& hung = rope.catenary;
  const Vector3 level = hung.horizontal * plane.level;
  return {level + hung.up_at_start(plane.span.weight) * plane.up,
          -level - hung.up_at_end(plane.span.weight) * plane.up};
}

std::array<EndForce, 2> end_forces(const WheelPlane& plane, const WheelCatenary& rope,
                                   const std::array<StoredLoad, 2>& stored,
                                   std::optional<double> length) {
  const auto [free, straight] = tensions_of(plane, rope, length);
  const std::array<double, 2> arcs{rope.first_arc.length, rope.second_arc.length};
  const std::array<double, 2> torques{plane.radii[0] * straight[0], -plane.radii[1] * straight[1]};
  std::array<EndForce, 2> forces;
  for (const std::size_t end : {0U, 1U}) {
    const double weight = plane.span.weight * arcs[end] + stored[end].weight;
    const double moment = torques[end] - dot(plane.normal, cross(stored[end].offset, plane.up));
    forces[end] = placed_force(plane, end, free[end] - weight * plane.up, moment);
  }
  return forces;
}

std::array<EndForce, 2> force_slopes(const WheelPlane& plane, const WheelCatenary& rope,
                                     const WheelCatenary& tighter, double step,
                                     std::optional<double> length) {
  const EndTensions before = tensions_of(plane, rope, length);
  const EndTensions after = tensions_of(plane, tighter, length);
  const std::array<double, 2> arcs{tighter.first_arc.length - rope.first_arc.length,
                                   tighter.second_arc.length - rope.second_arc.length};
  const std::array<double, 2> moments{plane.radii[0] * (after.straight[0] - before.straight[0]),
                                      -plane.radii[1] * (after.straight[1] - before.straight[1])};
  std::array<EndForce, 2> slopes;
  for (const std::size_t end : {0U, 1U}) {
    const Vector3 force =
        after.free[end] - before.free[end] - plane.span.weight * arcs[end] * plane.up;
    slopes[end] = placed_force(plane, end, force / step, moments[end] / step);
  }
  return slopes;
}

}  // namespace sheave
