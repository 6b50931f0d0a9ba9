// Given the normal, each solid presents a side to the other: a face, a line or a point. A side
// above a face is clipped to the prism over the face (Sutherland and Hodgman 1974). Two lines touch
// along their common part if they are parallel, else in one point.

#include "engine/contacts/manifold.h"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/contacts/contact_axis.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Limits for a cylinder's side: cosine of the angle within which a flat end faces the other solid,
/// and sine of the angle within which its mantle does.
constexpr double faces_it = 0.99;
constexpr double lies_along_it = 0.02;
/// Number of points that span an area.
constexpr std::size_t spread_points = 4;
/// Slope below which points are taken to lie in one plane: far above the tilt that rounding causes,
/// far below the angle between the sides of the roundest prism.
constexpr double flat = 1e-6;

/// The part of a solid that faces a direction.
struct Side {
  std::vector<Vector3> points;       // of the core: 1, 2, or the corners of a face in order
  Vector3 normal = Vector3::Zero();  // outward normal of a face
  double radius = 0.0;
  [[nodiscard]] bool is_face() const { return points.size() > 2; }
};

/// Index of the face whose normal is closest to `direction`.
std::size_t best_face(const PlacedSolid& solid, const Vector3& direction) {
  std::size_t best = 0;
  double most = -2.0;
  for (std::size_t f = 0; f < solid.solid->faces.size(); ++f) {
    const double cosine = dot(solid.face_normal(f), direction);
    if (!(cosine > most)) continue;
    most = cosine;
    best = f;
  }
  return best;
}

Side face_side(const PlacedSolid& solid, std::size_t face) {
  Side side;
  side.normal = solid.face_normal(face);
  for (const int corner : solid.solid->faces[face].corners) {
    side.points.push_back(solid.vertices[at(corner)]);
  }
  return side;
}

/// A flat end of a cylinder as an octagon with the deepest point of the rim as a corner.
Side end_side(const PlacedSolid& cylinder, const Vector3& center, const Vector3& outward,
              const Vector3& direction) {
  // Below this slope the end is level, and no corner is distinguished.
  constexpr double level = 1e-6;
  Side side;
  side.normal = outward;
  Vector3 x = direction - outward * dot(outward, direction);
  x = x.norm() > level ? Vector3(x.normalized()) : Vector3(cylinder.rotation.col(0));
  const Vector3 y = cross(outward, x);
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.25 * pi * i;
    side.points.emplace_back(center + cylinder.solid->radius *
                                          (portable::cos(angle) * x + portable::sin(angle) * y));
  }
  return side;
}

Vector3 rim_point(const PlacedSolid& cylinder, const Vector3& center, const Vector3& direction) {
  const Vector3 axis = cylinder.axis();
  Vector3 out = direction - axis * dot(axis, direction);
  const double length = out.norm();
  return center + cylinder.solid->radius *
                      (length > 0.0 ? Vector3(out / length) : Vector3(cylinder.rotation.col(0)));
}

/// The side of a cylinder that faces `direction`.
Side cylinder_side(const PlacedSolid& cylinder, const Vector3& direction) {
  const double along = dot(cylinder.axis(), direction);
  const Vector3& center = along < 0.0 ? cylinder.first() : cylinder.last();
  if (std::abs(along) > faces_it) {
    return end_side(cylinder, center, std::copysign(1.0, along) * cylinder.axis(), direction);
  }
  Side side;
  if (std::abs(along) < lies_along_it) {
    side.points = cylinder.vertices;
    side.radius = cylinder.round_reach(direction);
  } else {
    side.points = {rim_point(cylinder, center, direction)};
  }
  return side;
}

/// The side of a solid that faces `direction`; always a face if the solid has faces.
Side side_towards(const PlacedSolid& solid, const Vector3& direction) {
  if (solid.is(ConvexSolid::Kind::cylinder)) return cylinder_side(solid, direction);
  if (solid.solid->faces.empty()) return {solid.vertices, Vector3::Zero(), solid.solid->radius};
  return face_side(solid, best_face(solid, direction));
}

/// Clips a point, a line or a convex polygon to the prism over a face.
void clip(std::vector<Vector3>& points, const Side& face) {
  std::vector<Vector3> kept;
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    const Vector3& from = face.points[i];
    const Vector3 edge = face.points[(i + 1) % face.points.size()] - from;
    const Vector3 inward = cross(face.normal, edge).normalized();
    // Points outside the border by rounding are kept unchanged.
    const double border = -1e-9 * edge.norm();
    kept.clear();
    const std::size_t count = points.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Vector3& p = points[k];
      const Vector3& q = points[(k + 1) % count];
      const double height = dot(inward, p - from);
      const double next = dot(inward, q - from);
      const bool inside = height >= border;
      if (inside) kept.push_back(p);
      if (inside == (next >= border) || count == 1 || (count == 2 && k == 1)) continue;
      kept.emplace_back(p + (q - p) * (height / (height - next)));
    }
    points = kept;
  }
}

