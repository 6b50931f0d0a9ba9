#include "render/solid_mesh.h"

#include <array>
#include <cmath>
#include <vector>

namespace sheave::render {
namespace {

void add(MeshBuilder& builder, const BoxShape& box, int /*segments*/) {
  const Vector3 half = 0.5 * box.size;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      std::array<Vector3, 4> corners;
      constexpr std::array<double, 4> su{-1.0, 1.0, 1.0, -1.0};
      constexpr std::array<double, 4> sv{-1.0, -1.0, 1.0, 1.0};
      for (std::size_t k = 0; k < 4; ++k) {
        corners[k][axis] = side * half[axis];
        corners[k][u] = su[k] * half[u];
        corners[k][v] = sv[k] * half[v];
      }
      Vector3 normal = Vector3::Zero();
      normal[axis] = side;
      builder.add_polygon(corners, normal);
    }
  }
}

/// Adds a capsule; a ball if `length` is zero.
void add_rounded(MeshBuilder& builder, double radius, double length, int segments) {
  const int steps = std::max(4, segments / 4);
  std::vector<ProfilePoint> profile;
  for (const double end : {-1.0, 1.0}) {
    for (int k = 0; k <= steps; ++k) {
      if (end > 0.0 && k == 0 && !(length > 0.0)) continue;  // the first half has added the equator
      const double fraction = static_cast<double>(k) / steps;
      const double latitude = 0.5 * pi * (end < 0.0 ? fraction - 1.0 : fraction);
      const double c = std::abs(latitude) >= 0.5 * pi ? 0.0 : std::cos(latitude);
      const double s = std::sin(latitude);
      profile.push_back({radius * c, radius * s + end * 0.5 * length, c, s});
    }
  }
  builder.add_revolution(profile, segments);
}

void add(MeshBuilder& builder, const SphereShape& sphere, int segments) {
  add_rounded(builder, sphere.radius, 0.0, segments);
}

void add(MeshBuilder& builder, const CapsuleShape& capsule, int segments) {
  add_rounded(builder, capsule.radius, capsule.length, segments);
}

void add(MeshBuilder& builder, const CylinderShape& c, int segments) {
  const double z = 0.5 * c.length;
  builder.add_cone(0.0, -z, c.radius, -z, segments);
  builder.add_cone(c.radius, -z, c.radius, z, segments);
  builder.add_cone(c.radius, z, 0.0, z, segments);
}

void add(MeshBuilder& builder, const SheaveShape& sheave, int segments) {
  add_sheave(builder, sheave, segments);
}

void add(MeshBuilder& builder, const MeshShape& shape, int /*segments*/) {
  for (const auto& t : shape.mesh->triangles) {
    const std::array<Vector3, 3> p{shape.mesh->vertices[t[0]], shape.mesh->vertices[t[1]],
                                   shape.mesh->vertices[t[2]]};
    const Vector3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    if (normal.norm() > 0.0) builder.add_polygon(p, normal.normalized());
  }
}

}  // namespace

Mesh make_mesh(const Shape& shape, int segments) {
  MeshBuilder builder;
  std::visit([&](const auto& s) { add(builder, s, segments); }, shape);
  return builder.finish();
}

}  // namespace sheave::render
