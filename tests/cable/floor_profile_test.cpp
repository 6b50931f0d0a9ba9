// The tension along a rope on a floor with friction: against a fine chain of places with the same law,
// derivatives by differences, closed forms of pulls and their losses, and the bounded list of pieces.

#include "cable/floor_profile.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr double slope = 3.0;  // k [N/m]

/// The same law at many places of a rope, each with its own tension.
class FineFloor {
 public:
  FineFloor(double length, double tension)
      : tensions_(count, tension), length_(length), touch_(tension) {}

  struct Moved {
    double sum = 0.0;   ///< J [N m]
    double lost = 0.0;  ///< the loss times EA [N2 m]
  };
  Moved limit(double length, double tension) {
    Moved moved;
    double way = 0.0;
    for (std::size_t i = 0; place(i) < length; ++i) {
      const double s = place(i);
      double old = tensions_[i];
      if (s > length_) old = touch_ + (tension - touch_) * (s - length_) / (length - length_);
      const double allowed = slope * (length - s);
      tensions_[i] = std::clamp(old, tension - allowed, tension + allowed);
      moved.sum += tensions_[i] * step;
      way += (tensions_[i] - old) * step;
      if (tensions_[i] != old) moved.lost += slope * std::abs(way) * step;
    }
    moved.lost -= 0.5 * slope * std::abs(way) * (length - length_);
    length_ = length;
    touch_ = tension;
    return moved;
  }

  static constexpr std::size_t count = 20000;
  static constexpr double step = 1e-3;

 private:
  static double place(std::size_t i) { return (static_cast<double>(i) + 0.5) * step; }
  std::vector<double> tensions_;
  double length_;
  double touch_;
};

TEST(FloorProfile, IsThatOfAFineChain) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  FineFloor fine(10.0, 5.0);
  FloorProfile profile(10.0, 5.0);
  double length = 10.0;
  double tension = 5.0;
  std::size_t most = 0;
  for (int round = 0; round < 400; ++round) {
    length = std::clamp(length + any(random), 0.5, 19.9);
    tension = std::max(tension + 10.0 * any(random), 0.0);
    const FineFloor::Moved moved = fine.limit(length, tension);
    const FloorProfile::Sum sum = profile.limited_sum(length, tension, slope);
    const double lost = profile.limit(length, tension, slope);
    // The last place of the fine chain has an error of up to its step, and so has its front.
    const double most_tension = tension + slope * length;
    EXPECT_NEAR(sum.sum, moved.sum, 2.0 * FineFloor::step * most_tension) << round;
    EXPECT_NEAR(profile.sum(), sum.sum, 1e-12 * most_tension * length) << round;
    // The loss is the way, of the order of J, over the length that slides.
    EXPECT_NEAR(lost, moved.lost, 4.0 * FineFloor::step * slope * length * most_tension) << round;
    EXPECT_EQ(profile.length(), length);
    EXPECT_EQ(profile.touch_tension(), tension);
    most = std::max(most, profile.piece_count());
  }
  EXPECT_GT(most, 4U);
}

TEST(FloorProfile, HasTheDerivativesOfItsSum) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  FloorProfile profile(10.0, 20.0);
  for (int round = 0; round < 200; ++round) {
    const double length = std::max(profile.length() + any(random), 0.1);
    const double tension = std::max(profile.touch_tension() + 6.0 * any(random), 0.1);
    // J is quadratic between the kinks, so central differences have rounding only.
    constexpr double d = 1e-5;
    const auto sum_at = [&](double l, double t) { return profile.limited_sum(l, t, slope).sum; };
    const FloorProfile::Sum sum = profile.limited_sum(length, tension, slope);
    const double rounding = 1e-14 * sum.sum / d + 1e-9;
    EXPECT_NEAR(sum.by_tension,
                (sum_at(length, tension + d) - sum_at(length, tension - d)) / (2.0 * d), rounding);
    EXPECT_NEAR(sum.by_length,
                (sum_at(length + d, tension) - sum_at(length - d, tension)) / (2.0 * d), rounding);
    profile.limit(length, tension, slope);
  }
}

TEST(FloorProfile, HasTheFrontAndTheLossOfAPull) {
  // From 5 N to 11 N the front goes 6 / 3 = 2 m from the touch-down. Places move by the integral of
  // slope (s - front), so friction takes slope times the integral of slope x^2 / 2: slope^2 x^3 / 6.
  FloorProfile profile(10.0, 5.0);
  EXPECT_NEAR(profile.limit(10.0, 11.0, slope), slope * slope * 8.0 / 6.0, 1e-12);
  EXPECT_EQ(profile.at(8.0), 5.0);
  EXPECT_NEAR(profile.at(9.0), 8.0, 1e-14);
  EXPECT_NEAR(profile.sum(), 50.0 + 6.0, 1e-13);
  // Back to 5 N the front goes half as far, and the loss has half the slope on both sides.
  EXPECT_NEAR(profile.limit(10.0, 5.0, slope), 2.0 * slope * slope / 6.0, 1e-12);
  EXPECT_NEAR(profile.at(9.0), 8.0, 1e-14);
  EXPECT_NEAR(profile.sum(), 50.0 + 3.0, 1e-13);
  // The whole rope slides, and the anchor gets 65 N less the friction of 30 N.
  profile.limit(10.0, 65.0, slope);
  EXPECT_EQ(profile.piece_count(), 1U);
  EXPECT_NEAR(profile.anchor_tension(), 35.0, 1e-13);
}

