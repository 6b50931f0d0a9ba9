// Tensions along ropes with weight, in reports and where a rope parts.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/start_warnings.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr double heavy_density = 4.0;  // [kg/m]

/// 100 kg on 20 m of rope, counted from above or from below, at rest.
test::Machine heavy_hoist(bool from_load, IntegratorKind integrator = IntegratorKind::rattle) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(integrator, 1.0 / 240.0);
  constexpr double stiffness = 1e6;
  // The rope is stretched as by its tension in the middle.
  const double middle = (100.0 + 0.5 * 20.0 * heavy_density) * test::g;
  const double below = 20.0 * (1.0 + middle / stiffness);
  m.model.add(test::weight("load", {0.0, -below, 0.0}, 100.0));
  const auto top = test::attach(BodyId::world());
  const auto load = test::attach({0});
  m.cables.push_back(from_load ? test::cable("rope", {load, top})
                               : test::cable("rope", {top, load}));
  m.cables[0].linear_density = heavy_density;
  m.cables[0].axial_stiffness = stiffness;
  m.cables[0].rest_lengths = {20.0};
  return m;
}

TEST(HeavyTension, AtAPlaceIsTheWeightBelow) {
  for (const bool from_load : {false, true}) {
    const Simulation s = test::start(heavy_hoist(from_load));
    const CableReport report = s.cable_reports()[0];
    for (const double share : {0.0, 0.3, 1.0}) {
      const double below = 20.0 * (from_load ? share : 1.0 - share);
      // The strain of 1e-3 is that of rounded lengths, 1e-16 / 1e-3.
      const double closed = (100.0 + heavy_density * below) * test::g;
      EXPECT_NEAR(report.spans[0].tension_at(share), closed, 1e-11 * closed);
    }
    const double top = (100.0 + 20.0 * heavy_density) * test::g;
    EXPECT_NEAR(report.spans[0].largest_tension(), top, 1e-11 * top);
    EXPECT_NEAR(report.largest_tension(), top, 1e-11 * top);
    EXPECT_LT(report.spans[0].tension, 0.8 * top);
  }
}

TEST(HeavyTension, OfASaggingRopeIsThatOfItsCatenary) {
  // Two points at heights that differ by z: the tension T(y) - T(0) is w y exactly, and the horizontal
  // component is the same everywhere. The rope is counted from either end, in any direction.
  for (const double turn : {0.0, 2.0}) {
    for (const bool mirrored : {false, true}) {
      test::Machine m;
      m.model.gravity = test::down;
      const Vector3 high(8.0 * std::cos(turn), 3.0, 8.0 * std::sin(turn));
      const auto low = test::attach(BodyId::world());
      const auto other = test::attach(BodyId::world(), high);
      m.model.add(test::weight("elsewhere", {0.0, -50.0, 0.0}, 1.0));
      m.cables.push_back(mirrored ? test::cable("rope", {other, low})
                                  : test::cable("rope", {low, other}));
      m.cables[0].linear_density = heavy_density;
      m.cables[0].axial_stiffness = 1e12;
      m.cables[0].rest_lengths = {10.0};
      const Simulation s = test::start(m);
      const SpanReport span = s.cable_reports()[0].spans[0];
      ASSERT_TRUE(span.hangs);
      const double weight = heavy_density * test::g;
      const double rise =
          span.tension_at(mirrored ? 0.0 : 1.0) - span.tension_at(mirrored ? 1.0 : 0.0);
      // The strain is 1e-10.
      EXPECT_NEAR(rise, 3.0 * weight, 1e-8 * weight);
      EXPECT_EQ(span.largest_tension(), span.tension_at(mirrored ? 0.0 : 1.0));
      // In the lowest point the tension is the horizontal component.
      const double level = std::hypot(span.start_force.x(), span.start_force.z());
      double least = span.largest_tension();
      for (int i = 0; i <= 1000; ++i) least = std::min(least, span.tension_at(0.001 * i));
      EXPECT_GE(least, level * (1.0 - 1e-12));
      EXPECT_LT(least, level * (1.0 + 1e-4));
    }
  }
}

TEST(HeavyTension, WithoutWeightIsThatOfTheSpan) {
  test::Machine m = heavy_hoist(false);
  m.cables[0].linear_density = 0.0;
  const Simulation s = test::start(m);
  const SpanReport span = s.cable_reports()[0].spans[0];
  EXPECT_GT(span.tension, 0.0);
  for (const double share : {0.0, 0.37, 1.0}) EXPECT_EQ(span.tension_at(share), span.tension);
}

TEST(HeavyTension, PartsTheRopeWhereItIsLargest) {
  // 1373 N along the chord, 1766 N at the top.
  const double top = (100.0 + 20.0 * heavy_density) * test::g;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double share : {0.85, 0.99, 1.01}) {
      test::Machine m = heavy_hoist(false, integrator);
      m.cables[0].breaking_tension = share * top;
      Simulation s = test::start(m);
      for (int i = 0; i < 5; ++i) ASSERT_TRUE(s.step().ok());
      EXPECT_EQ(s.cable_reports()[0].cut, share < 1.0) << share;
    }
  }
}

TEST(HeavyTension, AStartAboveTheBreakingTensionIsWarnedOf) {
  const auto warned = [](double breaking_tension) {
    test::Machine m = heavy_hoist(false);
    m.cables[0].breaking_tension = breaking_tension;
    std::vector<Warning> warnings;
    append_strain_warnings(test::start(m), warnings);
    return warnings;
  };
  const std::vector<Warning> warnings = warned(1500.0);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].message.find("with 1.77e+03 N, and parts at once"), std::string::npos)
      << warnings[0].message;
  EXPECT_TRUE(warned(1800.0).empty());
}

}  // namespace
}  // namespace sheave
