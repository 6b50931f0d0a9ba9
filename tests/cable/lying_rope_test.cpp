// Ropes that lie on a floor: published and independent numbers, the laws at the head of
// cable/lying_rope.h, and derivatives by differences.

#include "cable/lying_rope.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

HangingRope rope_over_floor(double across, double start, double end, double weight,
                            double stiffness) {
  HangingRope rope{across, end - start, weight, stiffness > 0.0 ? 1.0 / stiffness : 0.0};
  rope.clearance = start;
  return rope;
}

double floored_of(const HangingRope& rope, const Catenary& found) {
  return found.length - (found.end_up - found.start_up) / rope.weight;
}

TEST(LyingRope, HasThePublishedForces) {
  // 400 m x 200 m, 500 m of rope. The published numbers are converged to 3e-7.
  const HangingRope rope = rope_over_floor(400.0, 0.0, 200.0, 800.0, 7.51e12);
  const Catenary found = catenary_of_length(rope, 500.0);
  EXPECT_NEAR(found.horizontal, 96643.428, 96643.428 * 1e-6);
  EXPECT_NEAR(found.end_up, 237751.755, 237751.755 * 1e-6);
  EXPECT_NEAR(floored_of(rope, found), 202.810306, 202.810306 * 1e-6);
  EXPECT_EQ(found.start_up, 0.0);
}

struct LyingNumbers {
  double across = 0.0;
  double start = 0.0;
  double end = 0.0;
  double length = 0.0;
  double weight = 0.0;
  double stiffness = 0.0;
  double horizontal = 0.0;
  double start_load = 0.0;
  double end_load = 0.0;
  double floored = 0.0;
};

// The equations of the sea bed by the vertical forces at the ends (J. M. Jonkman, NREL/TP-500-41958,
// section 2.7.2, without friction), bisected with 40 digits.
constexpr std::array lying_numbers{
    LyingNumbers{400.0, 0.0, 200.0, 500.0, 800.0, 7.51e12, 96643.45354712023, 0.0,
                 237751.7680341978, 202.8102899572527},
    LyingNumbers{100.0, 10.0, 10.0, 130.0, 20.0, 1e6, 0.0, 199.9800039990003, 199.9800039990003,
                 110.0019996001},
    LyingNumbers{100.0, 4.0, 30.0, 120.0, 20.0, 1e5, 164.6986603959475, 180.7536022719577,
                 743.9180727426396, 73.76641624927014},
    LyingNumbers{60.0, 0.0, 25.0, 75.0, 50.0, 0.0, 424.4668850979175, 0.0, 1619.773815304098,
                 42.60452369391804},
    LyingNumbers{80.0, 5.0, 0.0, 81.0, 10.0, 2e4, 113.2445934471139, 117.1010292881299, 0.0,
                 69.28989707118701},
    LyingNumbers{90.0, 20.0, 1.0, 100.0, 100.0, 5e5, 1155.82014087691, 2927.331183800559,
                 490.4690470806766, 65.82199769118765},
    LyingNumbers{10.0, 1.0, 2.0, 11.5, 3.0, 1e3, 2.665812132458696, 4.98539947794488,
                 8.210161222433579, 7.101479766540513},
};

TEST(LyingRope, HasTheForcesOfAnotherProgram) {
  for (const LyingNumbers& given : lying_numbers) {
    for (const bool mirrored : {false, true}) {
      const double start = mirrored ? given.end : given.start;
      const double end = mirrored ? given.start : given.end;
      const HangingRope rope =
          rope_over_floor(given.across, start, end, given.weight, given.stiffness);
      const Catenary found = catenary_of_length(rope, given.length);
      ASSERT_TRUE(found.lies);
      // H follows from differences of lengths of the size of the rope: their rounding is some
      // 1e-15 of it, and H changes by up to 200 times the share.
      const double size = given.weight * given.length;
      EXPECT_NEAR(found.horizontal, given.horizontal, 1e-13 * size);
      EXPECT_NEAR(-found.start_up, mirrored ? given.end_load : given.start_load, 1e-13 * size);
      EXPECT_NEAR(found.end_up, mirrored ? given.start_load : given.end_load, 1e-13 * size);
      EXPECT_NEAR(floored_of(rope, found), given.floored, 1e-13 * given.length);
    }
  }
}

