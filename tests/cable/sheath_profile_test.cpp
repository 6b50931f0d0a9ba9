// The tension along a rope in a sheath: closed forms of the capstan, fronts of slip against a fine
// chain of places with the same law, loops of hysteresis, and the bounded list of pieces.

#include "cable/sheath_profile.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

constexpr double test_yield = 1e-4;  // 1 / EA [1/N]

/// Stretch of a length S along which ln x rises by `rise` from x0: closed form.
double closed_stretch(double length, double x0, double rise) {
  return length * std::log((1.0 + x0 * std::exp(rise)) / (1.0 + x0)) / rise;
}

struct CapstanCase {
  double friction, bend, ratio, stretch, stiffness;
};

TEST(SheathProfile, HasTheRatioStretchAndStiffnessOfACapstan) {
  // Published to six digits, so the tolerance is half a digit. The stretch factor is the mean strain
  // over that of the pulled end for small strains, and the stiffness ratio its inverse.
  for (const CapstanCase& one : {CapstanCase{0.1, pi, 0.730403, 0.858155, 1.165291},
                                 CapstanCase{0.1, 2.0 * pi, 0.533488, 0.742477, 1.346843},
                                 CapstanCase{0.15, 3.0 * pi, 0.243238, 0.535300, 1.868112}}) {
    const SheathLaw law{2.0, one.friction * one.bend, 1e-10};
    const double tension = 5.0;  // strain 5e-10
    SheathProfile profile;
    EXPECT_EQ(profile.limit_from_entry(std::log(tension), law.exponent), 1.0);
    EXPECT_NEAR(std::exp(profile.exit()) / tension, one.ratio, 5e-7);
    const double factor = profile.stretch(law) / (law.length * tension * law.yield);
    EXPECT_NEAR(factor, one.stretch, 5e-7);
    EXPECT_NEAR(1.0 / factor, one.stiffness, 5e-7);
    const double x = law.exponent;
    EXPECT_NEAR(factor, (1.0 - std::exp(-x)) / x, 1e-9);
  }
}

/// The same law at many places of a sheath, each with its own tension.
class FineSheath {
 public:
  FineSheath(std::size_t count, double tension) : pulls_(count, std::log(tension)) {}
  void limit(double entry, double exit, double exponent) {
    for (std::size_t i = 0; i < pulls_.size(); ++i) {
      const double t = place(i);
      double& y = pulls_[i];
      y = std::clamp(y, std::log(entry) - exponent * t, std::log(entry) + exponent * t);
      y = std::clamp(y, std::log(exit) - exponent * (1.0 - t),
                     std::log(exit) + exponent * (1.0 - t));
    }
  }
  [[nodiscard]] double place(std::size_t i) const {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(pulls_.size());
  }
  [[nodiscard]] double pull(std::size_t i) const { return pulls_[i]; }
  [[nodiscard]] std::size_t count() const { return pulls_.size(); }
  [[nodiscard]] double stretch(const SheathLaw& law) const {
    double sum = 0.0;
    for (const double y : pulls_) sum += law.yield * std::exp(y) / (1.0 + law.yield * std::exp(y));
    return law.length * sum / static_cast<double>(pulls_.size());
  }

 private:
  std::vector<double> pulls_;
};

TEST(SheathProfile, FollowsAFineChainOfPlacesThroughAnyHistory) {
  const SheathLaw law{3.0, 0.8, test_yield};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> tensions(200.0, 4000.0);
  std::uniform_real_distribution<double> shares(-1.0, 1.0);
  SheathProfile profile(500.0, 500.0);
  FineSheath fine(4000, 500.0);
  for (int swing = 0; swing < 300; ++swing) {
    const double entry = tensions(random);
    const double exit = entry * std::exp(law.exponent * shares(random));
    profile.limit_from_entry(std::log(entry), law.exponent);
    profile.limit_from_exit(std::log(exit), law.exponent);
    profile.shorten(law);
    fine.limit(entry, exit, law.exponent);
    // Both are exact at their places.
    for (std::size_t i = 0; i < fine.count(); i += 37) {
      ASSERT_NEAR(profile.at(fine.place(i)), fine.pull(i), 1e-12) << swing;
    }
    // The midpoint rule over cells of 1/4000 misses at most X^2 / 24 / 4000^2 in the smooth parts,
    // and X / 8 / 4000^2 in each cell with a kink: 1e-8 of the stretch.
    ASSERT_NEAR(profile.stretch(law), fine.stretch(law), 1e-7 * fine.stretch(law)) << swing;
  }
}

