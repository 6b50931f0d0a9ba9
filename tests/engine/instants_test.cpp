// The search of an instant alone: on margins of closed forms.

#include "engine/instants.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace sheave {
namespace {

using Margins = std::function<std::vector<double>(double)>;

struct Located {
  double instant = 0.0;
  int attempts = 0;
};

Located search(double begin, double end, double shortest, const Margins& margins) {
  InstantSearch found(begin, end, shortest, margins(begin), margins(end));
  Located located;
  while (const auto instant = found.next()) {
    found.tell(*instant, margins(*instant));
    ++located.attempts;
  }
  located.instant = found.found();
  return located;
}

// The end of the bracket at which something holds is no farther from the root than the tolerance,
// 1e-9 of the interval, and never before it.
TEST(InstantSearch, FindsRootsOfSmoothMargins) {
  for (const double root : {0.2, 0.50001, 0.9}) {
    for (const double power : {1.0, 2.0, 3.0}) {
      SCOPED_TRACE(testing::Message() << root << ", " << power);
      const Located located = search(0.0, 1.0, 1e-4, [&](double t) {
        return std::vector<double>{std::pow(t, power) - std::pow(root, power)};
      });
      EXPECT_GE(located.instant, root);
      EXPECT_LE(located.instant, root + 1e-9);
      EXPECT_LE(located.attempts, 20);
    }
  }
}

TEST(InstantSearch, FindsTheFirstOfSeveral) {
  const Located located = search(2.0, 2.5, 1e-5, [](double t) {
    return std::vector<double>{t - 2.4, 1e6 * (t - 2.123), -1.0, (t * t) - 2.3 * 2.3};
  });
  EXPECT_GE(located.instant, 2.123);
  EXPECT_LE(located.instant, 2.123 + 0.5e-9);
}

// By halves: 30 of them make 1e-9, and as many guesses are in vain.
TEST(InstantSearch, FindsJumps) {
  for (const double jump : {0.01, 0.3, 0.77}) {
    const Located located = search(
        0.0, 1.0, 1e-4, [&](double t) { return std::vector<double>{t < jump ? -1e-9 : 1e9}; });
    EXPECT_GE(located.instant, jump);
    EXPECT_LE(located.instant, jump + 1e-9);
    EXPECT_LE(located.attempts, InstantSearch::most_attempts);
  }
}

TEST(InstantSearch, MakesNoShorterParts) {
  const auto ramp = [](double root) {
    return [root](double t) { return std::vector<double>{t - root}; };
  };
  EXPECT_EQ(search(0.0, 1.0, 0.01, ramp(0.001)).instant, 0.01);
  EXPECT_EQ(search(0.0, 1.0, 0.01, ramp(0.999)).instant, 1.0);
  EXPECT_EQ(search(0.0, 0.015, 0.01, ramp(0.007)).instant, 0.015) << "no room for two parts";
}

TEST(InstantSearch, KnowsWithoutMarginsAtTheStart) {
  InstantSearch found(0.0, 1.0, 1e-4, {}, std::vector<double>{0.4});
  while (const auto instant = found.next())
    found.tell(*instant, std::vector<double>{*instant - 0.6});
  EXPECT_NEAR(found.found(), 0.6, 1e-9);
}

}  // namespace
}  // namespace sheave