/// Ropes that lie from a hair to nearly all, slack and taut, with ends on the floor and above it.
template <class Visit>
void for_each_lying(Visit visit) {
  int lying = 0;
  for (const double across : {0.5, 10.0, 300.0}) {
    for (const double start : {0.0, 1e-6, 0.2, 5.0}) {
      for (const double end : {0.0, 1e-3, 2.0, 40.0}) {
        for (const double stiffness : {0.0, 1e3, 1e6}) {
          const HangingRope rope = rope_over_floor(across, start, end, 8.0, stiffness);
          const double slack =
              across + hung_part(rope, start, 0.0).length + hung_part(rope, end, 0.0).length;
          for (const double share : {0.7, 0.9, 0.99, 0.999999, 1.0, 1.5}) {
            const double length = share * slack;
            if (rope.yield == 0.0 && length <= rope.chord()) continue;
            const Catenary found = catenary_of_length(rope, length);
            if (!found.lies) continue;
            // The chord tension of soft steep ropes does not rise with H (cable/lying_rope.h).
            const double strain = rope.yield * rope.weight * std::abs(rope.rise);
            if (start > 0.0 && end > 0.0 && across < strain * std::abs(rope.rise)) continue;
            ++lying;
            visit(rope, found);
          }
        }
      }
    }
  }
  EXPECT_GT(lying, 400);
}

TEST(LyingRope, HangsFromItsEndsToTheFloor) {
  for_each_lying([](const HangingRope& rope, const Catenary& found) {
    SCOPED_TRACE(testing::Message() << rope.across << ' ' << rope.clearance << ' ' << rope.rise
                                    << ' ' << rope.yield << ' ' << found.length);
    const double h = found.horizontal;
    const double w = rope.weight;
    double width = 0.0;
    for (const auto& [load, height] : {std::pair{-found.start_up, rope.clearance},
                                       std::pair{found.end_up, rope.clearance + rope.rise}}) {
      const double tension = std::hypot(h, load);
      // The height of a hanging part, and its width, by its vertical force.
      const double lift = load * load / (tension + h + 1e-300) / w;
      EXPECT_NEAR(lift + 0.5 * rope.yield * load * load / w, height,
                  1e-13 * (height + rope.across));
      if (h > 0.0) width += h / w * std::asinh(load / h) + rope.yield * h * load / w;
    }
    const double floored = floored_of(rope, found);
    EXPECT_GE(floored, -1e-13 * found.length);
    const double left = rope.across - width - floored * (1.0 + rope.yield * h);
    if (h > 0.0) {
      EXPECT_NEAR(left, 0.0, 4e-13 * found.length);
    } else {
      EXPECT_LE(left, 1e-13 * found.length);
    }
  });
}

TEST(LyingRope, IsTheSameByItsTension) {
  for_each_lying([](const HangingRope& rope, const Catenary& found) {
    SCOPED_TRACE(testing::Message() << rope.across << ' ' << rope.clearance << ' ' << rope.rise
                                    << ' ' << rope.yield << ' ' << found.length);
    const Catenary same = catenary_of_tension(rope, found.tension);
    // Rounding decides at the instant of touch-down.
    ASSERT_TRUE(same.lies || floored_of(rope, found) < 1e-12 * found.length)
        << floored_of(rope, found);
    if (!same.lies) return;
    // The chord tension of a steep rope has a part that does not depend on H: (w / 2)(s1 - s0) z.
    const double rounding = 1e-14 * found.tension * rope.chord() / rope.across;
    EXPECT_NEAR(same.horizontal, found.horizontal, rounding + 1e-13 * found.horizontal);
    if (found.horizontal > 0.0) {
      const double by_tension = std::abs(lying_slopes(rope, found).length);
      EXPECT_NEAR(same.length, found.length, 1e-13 * found.length + 30.0 * by_tension * rounding);
    } else {
      EXPECT_EQ(same.horizontal, 0.0);
      EXPECT_LE(same.length, found.length * (1.0 + 1e-15));
    }
    EXPECT_NEAR(
        excess_of(rope, same).length, excess_of(rope, found).length,
        1e-12 * found.length + 30.0 * rounding * std::abs(lying_slopes(rope, found).length));
  });
}

/// Elastic energy and weight, above the floor.
double energy_on_floor(double across, double start, double end, double length,
                       const HangingRope& like) {
  HangingRope rope = like;
  rope.across = across;
  rope.rise = end - start;
  rope.clearance = start;
  const Catenary found = catenary_of_length(rope, length);
  return rope.weight * (height_integral(rope, found) + length * start) +
         elastic_energy(rope, found);
}

