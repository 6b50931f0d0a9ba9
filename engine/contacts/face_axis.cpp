// Solids with flat faces. The separating axis is the normal of a face, or the cross product of two
// edges whose arcs on the Gauss sphere cross (Gregorius, "The separating axis test between convex
// polyhedra", 2013). Cost: faces x corners of both, and edges x edges tests of some 20 operations;
// fine for hundreds of edges, slow for thousands.

#include <limits>

#include "engine/contacts/contact_axis.h"

namespace sheave {
namespace {

void try_faces(const PlacedSolid& own, const PlacedSolid& other, ContactAxis::Kind kind,
               double preferred, double margin, ContactAxis& best) {
  for (std::size_t f = 0; f < own.solid->faces.size(); ++f) {
    const Vector3 normal = own.face_normal(f);
    const double gap = -dot(normal, own.face_point(f)) - other.reach(-normal) - own.solid->radius;
    if (!(gap > best.gap + preferred)) continue;
    best.kind = kind;
    best.normal = kind == ContactAxis::Kind::face_b ? normal : Vector3(-normal);
    best.gap = gap;
    best.face = static_cast<int>(f);
    if (gap > margin) return;
  }
}

/// Whether the arcs a b and c d of unit vectors cross on the unit sphere.
bool arcs_cross(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 ba = cross(b, a);
  const Vector3 dc = cross(d, c);
  const double cba = dot(c, ba);
  const double dba = dot(d, ba);
  const double adc = dot(a, dc);
  const double bdc = dot(b, dc);
  return cba * dba < 0.0 && adc * bdc < 0.0 && cba * bdc > 0.0;
}

}  // namespace

ContactAxis axis_of_faces(const PlacedSolid& a, const PlacedSolid& b, double margin) {
  // The normals of faces give whole faces as contacts. Another kind of axis must therefore be
  // better by more than rounding errors, and so must the second of two equal faces.
  const double size =
      (a.vertices.front() - a.vertices.back()).norm() + (b.first() - b.last()).norm();
  const double preferred = 1e-9 * size;
  ContactAxis best;
  best.gap = -std::numeric_limits<double>::infinity();
  try_faces(b, a, ContactAxis::Kind::face_b, 0.0, margin, best);
  if (best.gap > margin) return best;
  try_faces(a, b, ContactAxis::Kind::face_a, preferred, margin, best);
  if (best.gap > margin) return best;
  for (const ConvexSolid::Edge& p : a.solid->edges) {
    const Vector3 left = a.face_normal(at(p.left));
    const Vector3 right = a.face_normal(at(p.right));
    for (const ConvexSolid::Edge& q : b.solid->edges) {
      // The Minkowski difference takes B with reversed normals.
      if (!arcs_cross(left, right, -b.face_normal(at(q.left)), -b.face_normal(at(q.right)))) {
        continue;
      }
      const Vector3 along_p = a.edge_vector(p);
      const Vector3 along_q = b.edge_vector(q);
      Vector3 normal = cross(along_p, along_q);
      const double sine = normal.norm();
      if (!(sine > 1e-6 * along_p.norm() * along_q.norm())) continue;
      normal /= sine;
      const Vector3& on_p = a.vertices[at(p.from)];
      const Vector3& on_q = b.vertices[at(q.from)];
      // Outwards from B: towards the mean of the adjacent faces' normals.
      if (dot(normal, b.face_normal(at(q.left)) + b.face_normal(at(q.right))) < 0.0)
        normal = -normal;
      const double gap = dot(normal, on_p - on_q);
      if (!(gap > best.gap + preferred)) continue;
      const auto [near_p, near_q] =
          nearest_points(on_p, a.vertices[at(p.to)], on_q, b.vertices[at(q.to)]);
      best = {ContactAxis::Kind::points, normal, gap, -1, near_p, near_q};
      if (gap > margin) return best;
    }
  }
  return best;
}

}  // namespace sheave
