#include "engine/time_table.h"

#include <gtest/gtest.h>

namespace sheave {
namespace {

TEST(TimeTable, IsLinearBetweenItsPointsAndConstantOutside) {
  const TimeTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, -20.0}};
  EXPECT_EQ(table.at(-5.0), 10.0);
  EXPECT_EQ(table.at(1.0), 10.0);
  EXPECT_EQ(table.at(1.5), 15.0);
  EXPECT_EQ(table.at(2.0), 20.0);
  EXPECT_EQ(table.at(3.0), 0.0);
  EXPECT_EQ(table.at(9.0), -20.0);
}

TEST(TimeTable, IntegralIsExactAcrossCorners) {
  const TimeTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, -20.0}};
  EXPECT_DOUBLE_EQ(table.integral(0.0, 1.0), 10.0);
  EXPECT_DOUBLE_EQ(table.integral(1.0, 2.0), 15.0);
  EXPECT_DOUBLE_EQ(table.integral(2.0, 4.0), 0.0);
  EXPECT_DOUBLE_EQ(table.integral(0.0, 5.0), 10.0 + 15.0 + 0.0 - 20.0);
  EXPECT_DOUBLE_EQ(table.integral(1.25, 1.75), 0.5 * 15.0);
}

TEST(TimeTable, ASingleValueIsConstantAndNoneIsZero) {
  const TimeTable constant{{}, {3.0}};
  EXPECT_EQ(constant.at(7.0), 3.0);
  EXPECT_EQ(constant.integral(1.0, 3.0), 6.0);
  const TimeTable none;
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.integral(0.0, 1.0), 0.0);
}

}  // namespace
}  // namespace sheave