TEST(LyingRope, ForcesAreDerivativesOfTheEnergy) {
  for_each_lying([](const HangingRope& rope, const Catenary& found) {
    const double start = rope.clearance;
    const double end = start + rope.rise;
    // Ends near the floor and ropes near touch-down have no differences on one side of the kink.
    const auto near = [](double height) { return height > 0.0 && height < 0.01; };
    if (near(start) || near(end) || floored_of(rope, found) < 0.02 * found.length) return;
    if (found.horizontal > 50.0 * rope.weight * found.length || rope.yield == 0.0) return;
    SCOPED_TRACE(testing::Message() << rope.across << ' ' << start << ' ' << end << ' '
                                    << rope.yield << ' ' << found.length);
    const double step = 1e-5 * found.length;
    const auto energy = [&](double x, double z0, double z1, double l) {
      return energy_on_floor(rope.across + x, start + z0, end + z1, found.length + l, rope);
    };
    const double size = rope.weight * found.length + found.mean_end;
    // Error of the differences: step^2 times the third derivative, and rounding of the energy. Where H
    // goes to 0 the third derivative has a pole, so slack ropes that just become taut are left out.
    const double slack = rope.across + hung_part(rope, start, 0.0).length +
                         hung_part(rope, end, 0.0).length - found.length;
    if (std::abs(slack) < 1e-3 * found.length) return;
    const double close = 2e-6 * size;
    EXPECT_NEAR((energy(step, 0, 0, 0) - energy(-step, 0, 0, 0)) / (2 * step), found.horizontal,
                close);
    if (start > 0.0) {
      EXPECT_NEAR((energy(0, step, 0, 0) - energy(0, -step, 0, 0)) / (2 * step), -found.start_up,
                  close);
    }
    if (end > 0.0) {
      EXPECT_NEAR((energy(0, 0, step, 0) - energy(0, 0, -step, 0)) / (2 * step), found.end_up,
                  close);
    }
    const double potential = found.horizontal * (1.0 + 0.5 * rope.yield * found.horizontal);
    EXPECT_NEAR((energy(0, 0, 0, step) - energy(0, 0, 0, -step)) / (2 * step), -potential,
                close * (1.0 + rope.yield * size));
  });
}

TEST(LyingRope, SlopesAreDifferences) {
  for_each_lying([](const HangingRope& rope, const Catenary& found) {
    const double least = least_tension(rope);
    if (!(found.tension > least * (1.0 + 1e-6))) return;
    if (floored_of(rope, found) < 0.02 * found.length) return;
    SCOPED_TRACE(testing::Message() << rope.across << ' ' << rope.clearance << ' ' << rope.rise
                                    << ' ' << rope.yield << ' ' << found.length);
    // The functions are made of powers and logarithms of H, so a step of 1e-4 has errors of 1e-8, and
    // up to a thousand times as much where the power is -3/2 beside a constant.
    const double step = 1e-4 * (found.tension - least);
    const auto at = [&](double more) { return catenary_of_tension(rope, found.tension + more); };
    const Catenary more = at(step);
    const Catenary less = at(-step);
    const LyingSlopes slopes = lying_slopes(rope, found);
    const double rounding = 1e-13 * found.tension / step;
    const auto check = [&](double high, double low, double slope, double scale) {
      EXPECT_NEAR(
          (high - low) / (2.0 * step), slope,
          1e-5 * std::abs(slope) + rounding * std::max(scale, std::abs(high) / found.tension));
    };
    check(more.horizontal, less.horizontal, slopes.horizontal, rope.chord() / rope.across);
    check(more.start_up, less.start_up, slopes.start, slopes.horizontal);
    check(more.end_up, less.end_up, slopes.end, slopes.horizontal);
    check(more.length, less.length, slopes.length,
          30.0 * std::abs(slopes.length) * rope.chord() / rope.across);
    const Excess excess = excess_of(rope, found);
    if (excess.length > 0.0) {
      check(excess_of(rope, more).length, excess_of(rope, less).length, excess.slope,
            30.0 * std::abs(slopes.length) * rope.chord() / rope.across);
    }
  });
}