/// Appends the contacts of a side above a face. `above_is_a`: the face is that of B.
void stand_on_face(const Side& above, const Side& face, bool above_is_a, double margin,
                   Manifold& manifold) {
  std::vector<Vector3> points = above.points;
  clip(points, face);
  // Measured along the manifold's normal, which may differ from the face's.
  const Vector3 up = above_is_a ? manifold.normal : Vector3(-manifold.normal);
  const double slope = dot(up, face.normal);
  for (const Vector3& point : points) {
    const double height = dot(face.normal, point - face.points.front()) / slope;
    const double gap = height - above.radius;
    if (!(gap <= margin)) continue;
    const Vector3 foot = point - height * up;
    if (above_is_a) {
      manifold.points.push_back({point, foot, above.radius, 0.0, gap});
    } else {
      manifold.points.push_back({foot, point, 0.0, above.radius, gap});
    }
  }
}

/// As above, for the side of `above` that now faces `down`, and also for the side that faces
/// `later`, the direction of the face relative to the solid after the motion of the substep.
void stand_on_face(const PlacedSolid& above, const Vector3& down, const Vector3& later,
                   const Side& face, bool above_is_a, double margin, Manifold& manifold) {
  stand_on_face(side_towards(above, down), face, above_is_a, margin, manifold);
  if (above.solid->faces.empty() || above.is(ConvexSolid::Kind::cylinder)) return;
  const std::size_t now = best_face(above, down);
  const std::size_t next = best_face(above, later);
  if (next == now) return;
  // Two sides with a common edge share its corners.
  const std::size_t first = manifold.points.size();
  stand_on_face(face_side(above, next), face, above_is_a, margin, manifold);
  const auto begin = manifold.points.begin();
  const auto known = [&](const ContactPoint& point) {
    return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(first),
                       [&](const ContactPoint& other) { return other.core_a == point.core_a; });
  };
  manifold.points.erase(
      std::remove_if(begin + static_cast<std::ptrdiff_t>(first), manifold.points.end(), known),
      manifold.points.end());
}

void add_pair(const Side& a, const Side& b, const Vector3& p, const Vector3& q, double margin,
              Manifold& manifold) {
  const double gap = dot(manifold.normal, p - q) - a.radius - b.radius;
  if (gap <= margin) manifold.points.push_back({p, q, a.radius, b.radius, gap});
}

/// Appends the contacts of points and lines.
void cross_lines(const Side& a, const Side& b, double margin, Manifold& manifold) {
  constexpr double parallel = 0.02;  // sine of the angle
  const Vector3& p0 = a.points.front();
  const Vector3& p1 = a.points.back();
  const Vector3& q0 = b.points.front();
  const Vector3& q1 = b.points.back();
  const Vector3 u = p1 - p0;
  const Vector3 w = q1 - q0;
  const double uu = dot(u, u);
  const bool lines = uu > 0.0 && dot(w, w) > 0.0;
  if (lines && cross(u, w).norm() < parallel * u.norm() * w.norm()) {
    const double from = std::clamp(dot(u, q0 - p0) / uu, 0.0, 1.0);
    const double to = std::clamp(dot(u, q1 - p0) / uu, 0.0, 1.0);
    if (from != to) {
      for (const double s : {from, to}) {
        const Vector3 p = p0 + s * u;
        add_pair(a, b, p, nearest_points(p, p, q0, q1).q, margin, manifold);
      }
      return;
    }
  }
  const auto [p, q] = nearest_points(p0, p1, q0, q1);
  add_pair(a, b, p, q, margin, manifold);
}

/// All points of a solid that may touch a half-space.
Side all_points(const PlacedSolid& solid, const Vector3& direction) {
  if (!solid.is(ConvexSolid::Kind::cylinder)) {
    return {solid.vertices, Vector3::Zero(), solid.solid->radius};
  }
  Side side = cylinder_side(solid, direction);
  if (side.points.size() != 1) return side;
  side.points.clear();
  for (const Vector3& center : solid.vertices) {
    side.points.push_back(rim_point(solid, center, direction));
  }
  return side;
}

