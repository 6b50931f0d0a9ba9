// When steps of a run are checked.

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

TEST(CertificateSchedule, ChecksTheFirstAndTheLastStepAndEveryNth) {
  Machine machine = Atwood{}.machine();
  const Simulation simulation = start(machine);
  CertificateSchedule schedule(simulation, 0.02);
  ASSERT_GT(schedule.stride(), 10);
  std::vector<int> checked;
  const int steps = static_cast<int>(5 * schedule.stride());
  for (int i = 1; i <= steps; ++i) {
    if (schedule.is_due(i == steps)) checked.push_back(i);
  }
  EXPECT_EQ(checked.front(), 1);
  EXPECT_EQ(checked.back(), steps);
  // The first, four strides on from it, and the last.
  EXPECT_EQ(checked.size(), 6U);
  EXPECT_EQ(checked[1], 1 + schedule.stride());
}

TEST(CertificateSchedule, EventsAreCheckedWhileTheyAreAffordable) {
  const Simulation simulation = start(Atwood{}.machine());
  CertificateSchedule schedule(simulation, 0.02);
  const auto steps = static_cast<std::size_t>(20 * schedule.stride());
  std::size_t checked = 0;
  for (std::size_t i = 0; i < steps; ++i) checked += schedule.is_due(false, i) ? 1 : 0;
  EXPECT_LE(checked, 21U);
  EXPECT_GE(checked, 19U);
}

TEST(CertificateSchedule, SuspiciousStepsAreCheckedAtOnceUpToALimit) {
  const Simulation simulation = start(Atwood{}.machine());
  CertificateSchedule schedule(simulation, 0.02);
  EXPECT_TRUE(schedule.is_due());
  EXPECT_FALSE(schedule.is_due());
  EXPECT_TRUE(schedule.is_due(false, 0, true));
  const auto steps = static_cast<int>(4 * schedule.stride());
  int checked = 0;
  for (int i = 0; i < steps; ++i) checked += schedule.is_due(false, 0, true) ? 1 : 0;
  EXPECT_GE(checked, 15);
  EXPECT_LE(checked, 15 + 4);
}

}  // namespace
}  // namespace sheave::test
