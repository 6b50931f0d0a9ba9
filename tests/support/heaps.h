#pragma once
// Bodies that touch each other, for tests.

#include "engine/shapes/box.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave::test {

inline std::shared_ptr<Sphere> ball(double radius) {
  return make<Sphere>([&](Sphere& s) { s.radius = radius; });
}

/// Bodies with colliders on a floor through the origin.
class Heap {
 public:
  Model model;
  ColliderDef surface;  ///< of every body that is added

  explicit Heap(SolverKind solver = SolverKind::gauss_seidel,
                IntegratorKind integrator = IntegratorKind::xpbd) {
    model.gravity = down;
    model.step = settings(1.0 / 60.0, 4, 20);
    model.step.solver = solver;
    model.step.integrator = integrator;
  }
  /// Gravity as on a slope that falls towards +x by `angle`, so that its floor stays the plane y =
  /// 0.
  Heap& incline(double angle) {
    model.gravity = g * Vector3(std::sin(angle), -std::cos(angle), 0.0);
    return *this;
  }
  BodyId add(BodyDef body) {
    surface.body = model.add(std::move(body));
    model.colliders.push_back(surface);
    return surface.body;
  }
  BodyId floor() {
    BodyDef body;
    body.name = "floor";
    body.mobility = Mobility::fixed;
    body.shapes.push_back({std::make_shared<HalfSpace>()});
    return add(std::move(body));
  }
  BodyId put(std::shared_ptr<const Shape> shape, const Vector3& position, double mass = 1.0) {
    BodyDef body;
    body.name = "body " + std::to_string(model.bodies.size());
    body.mass = mass;
    body.position = position;
    body.shapes.push_back({std::move(shape)});
    return add(std::move(body));
  }
  [[nodiscard]] BodyDef& last() { return model.bodies.back(); }
  [[nodiscard]] World start() const { return test::start(model); }
};

/// All four ways to step.
struct Method {
  SolverKind solver;
  IntegratorKind integrator;
};
inline constexpr std::array<Method, 4> methods{{
    {SolverKind::gauss_seidel, IntegratorKind::xpbd},
    {SolverKind::direct, IntegratorKind::xpbd},
    {SolverKind::gauss_seidel, IntegratorKind::rattle},
    {SolverKind::direct, IntegratorKind::rattle},
}};
inline std::string name_of(const Method& m) {
  return std::string(solver_names[static_cast<std::size_t>(m.solver)]) + " " +
         std::string(integrator_names[static_cast<std::size_t>(m.integrator)]);
}

}  // namespace sheave::test
