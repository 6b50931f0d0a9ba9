#include "render/draw_list.h"

#include <cmath>

namespace sheave::render {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

using Eigen::AlignedBox3d;

AlignedBox3d around(const Vector3& centre, const Vector3& half) {
  return {Vector3(centre - half), Vector3(centre + half)};
}

// Half extents of a cylinder with the unit axis given: a disc reaches r * sqrt(1 - a_i^2) along
// axis i.
Vector3 cylinder_half_extents(const Vector3& axis, double radius, double length) {
  const Vector3 disc = (Vector3::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt() * radius;
  return disc + axis.cwiseAbs() * (0.5 * length);
}

}  // namespace

AlignedBox3d bounds(const Solid& solid) {
  const Matrix3 rotation = solid.orientation.toRotationMatrix();
  const Vector3 axis = rotation.col(2);
  const Overloaded visitor{
      [&](const BoxShape& box) {
        return around(solid.position, rotation.cwiseAbs() * (0.5 * box.size));
      },
      [&](const SphereShape& sphere) {
        return around(solid.position, Vector3::Constant(sphere.radius));
      },
      [&](const CylinderShape& c) {
        return around(solid.position, cylinder_half_extents(axis, c.radius, c.length));
      },
      [&](const CapsuleShape& c) {
        return around(solid.position,
                      Vector3(axis.cwiseAbs() * (0.5 * c.length) + Vector3::Constant(c.radius)));
      },
      [&](const SheaveShape& s) {
        return around(solid.position,
                      cylinder_half_extents(axis, s.radius + s.cable_radius, s.length));
      },
      [&](const MeshShape& m) {
        AlignedBox3d box;
        if (m.mesh) {
          for (const Vector3& v : m.mesh->vertices) box.extend(solid.position + rotation * v);
        }
        return box;
      },
  };
  return std::visit(visitor, solid.shape);
}

AlignedBox3d bounds(const DrawList& list) {
  AlignedBox3d box;
  for (const Solid& solid : list.solids) box.extend(bounds(solid));
  for (const Tube& tube : list.tubes) {
    const Vector3 margin = Vector3::Constant(tube.radius);
    for (const TubePoint& point : tube.points) {
      box.extend(Vector3(point.position - margin));
      box.extend(Vector3(point.position + margin));
    }
  }
  return box;
}

}  // namespace sheave::render
