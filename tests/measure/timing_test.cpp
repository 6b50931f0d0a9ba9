// What is timed, how often and in which order. How long it takes is no matter for a test.

#include "measure/timing.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "measure/instruction_counter.h"
#include "measure/scene_contender.h"
#include "tests/support/builders.h"

namespace sheave::measure {
namespace {

using testing::ElementsAre;

TEST(Spread, IsOfTheSortedValues) {
  const Spread spread = spread_of({5.0, 1.0, 4.0, 2.0, 3.0});
  EXPECT_EQ(spread.median, 3.0);
  EXPECT_EQ(spread.lower, 2.0);
  EXPECT_EQ(spread.upper, 4.0);
  EXPECT_EQ(spread.minimum, 1.0);
  EXPECT_EQ(spread.count, 5);
  EXPECT_EQ(spread_of({7.0}).median, 7.0);
  EXPECT_EQ(quantile({1.0, 2.0}, 0.5), 1.5);
  EXPECT_EQ(quantile({1.0, 2.0}, 1.0), 2.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

/// Counts what is asked of it; fails at a frame if that is set.
struct Counting {
  int restarts = 0;
  int frames = 0;
  int failing_frame = -1;

  Contender contender(std::string name) {
    return {std::move(name), [this] { ++restarts; }, [this] { return frames++ != failing_frame; },
            10};
  }
};

TEST(Timing, GivesEachASampleInTurn) {
  Counting a;
  Counting b;
  std::vector<std::string> order;
  TimingOptions options;
  options.repetitions = 2;
  options.least_sample = 0.0;
  options.observe = [&](std::int64_t done, std::int64_t of, const std::string& name) {
    EXPECT_EQ(done, static_cast<std::int64_t>(order.size()));
    EXPECT_EQ(of, 4);
    order.push_back(name);
    return true;
  };
  const std::vector<Timing> timings =
      time_interleaved({a.contender("a"), b.contender("b")}, options);
  EXPECT_THAT(order, ElementsAre("a", "b", "a", "b"));
  ASSERT_EQ(timings.size(), 2U);
  // A run to warm up and two samples of one run each.
  EXPECT_EQ(a.restarts, 3);
  EXPECT_EQ(a.frames, 30);
  EXPECT_EQ(timings[0].seconds.count, 2);
  EXPECT_FALSE(timings[0].failed);
}

TEST(Timing, FillsASampleWithWholeRuns) {
  Counting a;
  TimingOptions options;
  options.repetitions = 1;
  options.warm_up = false;
  options.least_sample = 0.035;
  // By this clock a frame takes a millisecond, so a run takes ten, and four of them fill the
  // sample; each begins at the start.
  options.clock.cpu = [&] { return 1e-3 * a.frames; };
  const std::vector<Timing> timings = time_interleaved({a.contender("a")}, options);
  EXPECT_EQ(a.restarts, 4);
  EXPECT_EQ(a.frames, 40);
  EXPECT_NEAR(timings.front().seconds.median, 1e-3, 1e-15);
}

TEST(Timing, ReportsAFailure) {
  Counting a;
  a.failing_frame = 12;  // in the first sample, behind the warm-up
  TimingOptions options;
  options.repetitions = 2;
  options.least_sample = 0.0;
  EXPECT_TRUE(time_interleaved({a.contender("a")}, options).front().failed);
}

TEST(Timing, TheObserverCanEndTheRun) {
  Counting a;
  TimingOptions options;
  options.observe = [](std::int64_t done, std::int64_t, const std::string&) { return done < 1; };
  EXPECT_TRUE(time_interleaved({a.contender("a")}, options).empty());
}

TEST(Timing, ASceneIsRunFromItsStart) {
  const test::Machine machine = test::Atwood().machine();
  Scene scene;
  scene.model = machine.model;
  scene.cables = machine.cables;
  scene.duration = 0.5;
  scene.model.step.dt = 1.0 / 60.0;
  const Result<Contender> contender = scene_contender("atwood", scene);
  ASSERT_TRUE(contender);
  EXPECT_EQ(contender->frames, 30);
  // For ever: each run begins again, or weights would fall out of all proportion.
  for (int run = 0; run < 20; ++run) {
    contender->restart();
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(contender->frame());
  }
}

TEST(InstructionCounter, CountsOrGivesAReason) {
  const InstructionCounter counter;
  EXPECT_EQ(counter.available(), counter.reason().empty());
  const auto first = counter.read();
  volatile double sum = 0.0;
  for (int i = 0; i < 10000; ++i) sum = sum + 1.0;
  const auto last = counter.read();
  if (!counter.available()) {
    EXPECT_FALSE(first.has_value());
    return;
  }
  if (first && last) {
    EXPECT_GT(*last - *first, 10000U);
  }
}

}  // namespace
}  // namespace sheave::measure
