// The course of a rope in the groove of a drum: lengths of helices, layers, the way back, derivatives.
//
// Lengths are sums of some twenty products of the size 10 m, rounded to 1e-15 each: 1e-13 m. Central
// differences with the step 1e-4 rad of functions that are quadratic in each piece have no error but
// that rounding, 1e-13 / 1e-4 = 1e-9.

#include "cable/drum_groove.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

constexpr double exact = 1e-13;
constexpr double endless = std::numeric_limits<double>::infinity();

/// A hoist's drum of 600 mm with rope of 20 mm, five turns per layer.
DrumGroove hoist(double lead = 0.022, double turns = 5.0) {
  return {0.3, lead, -0.5 * 0.022 * 5.0, turns, 0.018, 0, endless};
}

double helix(double radius, double lead) { return std::hypot(2.0 * pi * radius, lead); }

TEST(DrumGroove, TakesTheLengthOfAHelixPerTurn) {
  const DrumGroove drum = hoist();
  const double turn = 2.0 * pi;
  for (int layer = 0; layer < 4; ++layer) {
    const double helical = helix(0.3 + 0.018 * layer, 0.022);
    const double begin = (5.0 * layer + 1.0) * turn;
    EXPECT_NEAR(drum.length(begin, turn), helical, exact) << layer;
    EXPECT_NEAR(drum.length(begin + turn) - drum.length(begin), helical, exact) << layer;
  }
  // The lead counts: without it a turn of this drum would be 0.13 mm shorter.
  EXPECT_NEAR(helix(0.3, 0.022) - 2.0 * pi * 0.3, 1.2838e-4, 1e-8);
  // Two full layers are ten helices, whatever the change between them.
  EXPECT_NEAR(drum.length(10.0 * turn - 0.5 * pi),
              5.0 * helix(0.3, 0.022) + 4.75 * helix(0.318, 0.022), exact);
}

TEST(DrumGroove, GoesForthAndBackAndShortOfTheEndByAnEighthOfTheLead) {
  const double turn = 2.0 * pi;
  for (const double lead : {0.022, -0.022}) {
    DrumGroove drum = hoist(lead);
    drum.start = -2.5 * lead;
    EXPECT_NEAR(drum.at(0.0).axial, -2.5 * lead, exact);
    EXPECT_NEAR(drum.at(3.0 * turn).axial, 0.5 * lead, exact);
    EXPECT_NEAR(drum.at(5.0 * turn).axial, 2.5 * lead - lead / 8.0, exact);
    EXPECT_NEAR(drum.at(7.0 * turn).axial, 0.5 * lead, exact);
    EXPECT_NEAR(drum.at(10.0 * turn).axial, -2.5 * lead + lead / 8.0, exact);
    EXPECT_NEAR(drum.at(13.0 * turn).axial, 0.5 * lead, exact);
    EXPECT_NEAR(drum.at(3.0 * turn).slope, lead / turn, exact);
    EXPECT_NEAR(drum.at(7.0 * turn).slope, -lead / turn, exact);
    EXPECT_NEAR(drum.at(5.0 * turn).slope, 0.0, exact);
  }
  const DrumGroove drum = hoist();
  const int expected[]{0, 0, 1, 1, 2};
  const double turns[]{2.0, 4.99, 5.01, 9.9, 10.1};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(drum.at(turns[i] * turn).layer, expected[i]) << turns[i];
}

TEST(DrumGroove, HasTheDerivativesOfItsLengthAndPlace) {
  constexpr double step = 1e-4;
  for (const double turns : {1.0, 2.5, 5.0, endless}) {
    const DrumGroove drum = hoist(0.03, turns);
    // No angle lies within a step of an end of a piece, which are multiples of pi / 2.
    for (double angle = 0.01; angle < 90.0; angle += 0.0731) {
      if (std::abs(std::remainder(angle, 0.25 * pi)) < 2.0 * step) continue;
      const DrumGroove::Place place = drum.at(angle);
      const double before = drum.at(angle - step).axial;
      const double after = drum.at(angle + step).axial;
      EXPECT_NEAR((after - before) / (2.0 * step), place.slope, 1e-9) << angle;
      EXPECT_NEAR((drum.length(angle + step) - drum.length(angle - step)) / (2.0 * step),
                  place.gain, 1e-9)
          << angle;
      EXPECT_NEAR(drum.length(angle - step, 2.0 * step) / (2.0 * step), place.gain, exact) << angle;
    }
  }
}

TEST(DrumGroove, HasNoJumpsWhereLayersChange) {
  constexpr double step = 1e-9;
  const DrumGroove drum = hoist(0.03, 2.0);
  for (double angle = 0.25 * pi; angle < 60.0; angle += 0.25 * pi) {
    const DrumGroove::Place before = drum.at(angle - step);
    const DrumGroove::Place after = drum.at(angle + step);
    // Rates are height / pi and lead / pi^2 at most.
    EXPECT_NEAR(before.gain, after.gain, 0.1 * step) << angle;
    EXPECT_NEAR(before.slope, after.slope, 0.1 * step) << angle;
    EXPECT_NEAR(before.axial, after.axial, 0.1 * step) << angle;
  }
}

TEST(DrumGroove, FindsTheAngleOfALength) {
  for (const double turns : {1.0, 2.5, 5.0, endless}) {
    const DrumGroove drum = hoist(0.03, turns);
    for (double angle = 0.0; angle < 90.0; angle += 0.0731) {
      EXPECT_NEAR(drum.angle(drum.length(angle)), angle, 10.0 * exact) << turns;
      for (const double turn : {-2.0, -0.3, 1e-6, 0.4, 7.0}) {
        EXPECT_NEAR(drum.length(angle, turn), drum.length(angle + turn) - drum.length(angle), exact)
            << angle;
      }
    }
  }
}

TEST(DrumGroove, IsFullWithTheLengthOfItsLayers) {
  DrumGroove drum = hoist();
  EXPECT_EQ(drum.full_length(), endless);
  drum.layers = 2;
  EXPECT_NEAR(drum.full_length(), 5.0 * (helix(0.3, 0.022) + helix(0.318, 0.022)), exact);
}

TEST(DrumGroove, EndsForAnyNumber) {
  const DrumGroove drum = hoist();
  EXPECT_TRUE(std::isnan(drum.angle(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_GT(drum.angle(1e12), 1e5);
  EXPECT_GT(drum.at(1e300).gain, 1.0);
  EXPECT_LT(drum.length(-0.1), 0.0);
}

}  // namespace
}  // namespace sheave
