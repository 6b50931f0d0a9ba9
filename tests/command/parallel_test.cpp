#include "command/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace sheave::command {
namespace {

TEST(Parallel, DoesEachPieceOnce) {
  for (const int threads : {1, 3, 64}) {
    std::vector<std::atomic<int>> times(20);
    run_parallel(
        times.size(), threads, [&](std::size_t i) { ++times[i]; }, [] {});
    for (const auto& count : times) EXPECT_EQ(count, 1);
  }
  run_parallel(
      0, 4, [](std::size_t) { FAIL(); }, [] {});
  EXPECT_GE(core_count(), 1);
}

TEST(Parallel, PassesOnAnExceptionAndStartsNoFurtherPiece) {
  std::atomic<int> done = 0;
  const auto work = [&](std::size_t i) {
    if (i == 3) throw std::runtime_error("the third");
    ++done;
  };
  EXPECT_THROW(run_parallel(1000, 1, work, [] {}), std::runtime_error);
  EXPECT_EQ(done, 3);
}

}  // namespace
}  // namespace sheave::command
