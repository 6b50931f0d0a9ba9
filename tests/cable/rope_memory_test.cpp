// Ropes that remember how they were stretched: the two laws by themselves.
//
// A way through many small strains is the definition of both laws: the memory follows step by step.
// The sums of such a way with n steps per piece have the error of the trapezoidal rule, which is
// c^2 / 12 T'' per strain, plus T' c^2 / 8 at each of the few kinks, with the step c.

#include "cable/rope_memory.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr double transition = 0.02;

CableDef with_table() {
  CableDef cable;
  cable.strain_table = {0.0, 0.01, 0.03, 0.06, 0.1, 0.15};
  cable.tension_table = {0.0, 800.0, 1800.0, 2600.0, 3200.0, 3700.0};
  return cable;
}

CableDef yielding() {
  CableDef cable = with_table();
  cable.unloading_stiffness = 1.2e5;
  return cable;
}

CableDef hysteretic() {
  CableDef cable = with_table();
  cable.unloading_table = {0.0, 200.0, 700.0, 1400.0, 2000.0, 2500.0};
  cable.transition_strain = transition;
  return cable;
}

/// A walk through strains, up and down beyond the last strain of the table and to a slack rope.
constexpr std::array ways{0.03, 0.022, 0.05, 0.0,  0.02,  0.018, 0.12,
                          0.07, 0.085, 0.2,  0.01, -0.02, 0.04,  0.2};

TEST(RopeMemory, OfOneWayIsThatOfItsParts) {
  for (const CableDef& cable : {yielding(), hysteretic()}) {
    const RopeMemory law(cable);
    double m = 0.0;
    double e = 0.0;
    for (const double to : ways) {
      constexpr int parts = 4000;
      double step_m = m;
      double step_e = e;
      double work = 0.0;
      double lost = 0.0;
      for (int i = 1; i <= parts; ++i) {
        const double next = e + (to - e) * i / parts;
        lost += law.lost(step_e, next, step_m);
        const double before = law.tension(step_e, step_m);
        step_m = law.after(next, step_m);
        work += 0.5 * (before + law.tension(next, step_m)) *
                (std::max(next, 0.0) - std::max(step_e, 0.0));
        step_e = next;
      }
      const double way = std::max(to, 0.0) - std::max(e, 0.0);
      // c = 0.2 / 4000, T'' below 1e7 N: 2e-3 x 0.2; kinks 1.2e5 N x c^2
      EXPECT_NEAR(law.mean(e, to, m) * way, work, 1e-3) << e << ' ' << to;
      EXPECT_NEAR(law.lost(e, to, m), lost, 1e-9);
      EXPECT_GE(lost, -1e-12);
      m = law.after(to, m);
      e = to;
      EXPECT_NEAR(m, step_m, 1e-15);
    }
  }
}

TEST(RopeMemory, HasTheDerivativesOfItsTensions) {
  // Central differences of d = 1e-7 have the error d^2 / 6 x T''', below 1e-4 N, and the rounding 1e-16
  // x 4e3 N / d.
  constexpr double d = 1e-7;
  for (const CableDef& cable : {yielding(), hysteretic()}) {
    const RopeMemory law(cable);
    double m = 0.0;
    double e = 0.0;
    for (const double end : ways) {
      for (const double share : {0.13, 0.47, 0.83}) {
        const double to = e + share * (end - e);
        if (to <= law.slack(m) + 1e-3) continue;
        const double slope = (law.tension(to + d, m) - law.tension(to - d, m)) / (2.0 * d);
        EXPECT_NEAR(law.stiffness(to, m), slope, 1e-3 * slope) << e << ' ' << to;
        const double of_mean = (law.mean(e, to + d, m) - law.mean(e, to - d, m)) / (2.0 * d);
        EXPECT_NEAR(law.mean_stiffness(e, to, m), of_mean, 1e-3 * of_mean) << e << ' ' << to;
      }
      m = law.after(end, m);
      e = end;
    }
  }
}

TEST(RopeMemory, OfAYieldingRopeIsWhereItsLineEnds) {
  const CableDef cable = yielding();
  const RopeMemory law(cable);
  const TensionLaw table(cable);
  const double slope = *cable.unloading_stiffness;
  const double m = law.after(0.1, 0.0);
  EXPECT_NEAR(m, 0.1 - 3200.0 / slope, 1e-15);
  EXPECT_EQ(law.slack(m), m);
  for (const double e : {0.08, 0.09, 0.099}) {
    EXPECT_NEAR(law.tension(e, m), slope * (e - m), 1e-9);
    EXPECT_EQ(law.after(e, m), m);
  }
  EXPECT_EQ(law.tension(0.5 * m, m), 0.0);
  EXPECT_NEAR(law.tension(0.12, m), table.tension(0.12), 1e-9);
  // Stretched and let off: the integral of the table less the triangle below the line.
  EXPECT_NEAR(law.lost(0.0, 0.1, 0.0), table.energy(0.1) - 0.5 * 3200.0 * 3200.0 / slope, 1e-10);
  EXPECT_NEAR(law.lost(0.1, 0.0, m), 0.0, 1e-12);
  EXPECT_NEAR(law.lost(0.0, 0.1, m), 0.0, 1e-10);
}

