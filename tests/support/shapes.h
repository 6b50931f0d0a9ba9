#pragma once
// Shapes and point sets that several tests of shapes use.

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/body.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"

namespace sheave::test {

template <class Type>
std::shared_ptr<Type> make(const std::function<void(Type&)>& fill) {
  auto shape = std::make_shared<Type>();
  fill(*shape);
  return shape;
}

inline std::shared_ptr<Box> box(const Vector3& size) {
  return make<Box>([&](Box& b) { b.size = size; });
}

/// Along z, with the length of the straight part of a capsule.
inline std::shared_ptr<const Shape> cylinder_of(double radius, double length) {
  return make<Cylinder>([&](Cylinder& c) { c.radius = radius, c.length = length; });
}
inline std::shared_ptr<const Shape> capsule_of(double radius, double length) {
  return make<Capsule>([&](Capsule& c) { c.radius = radius, c.length = length; });
}
inline std::shared_ptr<const Shape> sphere_of(double radius) {
  return make<Sphere>([&](Sphere& s) { s.radius = radius; });
}

/// A static body of one shape.
inline BodyDef static_body(std::string name, std::shared_ptr<const Shape> shape,
                           const Vector3& position) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::fixed;
  body.position = position;
  PlacedShape placed;
  placed.shape = std::move(shape);
  body.shapes.push_back(placed);
  return body;
}

inline std::shared_ptr<Prism> polygon(const std::vector<Vector3>& outline, double length) {
  return make<Prism>([&](Prism& p) { p.outline = outline, p.length = length; });
}

inline std::shared_ptr<Polyhedron> polyhedron(const std::vector<Vector3>& points) {
  return make<Polyhedron>([&](Polyhedron& p) { p.points = points; });
}

inline std::vector<Vector3> ring(int count, double radius, double z) {
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return points;
}

inline std::vector<Vector3> box_corners(const Vector3& size, const Vector3& center) {
  std::vector<Vector3> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3 sign(i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5);
    corners.emplace_back(center + size.cwiseProduct(sign));
  }
  return corners;
}

inline std::vector<Vector3> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  std::vector<Vector3> points(count);
  for (Vector3& point : points) {
    for (int k = 0; k < 3; ++k) {
      point[k] = coordinate(random);
    }
  }
  return points;
}

}  // namespace sheave::test
