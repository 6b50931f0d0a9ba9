// Bodies on bodies.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/effort.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

TEST(ContactStack, TenBoxesRestForAMinute) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = 0.5;
    heap.floor();
    constexpr double edge = 0.2;
    for (int i = 0; i < 10; ++i) {
      heap.put(test::box(Vector3::Constant(edge)), {0.0, (i + 0.5) * edge, 0.0});
    }
    World world = heap.start();
    const State start = world.state();
    double worst = 0.0;
    std::int64_t fallbacks = 0;
    for (int i = 0; i < test::long_run(3600); ++i) {
      const StepReport report = world.step();
      ASSERT_TRUE(report.ok());
      fallbacks += report.statistics.solver_fallbacks + report.statistics.integrator_fallbacks;
      for (std::size_t b = 1; b < start.bodies.size(); ++b) {
        worst =
            std::max(worst, (world.state().bodies[b].position - start.bodies[b].position).norm());
      }
    }
    EXPECT_LT(worst, 0.01 * edge);
    EXPECT_EQ(fallbacks, 0);
  }
}

TEST(ContactStack, AHeavyBoxRestsOnALightOne) {
  for (const test::Method& method : test::methods) {
    if (method.solver == SolverKind::gauss_seidel) continue;
    for (const double ratio : {1e2, 1e4}) {
      SCOPED_TRACE(test::name_of(method) + " " + std::to_string(ratio));
      Heap heap(method.solver, method.integrator);
      heap.surface.friction = 0.5;
      heap.floor();
      const BodyId light = heap.put(test::box(Vector3::Constant(1.0)), {0.0, 0.5, 0.0});
      const BodyId heavy = heap.put(test::box(Vector3::Constant(1.0)), {0.1, 1.5, 0.2}, ratio);
      World world = heap.start();
      test::run(world, 5.0);
      EXPECT_LT((world.position(light) - Vector3(0.0, 0.5, 0.0)).norm(), 1e-6);
      EXPECT_LT((world.position(heavy) - Vector3(0.1, 1.5, 0.2)).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace sheave
