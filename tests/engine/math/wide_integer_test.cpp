#include "engine/math/wide_integer.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr std::int64_t largest_word = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t smallest_word = std::numeric_limits<std::int64_t>::min();

TEST(TwoWordInteger, KnowsSignsAndOrder) {
  const TwoWordInteger zero = 0;
  const TwoWordInteger wide = TwoWordInteger(largest_word) * largest_word;
  EXPECT_LT(-wide, TwoWordInteger(smallest_word));
  EXPECT_LT(TwoWordInteger(smallest_word), TwoWordInteger(-1));
  EXPECT_LT(TwoWordInteger(-1), zero);
  EXPECT_LT(zero, TwoWordInteger(1));
  EXPECT_LT(TwoWordInteger(largest_word), wide);
  EXPECT_EQ(wide - wide, zero);
  EXPECT_EQ(-zero, zero);
  EXPECT_EQ(TwoWordInteger(-7) * 6, TwoWordInteger(-42));
}

TEST(TwoWordInteger, CarriesIntoTheUpperWord) {
  const TwoWordInteger word = TwoWordInteger(std::int64_t{1} << 32) * (std::int64_t{1} << 32);
  EXPECT_EQ(static_cast<double>(word), 0x1p64);
  EXPECT_EQ(word - 1 + 1, word);
  EXPECT_EQ((word - 1) * (word - 1), word * word - word - word + 1);
  // (a + b) (a - b) = a^2 - b^2
  const TwoWordInteger a = 0x123456789abcdef;
  const TwoWordInteger b = 0xfedcba987654321;
  EXPECT_EQ((a + b) * (a - b), a * a - b * b);
}

TEST(TwoWordInteger, BecomesTheNearestDouble) {
  const auto square = [](std::int64_t x) { return TwoWordInteger(x) * x; };
  // (2^53 + 1)^2 = 2^106 + 2^54 + 1: just above half of the last place, 2^54.
  EXPECT_EQ(static_cast<double>(square((std::int64_t{1} << 53) + 1)), 0x1p106 + 0x1p54);
  const TwoWordInteger power = square(std::int64_t{1} << 53);  // doubles above it are 2^54 apart
  const TwoWordInteger half = std::int64_t{1} << 53;
  EXPECT_EQ(static_cast<double>(power + half), 0x1p106);                         // a tie, to even
  EXPECT_EQ(static_cast<double>(power + half + 1), 0x1p106 + 0x1p54);            // above it
  EXPECT_EQ(static_cast<double>(power + half + half + half), 0x1p106 + 0x1p55);  // a tie, to even
  EXPECT_EQ(static_cast<double>(-(power + half + 1)), -0x1p106 - 0x1p54);
}

#ifdef __SIZEOF_INT128__
TEST(TwoWordInteger, CountsAsTheCompilersOwn) {
  std::mt19937_64 random(5);
  const auto drawn = [&random] {
    // Of all sizes, both signs.
    return static_cast<std::int64_t>(random()) >> (random() % 64U);
  };
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t a = drawn();
    const std::int64_t b = drawn();
    const std::int64_t c = drawn() / 2;
    const TwoWordInteger ours = TwoWordInteger(a) * b + c;
    const WideInteger right = WideInteger{a} * b + c;
    ASSERT_EQ(static_cast<double>(ours), static_cast<double>(right)) << a << " " << b << " " << c;
    ASSERT_EQ(ours < TwoWordInteger(c), right < WideInteger{c});
    ASSERT_EQ(static_cast<double>(ours - a), static_cast<double>(right - a));
    ASSERT_EQ(static_cast<double>(-ours), static_cast<double>(-right));
  }
}
#endif

}  // namespace
}  // namespace sheave