/// The loop between the tensions `top` and `bottom` of the entry [N]; the first pull was to `top`.
struct SheathLoop {
  SheathLaw law;
  double top = 0.0;
  double bottom = 0.0;
  /// Stretch at a tension of the entry on the way down or up [m]: up to three lines of ln T, each of
  /// which meets the next where both have the same tension.
  [[nodiscard]] double stretch(double now, bool down) const {
    const double x = law.exponent;
    const double turned = down ? now : bottom;  // the tension at which the line of +X began
    const double first = down ? 0.0 : std::log(now / bottom) / (2.0 * x);
    const double second = std::log(top / turned) / (2.0 * x);
    double sum = 0.0;
    if (first > 0.0) sum += closed_stretch(law.length * first, law.yield * now, -x * first);
    if (second > first) {
      sum += closed_stretch(law.length * (second - first), law.yield * turned * std::exp(x * first),
                            x * (second - first));
    }
    return sum + closed_stretch(law.length * (1.0 - second),
                                law.yield * top * std::exp(-x * second), -x * (1.0 - second));
  }
};

TEST(SheathProfile, RunsThroughTenReversalsOnTheClosedLoop) {
  const SheathLoop loop{{2.5, 0.4, test_yield}, 2000.0, 1400.0};
  SheathProfile profile;
  profile.limit_from_entry(std::log(loop.top), loop.law.exponent);
  for (int reversal = 0; reversal < 10; ++reversal) {
    const bool down = reversal % 2 == 0;
    const double from = down ? loop.top : loop.bottom;
    const double to = down ? loop.bottom : loop.top;
    for (int k = 1; k < 20; ++k) {
      const double now = from + (to - from) * k / 20.0;
      profile.limit_from_entry(std::log(now), loop.law.exponent);
      // Stretches of 0.3 m; places have errors of 1e-16 / X.
      ASSERT_NEAR(profile.stretch(loop.law), loop.stretch(now, down), 1e-14) << reversal;
      ASSERT_EQ(profile.piece_count(), down ? 2U : 3U);
    }
    profile.limit_from_entry(std::log(to), loop.law.exponent);
  }
  // The upper end of the loop wipes the lower one out.
  EXPECT_EQ(profile.piece_count(), 1U);
}

TEST(SheathProfile, LosesTheAreaOfItsLoop) {
  // On a loop the elastic energy returns, so friction takes the work of the end: minus the integral
  // of g dM with g = T + T^2 / 2 EA and the unstretched length M that comes in, dM = -d(stretch).
  // By parts that is the integral of M dg.
  const SheathLoop loop{{2.5, 0.4, test_yield}, 2000.0, 1400.0};
  const auto energy = [](double tension) { return tension + 0.5 * test_yield * tension * tension; };
  // Simpson's rule in ln T over M dg: the integrand is smooth; 2000 steps have errors below 1e-13.
  const int steps = 2000;
  const double range = std::log(loop.top / loop.bottom);
  double area = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double tension = loop.bottom * std::exp(range * i / steps);
    const double slope = tension + test_yield * tension * tension;  // dg / d ln T
    const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    area += weight * slope * (loop.stretch(tension, true) - loop.stretch(tension, false));
  }
  area *= range / steps / 3.0;
  ASSERT_GT(area, 1.0);
  ASSERT_GT(energy(loop.top), energy(loop.bottom));

  SheathProfile profile;
  profile.limit_from_entry(std::log(loop.top), loop.law.exponent);
  for (const int parts : {1, 7, 40}) {
    double lost = 0.0;
    for (const bool down : {true, false}) {
      for (int k = 1; k <= parts; ++k) {
        const double from = down ? loop.top : loop.bottom;
        const double to = down ? loop.bottom : loop.top;
        const double pull = std::log(from + (to - from) * k / parts);
        const double before = profile.energy(loop.law);
        const double work = profile.work_at_entry(loop.law, pull);
        profile.limit_from_entry(pull, loop.law.exponent);
        const double taken = before - profile.energy(loop.law) - work;
        EXPECT_GE(taken, 0.0);
        lost += taken;
      }
    }
    EXPECT_NEAR(lost, area, 1e-10 * area) << parts;
  }
}

TEST(SheathProfile, CountsTheSameWorkFromBothEnds) {
  const SheathLaw law{2.0, 0.7, test_yield};
  SheathProfile profile(1500.0, 1500.0);
  SheathProfile mirrored = profile;
  for (const double tension : {1900.0, 1600.0, 1750.0, 1650.0, 2000.0}) {
    const double pull = std::log(tension);
    EXPECT_NEAR(profile.work_at_entry(law, pull), mirrored.work_at_exit(law, pull), 1e-12);
    const double front = profile.limit_from_entry(pull, law.exponent);
    EXPECT_NEAR(mirrored.limit_from_exit(pull, law.exponent), 1.0 - front, 1e-15);
    EXPECT_NEAR(profile.stretch(law), mirrored.stretch(law), 1e-15);
    EXPECT_NEAR(profile.energy(law), mirrored.energy(law), 1e-12);
  }
}