void stand_on_half_space(const PlacedSolid& a, const PlacedSolid& b, double margin,
                         Manifold& manifold) {
  manifold.normal = b.face_normal(0);
  const Side side = all_points(a, -manifold.normal);
  for (const Vector3& point : side.points) {
    const double height = dot(manifold.normal, point - b.first());
    if (!(height - side.radius <= margin)) continue;
    manifold.points.push_back(
        {point, point - height * manifold.normal, side.radius, 0.0, height - side.radius});
  }
}

/// Reduces a side to an edge or a corner if no face is perpendicular to `direction`.
void shrink_to_edge(const PlacedSolid& solid, const Vector3& direction, Side& side) {
  if (!side.is_face() || dot(side.normal, direction) > 1.0 - 1e-6 ||
      solid.is(ConvexSolid::Kind::cylinder)) {
    return;
  }
  const Vector3& extreme = solid.vertices[solid.extreme(direction)];
  for (const ConvexSolid::Edge& edge : solid.solid->edges) {
    const Vector3 along = solid.edge_vector(edge);
    const double top = dot(direction, extreme - solid.vertices[at(edge.from)]);
    if (std::abs(dot(along, direction)) > lies_along_it * along.norm()) continue;
    if (std::abs(top) > lies_along_it * along.norm()) continue;
    side.points = {solid.vertices[at(edge.from)], solid.vertices[at(edge.to)]};
    return;
  }
  side.points = {extreme};
}

/// Four points that span about the same area as all, chosen from points at a distance.
std::vector<std::size_t> spanning_points(const Manifold& manifold, double size) {
  const std::vector<ContactPoint>& points = manifold.points;
  // The corners of two squares that are slightly rotated against each other come in pairs. One of
  // each pair is sufficient, and the choice of four then does not depend on rounding.
  std::vector<std::size_t> apart;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::none_of(apart.begin(), apart.end(), [&](std::size_t other) {
          return (points[other].core_a - points[i].core_a).norm() < 0.05 * size;
        })) {
      apart.push_back(i);
    }
  }
  if (apart.size() <= spread_points) return apart;
  const auto position = [&](std::size_t i) -> const Vector3& { return points[apart[i]].core_a; };
  // Among points of equal depth the first is chosen, independent of rounding.
  std::size_t deepest = 0;
  for (std::size_t i = 1; i < apart.size(); ++i) {
    if (points[apart[i]].gap < points[apart[deepest]].gap - 1e-3 * size) deepest = i;
  }
  const auto farthest = [&](const auto& measure) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < apart.size(); ++i) {
      if (measure(position(i)) > measure(position(best)) + 1e-9 * size) best = i;
    }
    return best;
  };
  const Vector3 origin = position(deepest);
  const std::size_t second = farthest([&](const Vector3& p) { return (p - origin).norm(); });
  const Vector3 across = cross(manifold.normal, position(second) - origin).normalized();
  return {apart[deepest], apart[second],
          apart[farthest([&](const Vector3& p) { return dot(across, p - origin); })],
          apart[farthest([&](const Vector3& p) { return -dot(across, p - origin); })]};
}

/// The points on which a tilted solid comes to rest: the lowest one, the first one that it meets
/// when it tips about the lowest, and the first ones to either side when it tips about the line
/// through both. Among points met at the same time, as on a flat side, the farthest is chosen.
std::vector<std::size_t> bearing_points(const Manifold& manifold, double size) {
  const std::vector<ContactPoint>& points = manifold.points;
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].due < points[lowest].due - flat * size) lowest = i;
  }
  std::vector<std::size_t> found{lowest};
  const Vector3 origin = points[lowest].core_a;
  // The point with the least rise per distance; `rise` and `distance` are functions of its index.
  const auto first_met = [&](const auto& rise, const auto& distance) -> std::optional<std::size_t> {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(distance(i) > 1e-6 * size)) continue;
      const double slope = rise(i) / distance(i);
      const double least = best ? rise(*best) / distance(*best) : 0.0;
      const bool level = best && std::abs(slope - least) <= flat;
      if (!best || (level ? distance(i) > distance(*best) + 1e-9 * size : slope < least)) best = i;
    }
    return best;
  };
  const Vector3& n = manifold.normal;
  const auto level_way = [&](std::size_t i) {
    const Vector3 way = points[i].core_a - origin;
    return Vector3(way - n * dot(n, way));
  };
  const auto height = [&](std::size_t i) { return points[i].due - points[lowest].due; };
  const auto second = first_met(height, [&](std::size_t i) { return level_way(i).norm(); });
  if (!second) return found;
  found.push_back(*second);
  const Vector3 along = level_way(*second).normalized();
  const double slope = height(*second) / level_way(*second).norm();
  const auto rise = [&](std::size_t i) { return height(i) - slope * dot(along, level_way(i)); };
  for (const double side : {1.0, -1.0}) {
    const Vector3 across = side * cross(n, along);
    const auto next = first_met(rise, [&](std::size_t i) { return dot(across, level_way(i)); });
    if (next) found.push_back(*next);
  }
  return found;
}

}  // namespace

