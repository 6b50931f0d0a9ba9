#include "engine/shapes/solid.h"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/index.h"
#include "engine/shapes/convex_hull.h"

namespace sheave {
namespace {

/// Half the sum of the cross products of a loop's corners: its area along its normal [m2].
Vector3 loop_area(std::span<const Vector3> vertices, const std::vector<int>& loop) {
  Vector3 sum = Vector3::Zero();
  const Vector3& origin = vertices[at(loop.front())];
  for (std::size_t i = 2; i < loop.size(); ++i) {
    sum += (vertices[at(loop[i - 1])] - origin).cross(vertices[at(loop[i])] - origin);
  }
  return 0.5 * sum;
}

/// The boundary of triangles that lie in one plane, as one loop: all edges that belong to one
/// triangle only.
std::vector<int> boundary(const Hull& hull, const std::vector<int>& triangles) {
  std::map<int, int> next;
  std::map<std::pair<int, int>, bool> edges;
  for (const int t : triangles) {
    const auto& corners = hull.triangles[at(t)];
    for (std::size_t k = 0; k < 3; ++k) edges[{corners[k], corners[(k + 1) % 3]}] = true;
  }
  for (const auto& [edge, present] : edges) {
    if (!edges.contains({edge.second, edge.first})) next[edge.first] = edge.second;
  }
  std::vector<int> loop{next.begin()->first};
  while (loop.size() < next.size()) loop.push_back(next[loop.back()]);
  return loop;
}

/// Sets ConvexSolid::Edge::repeats.
void find_directions(ConvexSolid& solid) {
  constexpr double parallel = 1e-12;
  std::vector<Vector3> directions;
  for (ConvexSolid::Edge& edge : solid.edges) {
    const Vector3 along =
        (solid.vertices[at(edge.to)] - solid.vertices[at(edge.from)]).normalized();
    edge.repeats = std::any_of(directions.begin(), directions.end(), [&](const Vector3& other) {
      return along.cross(other).norm() <= parallel;
    });
    if (!edge.repeats) directions.push_back(along);
  }
}

}  // namespace

ConvexSolid solid_about_segment(ConvexSolid::Kind kind, double length, double radius) {
  ConvexSolid solid;
  solid.kind = kind;
  solid.radius = radius;
  if (length == 0.0) {
    solid.vertices = {Vector3::Zero()};
    return solid;
  }
  solid.vertices = {Vector3(0.0, 0.0, -0.5 * length), Vector3(0.0, 0.0, 0.5 * length)};
  solid.edges = {{0, 1, -1, -1}};
  return solid;
}

ConvexSolid solid_of_faces(std::span<const Vector3> vertices, std::vector<std::vector<int>> loops) {
  ConvexSolid solid;
  solid.vertices.assign(vertices.begin(), vertices.end());
  std::map<std::pair<int, int>, int> edge_of;
  for (std::vector<int>& loop : loops) {
    const int face = static_cast<int>(solid.faces.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int from = loop[i];
      const int to = loop[(i + 1) % loop.size()];
      const auto opposite = edge_of.find({to, from});
      if (opposite != edge_of.end()) {
        solid.edges[at(opposite->second)].right = face;
      } else {
        edge_of[{from, to}] = static_cast<int>(solid.edges.size());
        solid.edges.push_back({from, to, face, face});
      }
    }
    const Vector3 normal = loop_area(vertices, loop).normalized();
    solid.faces.push_back({normal, std::move(loop)});
  }
  find_directions(solid);
  return solid;
}

ConvexSolid solid_of_outline(std::span<const Vector3> outline, double length) {
  const int n = static_cast<int>(outline.size());
  std::vector<Vector3> vertices;
  std::vector<std::vector<int>> loops(2);
  for (const double end : {-0.5, 0.5}) {
    for (const Vector3& corner : outline) {
      vertices.emplace_back(corner.x(), corner.y(), end * length);
    }
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    loops[0].push_back(n - 1 - i);
    loops[1].push_back(n + i);
    loops.push_back({i, next, n + next, n + i});
  }
  return solid_of_faces(vertices, std::move(loops));
}

ConvexSolid solid_of_hull(const Hull& hull) {
  // Neighbours whose normals differ by less than this lie in one plane, with rounding errors
  // (engine/shapes/convex_hull.h).
  constexpr double flat = 1e-9;
  std::map<std::pair<int, int>, int> triangle_at;
  std::vector<Vector3> normals;
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    const auto& corners = hull.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      triangle_at[{corners[k], corners[(k + 1) % 3]}] = static_cast<int>(t);
    }
    normals.emplace_back(hull.area_vector(corners).normalized());
  }
  std::vector<char> done(hull.triangles.size(), 0);
  std::vector<std::vector<int>> loops;
  for (std::size_t first = 0; first < done.size(); ++first) {
    if (done[first] != 0) continue;
    std::vector<int> group{static_cast<int>(first)};
    done[first] = 1;
    for (std::size_t g = 0; g < group.size(); ++g) {
      const auto& corners = hull.triangles[at(group[g])];
      for (std::size_t k = 0; k < 3; ++k) {
        const int other = triangle_at.at({corners[(k + 1) % 3], corners[k]});
        if (done[at(other)] != 0) continue;
        if (normals[first].cross(normals[at(other)]).norm() > flat) continue;
        done[at(other)] = 1;
        group.push_back(other);
      }
    }
    loops.push_back(boundary(hull, group));
  }
  return solid_of_faces(hull.vertices, std::move(loops));
}

}  // namespace sheave
