#include "engine/ramp.h"

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

Ramp some_ramp() { return {1.0, 3.0, 2.0, -1.0, 5.0, 4.0, -0.5}; }

TEST(Ramp, HasItsValuesAndRatesAtBothEnds) {
  const Ramp ramp = some_ramp();
  EXPECT_EQ(ramp.at(1.0), 2.0);
  EXPECT_EQ(ramp.rate(1.0), -1.0);
  EXPECT_DOUBLE_EQ(ramp.at(3.0), 5.0);
  // At its end it still arrives, whatever the last bit of the time is.
  EXPECT_NEAR(ramp.rate(3.0), 4.0, 1e-14);
  EXPECT_NEAR(ramp.rate(std::nextafter(3.0, 4.0)), 4.0, 1e-14);
  EXPECT_EQ(ramp.rate(3.1), -0.5);
  EXPECT_DOUBLE_EQ(ramp.at(5.0), 4.0);
}

TEST(Ramp, RateIsTheDerivative) {
  const Ramp ramp = some_ramp();
  const double d = 1e-5;
  for (const double t : {1.1, 1.7, 2.5, 2.9, 4.0}) {
    // The third derivative of the cubic is some 10, so d^2 / 6 of that is left, and rounding over
    // d.
    EXPECT_NEAR(ramp.rate(t), (ramp.at(t + d) - ramp.at(t - d)) / (2.0 * d), 2e-9) << t;
  }
}

TEST(Ramp, IntegralIsExactAcrossItsEnd) {
  const Ramp ramp = some_ramp();
  double sum = 0.0;
  constexpr int parts = 20000;
  const double step = 3.0 / parts;
  for (int i = 0; i < parts; ++i) sum += step * ramp.at(1.5 + (i + 0.5) * step);
  // Midpoints: the second derivative is below 20, times step^2 / 24 of the 3 s.
  EXPECT_NEAR(ramp.integral(1.5, 4.5), sum, 1e-7);
  EXPECT_NEAR(ramp.integral(1.5, 2.0) + ramp.integral(2.0, 4.5), ramp.integral(1.5, 4.5), 1e-14);
}

TEST(Ramp, EqualRatesMakeAStraightLine) {
  const Ramp ramp{0.0, 2.0, 1.0, 1.5, 4.0, 1.5, 0.0};
  for (const double t : {0.3, 1.0, 1.9}) {
    EXPECT_NEAR(ramp.at(t), 1.0 + 1.5 * t, 1e-15);
    EXPECT_NEAR(ramp.rate(t), 1.5, 1e-14);
  }
}

TEST(Ramp, WithoutADurationItJumps) {
  const Ramp ramp{2.0, 2.0, 1.0, 0.0, 7.0, 0.0, 0.0};
  EXPECT_EQ(ramp.at(2.0), 7.0);
  EXPECT_EQ(ramp.rate(2.0), 0.0);
  EXPECT_DOUBLE_EQ(ramp.integral(2.0, 2.5), 3.5);
}

TEST(Ramp, OfVectors) {
  RampOf<Vector3> ramp;
  ramp.to = 1.0;
  ramp.end = {1.0, 2.0, 3.0};
  EXPECT_NEAR((ramp.at(0.5) - Vector3(0.5, 1.0, 1.5)).norm(), 0.0, 1e-15);
  EXPECT_EQ(ramp.rate(0.0), Vector3(Vector3::Zero()));
}

}  // namespace
}  // namespace sheave
