#include "engine/shapes/convex_hull.h"

// Hulls in space: Quickhull's choice of points with the conflict lists of Clarkson and Shor (1989).
//
// Every face keeps the list of the points strictly above it. The highest point p of some face
// replaces all faces below p by a cone from p to their common border, the horizon. A point above
// the new face through the horizon edge e is above one of the two old faces that met at e, because
// a point below both is below the new face. Only the lists of these two are searched.
//
// Exactness: grid coordinates differ by at most 2^40, so the components of a face normal are below
// 2^81 and a height (normal . offset) is below 3 * 2^121, inside 128 bits. With exact signs the
// faces visible from p are whole flat faces and form a disc, so the horizon is always one simple
// loop. A new triangle cannot be degenerate: if p were on the line of e, p would be in the plane of
// the visible face at e, and that face would not be visible.
//
// Cost: typically O(n log n). 4096 points on a sphere, the most a polyhedron may have, take some
// 0.1 s; a hundred points take less than a millisecond.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "engine/shapes/point_grid.h"

namespace sheave {
namespace {

using Triangle = std::array<int, 3>;

double length_of(const std::array<WideInteger, 3>& v) {
  return Vector3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]))
      .norm();
}

struct Face {
  Triangle corners{};
  std::array<WideInteger, 3> normal{};  ///< outward; its length is twice the area
  std::vector<int> above;  ///< points strictly above, ascending; empty once the face is not alive
  bool alive = true;       ///< still part of the hull
};

/// A hull that grows point by point; points are indices into the grid.
class GrowingHull {
 public:
  explicit GrowingHull(const std::vector<GridPoint>& points)
      : points_(points), seen_by_(points.size()) {}

  /// The surface once all points are added; empty if the points are flat.
  std::vector<Triangle> grow() {
    std::vector<Triangle> surface;
    if (!start()) return surface;
    // add() appends faces, which would invalidate iterators.
    // NOLINTNEXTLINE(modernize-loop-convert)
    for (std::size_t id = 0; id < faces_.size(); ++id) {
      const int next = faces_[id].alive ? highest_above(faces_[id]) : -1;
      if (next >= 0) add(next);  // removes faces_[id] from the hull
    }
    WideInteger six_volumes = 0;  // exact: seen from corner 0 all faces are back faces
    double twice_area = 0.0;
    for (const Face& face : faces_) {
      if (!face.alive) continue;
      surface.push_back(face.corners);
      six_volumes -= height(face.normal, face.corners[0], 0);
      twice_area += length_of(face.normal);
    }
    const bool thick =
        static_cast<double>(six_volumes) / 6.0 > thinnest * grid_cells * 0.5 * twice_area;
    return thick ? surface : std::vector<Triangle>{};
  }

 private:
  static std::uint64_t edge_key(int from, int to) {
    return static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint64_t>(to);
  }

  [[nodiscard]] GridPoint offset(int from, int to) const {
    const GridPoint& a = points_[from];
    const GridPoint& b = points_[to];
    return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  }

  [[nodiscard]] WideInteger height(const std::array<WideInteger, 3>& normal, int origin,
                                   int point) const {
    const GridPoint r = offset(origin, point);
    return normal[0] * r[0] + normal[1] * r[1] + normal[2] * r[2];
  }

  [[nodiscard]] std::array<WideInteger, 3> normal_of(const Triangle& corners) const {
    const GridPoint u = offset(corners[0], corners[1]);
    const GridPoint v = offset(corners[0], corners[2]);
    return {WideInteger{u[1]} * v[2] - WideInteger{u[2]} * v[1],
            WideInteger{u[2]} * v[0] - WideInteger{u[0]} * v[2],
            WideInteger{u[0]} * v[1] - WideInteger{u[1]} * v[0]};
  }

