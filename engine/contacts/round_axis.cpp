// Balls and capsules consist of all points within a radius of a core. Their distance is that of the
// cores less the radii, along the line between the nearest points of the cores. If a core is partly
// inside a solid with faces, that line does not exist; the shortest way out is along a face's
// normal or across an edge.

#include <algorithm>
#include <limits>

#include "engine/contacts/contact_axis.h"

namespace sheave {
namespace {

/// The part of a segment inside a solid with faces, as shares of the segment; empty if begin > end.
struct Inside {
  double begin = 0.0;
  double end = 1.0;
};

Inside part_inside(const Vector3& p, const Vector3& q, const PlacedSolid& solid) {
  Inside part;
  for (std::size_t f = 0; f < solid.solid->faces.size(); ++f) {
    const Vector3 normal = solid.face_normal(f);
    const double from = dot(normal, p - solid.face_point(f));
    const double to = dot(normal, q - solid.face_point(f));
    if (from > 0.0 && to > 0.0) return {1.0, 0.0};
    if (from > 0.0) part.begin = std::max(part.begin, from / (from - to));
    if (to > 0.0) part.end = std::min(part.end, from / (from - to));
  }
  return part;
}

/// Whether the projection of a point on the plane of a face is inside the face.
bool above_face(const PlacedSolid& solid, std::size_t face, const Vector3& point) {
  const std::vector<int>& corners = solid.solid->faces[face].corners;
  const Vector3 normal = solid.face_normal(face);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& from = solid.vertices[at(corners[i])];
    const Vector3& to = solid.vertices[at(corners[(i + 1) % corners.size()])];
    if (dot(cross(normal, to - from), point - from) < 0.0) return false;
  }
  return true;
}

/// The shortest way out of a solid with faces, for a core that is partly inside.
ContactAxis way_out(const PlacedSolid& a, const PlacedSolid& b) {
  ContactAxis best;
  best.gap = -std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < b.solid->faces.size(); ++f) {
    const Vector3 normal = b.face_normal(f);
    const double lowest = std::min(dot(normal, a.first()), dot(normal, a.last()));
    const double gap = lowest - dot(normal, b.face_point(f)) - a.solid->radius;
    if (!(gap > best.gap)) continue;
    best = {ContactAxis::Kind::face_b, normal, gap, static_cast<int>(f), a.first(), a.first()};
  }
  for (const ConvexSolid::Edge& edge : b.solid->edges) {
    Vector3 normal = cross(a.last() - a.first(), b.edge_vector(edge));
    const double length = normal.norm();
    if (!(length > 1e-9 * b.edge_vector(edge).squaredNorm())) continue;
    normal /= length;
    for (const double side : {1.0, -1.0}) {
      const Vector3 along = side * normal;
      const double gap = gap_along(a, b, along);
      // An edge that is only as good as a face adds rounding errors.
      if (!(gap > best.gap + 1e-9 * std::abs(best.gap))) continue;
      const auto [p, q] =
          nearest_points(a.first(), a.last(), b.vertices[at(edge.from)], b.vertices[at(edge.to)]);
      best = {ContactAxis::Kind::points, along, gap, -1, p, q};
    }
  }
  return best;
}

}  // namespace

NearestPoints nearest_points(const Vector3& p0, const Vector3& p1, const Vector3& q0,
                             const Vector3& q1) {
  // Minimises |p0 + s u - q0 - t w|^2 over the unit square (Ericson, "Real-Time Collision
  // Detection", 5.1.9).
  const Vector3 u = p1 - p0;
  const Vector3 w = q1 - q0;
  const Vector3 d = p0 - q0;
  const double uu = dot(u, u);
  const double ww = dot(w, w);
  const double uw = dot(u, w);
  const double ud = dot(u, d);
  const double wd = dot(w, d);
  double s = 0.0;
  double t = 0.0;
  if (uu > 0.0 && ww > 0.0) {
    const double determinant = uu * ww - uw * uw;
    if (determinant > 1e-12 * uu * ww) {
      s = std::clamp((uw * wd - ww * ud) / determinant, 0.0, 1.0);
    } else {
      // Parallel segments: the middle of the part of P beside Q.
      const double from = -ud / uu;
      const double to = (uw - ud) / uu;
      s = 0.5 *
          (std::clamp(std::min(from, to), 0.0, 1.0) + std::clamp(std::max(from, to), 0.0, 1.0));
    }
    t = std::clamp((uw * s + wd) / ww, 0.0, 1.0);
    s = std::clamp((uw * t - ud) / uu, 0.0, 1.0);
  } else if (uu > 0.0) {
    s = std::clamp(-ud / uu, 0.0, 1.0);
  } else if (ww > 0.0) {
    t = std::clamp(wd / ww, 0.0, 1.0);
  }
  return {p0 + s * u, q0 + t * w};
}

ContactAxis axis_of_round(const PlacedSolid& a, const PlacedSolid& b) {
  const auto [p, q] = nearest_points(a.first(), a.last(), b.first(), b.last());
  const double radii = a.solid->radius + b.solid->radius;
  const Vector3 between = p - q;
  const double distance = between.norm();
  ContactAxis axis;
  axis.kind = ContactAxis::Kind::points;
  axis.core_a = p;
  axis.core_b = q;
  if (distance > 1e-9 * radii) {
    axis.normal = between / distance;
    axis.gap = distance - radii;
    return axis;
  }
  // The cores meet: the normal is across both, or across one, or arbitrary.
  Vector3 across = cross(a.last() - a.first(), b.last() - b.first());
  if (!(across.norm() > 1e-9 * radii * radii)) {
    const Vector3 along =
        a.vertices.size() > 1 ? Vector3(a.last() - a.first()) : Vector3(b.last() - b.first());
    across = along.norm() > 0.0 ? any_perpendicular(along.normalized()) : Vector3::UnitY();
  }
  axis.normal = across.normalized();
  axis.gap = gap_along(a, b, axis.normal);
  return axis;
}

ContactAxis axis_of_round_and_faces(const PlacedSolid& a, const PlacedSolid& b) {
  const Inside inside = part_inside(a.first(), a.last(), b);
  if (inside.begin <= inside.end) return way_out(a, b);
  const double radius = a.solid->radius;
  double nearest = std::numeric_limits<double>::infinity();
  ContactAxis best;
  for (std::size_t f = 0; f < b.solid->faces.size(); ++f) {
    const Vector3 normal = b.face_normal(f);
    for (const Vector3& end : a.vertices) {
      const double height = dot(normal, end - b.face_point(f));
      if (!(height > 0.0) || !(height < nearest) || !above_face(b, f, end)) continue;
      nearest = height;
      const double lowest = std::min(dot(normal, a.first()), dot(normal, a.last()));
      best = {ContactAxis::Kind::face_b, normal, lowest - dot(normal, b.face_point(f)) - radius,
              static_cast<int>(f),       end,    end - height * normal};
    }
  }
  for (const ConvexSolid::Edge& edge : b.solid->edges) {
    const auto [p, q] =
        nearest_points(a.first(), a.last(), b.vertices[at(edge.from)], b.vertices[at(edge.to)]);
    const Vector3 between = p - q;
    const double distance = between.norm();
    // An equally near face is preferred, because its normal is not computed from a difference.
    if (!(distance < nearest * (1.0 - 1e-9))) continue;
    if (!(distance > 1e-9 * radius)) return way_out(a, b);
    nearest = distance;
    best = {ContactAxis::Kind::points, between / distance, distance - radius, -1, p, q};
  }
  return best;
}

}  // namespace sheave
