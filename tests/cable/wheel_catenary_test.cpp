// Ropes with weight between wheels against closed forms, the derivatives of their energy, and the
// single catenary.

#include "cable/wheel_catenary.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace sheave {
namespace {

/// A span with its straight tangent, and the length of that [m].
struct Straight {
  WheelSpan span;
  double length = 0.0;
};

Straight straight(WheelSpan span) {
  const double radii = span.first_radius - span.second_radius;
  const double square = span.across * span.across + span.rise * span.rise;
  const double length = std::sqrt(square - radii * radii);
  span.slope =
      slope_of(span.across * length + span.rise * radii, span.rise * length - span.across * radii);
  return {span, length};
}

TEST(WheelCatenary, IsAClosedFormBetweenEqualWheels) {
  // With a = H / w and the slope d at the wheels, half of the free rope is a tan d long, and
  // reaches a asinh(tan d) level.
  const double a = 50.0;
  const double w = 10.3;
  for (const double radius : {2.0, 0.0, -2.0}) {
    for (const double d : {1e-3, 0.3, 1.2}) {
      const double half = a * std::asinh(std::tan(d));
      const WheelSpan span =
          straight({2.0 * (half + radius * std::sin(d)), 0.0, radius, radius, 0.0, w, 0.0}).span;
      const WheelCatenary rope =
          wheel_catenary_of_length(span, 2.0 * (a * std::tan(d) + radius * d));
      ASSERT_TRUE(rope.found);
      // The excess of the length, d^2 / 6 of it, has the rounding of the length.
      const double rounding = 1e-14 / std::min(d * d, 1.0);
      EXPECT_NEAR(rope.catenary.horizontal, w * a, 10.0 * rounding * w * a);
      EXPECT_NEAR(rope.catenary.end_tension(), w * a / std::cos(d), 20.0 * rounding * w * a);
      EXPECT_NEAR(rope.second_slope, d, 10.0 * rounding * d);
      EXPECT_NEAR(rope.first_slope, -d, 10.0 * rounding * d);
      EXPECT_NEAR(rope.second_arc.length, radius * d, 10.0 * rounding * d * std::abs(radius));
    }
  }
}

TEST(WheelCatenary, StretchesUnderLoadAndItsOwnWeight) {
  // A hoist with a drop of 500 m: F L / EA = 1 m of the hook load, and w L^2 / 2 EA = 0.125 m.
  const double length = 500.0;
  const WheelSpan span = straight({0.5, -501.125, 0.5, 0.0, 0.0, 50.0, 1.0 / 5e7}).span;
  const WheelCatenary rope = wheel_catenary_of_length(span, length);
  ASSERT_TRUE(rope.found);
  // The stretch of 1.125 m has the rounding of 501 m; a drop that is 5e-10 m level is vertical.
  EXPECT_NEAR(rope.catenary.start_tension(), 125e3, 1e-6);
  EXPECT_NEAR(rope.catenary.end_tension(), 100e3, 1e-6);
}

/// Spans over and under wheels, level, steep and down, with lengths from taut to hanging.
template <class Visit>
void for_each_span(double yield, Visit visit) {
  for (const double first : {0.0, 1.5, -1.0}) {
    for (const double second : {0.0, 2.0, -0.5}) {
      for (const double rise : {-30.0, 0.0, 5.0}) {
        const Straight given = straight({20.0, rise, first, second, 0.0, 10.0, yield});
        for (const double longer : {1e-6, 1e-3, 0.03, 0.3}) {
          visit(given.span, given.length * (1.0 + longer));
        }
      }
    }
  }
}

TEST(WheelCatenary, LeavesItsWheelsAlongTheirTangents) {
  for (const double yield : {0.0, 1e-6, 1e-4}) {
    for_each_span(yield, [](const WheelSpan& span, double length) {
      const WheelCatenary rope = wheel_catenary_of_length(span, length);
      ASSERT_TRUE(rope.found) << span.first_radius << " " << span.second_radius << " " << length;
      const Catenary& hung = rope.catenary;
      const double half = 0.5 * span.weight * hung.length;
      // Slopes near the vertical have the rounding of 1 / H, and the search ends at 1e-8.
      EXPECT_NEAR(rope.first_slope, std::atan2(hung.vertical - half, hung.horizontal), 1e-8);
      EXPECT_NEAR(rope.second_slope, std::atan2(hung.vertical + half, hung.horizontal), 1e-8);
      EXPECT_LE(rope.first_slope, span.slope);
      EXPECT_GE(rope.second_slope, span.slope);
      EXPECT_NEAR(rope.length(), length, 1e-9 * length);
    });
  }
}

/// Elastic energy and weight of the rope [J].
double energy_of(const WheelSpan& span, double length) {
  const WheelCatenary rope = wheel_catenary_of_length(span, length);
  return elastic_energy(rope) + span.weight * height_integral(span, rope);
}

TEST(WheelCatenary, PullsByTheDerivativesOfItsEnergy) {
  // The rope is held where it lies on the wheels at the slope of the straight tangent. Moving the
  // second wheel works against the tension at its tangent point and the weight of the additional arc,
  // and more length takes the potential T + T^2 / 2 EA - w z.
  const double yield = 1e-5;
  for_each_span(yield, [&](const WheelSpan& span, double length) {
    constexpr double step = 1e-5;
    const WheelCatenary rope = wheel_catenary_of_length(span, length);
    const auto by = [&](double WheelSpan::*member) {
      WheelSpan more = span;
      WheelSpan less = span;
      more.*member += step;
      less.*member -= step;
      return (energy_of(more, length) - energy_of(less, length)) / (2.0 * step);
    };
    const double by_length =
        (energy_of(span, length + step) - energy_of(span, length - step)) / (2.0 * step);
    const double vertical = rope.catenary.vertical + 0.5 * span.weight * rope.catenary.length;
    // The rounding of 1e4 J is 2e-7 N after division by the step. The stretch of a taut rope is
    // some 1e-5 of the length, so the tension of 1e2 N changes by 1 / 20 per step, and its third
    // derivative leaves less than 1e-5 of it.
    const double off = 1e-6 + 2e-5 * rope.catenary.end_tension();
    EXPECT_NEAR(by(&WheelSpan::across), rope.catenary.horizontal, off);
    EXPECT_NEAR(by(&WheelSpan::rise), vertical + span.weight * rope.second_arc.length, off);
    const double height = span.first_radius * std::cos(span.slope);
    const double tension = rope.first_tension;
    EXPECT_NEAR(-by_length, tension * (1.0 + 0.5 * yield * tension) - span.weight * height, off);
  });
}

TEST(WheelCatenary, PullsByTheDerivativesOfItsEnergyOnAFloor) {
  // As above a floor at a depth that the rope reaches, from a hair to most of its length, and slack.
  const double yield = 1e-5;
  int lying = 0;
  for_each_span(yield, [&](const WheelSpan& given, double length) {
    WheelSpan span = given;
    const double lowest = std::min(0.0, span.rise) - 2.0;
    span.clearance = -lowest;
    for (const double longer : {1.0, 1.1, 1.3, 3.0}) {
      const WheelCatenary rope = wheel_catenary_of_length(span, longer * length);
      if (!rope.catenary.lies) continue;
      // The derivatives jump at touch-down, and have a pole where the rope becomes slack.
      const double floored = rope.catenary.floored(span.weight);
      const auto slack = slack_on_floor(span);
      ASSERT_TRUE(slack);
      if (floored < 0.01 * length || std::abs(slack->length() / rope.length() - 1.0) < 1e-3)
        continue;
      ++lying;
      EXPECT_NEAR(rope.length(), longer * length, 1e-9 * longer * length);
      constexpr double step = 1e-5;
      const auto by = [&](double WheelSpan::*member) {
        WheelSpan more = span;
        WheelSpan less = span;
        more.*member += step;
        less.*member -= step;
        return (energy_of(more, longer * length) - energy_of(less, longer * length)) / (2.0 * step);
      };
      const double by_length =
          (energy_of(span, longer * length + step) - energy_of(span, longer * length - step)) /
          (2.0 * step);
      const double off = 2e-6 + 2e-5 * rope.catenary.end_tension();
      EXPECT_NEAR(by(&WheelSpan::across), rope.catenary.horizontal, off);
      EXPECT_NEAR(by(&WheelSpan::rise), rope.catenary.end_up + span.weight * rope.second_arc.length,
                  off);
      // Moving the floor down takes the weight of the rope that lies there.
      EXPECT_NEAR(-by(&WheelSpan::clearance), span.weight * floored, off);
      const double height = span.first_radius * std::cos(span.slope);
      const double tension = rope.first_tension;
      const double potential = tension * (1.0 + 0.5 * yield * tension) - span.weight * height;
      EXPECT_NEAR(-by_length, potential, off);
      // The potential is that of the part on the floor.
      const double h = rope.catenary.horizontal;
      EXPECT_NEAR(potential, h * (1.0 + 0.5 * yield * h) + span.weight * span.clearance, off);
    }
  });
  EXPECT_GT(lying, 50);
}

TEST(WheelCatenary, DiffersInTensionByWeightTimesHeight) {
  for_each_span(0.0, [](const WheelSpan& span, double length) {
    const WheelCatenary rope = wheel_catenary_of_length(span, length);
    const double first = span.first_radius * std::cos(span.slope);
    const double second = span.rise + span.second_radius * std::cos(span.slope);
    // The slopes of a long rope are known to 1e-8, and so are its heights.
    EXPECT_NEAR(rope.second_tension - rope.first_tension, span.weight * (second - first),
                1e-7 * (rope.second_tension + rope.first_tension));
  });
}

TEST(WheelCatenary, IsTheSameFromTheOtherEnd) {
  for_each_span(1e-6, [](const WheelSpan& span, double length) {
    const WheelSpan mirrored{span.across, -span.rise,  span.second_radius, span.first_radius,
                             -span.slope, span.weight, span.yield};
    const WheelCatenary rope = wheel_catenary_of_length(span, length);
    const WheelCatenary other = wheel_catenary_of_length(mirrored, length);
    EXPECT_NEAR(rope.first_slope, -other.second_slope, 1e-8);
    EXPECT_NEAR(rope.second_slope, -other.first_slope, 1e-8);
    EXPECT_NEAR(rope.catenary.tension, other.catenary.tension, 1e-7 * other.catenary.tension);
  });
}

TEST(WheelCatenary, IsASingleCatenaryBetweenPoints) {
  for_each_span(1e-6, [](const WheelSpan& span, double length) {
    if (span.first_radius != 0.0 || span.second_radius != 0.0) return;
    const HangingRope points{span.across, span.rise, span.weight, span.yield};
    const WheelCatenary rope = wheel_catenary_of_length(span, length);
    EXPECT_EQ(rope.catenary.tension, catenary_of_length(points, length).tension);
    EXPECT_EQ(rope.length(), length);
  });
}

TEST(WheelCatenary, HasTheLengthOfItsTensionAndTheTensionOfItsLength) {
  for_each_span(1e-6, [](const WheelSpan& span, double length) {
    const WheelCatenary rope = wheel_catenary_of_length(span, length);
    const WheelCatenary same = wheel_catenary_of_tension(span, rope.catenary.tension);
    EXPECT_NEAR(same.length(), length, 1e-8 * length);
  });
}

TEST(WheelCatenary, IsFoundOrHangsStraightForAnySpan) {
  // Steep long ropes below wheels may have no slopes that fit; then the rope hangs between the points
  // of the straight tangent, with finite forces.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int found = 0;
  int spans = 0;
  while (spans < 5000) {
    const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
    const double first = between(-2.5, 2.5);
    const double second = between(-2.5, 2.5);
    const double across = between(0.0, 20.0);
    const double rise = between(-20.0, 20.0);
    const double radii = first - second;
    if (std::hypot(across, rise) < std::abs(radii) + 0.1) continue;
    if (across * std::sqrt(across * across + rise * rise - radii * radii) + rise * radii < 0.0)
      continue;
    const Straight given = straight({across, rise, first, second, 0.0, 10.0, 1e-6});
    ++spans;
    const double length = given.length * (1.0 + std::pow(10.0, between(-6.0, 0.3)));
    const WheelCatenary rope = wheel_catenary_of_length(given.span, length);
    found += rope.found ? 1 : 0;
    EXPECT_TRUE(std::isfinite(rope.first_tension) && std::isfinite(rope.second_tension));
    EXPECT_NEAR(rope.length(), length, 1e-3 * length);
  }
  // Ropes twice as long as their chord that hang past a wheel are among these spans.
  EXPECT_GT(found, 4900);
}

}  // namespace
}  // namespace sheave
