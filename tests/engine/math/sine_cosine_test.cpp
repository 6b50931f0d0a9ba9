// Against the library's functions in long double, which know all digits of a double's angle.

#include "engine/math/sine_cosine.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sheave {
namespace {

TEST(SineCosine, IsExactToRounding) {
  test::Random random(3);
  // Three parts of pi / 2 have 33 + 33 + 53 bits: 2^20 of them are off by 1e-16 of the last.
  for (const double size : {1e-8, 0.1, 3.0, 100.0, 1e4, 1e6, 1e9}) {
    for (int i = 0; i < 20000; ++i) {
      const double angle = random.between(-size, size);
      const auto [sine, cosine] = sine_cosine(angle);
      ASSERT_NEAR(sine, static_cast<double>(std::sin(static_cast<long double>(angle))), 1e-15);
      ASSERT_NEAR(cosine, static_cast<double>(std::cos(static_cast<long double>(angle))), 1e-15);
    }
  }
}

TEST(SineCosine, IsRightForQuarterTurnsAndNan) {
  for (int k = -9; k <= 9; ++k) {
    const double angle = 1.5707963267948966 * k;
    ASSERT_NEAR(sine_cosine(angle).sine, std::sin(angle), 1e-15) << k;
    ASSERT_NEAR(sine_cosine(angle).cosine, std::cos(angle), 1e-15) << k;
  }
  EXPECT_EQ(sine_cosine(0.0).sine, 0.0);
  EXPECT_EQ(sine_cosine(0.0).cosine, 1.0);
  EXPECT_TRUE(std::isnan(sine_cosine(std::numeric_limits<double>::quiet_NaN()).sine));
  EXPECT_TRUE(std::isnan(sine_cosine(std::numeric_limits<double>::infinity()).cosine));
}

// One that is not small sends all of them the long way; the bits are those of each alone.
TEST(SineCosine, OfManyAnglesEqualsThatOfEachAngle) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t count : {1U, 4U, 7U, 33U}) {
    for (const double last : {0.5, 3e7, -1e300, nothing}) {
      std::vector<double> angles;
      for (std::size_t i = 0; i + 1 < count; ++i) {
        angles.push_back(-40.0 + 2.7 * static_cast<double>(i));
      }
      angles.push_back(last);
      std::vector<double> sines(count);
      std::vector<double> cosines(count);
      sines_cosines(count, angles.data(), sines.data(), cosines.data());
      for (std::size_t i = 0; i < count; ++i) {
        const auto [sine, cosine] = sine_cosine(angles[i]);
        EXPECT_TRUE(sines[i] == sine || (std::isnan(sines[i]) && std::isnan(sine)));
        EXPECT_TRUE(cosines[i] == cosine || (std::isnan(cosines[i]) && std::isnan(cosine)));
      }
    }
  }
}

}  // namespace
}  // namespace sheave
