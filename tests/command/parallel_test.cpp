#include "command/parallel.h"

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

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
  EXPECT_TRUE(can_start_threads(0));
  EXPECT_TRUE(can_start_threads(8));
}

/// Whether all pieces of work are done where the system allows this user no further thread.
[[noreturn]] void work_without_threads() {
  // Root has no such limit.
  if (::geteuid() == 0 && ::setuid(65534) != 0) std::_Exit(2);
  const rlimit one{1, 1};
  if (::setrlimit(RLIMIT_NPROC, &one) != 0) std::_Exit(3);
  if (can_start_threads(1)) std::_Exit(4);
  int done = 0;
  int polls = 0;
  run_parallel(
      7, 4, [&](std::size_t) { ++done; }, [&] { ++polls; });
  std::_Exit(done == 7 && polls >= 7 ? 0 : 1);
}

TEST(Parallel, WorksOnThisThreadWhereThereAreNoOthers) {
  EXPECT_EXIT(work_without_threads(), testing::ExitedWithCode(0), "");
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