TEST(LyingRope, IsAFreeRopeAtTouchDown) {
  // A level rope touches the floor where its sag is the height of its ends: with a tangent a of its
  // end, w s / H = a, so that the inextensible length and width are 2 H a / w and 2 H asinh(a) / w.
  for (const double tangent : {0.01, 0.5, 4.0}) {
    const double weight = 7.0;
    const double h = 90.0;
    const double height = h / weight * (std::sqrt(1.0 + tangent * tangent) - 1.0);
    const double across = 2.0 * h / weight * std::asinh(tangent);
    const double length = 2.0 * h / weight * tangent;
    const HangingRope rope = rope_over_floor(across, height, height, weight, 0.0);
    double jump = 0.0;
    for (const double off : {1e-4, 1e-6, 1e-8}) {
      const Catenary free = catenary_of_length(rope, length * (1.0 - off));
      const Catenary lying = catenary_of_length(rope, length * (1.0 + off));
      EXPECT_FALSE(free.lies);
      EXPECT_TRUE(lying.lies);
      const double change = std::abs(free.horizontal - lying.horizontal);
      if (jump > 0.0) {
        EXPECT_LT(change, 0.02 * jump);  // in proportion to `off`
      }
      jump = change;
      EXPECT_NEAR(lying.horizontal, h, 2.0 * change + 1e-9 * h);
    }
  }
}

TEST(LyingRope, LiesWholeAsAStraightSpring) {
  const HangingRope rope = rope_over_floor(20.0, 0.0, 0.0, 5.0, 1e4);
  const Catenary taut = catenary_of_length(rope, 19.9);
  ASSERT_TRUE(taut.lies);
  EXPECT_NEAR(taut.horizontal, 1e4 * (20.0 / 19.9 - 1.0), 1e-9);
  EXPECT_EQ(taut.start_up, 0.0);
  EXPECT_EQ(catenary_of_length(rope, 20.0).horizontal, 0.0);
  EXPECT_EQ(catenary_of_length(rope, 30.0).horizontal, 0.0);
  EXPECT_NEAR(excess_of(rope, taut).length, 0.0, 1e-14);
  EXPECT_NEAR(excess_of(rope, taut).slope, 0.0, 1e-15);
}

TEST(LyingRope, HangsPlumbWhereItIsSlack) {
  // w s = w b without stretch; with e, w s + e (w s)^2 / 2 = w b.
  const HangingRope rope = rope_over_floor(3.0, 2.0, 4.0, 10.0, 1e3);
  const Catenary slack = catenary_of_length(rope, 12.0);
  EXPECT_EQ(slack.horizontal, 0.0);
  EXPECT_NEAR(-slack.start_up, 1e3 * (std::sqrt(1.0 + 2.0 * 20.0 / 1e3) - 1.0), 1e-12);
  EXPECT_NEAR(slack.end_up, 1e3 * (std::sqrt(1.0 + 2.0 * 40.0 / 1e3) - 1.0), 1e-12);
  EXPECT_EQ(slack.tension, least_tension(rope));
  // The energy of the rest is 0: that of both hanging parts, w s^2 / 2 and half of their stretch.
  const HangingRope stiff = rope_over_floor(3.0, 2.0, 4.0, 10.0, 0.0);
  const Catenary heap = catenary_of_length(stiff, 12.0);
  EXPECT_NEAR(height_integral(stiff, heap) + 2.0 * 12.0, 0.5 * (4.0 + 16.0), 1e-13);
}

TEST(LyingRope, IsAFreeRopeAboveItsFloor) {
  for (const double yield : {0.0, 1e-4}) {
    for (const double rise : {-3.0, 0.0, 8.0}) {
      const HangingRope free{30.0, rise, 6.0, yield};
      HangingRope above = free;
      above.clearance = 20.0;
      for (const double longer : {1e-9, 1e-3, 0.1}) {
        const double length = free.chord() * (1.0 + longer);
        const Catenary one = catenary_of_length(free, length);
        const Catenary other = catenary_of_length(above, length);
        EXPECT_FALSE(other.lies);
        EXPECT_EQ(one.horizontal, other.horizontal);
        EXPECT_EQ(one.vertical, other.vertical);
        EXPECT_EQ(catenary_of_tension(free, one.tension).length,
                  catenary_of_tension(above, one.tension).length);
      }
    }
  }
}

