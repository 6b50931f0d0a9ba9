#include "engine/math/written_out.h"

#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

/// Lengths up to 8 are written out, longer ones are a loop.
TEST(ShortLoops, VisitEachIndexOnceInOrder) {
  for (int count = 0; count <= 12; ++count) {
    std::vector<int> visited;
    for_few(count, [&](int i) { visited.push_back(i); });
    std::vector<int> right(static_cast<std::size_t>(count));
    std::iota(right.begin(), right.end(), 0);
    EXPECT_EQ(visited, right) << count;
  }
}

}  // namespace
}  // namespace sheave
