// Rest and small vibrations of ropes that remember how they were stretched: tests/support/rope_memory.h.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/support/rope_memory.h"

namespace sheave::rope_memory_at_rest {
namespace {

using test::g;
using test::rope_memory::hanging;
using test::rope_memory::Law;
using test::rope_memory::length;
using test::rope_memory::letting;
using test::rope_memory::loading;
using test::rope_memory::mass;
using test::rope_memory::steep;
using test::rope_memory::width;

constexpr std::array laws{Law::yields, Law::has_two_curves};

TEST(RopeMemoryAtRest, IsStretchedByItsTable) {
  // The search goes one way from the pose, so the load rests where it would come to if it was let
  // down slowly: at the strain of its weight on the table, for any pose above.
  const double e = mass * g / loading;
  for (const Law law : laws) {
    for (const double start : {-0.01, 0.0, 0.2 * e, 0.9 * e}) {
      Simulation s = test::start(hanging(law, start));
      const Equilibrium rest = find_equilibrium(s);
      ASSERT_TRUE(rest.converged) << rest.message;
      EXPECT_NEAR(s.world.position({0}).y(), -length * (1.0 + e), 1e-10) << start;
      EXPECT_EQ(rest.stability, Stability::stable);
    }
  }
}

TEST(RopeMemoryAtRest, KeepsThePermanentStretchOfAnOverload) {
  // A run from 0.03 m below the slack rope leaves the permanent strain p of the largest strain; the load
  // then rests on the line of unloading, at p + m g / E.
  const double largest = 0.06;
  test::Machine m = hanging(Law::yields, largest);
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
  Simulation s = test::start(m);
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(s.world.step().ok());
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const double p = largest * (1.0 - loading / steep);
  EXPECT_NEAR(s.world.position({0}).y(), -length * (1.0 + p + mass * g / steep), 1e-10);
  EXPECT_NEAR(s.cable_reports()[0].permanent_stretch, length * p, 1e-12);
}

TEST(RopeMemoryAtRest, VibratesOnTheLineOnWhichTheRopeTurns) {
  // At the strain e of the weight on the table, the first motion back is on the line: its slope is E, or
  // k + (k - k') e / w.
  const double e = mass * g / loading;
  for (const Law law : laws) {
    Simulation s = test::start(hanging(law, 0.0));
    ASSERT_TRUE(find_equilibrium(s).converged);
    const double slope = law == Law::yields ? steep : loading + (loading - letting) * e / width;
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 1U);
    EXPECT_LT(modes.imbalance, 1e-9);
    EXPECT_NEAR(modes.modes[0].eigenvalue, slope / (length * mass), 1e-8 * slope);
  }
}

TEST(RopeMemoryAtRest, RunsOnFromThere) {
  for (const Law law : laws) {
    test::Machine m = hanging(law, 0.0);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 0.005);
    Simulation s = test::start(m);
    ASSERT_TRUE(find_equilibrium(s).converged);
    const double height = s.world.position({0}).y();
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.world.position({0}).y(), height, 1e-9);
    EXPECT_NEAR(s.cable_reports()[0].hysteresis_loss, 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace sheave::rope_memory_at_rest