TEST(RopeMemory, OfAnUnloadingCurveEnclosesTheAreaBetweenBoth) {
  // Of straight curves k e and k' e: (k - k') (e^2 / 2 - w^2 / 6 - (e - w) w / 2 - w^2 / 3), see
  // cable/rope_memory.h.
  CableDef cable;
  cable.strain_table = {0.0, 0.1};
  cable.tension_table = {0.0, 4000.0};
  cable.unloading_table = {0.0, 3000.0};
  cable.transition_strain = transition;
  const RopeMemory law(cable);
  for (const double e : {0.02, 0.05, 0.1, 0.3}) {
    const double m = law.after(e, 0.0);
    const double loop = law.lost(0.0, e, 0.0) + law.lost(e, 0.0, m);
    const double area = 1e4 * (0.5 * e * e - transition * transition / 6.0 -
                               0.5 * (e - transition) * transition - transition * transition / 3.0);
    EXPECT_NEAR(loop, area, 1e-12 * (1.0 + area));
    EXPECT_NEAR(law.mean(0.0, e, 0.0) * e - law.returned(e, m), area, 1e-12 * 4e4 * e * e);
    EXPECT_EQ(law.after(0.0, m), 0.0);
  }
}

TEST(RopeMemory, ReturnsOnOneLineAfterASmallTurn) {
  const RopeMemory law(hysteretic());
  const double m = law.after(0.08, 0.0);
  EXPECT_NEAR(m, 0.08 - transition, 1e-15);
  EXPECT_EQ(law.after(0.07, m), m);
  EXPECT_NEAR(law.lost(0.08, 0.07, m) + law.lost(0.07, 0.08, m), 0.0, 1e-11);
}

TEST(RopeMemory, NeverGivesMoreThanItTook) {
  // Ways of a generator of pseudorandom numbers; any prefix that comes back to its first strain and
  // memory has taken energy, because each part loses some and the stored energy is a function of both.
  for (const CableDef& cable : {yielding(), hysteretic()}) {
    const RopeMemory law(cable);
    unsigned seed = 7;
    double m = 0.0;
    double e = 0.0;
    double lost = 0.0;
    for (int i = 0; i < 20000; ++i) {
      seed = seed * 1664525U + 1013904223U;
      const double to = 0.22 * (seed >> 8) / 16777216.0 - 0.02;
      const double part = law.lost(e, to, m);
      const double scale = law.mean(0.0, 0.2, 0.0) * 0.2;
      ASSERT_GE(part, -1e-13 * scale) << e << ' ' << to << ' ' << m;
      lost += part;
      const double taken = law.mean(e, to, m) * (std::max(to, 0.0) - std::max(e, 0.0));
      ASSERT_NEAR(taken, part + law.stored(to, m) - law.stored(e, m), 1e-12 * scale);
      m = law.after(to, m);
      e = to;
    }
    EXPECT_GT(lost, 0.0);
  }
}

TEST(RopeMemory, IsStretchedToATensionForTheFirstTime) {
  for (const CableDef& cable : {yielding(), hysteretic()}) {
    const RopeMemory law(cable);
    EXPECT_EQ(law.first_strain(0.0), 0.0);
    for (const double tension : {1.0, 700.0, 3000.0, 9000.0}) {
      EXPECT_NEAR(law.tension(law.first_strain(tension), 0.0), tension, 1e-10 * tension);
    }
  }
}

TEST(RopeMemory, OfTheseTablesHasNoFault) {
  for (const CableDef& cable : {yielding(), hysteretic()}) {
    EXPECT_FALSE(TensionLaw::fault_of(cable));
    EXPECT_FALSE(RopeMemory::fault_of(cable));
  }
  CableDef cable = hysteretic();
  cable.unloading_table.back() = 3600.0;  // below the table, and steeper beyond its end
  ASSERT_TRUE(RopeMemory::fault_of(cable));
  EXPECT_EQ(RopeMemory::fault_of(cable)->field, "/unloading_table");
  cable.unloading_table[2] = 1900.0;
  ASSERT_TRUE(RopeMemory::fault_of(cable));
}

TEST(RopeMemory, NeedsALineAsSteepAsItsTable) {
  // A cubic between points is steeper than its chord: the first piece has the slope of the parabola
  // through three points at its start.
  CableDef cable = with_table();
  const double first = ((2.0 * 0.01 + 0.02) * 8e4 - 0.01 * 5e4) / 0.03;
  cable.unloading_stiffness = 1.001 * first;
  EXPECT_FALSE(RopeMemory::fault_of(cable));
  cable.unloading_stiffness = 0.999 * first;
  ASSERT_TRUE(RopeMemory::fault_of(cable));
  EXPECT_EQ(RopeMemory::fault_of(cable)->field, "/unloading_stiffness");
}

}  // namespace
}  // namespace sheave
