// at(), rate() and integral() of one function of time must belong together: the rate is the slope
// of the value, the value that of the integral.

#include "engine/time_signal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

/// A table with a sine on it; corners at 0.5, 1 and 2.5 s.
TimeSignal table_and_sine() { return {{{0.5, 1.0, 2.5}, {1.0, 4.0, -2.0}}, 0.7, 1.3, 0.4}; }

/// Integral by Simpson's rule. Its error is (to - from) d^4 |f''''| / 180 for the spacing d = 1 /
/// 2000 s: with
/// |f''''| <= 0.7 (2 pi 1.3)^4 = 3116 below 4e-12 for 4 s, and none from the table, whose corners are nodes.
double quadrature(const TimeSignal& signal, double from, double to) {
  const auto pieces = static_cast<int>(std::lround((to - from) * 1000.0));
  const double d = (to - from) / (2.0 * pieces);
  double sum = 0.0;
  for (int i = 0; i < pieces; ++i) {
    const double left = from + 2.0 * i * d;
    sum += d / 3.0 * (signal.at(left) + 4.0 * signal.at(left + d) + signal.at(left + 2.0 * d));
  }
  return sum;
}

TEST(TimeSignal, IsTheTableAndTheSine) {
  const TimeSignal s = table_and_sine();
  EXPECT_DOUBLE_EQ(s.at(0.0), 1.0 + 0.7 * std::sin(0.4));
  EXPECT_DOUBLE_EQ(s.at(0.75), 2.5 + 0.7 * std::sin(2.0 * pi * 1.3 * 0.75 + 0.4));
  EXPECT_DOUBLE_EQ(s.at(9.0), -2.0 + 0.7 * std::sin(2.0 * pi * 1.3 * 9.0 + 0.4));
}

TEST(TimeSignal, RateIsTheSlope) {
  const TimeSignal s = table_and_sine();
  // Central differences: d^2 / 6 |f'''| <= 1e-8 / 6 x 0.7 (2 pi 1.3)^3 = 6.4e-7, and rounding 1e-15
  // / d = 1e-11.
  const double d = 1e-4;
  for (const double t : {0.2, 0.7, 0.99, 1.01, 2.4, 2.6, 5.0}) {
    EXPECT_NEAR(s.rate(t), (s.at(t + d) - s.at(t - d)) / (2.0 * d), 7e-7) << t;
  }
}

TEST(TimeSignal, TheRateAtACornerIsThatOfThePieceBefore) {
  TimeSignal s = table_and_sine();
  s.amplitude = 0.0;
  EXPECT_EQ(s.rate(0.5), 0.0);
  EXPECT_DOUBLE_EQ(s.rate(1.0), 6.0);
  EXPECT_DOUBLE_EQ(s.rate(2.5), -4.0);
  EXPECT_EQ(s.rate(2.5 + 1e-12), 0.0);
}

TEST(TimeSignal, IntegralIsTheIntegralOfTheValue) {
  const TimeSignal s = table_and_sine();
  const std::pair<double, double> spans[] = {{0.0, 0.4}, {0.5, 1.0}, {0.2, 3.0},
                                             {0.9, 1.1}, {2.5, 4.0}, {0.0, 4.0}};
  for (const auto& [from, to] : spans) {
    EXPECT_NEAR(s.integral(from, to), quadrature(s, from, to), 1e-11) << from << " to " << to;
  }
}

TEST(TimeSignal, IntegralsAddUp) {
  const TimeSignal s = table_and_sine();
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) sum += s.integral(0.003 * i, 0.003 * (i + 1));
  // A thousand roundings of numbers below 5.
  EXPECT_NEAR(sum, s.integral(0.0, 3.0), 1e-12);
}

TEST(TimeSignal, IntegralOfAShortTimeKeepsItsDigits) {
  // From cosines it would be a difference of numbers near 1 with but 7 digits left.
  const TimeSignal s{{{}, {}}, 2.0, 0.5, 0.3};
  const double from = 1.0;
  const double to = 1.0 + 1e-9;
  const double expected = s.at(0.5 * (from + to)) * (to - from);
  EXPECT_NEAR(s.integral(from, to) / expected, 1.0, 1e-14);
  EXPECT_EQ(s.integral(from, from), 0.0);
}

TEST(TimeSignal, ASineWithoutFrequencyIsConstant) {
  const TimeSignal s{{{}, {1.0}}, 2.0, 0.0, 0.5 * pi};
  EXPECT_DOUBLE_EQ(s.at(3.0), 3.0);
  EXPECT_EQ(s.rate(3.0), 0.0);
  EXPECT_DOUBLE_EQ(s.integral(1.0, 3.0), 6.0);
}

TEST(TimeSignal, NothingGivenIsZero) {
  const TimeSignal s;
  EXPECT_EQ(s.at(1.0), 0.0);
  EXPECT_EQ(s.rate(1.0), 0.0);
  EXPECT_EQ(s.integral(0.0, 7.0), 0.0);
}

}  // namespace
}  // namespace sheave
