#include "render/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sheave::render {
namespace {

using Place = std::array<float, 3>;

std::array<float, 3> to_float(const Vector3& v) {
  // Adding zero turns -0 into 0, so that equal places compare equal.
  return {static_cast<float>(v.x()) + 0.0F, static_cast<float>(v.y()) + 0.0F,
          static_cast<float>(v.z()) + 0.0F};
}

Vector3 to_double(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

/// The number of each vertex's place in space: vertices at one place share a number.
std::vector<std::uint32_t> weld(const std::vector<MeshVertex>& vertices) {
  std::map<Place, std::uint32_t> places;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(vertices.size());
  for (const MeshVertex& v : vertices) {
    const auto next = static_cast<std::uint32_t>(places.size());
    numbers.push_back(places.try_emplace(v.position, next).first->second);
  }
  return numbers;
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Weights each face by its angle at the corner, so that the division of a face into triangles has
/// no effect.
void compute_outline(Mesh& mesh, const std::vector<std::uint32_t>& places) {
  std::vector<Vector3> sums(mesh.vertices.size(), Vector3::Zero());
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    std::array<Vector3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = to_double(mesh.vertices[mesh.triangles[t + k]].position);
    }
    const Vector3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 a = p[(k + 1) % 3] - p[k];
      const Vector3 b = p[(k + 2) % 3] - p[k];
      sums[places[mesh.triangles[t + k]]] += normal * angle_between(a, b);
    }
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3& sum = sums[places[i]];
    mesh.vertices[i].outline =
        sum.norm() > 0.0 ? to_float(sum.normalized()) : mesh.vertices[i].normal;
  }
}

/// An edge is sharp if the shading normals of its two sides differ. (The angle between the
/// triangles would also find the facets of a coarse cylinder.)
void find_sharp_edges(Mesh& mesh, const std::vector<std::uint32_t>& places) {
  constexpr double cos_sharp = 0.88;  // about 28 degrees
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, Edge> open;  // places of an edge seen once -> the vertices it was seen with
  const auto differ = [&](std::uint32_t a, std::uint32_t b) {
    return to_double(mesh.vertices[a].normal).dot(to_double(mesh.vertices[b].normal)) < cos_sharp;
  };
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t a = mesh.triangles[t + k];
      std::uint32_t b = mesh.triangles[t + (k + 1) % 3];
      if (places[a] > places[b]) std::swap(a, b);
      const Edge key{places[a], places[b]};
      const auto [seen, is_new] = open.try_emplace(key, Edge{a, b});
      if (is_new) continue;
      if (differ(a, seen->second.first) && differ(b, seen->second.second)) {
        mesh.lines.insert(mesh.lines.end(), {a, b});
      }
      open.erase(seen);
    }
  }
}

}  // namespace

std::uint32_t MeshBuilder::add_vertex(const Vector3& position, const Vector3& normal) {
  mesh_.vertices.push_back({to_float(position), to_float(normal), {}, paint_});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const MeshVertex& va = mesh_.vertices[a];
  const MeshVertex& vb = mesh_.vertices[b];
  const MeshVertex& vc = mesh_.vertices[c];
  const Vector3 face = (to_double(vb.position) - to_double(va.position))
                           .cross(to_double(vc.position) - to_double(va.position));
  if (!(face.norm() > 0.0)) return;  // at the tip of a cone
  const Vector3 normal = to_double(va.normal) + to_double(vb.normal) + to_double(vc.normal);
  if (face.dot(normal) < 0.0) std::swap(b, c);
  mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
}

void MeshBuilder::add_polygon(std::span<const Vector3> corners, const Vector3& normal) {
  std::vector<std::uint32_t> index;
  index.reserve(corners.size());
  for (const Vector3& corner : corners) index.push_back(add_vertex(corner, normal));
  for (std::size_t k = 2; k < index.size(); ++k) add_triangle(index[0], index[k - 1], index[k]);
}

void MeshBuilder::add_revolution(std::span<const ProfilePoint> profile, int segments) {
  // The last ring repeats the first one exactly, because the edges along the seam must meet.
  std::vector<Vector3> around;
  for (int s = 0; s <= segments; ++s) {
    const double angle = 2.0 * pi * static_cast<double>(s % segments) / segments;
    around.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  std::vector<std::uint32_t> previous;
  for (const ProfilePoint& point : profile) {
    std::vector<std::uint32_t> ring;
    ring.reserve(around.size());
    for (const Vector3& out : around) {
      ring.push_back(add_vertex(out * point.radius + Vector3::UnitZ() * point.z,
                                out * point.normal_radius + Vector3::UnitZ() * point.normal_z));
    }
    for (std::size_t s = 0; !previous.empty() && s + 1 < ring.size(); ++s) {
      add_triangle(previous[s], previous[s + 1], ring[s + 1]);
      add_triangle(previous[s], ring[s + 1], ring[s]);
    }
    previous = std::move(ring);
  }
}

void MeshBuilder::add_cone(double r0, double z0, double r1, double z1, int segments) {
  const double length = std::hypot(r1 - r0, z1 - z0);
  if (!(length > 0.0)) return;
  const double nr = (z1 - z0) / length;
  const double nz = -(r1 - r0) / length;
  const std::array<ProfilePoint, 2> profile{ProfilePoint{r0, z0, nr, nz},
                                            ProfilePoint{r1, z1, nr, nz}};
  add_revolution(profile, segments);
}

Mesh MeshBuilder::finish() {
  const std::vector<std::uint32_t> places = weld(mesh_.vertices);
  compute_outline(mesh_, places);
  find_sharp_edges(mesh_, places);
  return std::exchange(mesh_, Mesh{});
}

}  // namespace sheave::render
