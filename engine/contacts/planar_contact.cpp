#include "engine/contacts/planar_contact.h"

#include <algorithm>

namespace sheave {
namespace {

/// Largest distance across the axis, relative to the smaller form, of points behind one another.
constexpr double same_place = 1e-6;

bool has_plane(const BodySet& bodies, int body) {
  return body != bodies.count() && bodies[body].mobility == Mobility::planar;
}

}  // namespace

std::optional<Vector3> plane_of_motion(const BodySet& bodies, int a, int b) {
  if (!has_plane(bodies, a) && !has_plane(bodies, b)) return std::nullopt;
  const Vector3& axis = bodies[has_plane(bodies, a) ? a : b].axis;
  if (!bodies.stays_in_plane(a, axis) || !bodies.stays_in_plane(b, axis)) return std::nullopt;
  return axis;
}

void merge_behind(const Vector3& axis, double size, Manifold& manifold) {
  if (!lies_in_plane(manifold.normal, axis)) return;
  std::vector<ContactPoint>& points = manifold.points;
  const auto behind = [&](const ContactPoint& p, const ContactPoint& q) {
    const Vector3 apart = p.core_a - q.core_a;
    return (apart - dot(axis, apart) * axis).norm() <= same_place * size;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = points.size() - 1; j > i; --j) {
      if (!behind(points[i], points[j])) continue;
      const double half = 0.5 * dot(axis, points[j].core_a - points[i].core_a);
      points[i].core_a += half * axis;
      points[i].core_b += half * axis;
      points[i].gap = std::min(points[i].gap, points[j].gap);
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

}  // namespace sheave