void reduce_points(Manifold& manifold) {
  std::vector<ContactPoint>& points = manifold.points;
  if (points.size() <= spread_points) return;
  double size = 0.0;
  double lowest = points.front().due;
  for (const ContactPoint& point : points) {
    size = std::max(size, (point.core_a - points.front().core_a).norm());
    lowest = std::min(lowest, point.due);
  }
  std::vector<std::size_t> chosen = spanning_points(manifold, size);
  if (std::any_of(chosen.begin(), chosen.end(),
                  [&](std::size_t i) { return points[i].due > lowest + flat * size; })) {
    for (const std::size_t i : bearing_points(manifold, size)) chosen.push_back(i);
  }
  std::vector<ContactPoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) kept.push_back(points[i]);
  }
  points = kept;
}

namespace {

/// Finds the contacts of two bounded solids.
void meet_solids(const PlacedSolid& a, const PlacedSolid& b, double margin,
                 const SolidMotion& motion_a, const SolidMotion& motion_b, Manifold& manifold) {
  const ContactAxis axis = contact_axis(a, b, margin);
  manifold.normal = axis.normal;
  if (!(axis.gap <= margin)) return;
  using Kind = ContactAxis::Kind;
  const Vector3 down = -axis.normal;
  if (axis.kind == Kind::face_b) {
    const Vector3 later = times(motion_a.turn.transpose(), times(motion_b.turn, down));
    stand_on_face(a, down, later, face_side(b, at(axis.face)), true, margin, manifold);
  } else if (axis.kind == Kind::face_a) {
    const Vector3 later = times(motion_b.turn.transpose(), times(motion_a.turn, axis.normal));
    stand_on_face(b, axis.normal, later, face_side(a, at(axis.face)), false, margin, manifold);
  } else if (axis.kind == Kind::points) {
    Side side_a{{axis.core_a}, Vector3::Zero(), a.solid->radius};
    Side side_b{{axis.core_b}, Vector3::Zero(), b.solid->radius};
    if (a.is_round() && b.is_round()) {
      side_a.points = a.vertices;
      side_b.points = b.vertices;
    }
    cross_lines(side_a, side_b, margin, manifold);
  } else {
    Side side_a = side_towards(a, down);
    Side side_b = side_towards(b, axis.normal);
    shrink_to_edge(a, down, side_a);
    shrink_to_edge(b, axis.normal, side_b);
    const double cosine_a = side_a.is_face() ? dot(side_a.normal, down) : -1.0;
    const double cosine_b = side_b.is_face() ? dot(side_b.normal, axis.normal) : -1.0;
    if (cosine_b > 0.5 && cosine_b >= cosine_a) {
      stand_on_face(side_a, side_b, true, margin, manifold);
    } else if (cosine_a > 0.5) {
      stand_on_face(side_b, side_a, false, margin, manifold);
    } else {
      cross_lines(side_a, side_b, margin, manifold);
    }
  }
  if (manifold.points.empty() && axis.gap <= 0.0) {
    // The solids overlap, but rounding left no point after clipping: take the deepest point of
    // each.
    Side side_a{{a.vertices[a.extreme(down)]}, {}, a.round_reach(down)};
    Side side_b{{b.vertices[b.extreme(axis.normal)]}, {}, b.round_reach(axis.normal)};
    cross_lines(side_a, side_b, margin, manifold);
  }
}

}  // namespace

void find_contacts(const PlacedSolid& a, const PlacedSolid& b, double margin, Manifold& manifold,
                   const SolidMotion& motion_a, const SolidMotion& motion_b) {
  manifold.points.clear();
  if (b.is(ConvexSolid::Kind::half_space)) {
    stand_on_half_space(a, b, margin, manifold);
  } else {
    meet_solids(a, b, margin, motion_a, motion_b, manifold);
  }
  for (ContactPoint& point : manifold.points) {
    const Vector3 apart = motion_a.moved(point.core_a) - motion_b.moved(point.core_b);
    point.due = dot(manifold.normal, apart) - point.radius_a - point.radius_b;
  }
  reduce_points(manifold);
}

}  // namespace sheave
