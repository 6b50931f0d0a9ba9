// Pressures that fall with the friction that they allow: n(p) = max(N - a p, 0), of which N / (1 + a)
// is the root.

#include "engine/followed_pressure.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

int rounds_until_found(double fall, double pushed) {
  FollowedPressure pressure;
  double taken = 0.0;
  for (int round = 1; round <= 100; ++round) {
    const double found = std::max(pushed - fall * taken, 0.0);
    if (std::abs(found - taken) <= 1e-9 * pushed) return round;
    taken = pressure.next(taken, found);
  }
  return 101;
}

// Where friction hardly unloads what presses, rounds converge by themselves, by the factor a.
TEST(FollowedPressure, ConvergesAsFastAsConvergingRounds) {
  EXPECT_LE(rounds_until_found(0.0, 3.0), 2);
  EXPECT_LE(rounds_until_found(0.1, 3.0), 11);  // 0.1^10 = 1e-10
}

// Taken as found, p would go to and fro between 0 and N.
TEST(FollowedPressure, FindsTheRootWhereRoundsAlternateForEver) {
  for (const double fall : {0.9, 1.0, 1.5, 2.0, 3.0, 5.0}) {
    SCOPED_TRACE(fall);
    EXPECT_LE(rounds_until_found(fall, 1.0), 20);
    EXPECT_LE(rounds_until_found(fall, 1e-7), 20);
  }
}

TEST(FollowedPressure, ContinuesFromZeroPressure) {
  FollowedPressure pressure;
  EXPECT_EQ(pressure.next(0.0, 0.0), 0.0);
  EXPECT_EQ(pressure.next(0.0, 2.0), 2.0);
  EXPECT_EQ(pressure.next(2.0, 0.0), 1.0);
}

}  // namespace
}  // namespace sheave