TEST(FloorProfile, CountsTheLossToSecondOrder) {
  // Lifted under a tension that rises, and laid under one that falls faster than friction holds.
  for (const double sense : {1.0, -1.0}) {
    std::vector<double> lost;
    for (const int steps : {20, 40, 80}) {
      FloorProfile profile(30.0, 100.0);
      double sum = 0.0;
      for (int i = 1; i <= steps; ++i) {
        const double t = sense * i / steps;
        sum += profile.limit(30.0 - 4.0 * t - t * t, 100.0 + 60.0 * t + 10.0 * t * t, slope);
      }
      lost.push_back(sum);
    }
    EXPECT_NEAR((lost[0] - lost[1]) / (lost[1] - lost[2]), 4.0, 0.2);
  }
}

TEST(FloorProfile, LaysAndForgets) {
  FloorProfile profile(10.0, 5.0);
  // Laid with a tension that changes less than friction holds.
  EXPECT_EQ(profile.limit(12.0, 9.0, slope), 0.0);
  EXPECT_EQ(profile.at(11.0), 7.0);
  // Laid with one that changes more: 2 m at 3 N/m hold 6 N of the 9 N, so the front is 1 m further.
  profile.limit(14.0, 18.0, slope);
  EXPECT_NEAR(profile.at(12.0), 12.0, 1e-14);
  EXPECT_NEAR(profile.at(10.5), 7.5, 1e-14);
  // Lifted off the floor.
  profile.limit(9.0, 5.0, slope);
  EXPECT_EQ(profile.piece_count(), 1U);
  EXPECT_EQ(profile.limit(0.0, 3.0, slope), 0.0);
  EXPECT_EQ(profile.length(), 0.0);
  EXPECT_EQ(profile.limited_sum(4.0, 6.0, slope).sum, 18.0);
}

TEST(FloorProfile, LandsWithTheTensionOfTheInstant) {
  // The anchor bears the weight of 1 m of rope, and then 3 m lie: a quarter of the way is before landing.
  FloorProfile profile(10.0, 5.0);
  EXPECT_EQ(profile.limit(-1.0, 10.0, slope), 0.0);
  EXPECT_EQ(profile.length(), -1.0);
  const double sum = profile.limited_sum(3.0, 18.0, slope).sum;
  EXPECT_EQ(profile.limit(3.0, 18.0, slope), 0.0);
  EXPECT_EQ(profile.anchor_tension(), 12.0);
  EXPECT_EQ(profile.at(1.5), 15.0);
  EXPECT_EQ(profile.sum(), 45.0);
  EXPECT_EQ(sum, 45.0);
}

TEST(FloorProfile, IsSavedAndRead) {
  FloorProfile profile(10.0, 50.0);
  for (int i = 0; i < 6; ++i) profile.limit(10.0, i % 2 == 0 ? 60.0 - i : 40.0 + i, slope);
  std::vector<double> reals(FloorProfile::real_count);
  profile.save(reals);
  ASSERT_TRUE(FloorProfile::is_sound(reals));
  const FloorProfile again(reals);
  EXPECT_EQ(again.piece_count(), profile.piece_count());
  EXPECT_EQ(again.sum(), profile.sum());
  EXPECT_EQ(again.square(), profile.square());
  const auto spoilt = [&](std::size_t index, double value) {
    std::vector<double> wrong = reals;
    wrong[index] = value;
    return FloorProfile::is_sound(wrong);
  };
  EXPECT_FALSE(spoilt(0, 0.0));
  EXPECT_FALSE(spoilt(0, 2.5));
  EXPECT_FALSE(spoilt(0, 1000.0));
  EXPECT_FALSE(spoilt(1, 1.0));   // it begins at the anchor
  EXPECT_FALSE(spoilt(2, -1.0));  // a rope does not push
  EXPECT_FALSE(spoilt(3, NAN));
  EXPECT_FALSE(spoilt(5, 1e-3));  // places rise
}

TEST(FloorProfile, KeepsItsSumWhenPiecesAreTooMany) {
  // A rope that is laid with the tension of a parabola has a piece per step. Nodes that are joined keep J,
  // so it is that of the trapezia of the steps h: off by h^2 T'' / 12 of the length. The tension between
  // two nodes is off by up to that of a chord of the length l, l^2 T'' / 8.
  FloorProfile profile(0.0, 100.0);
  const auto tension_at = [](double s) { return 100.0 + 0.01 * s * s; };
  constexpr double last = 100.0;
  for (int i = 1; i <= 1000; ++i)
    profile.limit(0.001 * i * last, tension_at(0.001 * i * last), slope);
  EXPECT_EQ(profile.piece_count(), FloorProfile::most_pieces);
  const double exact = 100.0 * last + 0.01 * last * last * last / 3.0;
  EXPECT_NEAR(profile.sum(), exact, 1.01 * 0.1 * 0.1 * 0.02 / 12.0 * last);
  const double piece = 3.0 * last / FloorProfile::most_pieces;  // some are longer than the mean
  EXPECT_NEAR(profile.at(50.0), tension_at(50.0), piece * piece * 0.02 / 8.0);
}

}  // namespace
}  // namespace sheave
