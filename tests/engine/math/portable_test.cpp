// Against the library's functions in long double, whose 64 bits of mantissa tell an error of a double
// in the last place exactly enough.

#include "engine/math/portable.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sheave {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double relative_error(double value, long double right) {
  return static_cast<double>(std::abs((static_cast<long double>(value) - right) / right));
}

TEST(Portable, ArcTangentIsExactToRounding) {
  test::Random random(1);
  for (int i = 0; i < 100000; ++i) {
    // Both of all sizes, and of all quadrants.
    const double y = random.between(-1.0, 1.0) * std::exp2(random.between(-40.0, 40.0));
    const double x = random.between(-1.0, 1.0) * std::exp2(random.between(-40.0, 40.0));
    const long double right = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    ASSERT_LT(relative_error(portable::atan2(y, x), right), 4e-16) << y << ' ' << x;
  }
  for (int i = 0; i < 100000; ++i) {
    const double y = random.between(-3.0, 3.0);
    const long double right = std::atan2(static_cast<long double>(y), 1.0L);
    ASSERT_LT(relative_error(portable::atan2(y, 1.0), right), 4e-16) << y;
  }
}

TEST(Portable, ArcTangentOfZerosAndInfinitiesFollowsTheStandard) {
  for (const double y : {0.0, -0.0, 1.0, -1.0, 1e-310, -1e308, unbounded, -unbounded}) {
    for (const double x : {0.0, -0.0, 2.0, -2.0, 1e-310, -1e308, 1e308, unbounded, -unbounded}) {
      const double right = std::atan2(y, x);
      const double value = portable::atan2(y, x);
      EXPECT_NEAR(value, right, 4e-16 * std::abs(right)) << y << ' ' << x;
      EXPECT_EQ(std::signbit(value), std::signbit(right)) << y << ' ' << x;
    }
  }
  EXPECT_TRUE(std::isnan(portable::atan2(nothing, 1.0)));
  EXPECT_TRUE(std::isnan(portable::atan2(1.0, nothing)));
}

TEST(Portable, ExponentialsAndLogarithmsAreExactToRounding) {
  test::Random random(2);
  for (const double size : {1e-9, 1e-3, 0.3, 0.4, 1.0, 30.0, 700.0}) {
    for (int i = 0; i < 30000; ++i) {
      const double x = random.between(-size, size);
      const auto exact = static_cast<long double>(x);
      ASSERT_LT(relative_error(portable::exp(x), std::exp(exact)), 3e-16) << x;
      if (x != 0.0) {
        ASSERT_LT(relative_error(portable::expm1(x), std::expm1(exact)), 1e-15) << x;
      }
      const double y = std::exp(x);
      if (y != 1.0) {
        ASSERT_LT(relative_error(portable::log(y), std::log(static_cast<long double>(y))), 3e-16)
            << y;
      }
    }
  }
}

TEST(Portable, ExponentialsAndLogarithmsAreRightAtTheEndsOfTheirRange) {
  EXPECT_EQ(portable::exp(0.0), 1.0);
  EXPECT_EQ(portable::exp(-unbounded), 0.0);
  EXPECT_EQ(portable::exp(unbounded), unbounded);
  EXPECT_EQ(portable::exp(710.0), unbounded);
  EXPECT_EQ(portable::exp(-746.0), 0.0);
  EXPECT_GT(portable::exp(709.7), 1e308);
  EXPECT_GT(portable::exp(-744.0), 0.0);
  EXPECT_EQ(portable::expm1(0.0), 0.0);
  EXPECT_EQ(portable::expm1(-unbounded), -1.0);
  EXPECT_EQ(portable::expm1(unbounded), unbounded);
  EXPECT_EQ(portable::log(1.0), 0.0);
  EXPECT_EQ(portable::log(0.0), -unbounded);
  EXPECT_EQ(portable::log(unbounded), unbounded);
  EXPECT_NEAR(portable::log(5e-324), std::log(5e-324), 1e-12);
  for (const auto function : {portable::exp, portable::expm1, portable::log}) {
    EXPECT_TRUE(std::isnan(function(nothing)));
  }
  EXPECT_TRUE(std::isnan(portable::log(-1.0)));
}

TEST(Portable, LengthsOfAllSizesAreExactToRounding) {
  test::Random random(3);
  for (const double size : {1.0, 1e-150, 1e150, 1e-300, 1e300}) {
    for (int i = 0; i < 20000; ++i) {
      const double x = size * random.between(-1.0, 1.0);
      const double y = size * random.between(-1.0, 1.0);
      const long double right =
          std::hypot(static_cast<long double>(x), static_cast<long double>(y));
      ASSERT_LT(relative_error(portable::hypot(x, y), right), 5e-16) << x << ' ' << y;
    }
  }
  EXPECT_EQ(portable::hypot(0.0, 0.0), 0.0);
  EXPECT_EQ(portable::hypot(3.0, -4.0), 5.0);
  EXPECT_EQ(portable::hypot(-unbounded, nothing), unbounded);
  EXPECT_TRUE(std::isnan(portable::hypot(1.0, nothing)));
}

}  // namespace
}  // namespace sheave
