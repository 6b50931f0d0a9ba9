// What wheels give and take: whole quanta, none lost, and what is left over waits for the next turn.

#include "cable/winding_kernels.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/index.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

/// A cable over wheels in a row: span k lies between the links k and k + 1, which are wheels of
/// these numbers.
struct WheelRow {
  WindingSpans spans;
  std::vector<double> motion, rest_lengths, remainders, stored;
  std::size_t count = 0;

  WheelRow(std::size_t spans_of_it, double quantum, test::Random& random) : count(spans_of_it) {
    const auto whole = [&](double length) { return std::round(length / quantum) * quantum; };
    motion.push_back(0.0);
    for (std::size_t i = 0; i <= count; ++i) {
      motion.push_back(random.between(-0.5, 0.5));
      stored.push_back(whole(random.between(0.0, 2.0)));
      spans.least_stored.push_back(-1e300);
      spans.link_ends[0].push_back(static_cast<int>(i > 0 ? 2 * i - 1 : 0));
      const bool inside = i > 0 && i < count;
      spans.link_ends[1].push_back(static_cast<int>(inside ? 2 * i : 2 * count));
    }
    for (std::size_t k = 0; k < count; ++k) {
      for (const std::size_t e : {0U, 1U}) {
        spans.wheels[e].push_back(static_cast<int>(k + e + 1));
        spans.given[e].push_back(random.between(-1.0, 1.0));
        remainders.push_back(random.between(-0.5, 0.5) * quantum);
      }
      spans.lengths.push_back(random.between(1.0, 2.0));
      rest_lengths.push_back(whole(random.between(1.0, 2.0)));
    }
  }
};

class WindingKernels : public testing::TestWithParam<std::size_t> {};

TEST_P(WindingKernels, MovesWholeQuantaAndLosesNothing) {
  // Coarse, so that what is left over is seen.
  const double quantum = std::exp2(-12);
  test::Random random(GetParam());
  WheelRow row(GetParam(), quantum, random);
  std::vector<double> lengths(row.count);
  std::vector<double> remainders(2 * row.count);
  std::vector<double> moved(2 * row.count + 1);
  std::vector<double> stored(row.count + 1);
  const WoundCable wound =
      wind_cable(row.spans, {0, row.count, quantum}, row.motion.data(), row.rest_lengths.data(),
                 row.remainders.data(), lengths.data(), remainders.data(), moved.data());
  EXPECT_TRUE(take_from_links(row.spans, row.stored.data(), moved.data(), stored.data()));
  double most = 0.0;
  double shortest = 0.0;
  for (std::size_t k = 0; k < row.count; ++k) {
    for (const std::size_t e : {0U, 1U}) {
      const double amount = row.spans.given[e][k] * row.motion[at(row.spans.wheels[e][k])];
      const double gone = moved[2 * k + e];
      EXPECT_EQ(gone, std::round(gone / quantum) * quantum);
      // Rounded to the nearest quantum, and what is left of it is kept.
      EXPECT_LE(std::abs(remainders[2 * k + e]), 0.5 * quantum * (1.0 + 1e-12));
      EXPECT_NEAR(gone + remainders[2 * k + e], amount + row.remainders[2 * k + e], 1e-16);
      most = std::max(most, std::abs(gone));
    }
    EXPECT_EQ(lengths[k], row.rest_lengths[k] + moved[2 * k] + moved[2 * k + 1]);
    shortest = std::min(shortest, lengths[k]);
  }
  EXPECT_EQ(wound.most_moved, most);
  EXPECT_EQ(wound.shortest, shortest);
  // Sums of multiples of a power of two are exact: the cable is as long as it was.
  double before = 0.0;
  double after = 0.0;
  for (std::size_t k = 0; k < row.count; ++k) {
    before += row.rest_lengths[k];
    after += lengths[k];
  }
  for (std::size_t i = 0; i <= row.count; ++i) {
    before += row.stored[i];
    after += stored[i];
  }
  EXPECT_EQ(after, before);
}

TEST_P(WindingKernels, ReportsTheShortestSpanAndEmptyLinks) {
  const double quantum = std::exp2(-40);
  test::Random random(GetParam());
  const WheelRow row(GetParam(), quantum, random);
  std::vector<double> out(2 * row.count);
  std::vector<double> moved(2 * row.count + 1);
  for (std::size_t k = 0; k < row.count; ++k) {
    std::vector<double> rest_lengths = row.rest_lengths;
    std::vector<double> lengths(row.count);
    rest_lengths[k] = -7.0;
    const WoundCable wound =
        wind_cable(row.spans, {0, row.count, quantum}, row.motion.data(), rest_lengths.data(),
                   row.remainders.data(), lengths.data(), out.data(), moved.data());
    EXPECT_EQ(wound.shortest, lengths[k]);
  }
  for (std::size_t i = 0; i <= row.count; ++i) {
    std::vector<double> stored(row.count + 1);
    WindingSpans spans = row.spans;
    spans.least_stored[i] = 100.0;
    EXPECT_FALSE(take_from_links(spans, row.stored.data(), moved.data(), stored.data()));
  }
}

TEST_P(WindingKernels, FindsTensionsAndSlackSpans) {
  std::vector<double> multipliers(GetParam(), 0.5);
  std::vector<double> tensions(GetParam());
  std::vector<char> active(GetParam());
  for (std::size_t k = 0; k < GetParam(); ++k) {
    multipliers[k] = 3.0;
    EXPECT_EQ(find_tensions(GetParam(), 4.0, multipliers.data(), tensions.data()), 12.0);
    EXPECT_TRUE(find_active(GetParam(), tensions.data(), active.data()));
    tensions[k] = 0.0;
    EXPECT_FALSE(find_active(GetParam(), tensions.data(), active.data()));
    for (std::size_t i = 0; i < GetParam(); ++i) EXPECT_EQ(active[i] != 0, i != k);
    multipliers[k] = 0.5;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, WindingKernels, testing::Values(1U, 3U, 8U, 13U, 40U));

}  // namespace
}  // namespace sheave
