// The elastic catenary against closed forms, published numbers and its own laws.

#include "cable/catenary.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

/// Published numbers of single spans, with the gravity that their weights contain.
struct PublishedSpan {
  HangingRope rope;
  double length = 0.0;
  double horizontal = 0.0;
  double start = 0.0;
  double end = 0.0;
};

TEST(Catenary, HasPublishedForces) {
  const double ea = 1.0 / 13e6;
  const PublishedSpan spans[] = {
      {{100.0, 0.0, 10.3005, ea}, 101.0, 2088.39219, 2152.19986, 2152.19986},
      {{100.0, 30.0, 10.3005, ea}, 105.0, 2617.46082, 2629.81058, 2938.75941},
  };
  for (const PublishedSpan& span : spans) {
    const Catenary catenary = catenary_of_length(span.rope, span.length);
    // The published numbers have nine digits.
    EXPECT_NEAR(catenary.horizontal, span.horizontal, 6e-6);
    EXPECT_NEAR(catenary.start_tension(), span.start, 6e-6);
    EXPECT_NEAR(catenary.end_tension(), span.end, 6e-6);
  }
}

TEST(Catenary, HasPublishedForcesNearTaut) {
  const HangingRope rope{246.22420940032947, 263.55766330843164, 3.08735, 1.0 / 7e8};
  const double length = 360.63566262396927;
  EXPECT_NEAR(catenary_of_length(rope, length - 0.01).horizontal, 71116.817, 1e-3);
  EXPECT_NEAR(catenary_of_length(rope, length + 0.01).horizontal, 46077.271, 1e-3);
  const Catenary same = catenary_of_length(rope, length);
  EXPECT_NEAR(same.horizontal, 58377.241, 1e-3);
  EXPECT_NEAR(same.vertical + 0.5 * rope.weight * length, 63044.413, 1e-3);
  EXPECT_NEAR(same.vertical - 0.5 * rope.weight * length, 61931.004, 1e-3);
}

/// Ropes from taut to hanging, level, steep and vertical, inextensible and soft.
template <class Visit>
void for_each_rope(Visit visit) {
  for (const double across : {0.0, 1e-6, 0.3, 1.0, 40.0}) {
    for (const double rise : {-2.0, 0.0, 1e-3, 5.0}) {
      for (const double yield : {0.0, 1e-9, 1e-4, 1e-1}) {
        for (const double weight : {1e-3, 10.0}) {
          const HangingRope rope{across, rise, weight, yield};
          if (rope.chord() == 0.0) continue;
          for (const double longer : {1e-9, 1e-4, 0.1, 3.0, 1e3}) {
            visit(rope, rope.chord() * (1.0 + longer));
          }
        }
      }
    }
  }
}

/// Where the rope ends as its start has it: the integral of the tension's direction and of the stretch.
struct RopeEnd {
  double across = 0.0;
  double rise = 0.0;
};

RopeEnd end_of(const HangingRope& rope, const Catenary& catenary, double length) {
  const double h = catenary.horizontal;
  const double start = catenary.vertical - 0.5 * rope.weight * length;
  const double end = catenary.vertical + 0.5 * rope.weight * length;
  const double both = std::hypot(h, start) + std::hypot(h, end);
  // asinh(end / h) - asinh(start / h) = 2 atanh(w L / both): the form without cancellation.
  const double share = rope.weight * length / both;
  const double turn =
      share > 0.5 ? std::asinh(end / h) - std::asinh(start / h) : 2.0 * std::atanh(share);
  return {h / rope.weight * turn + h * length * rope.yield,
          (start + end) * length * (1.0 / both + 0.5 * rope.yield)};
}

TEST(Catenary, EndsWhereItShould) {
  for_each_rope([](const HangingRope& rope, double length) {
    const Catenary catenary = catenary_of_length(rope, length);
    const RopeEnd end = end_of(rope, catenary, length);
    // The ends of a hanging rope lie within the rounding of the longest part.
    const double rounding = 2e-12 * length;
    EXPECT_NEAR(end.across, rope.across, rounding);
    EXPECT_NEAR(end.rise, rope.rise, rounding);
    EXPECT_NEAR(std::hypot(catenary.horizontal, catenary.vertical + 0.5 * rope.weight * length),
                catenary.end_tension(), 1e-12 * catenary.mean_end);
    EXPECT_NEAR(std::hypot(catenary.horizontal, catenary.vertical - 0.5 * rope.weight * length),
                catenary.start_tension(), 1e-12 * catenary.mean_end);
  });
}

TEST(Catenary, IsTheSameByItsLengthAndByItsTension) {
  for_each_rope([](const HangingRope& rope, double length) {
    if (rope.across < 0.1)
      return;  // the tension of a vertical hanging rope does not tell its length
    const Catenary by_length = catenary_of_length(rope, length);
    const Catenary by_tension = catenary_of_tension(rope, by_length.tension);
    // Long hanging ropes: the tension above the least one is a share of 1e-3 or less.
    EXPECT_NEAR(by_tension.length, length, 1e-9 * length)
        << rope.across << ' ' << rope.rise << ' ' << rope.weight << ' ' << rope.yield;
  });
}

