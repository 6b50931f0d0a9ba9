// The searches behind `sheave tune` on functions with known optima.

#include "command/tune/optimiser.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace sheave::test {
namespace {

using command::search_least;
using command::SearchEnd;
using command::SearchSettings;
using command::TuneMethod;

/// The last place of least f with all g <= 0, and the number of calls.
struct Found {
  std::vector<double> x;
  double f = 1e300;
  int calls = 0;
};

template <class Function>
SearchEnd search(const SearchSettings& settings, const Function& function, Found& found,
                 int most_calls = 100000) {
  return search_least(settings, [&](std::span<const double> x, double& f, std::span<double> g) {
    if (found.calls == most_calls) return false;
    ++found.calls;
    function(x, f, g);
    bool kept = true;
    for (const double excess : g) kept = kept && excess <= 0.0;
    for (const double share : x) {
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0);
    }
    if (kept && f < found.f) {
      found.f = f;
      found.x.assign(x.begin(), x.end());
    }
    return true;
  });
}

void bowl(std::span<const double> x, double& f, std::span<double> /*g*/) {
  f = std::pow(x[0] - 0.3, 2) + 10.0 * std::pow(x[1] - 0.8, 2) + 2.0;
}

TEST(Optimiser, LocalMethodsFindABowlWithinTheTolerance) {
  for (const TuneMethod method : {TuneMethod::cobyla, TuneMethod::bobyqa}) {
    Found found;
    EXPECT_EQ(search({method, {0.5, 0.5}, 0.2, 1e-5, 0}, bowl, found), SearchEnd::converged);
    EXPECT_NEAR(found.x[0], 0.3, 1e-4) << name_of(method);
    EXPECT_NEAR(found.x[1], 0.8, 1e-4) << name_of(method);
    EXPECT_LT(found.calls, 200) << name_of(method);
  }
}

TEST(Optimiser, CobylaKeepsBounds) {
  // Least x + y with x y >= 1/4: both are 1/2.
  Found found;
  const auto function = [](std::span<const double> x, double& f, std::span<double> g) {
    f = x[0] + x[1];
    g[0] = 0.25 - x[0] * x[1] + 1e-9;
  };
  EXPECT_EQ(search({TuneMethod::cobyla, {0.9, 0.6}, 0.2, 1e-6, 1}, function, found),
            SearchEnd::converged);
  EXPECT_NEAR(found.x[0], 0.5, 1e-4);
  EXPECT_NEAR(found.f, 1.0, 1e-7);
}

TEST(Optimiser, DirectFindsTheLeastOfManyValleys) {
  // Valleys 1/4 apart; the one at 7/8 is the deepest by 0.1.
  const auto function = [](std::span<const double> x, double& f, std::span<double> /*g*/) {
    f = std::cos(8.0 * std::numbers::pi * x[0]) - 0.4 * x[0];
  };
  Found local;
  EXPECT_EQ(search({TuneMethod::cobyla, {0.1}, 0.02, 1e-6, 0}, function, local),
            SearchEnd::converged);
  EXPECT_LT(local.x[0], 0.25) << "a local search stays in its valley";
  Found global;
  EXPECT_EQ(search({TuneMethod::direct, {0.1}, 0.2, 1e-6, 0}, function, global, 100),
            SearchEnd::stopped);
  EXPECT_NEAR(global.x[0], 0.875, 0.01);
}

TEST(Optimiser, RepeatsItselfToTheBit) {
  for (const TuneMethod method : {TuneMethod::cobyla, TuneMethod::bobyqa, TuneMethod::direct}) {
    Found first;
    Found second;
    (void)search({method, {0.5, 0.5}, 0.2, 1e-6, 0}, bowl, first, 60);
    (void)search({method, {0.5, 0.5}, 0.2, 1e-6, 0}, bowl, second, 60);
    EXPECT_EQ(first.x, second.x) << name_of(method);
    EXPECT_EQ(first.calls, second.calls) << name_of(method);
  }
}

TEST(Optimiser, AnExceptionPassesThrough) {
  Found found;
  const auto function = [&](std::span<const double> /*x*/, double& f, std::span<double> /*g*/) {
    if (found.calls == 3) throw std::runtime_error("full disk");
    f = found.calls;
  };
  EXPECT_THROW((void)search({TuneMethod::cobyla, {0.5, 0.5}, 0.2, 1e-6, 0}, function, found),
               std::runtime_error);
  EXPECT_EQ(found.calls, 3) << "nothing is computed behind a fault";
}

}  // namespace
}  // namespace sheave::test
