// Central differences.
//
// Tolerance. The difference of a polynomial of the fourth degree has no error but rounding: values of
// at most 1 with errors of 1e-16, divided by a step of 1e-3 and taken 1.5 times: 3e-13.

#include "statics/difference.h"

#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

TEST(Difference, OfAPolynomialOfTheFourthDegreeIsItsSlope) {
  const auto at = [](double x) {
    return VectorX(VectorX::Constant(1, 0.5 + x * (0.25 + x * (-1.0 + x * (2.0 - 3.0 * x)))));
  };
  EXPECT_NEAR(difference_with(at, 1e-3).slope[0], 0.25, 3e-13);
}

TEST(Difference, CallsItsFunctionInOneOrder) {
  // A function that starts from its last result gives other digits in another order.
  std::vector<double> calls;
  const auto at = [&](double x) {
    calls.push_back(x);
    return VectorX(VectorX::Constant(1, x));
  };
  (void)difference_with(at, 0.5);
  EXPECT_EQ(calls, (std::vector<double>{0.5, -0.5, 1.0, -1.0}));
}

TEST(Difference, AKinkShortensTheStep) {
  // Beyond 1e-3 the slope is another one.
  const auto at = [](double x) {
    return VectorX(VectorX::Constant(1, x > 1e-3 ? 5.0 * x - 4e-3 : x));
  };
  // The steps are 1e-2 / 8^k, and the third one, with twice its length, is below the kink.
  const Difference slope = difference(at, 1e-2);
  EXPECT_NEAR(slope.slope[0], 1.0, 1e-9);
  EXPECT_LE(slope.error, 1e-9);
}

}  // namespace
}  // namespace sheave