TEST(Catenary, HasTheTensionAskedFor) {
  // The searches for p and S end with a change below 1e-9, which another round would square. Beyond
  // p = 18 the tension of a steep rope is the least one to the last digit.
  for_each_rope([](const HangingRope& rope, double length) {
    const double tension = catenary_of_length(rope, length).tension;
    const Catenary found = catenary_of_tension(rope, tension);
    if (found.parameter >= 18.0) return;
    EXPECT_NEAR(found.tension, tension, 1e-12 * tension);
  });
}

TEST(Catenary, HasNoMoreTensionThanItsBound) {
  for_each_rope([](const HangingRope& rope, double length) {
    // The bound is that of a taut rope, where both are equal but for the rounding of the length,
    // which has a share 1e-16 / (L / c - 1) of the excess.
    const double excess = length / rope.chord() - 1.0;
    const double bound = tension_bound(rope, length);
    EXPECT_LE(catenary_of_length(rope, length).tension, bound * (1.0 + 2e-16 / excess + 1e-15));
    // The tension of level ropes falls as the bound does: it is not empty.
    if (rope.yield > 0.0) return;
    EXPECT_GE(catenary_of_length(rope, length).tension, 0.3 * bound);
  });
}

TEST(Catenary, HasTheSlopeOfItsExcess) {
  for_each_rope([](const HangingRope& rope, double length) {
    if (rope.across < 0.1 || length > 5.0 * rope.chord()) return;
    const Catenary at = catenary_of_length(rope, length);
    const Excess excess = excess_of(rope, at);
    // A hanging rope has at least the tension w |z| / 2, from which the length grows without bound.
    const double step = 1e-5 * (at.tension - 0.5 * rope.weight * std::abs(rope.rise));
    const auto excess_at = [&](double tension) {
      return excess_of(rope, catenary_of_tension(rope, tension)).length;
    };
    const double slope =
        (excess_at(at.tension + step) - excess_at(at.tension - step)) / (2.0 * step);
    // Rounding of the excess over the step, and the third derivative, of (slope / T^2).
    const double rounding = 4e-16 * length / step + 1e-8 * std::abs(slope);
    EXPECT_NEAR(excess.slope, slope, 4.0 * rounding + 1e-14 * rope.yield * length)
        << rope.across << ' ' << rope.rise << ' ' << rope.weight << ' ' << rope.yield << ' '
        << length;
  });
}

TEST(Catenary, HasTheForcesOfItsEnergy) {
  for_each_rope([](const HangingRope& rope, double length) {
    if (rope.across < 0.1 || length > 5.0 * rope.chord() || length < 1.01 * rope.chord()) return;
    const auto energy = [&](double across, double rise) {
      const HangingRope moved{across, rise, rope.weight, rope.yield};
      const Catenary catenary = catenary_of_length(moved, length);
      return rope.weight * height_integral(moved, catenary) + elastic_energy(moved, catenary);
    };
    const double step = 1e-5 * rope.chord();
    const Catenary at = catenary_of_length(rope, length);
    const double by_across =
        (energy(rope.across + step, rope.rise) - energy(rope.across - step, rope.rise)) /
        (2 * step);
    const double by_rise =
        (energy(rope.across, rope.rise + step) - energy(rope.across, rope.rise - step)) /
        (2 * step);
    // Rounding of the energy over the step, and the third derivative: the stiffness of the rope
    // changes over a hundredth of the chord, so (1e-5 / 1e-2)^2 of the force.
    const double bound = 1e-6 * at.mean_end + 1e-9 * rope.weight * length;
    EXPECT_NEAR(by_across, at.horizontal, bound);
    EXPECT_NEAR(by_rise, at.vertical + 0.5 * rope.weight * length, bound);
  });
}

TEST(Catenary, HangsVerticallyFromTwoPoints) {
  // Two legs: (L + z) / 2 on the higher side, (L - z) / 2 on the lower side.
  const HangingRope rope{0.0, 2.0, 5.0, 0.0};
  const Catenary catenary = catenary_of_length(rope, 6.0);
  EXPECT_NEAR(catenary.end_tension(), 5.0 * 4.0, 1e-9);
  EXPECT_NEAR(catenary.start_tension(), 5.0 * 2.0, 1e-9);
  EXPECT_NEAR(catenary.tension, 5.0 * 1.0, 1e-9);
}

TEST(Catenary, StretchesUnderItsOwnWeight) {
  // A load of 50 N below 10 m of rope with 3 N/m and EA of 1000 N:
  // z = L + (T L + w L^2 / 2) / EA with the tension T at the lower end.
  const double length = 10.0;
  const double drop = length + (50.0 * length + 1.5 * length * length) / 1000.0;
  const HangingRope rope{0.0, -drop, 3.0, 1e-3};
  const Catenary catenary = catenary_of_length(rope, length);
  EXPECT_NEAR(catenary.end_tension(), 50.0, 1e-9);
  EXPECT_NEAR(catenary.start_tension(), 80.0, 1e-9);
}

}  // namespace
}  // namespace sheave