/// Ropes from an anchor to an end above the floor, or back, with friction and tensions of before.
template <class Visit>
void for_each_held(Visit visit) {
  int held = 0;
  for (const bool at_end : {false, true}) {
    for (const double height : {0.0, 0.5, 20.0}) {
      for (const double stiffness : {2e3, 1e6}) {
        for (const double friction : {0.1, 0.7, 3.0}) {
          HangingRope rope = at_end ? rope_over_floor(60.0, height, 0.0, 8.0, stiffness)
                                    : rope_over_floor(60.0, 0.0, height, 8.0, stiffness);
          FloorProfile tensions(50.0, 100.0);
          const double slope = friction * rope.weight;
          tensions.limit(50.0, 130.0, slope);
          tensions.limit(51.0, 90.0, slope);
          rope.grip = {&tensions, slope, at_end};
          for (const double share : {0.9, 0.99, 0.999, 1.0, 1.2}) {
            const double slack = catenary_of_tension(rope, 0.0).length;
            const Catenary found = catenary_of_length(rope, share * slack);
            if (!found.lies) continue;
            SCOPED_TRACE(testing::Message() << at_end << ' ' << height << ' ' << stiffness << ' '
                                            << friction << ' ' << share);
            ++held;
            visit(rope, found);
          }
        }
      }
    }
  }
  EXPECT_GT(held, 100);
}

TEST(LyingRope, IsAsWideAsItsEndsAreApartWithFriction) {
  for_each_held([](const HangingRope& rope, const Catenary& found) {
    const double h = found.horizontal;
    const double w = rope.weight;
    const double load = rope.grip.at_end ? -found.start_up : found.end_up;
    const TouchDown touch = touch_down(rope, found);
    EXPECT_EQ(touch.tension, h);
    const FloorProfile tensions = lying_tensions(rope, found);
    EXPECT_EQ(tensions.touch_tension(), h);
    const double hangs = h > 0.0 ? h / w * std::asinh(load / h) + rope.yield * h * load / w : 0.0;
    EXPECT_NEAR(touch.length + rope.yield * tensions.sum() + hangs, rope.across, 1e-11);
    // The rope that is taut, and that which lies loose.
    const double taut = touch.length + load / w;
    if (found.is_slack()) {
      EXPECT_GE(found.length, taut - 1e-12 * taut);
    } else {
      EXPECT_NEAR(found.length, taut, 1e-12 * taut);
    }
    // T^2 / 2 EA along the rope; T^2 = H^2 + v^2 with v from 0 to the load in the part that hangs.
    const double own = (h * h + load * load / 3.0) * load / w;
    EXPECT_NEAR(elastic_energy(rope, found), 0.5 * rope.yield * (tensions.square() + own),
                1e-12 * elastic_energy(rope, found));
  });
}

TEST(LyingRope, IsTheSameByItsTensionWithFriction) {
  for_each_held([](const HangingRope& rope, const Catenary& found) {
    const Catenary same = catenary_of_tension(rope, found.tension);
    if (found.is_slack()) {
      EXPECT_EQ(same.horizontal, 0.0);
      return;
    }
    EXPECT_NEAR(same.horizontal, found.horizontal, 1e-10 * found.horizontal);
    EXPECT_NEAR(same.length, found.length, 1e-11 * found.length);
    const Excess excess = excess_of(rope, found);
    EXPECT_NEAR(excess.length, found.length * (1.0 + rope.yield * found.tension) - rope.chord(),
                1e-11 * found.length);
  });
}

TEST(LyingRope, SlopesAreDifferencesWithFriction) {
  for_each_held([](const HangingRope& rope, const Catenary& found) {
    const double least = least_tension(rope);
    if (!(found.tension > least * (1.0 + 1e-6))) return;
    const double step = 1e-5 * (found.tension - least);
    const Catenary more = catenary_of_tension(rope, found.tension + step);
    const Catenary less = catenary_of_tension(rope, found.tension - step);
    if (!more.lies || !less.lies) return;
    // The second derivative of the stretch jumps at kinks of the old tension only; the step is small
    // beside their distances.
    const LyingSlopes slopes = lying_slopes(rope, found);
    const double rounding = 1e-13 * found.length / step;
    EXPECT_NEAR((more.length - less.length) / (2.0 * step), slopes.length,
                1e-4 * std::abs(slopes.length) + rounding);
    EXPECT_NEAR((excess_of(rope, more).length - excess_of(rope, less).length) / (2.0 * step),
                excess_of(rope, found).slope,
                1e-4 * std::abs(slopes.length) + rounding * (1.0 + rope.yield * found.tension));
    EXPECT_LE(slopes.length, 0.0);
  });
}

}  // namespace
}  // namespace sheave
