#include "render/curved_mesh.h"

#include <cmath>
#include <cstdint>
#include <utility>

namespace sheave::render {
namespace {

constexpr std::uint32_t mesh_sectors = 96;

Vector3 circle_point(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Rings of vertices, from outside counter-clockwise and upwards, joined by two triangles per
/// facet; `closed` joins the last ring to the first.
MeshShape joined_rings(std::vector<Vector3> vertices, bool closed) {
  TriangleMesh mesh;
  const auto rings = static_cast<std::uint32_t>(vertices.size()) / mesh_sectors;
  for (std::uint32_t ring = 0; ring + (closed ? 0 : 1) < rings; ++ring) {
    const std::uint32_t low = ring * mesh_sectors;
    const std::uint32_t high = (ring + 1) % rings * mesh_sectors;
    for (std::uint32_t k = 0; k < mesh_sectors; ++k) {
      const std::uint32_t next = (k + 1) % mesh_sectors;
      mesh.triangles.push_back({low + k, low + next, high + next});
      mesh.triangles.push_back({low + k, high + next, high + k});
    }
  }
  mesh.vertices = std::move(vertices);
  return {std::make_shared<TriangleMesh>(std::move(mesh))};
}

}  // namespace

MeshShape drawable_cone(const Cone& cone) {
  std::vector<Vector3> vertices;
  const double half = 0.5 * cone.length;
  for (const auto& [radius, z] : {std::pair{0.0, -half}, std::pair{cone.radius, -half},
                                  std::pair{cone.top_radius, half}, std::pair{0.0, half}}) {
    for (std::uint32_t k = 0; k < mesh_sectors; ++k) {
      vertices.push_back(circle_point(radius, 2.0 * pi * k / mesh_sectors, z));
    }
  }
  return joined_rings(std::move(vertices), false);
}

MeshShape drawable_torus(const Torus& torus) {
  constexpr std::uint32_t rings = 48;
  std::vector<Vector3> vertices;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double angle = 2.0 * pi * ring / rings;
    for (std::uint32_t k = 0; k < mesh_sectors; ++k) {
      vertices.push_back(circle_point(torus.radius + torus.tube_radius * std::cos(angle),
                                      2.0 * pi * k / mesh_sectors,
                                      torus.tube_radius * std::sin(angle)));
    }
  }
  return joined_rings(std::move(vertices), true);
}

MeshShape drawable_ellipsoid(const Ellipsoid& ellipsoid) {
  constexpr std::uint32_t rings = 48;
  std::vector<Vector3> vertices;
  for (std::uint32_t ring = 0; ring <= rings; ++ring) {
    const double latitude = pi * ring / rings - 0.5 * pi;
    for (std::uint32_t k = 0; k < mesh_sectors; ++k) {
      const Vector3 on_ball =
          circle_point(std::cos(latitude), 2.0 * pi * k / mesh_sectors, std::sin(latitude));
      vertices.push_back(ellipsoid.half_axes.cwiseProduct(on_ball));
    }
  }
  return joined_rings(std::move(vertices), false);
}

}  // namespace sheave::render