  /// The point farthest from the plane through `origin`, on either side. Among several the last
  /// one, which is a corner of the hull. -1 if all points are in the plane.
  [[nodiscard]] int farthest(const std::array<WideInteger, 3>& normal, int origin) const {
    int best = -1;
    WideInteger best_distance = 1;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const WideInteger signed_distance = height(normal, origin, i);
      const WideInteger distance = signed_distance < 0 ? -signed_distance : signed_distance;
      if (distance < best_distance) continue;
      best = i;
      best_distance = distance;
    }
    return best;
  }

  /// Makes the first tetrahedron: the lexicographically first and last points, the point farthest
  /// from them in a direction across, and the point farthest from the plane of these three.
  bool start() {
    const int first = 0;
    const int last = static_cast<int>(points_.size()) - 1;
    const GridPoint along = offset(first, last);
    const std::array<std::array<WideInteger, 3>, 3> across{
        {{0, along[2], -along[1]}, {-along[2], 0, along[0]}, {along[1], -along[0], 0}}};
    int third = -1;
    for (int axis = 0; axis < 3 && third < 0; ++axis) {
      third = farthest(across[axis], first);
    }
    if (third < 0) return false;
    Triangle base{first, last, third};
    const int apex = farthest(normal_of(base), first);
    if (apex < 0) return false;
    if (height(normal_of(base), first, apex) > 0) std::swap(base[0], base[1]);
    std::vector<int> all(points_.size());
    std::iota(all.begin(), all.end(), 0);
    add_face(base, all);
    for (int k = 0; k < 3; ++k) {
      add_face({base[(k + 1) % 3], base[k], apex}, all);
    }
    return true;
  }

  void add_face(const Triangle& corners, const std::vector<int>& candidates) {
    const int id = static_cast<int>(faces_.size());
    Face face{corners, normal_of(corners), {}, true};
    for (const int point : candidates) {
      if (height(face.normal, corners[0], point) <= 0) continue;
      face.above.push_back(point);
      seen_by_[point].push_back(id);
    }
    for (int k = 0; k < 3; ++k) {
      face_at_edge_[edge_key(corners[k], corners[(k + 1) % 3])] = id;
    }
    faces_.push_back(std::move(face));
  }

  /// The highest point above a face if it stands out, otherwise -1. Among several the last one,
  /// which is a corner of the hull and not in the middle of one of its faces.
  [[nodiscard]] int highest_above(const Face& face) const {
    int best = -1;
    WideInteger best_height = 0;
    for (const int point : face.above) {
      const WideInteger here = height(face.normal, face.corners[0], point);
      if (here < best_height) continue;
      best = point;
      best_height = here;
    }
    return static_cast<double>(best_height) > flat_cells * length_of(face.normal) ? best : -1;
  }

  void add(int point) {
    std::vector<int> visible;
    for (const int id : seen_by_[point]) {
      if (!std::exchange(faces_[id].alive, false)) continue;
      visible.push_back(id);
    }
    for (const int id : visible) {
      const Triangle corners = faces_[id].corners;
      for (int k = 0; k < 3; ++k) {
        const int from = corners[k];
        const int to = corners[(k + 1) % 3];
        const int beyond = face_at_edge_.at(edge_key(to, from));
        if (!faces_[beyond].alive) continue;  // also visible, so the edge is not on the horizon
        std::vector<int> candidates;
        const std::vector<int>& one = faces_[id].above;
        const std::vector<int>& other = faces_[beyond].above;
        std::set_union(one.begin(), one.end(), other.begin(), other.end(),
                       std::back_inserter(candidates));
        add_face({from, to, point}, candidates);
      }
    }
    for (const int id : visible) {
      faces_[id].above = {};
    }
  }

  const std::vector<GridPoint>& points_;
  std::vector<Face> faces_;
  std::vector<std::vector<int>> seen_by_;  ///< per point: the faces that it was ever above
  std::unordered_map<std::uint64_t, int> face_at_edge_;  ///< the face to the left of each edge
};

}  // namespace

Vector3 Hull::area_vector(const std::array<int, 3>& triangle) const {
  // The cross product of the shortest edge with another. Two long edges of a thin triangle would
  // cancel, and the volume of a rod of slenderness s would lose accuracy by s^2 instead of s.
  std::array<Vector3, 3> edges;
  int shortest = 0;
  for (int k = 0; k < 3; ++k) {
    edges[k] = vertices[triangle[(k + 1) % 3]] - vertices[triangle[k]];
    if (edges[k].squaredNorm() < edges[shortest].squaredNorm()) shortest = k;
  }
  return 0.5 * edges[shortest].cross(edges[(shortest + 1) % 3]);
}

Result<Hull> hull_3d(std::span<const Vector3> points) {
  const Error flat{"",
                   "the points enclose no volume; at least four points that do not lie in one "
                   "plane are needed"};
  const Result<PointGrid> grid = PointGrid::make(points, 3);
  if (!grid) return grid.errors();
  Hull hull;
  hull.triangles = GrowingHull(grid->points).grow();
  if (hull.triangles.empty()) return flat;
  std::vector<int> renumbered(grid->points.size(), -1);
  for (const auto& [a, b, c] : hull.triangles) {
    renumbered[a] = renumbered[b] = renumbered[c] = 0;
  }
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    renumbered[i] = static_cast<int>(hull.vertices.size());
    hull.vertices.push_back(points[grid->source[i]]);
  }
  for (Triangle& triangle : hull.triangles) {
    triangle = {renumbered[triangle[0]], renumbered[triangle[1]], renumbered[triangle[2]]};
  }
  return hull;
}

}  // namespace sheave
