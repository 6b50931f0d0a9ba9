#include "engine/time_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

TEST(TimeTable, IsLinearBetweenItsPointsAndConstantOutside) {
  const TimeTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, -20.0}};
  EXPECT_EQ(table.at(-5.0), 10.0);
  EXPECT_EQ(table.at(1.0), 10.0);
  EXPECT_EQ(table.at(1.5), 15.0);
  EXPECT_EQ(table.at(2.0), 20.0);
  EXPECT_EQ(table.at(3.0), 0.0);
  EXPECT_EQ(table.at(9.0), -20.0);
}

TEST(TimeTable, PointsThatDoNotGoTogetherHaveNoSpline) {
  // What a scene with such a fault makes before the fault is told.
  for (const Interpolation kind :
       {Interpolation::cubic, Interpolation::clamped, Interpolation::monotone}) {
    EXPECT_TRUE(TimeTable::of({0.0, 1.0, 2.0}, {1.0}, kind).bends.empty());
    EXPECT_TRUE(TimeTable::of({0.0, 1.0, 2.0}, {}, kind).bends.empty());
  }
}

TEST(TimeTable, IntegralIsExactAcrossCorners) {
  const TimeTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, -20.0}};
  EXPECT_DOUBLE_EQ(table.integral(0.0, 1.0), 10.0);
  EXPECT_DOUBLE_EQ(table.integral(1.0, 2.0), 15.0);
  EXPECT_DOUBLE_EQ(table.integral(2.0, 4.0), 0.0);
  EXPECT_DOUBLE_EQ(table.integral(0.0, 5.0), 10.0 + 15.0 + 0.0 - 20.0);
  EXPECT_DOUBLE_EQ(table.integral(1.25, 1.75), 0.5 * 15.0);
}

TEST(TimeTable, ASingleValueIsConstantAndNoneIsZero) {
  const TimeTable constant{{}, {3.0}};
  EXPECT_EQ(constant.at(7.0), 3.0);
  EXPECT_EQ(constant.integral(1.0, 3.0), 6.0);
  const TimeTable none;
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.integral(0.0, 1.0), 0.0);
}

/// A sine through points `spacing` apart, from 0 to 3.
TimeTable sampled_sine(double spacing, Interpolation interpolation) {
  std::vector<double> times;
  std::vector<double> values;
  const auto count = static_cast<int>(std::lround(3.0 / spacing));
  for (int i = 0; i <= count; ++i) {
    times.push_back(i * spacing);
    values.push_back(std::sin(times.back()));
  }
  return TimeTable::of(times, values, interpolation);
}

/// The same of 3 s^2 - 2 s^3, which begins and ends at rest: s = t / 3.
TimeTable sampled_blend(double spacing, Interpolation interpolation) {
  TimeTable sine = sampled_sine(spacing, Interpolation::linear);
  for (std::size_t i = 0; i < sine.times.size(); ++i) {
    const double s = sine.times[i] / 3.0;
    sine.values[i] = s * s * (3.0 - 2.0 * s);
  }
  return TimeTable::of(sine.times, sine.values, interpolation);
}

// Through points of a cubic polynomial goes no other spline that is one polynomial in its first two
// pieces and in its last.
TEST(TimeTable, SplinesOfCubicPolynomialsAreExact) {
  const auto cubic = [](double t) { return 1.0 - 2.0 * t + 3.0 * t * t - 0.5 * t * t * t; };
  const auto slope = [](double t) { return -2.0 + 6.0 * t - 1.5 * t * t; };
  const auto sum = [](double t) { return t - t * t + t * t * t - 0.125 * t * t * t * t; };
  const std::vector<double> times{0.0, 0.5, 0.6, 2.0, 3.5, 5.0};  // of very different lengths
  std::vector<double> values;
  for (const double t : times) values.push_back(cubic(t));
  const TimeTable table = TimeTable::of(times, values, Interpolation::cubic);
  for (double t = 0.01; t < 5.0; t += 0.07) {
    EXPECT_NEAR(table.at(t), cubic(t), 1e-13) << t;
    EXPECT_NEAR(table.rate(t), slope(t), 1e-13) << t;
    EXPECT_NEAR(table.integral(0.01, t), sum(t) - sum(0.01), 1e-13) << t;
  }
  const TimeTable blend = sampled_blend(0.5, Interpolation::clamped);
  EXPECT_NEAR(blend.rate(1.5), 0.5, 1e-14);
  EXPECT_NEAR(blend.at(0.75), 0.15625, 1e-14);
}

TEST(TimeTable, SplinesOfFewPointsAreALineAndAParabola) {
  const TimeTable line = TimeTable::of({0.0, 2.0}, {1.0, 5.0}, Interpolation::cubic);
  EXPECT_DOUBLE_EQ(line.at(0.5), 2.0);
  const TimeTable parabola = TimeTable::of({0.0, 1.0, 3.0}, {0.0, 1.0, 9.0}, Interpolation::cubic);
  EXPECT_DOUBLE_EQ(parabola.at(2.0), 4.0);
  EXPECT_DOUBLE_EQ(parabola.rate(0.5), 1.0);
  EXPECT_DOUBLE_EQ(parabola.integral(0.0, 3.0), 9.0);
  // 3 s^2 - 2 s^3 is all that goes from 0 to 1 with rate 0 at both ends in one piece.
  const TimeTable step = TimeTable::of({0.0, 1.0}, {0.0, 1.0}, Interpolation::clamped);
  EXPECT_DOUBLE_EQ(step.at(0.25), 0.15625);
  EXPECT_DOUBLE_EQ(step.integral(0.0, 1.0), 0.5);
  const TimeTable one = TimeTable::of({1.0}, {7.0}, Interpolation::cubic);
  EXPECT_EQ(one.at(3.0), 7.0);
}