TEST(SheathProfile, HoldsTheEnergyOfItsTensions) {
  // The midpoint rule with 2e5 steps: 1e-11 in the smooth parts, 1e-10 at kinks.
  for (const double yield : {1e-9, test_yield}) {
    const SheathLaw law{2.0, 0.7, yield};
    SheathProfile profile(900.0, 900.0);
    profile.limit_from_entry(std::log(1500.0), law.exponent);
    profile.limit_from_exit(std::log(1100.0), law.exponent);
    double sum = 0.0;
    const auto density = [&](double t) {
      const double x = yield * std::exp(profile.at(t));
      return x * x / (1.0 + x);
    };
    const int steps = 200000;
    for (int i = 0; i < steps; ++i) sum += density((i + 0.5) / steps) / steps;
    const double expected = 0.5 * law.length / yield * sum;
    EXPECT_NEAR(profile.energy(law), expected, 1e-9 * expected);
  }
}

TEST(SheathProfile, EmptiesWhenAnEndHasNoTension) {
  SheathProfile profile(900.0, 1000.0);
  EXPECT_EQ(profile.limit_from_exit(SheathProfile::slack, 0.5), 0.0);
  EXPECT_EQ(profile.piece_count(), 0U);
  EXPECT_EQ(profile.stretch({1.0, 0.5, test_yield}), 0.0);
}

TEST(SheathProfile, KeepsAtMostItsPiecesAndAlmostAllOfItsStretch) {
  // Ever smaller swings from both ends, each of which leaves two pieces.
  const SheathLaw law{1.0, 2.0, test_yield};
  SheathProfile profile(1000.0, 1000.0);
  FineSheath fine(200000, 1000.0);
  double swing = 1.0;
  for (int i = 0; i < 120; ++i) {
    swing *= -0.95;
    const double tension = 1000.0 * std::exp(swing);
    profile.limit_from_entry(std::log(tension), law.exponent);
    profile.limit_from_exit(std::log(tension), law.exponent);
    profile.shorten(law);
    fine.limit(tension, tension, law.exponent);
    ASSERT_LE(profile.piece_count(), SheathProfile::most_pieces);
    std::vector<double> saved(SheathProfile::real_count);
    profile.save(saved);
    ASSERT_TRUE(SheathProfile::is_sound(saved, law.exponent));
  }
  // A removed swing is one of the smallest of 32.
  EXPECT_NEAR(profile.stretch(law), fine.stretch(law), 1e-3 * fine.stretch(law));
}

TEST(SheathProfile, IsSavedBitForBitAndRefusedIfUnsound) {
  SheathProfile profile(900.0, 1000.0);
  profile.limit_from_entry(std::log(1200.0), 0.6);
  std::vector<double> saved(SheathProfile::real_count);
  profile.save(saved);
  EXPECT_TRUE(SheathProfile::is_sound(saved, 0.6));
  std::vector<double> again(SheathProfile::real_count, 1.0);
  SheathProfile(saved).save(again);
  EXPECT_EQ(saved, again);
  EXPECT_FALSE(SheathProfile::is_sound(saved, 0.1)) << "steeper than the friction allows";
  for (const auto& [index, value] : {std::pair<std::size_t, double>{0, 1.0},
                                     {0, 99.0},
                                     {0, 2.5},
                                     {1, 0.1},
                                     {2, 1e4},
                                     {3, 2.0},
                                     {4, std::nan("")}}) {
    std::vector<double> bad = saved;
    bad[index] = value;
    EXPECT_FALSE(SheathProfile::is_sound(bad, 0.6)) << index << " " << value;
  }
}

TEST(SheathProfile, TellsTheSlopeOfAFrontsStretch) {
  // Central differences with a relative step of 1e-5: error 1e-10 of the slope by the third
  // derivative, and 1e-16 / 1e-5 by rounding.
  const SheathLaw law{1.5, 0.9, 1e-3};
  for (const double front : {0.2, 1.0}) {
    for (const double rise : {-0.9, 0.0, 0.9}) {
      const double step = 1e-5 * 700.0;
      const double above = front_stretch(law, 700.0 + step, rise, front).stretch;
      const double below = front_stretch(law, 700.0 - step, rise, front).stretch;
      const double slope = front_stretch(law, 700.0, rise, front).slope;
      EXPECT_NEAR((above - below) / (2.0 * step), slope, 1e-9 * slope);
    }
  }
}

}  // namespace
}  // namespace sheave