TEST(TimeTable, SplinesAreTwiceSmooth) {
  for (const Interpolation kind : {Interpolation::cubic, Interpolation::clamped}) {
    const TimeTable table =
        TimeTable::of({0.0, 0.4, 1.0, 1.1, 2.0}, {0.0, 2.0, -1.0, 0.5, 0.0}, kind);
    for (const double t : {0.4, 1.0, 1.1}) {
      // One-sided differences of the rate over e differ by e times the jump of the third
      // derivative, here below 3e4.
      const double e = 1e-7;
      EXPECT_NEAR(table.rate(t - e), table.rate(t + e), 2e-4) << t;
      const double before = (table.rate(t - e) - table.rate(t - 2.0 * e)) / e;
      const double after = (table.rate(t + 2.0 * e) - table.rate(t + e)) / e;
      EXPECT_NEAR(before, after, 0.02) << t;
    }
    const bool clamped = kind == Interpolation::clamped;
    EXPECT_EQ(std::abs(table.rate(1e-12)) < 1e-9, clamped);
    EXPECT_EQ(std::abs(table.rate(2.0)) < 1e-9, clamped);
  }
}

// Values to the fourth order of the spacing, second derivatives to the second, up to the ends.
TEST(TimeTable, SplinesOfSampledMotionsConverge) {
  const auto errors = [](double spacing) {
    const TimeTable table = sampled_sine(spacing, Interpolation::cubic);
    std::array<double, 2> largest{};
    for (double t = 0.001; t < 2.998; t += 0.00137) {
      largest[0] = std::max(largest[0], std::abs(table.at(t) - std::sin(t)));
      const double bend = (table.rate(t + 1e-5) - table.rate(t - 1e-5)) / 2e-5;
      largest[1] = std::max(largest[1], std::abs(bend + std::sin(t)));
    }
    return largest;
  };
  const auto coarse = errors(0.0125);
  const auto fine = errors(0.00625);
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 4.0, 0.15);
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 2.0, 0.15);
}

// Points of a ramp from rest to rest: a spline starts backwards there, and overshoots.
TEST(TimeTable, MonotoneTablesStayBetweenTheirPoints) {
  const std::vector<double> times{0.0, 1.0, 2.0, 3.0, 5.0, 5.5};
  const std::vector<double> values{0.0, 0.0, 3.0, 3.0, 1.0, -4.0};
  const TimeTable spline = TimeTable::of(times, values, Interpolation::cubic);
  EXPECT_LT(spline.at(0.5), -0.1) << "or the points show nothing";
  const TimeTable table = TimeTable::of(times, values, Interpolation::monotone);
  for (double t = 0.0; t <= 5.5; t += 0.01) {
    const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, t) - times.begin();
    const auto [low, high] = std::minmax(values[after - 1], values[after]);
    EXPECT_GE(table.at(t), low - 1e-15) << t;
    EXPECT_LE(table.at(t), high + 1e-15) << t;
  }
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    EXPECT_NEAR(table.rate(times[i] - 1e-9), table.rate(times[i] + 1e-9), 1e-6) << times[i];
  }
}

TEST(TimeTable, MonotoneTablesOfFewPointsAreALineAndAParabola) {
  const TimeTable line = TimeTable::of({0.0, 2.0}, {1.0, 5.0}, Interpolation::monotone);
  EXPECT_DOUBLE_EQ(line.at(0.5), 2.0);
  EXPECT_DOUBLE_EQ(line.rate(1.0), 2.0);
  // The rates of t^2 at 0, 1 and 2: parabolas through three points tell those at the ends.
  const TimeTable parabola =
      TimeTable::of({0.0, 1.0, 2.0}, {0.0, 1.0, 4.0}, Interpolation::monotone);
  EXPECT_DOUBLE_EQ(parabola.rate(2.0), 4.0);
  EXPECT_DOUBLE_EQ(parabola.rate(1.0), 1.5) << "the harmonic mean of 1 and 3";
}

// Rates are right to the second order where they do not change their sign, and so values to the
// third.
TEST(TimeTable, MonotoneTablesOfSampledMotionsConverge) {
  const auto error = [](double spacing) {
    const TimeTable table = sampled_sine(spacing, Interpolation::monotone);
    double largest = 0.0;
    for (double t = 0.0; t < 1.2; t += 0.00137)
      largest = std::max(largest, std::abs(table.at(t) - std::sin(t)));
    return largest;
  };
  EXPECT_NEAR(std::log2(error(0.0125) / error(0.00625)), 3.0, 0.15);
}

TEST(TimeTable, IntegralsOfSplinesHaveTheRightRates) {
  for (const Interpolation kind : {Interpolation::cubic, Interpolation::monotone}) {
    const TimeTable table = sampled_sine(0.3, kind);
    // Of a fine midpoint rule: second order, 3 (1e-4)^2 / 24.
    double sum = 0.0;
    for (int i = 0; i < 40000; ++i) sum += 1e-4 * table.at(-0.5 + (i + 0.5) * 1e-4);
    EXPECT_NEAR(table.integral(-0.5, 3.5), sum, 2e-9);
    EXPECT_NEAR(table.integral(0.7, 0.70001), 1e-5 * table.at(0.700005), 1e-16)
        << "but for the rounding of the times";
    double way = 0.0;
    for (int i = 0; i < 30000; ++i) way += 1e-4 * table.rate((i + 0.5) * 1e-4);
    EXPECT_NEAR(way, table.at(3.0) - table.at(0.0), 2e-9);
  }
}

}  // namespace
}  // namespace sheave
