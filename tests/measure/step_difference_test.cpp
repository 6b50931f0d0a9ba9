#include "measure/step_difference.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/support/rounding.h"

namespace sheave::measure {
namespace {

/// Differences of a quantity q(h, t) in 20 frames.
StepDifferenceSum summed(const std::function<Vector3(double, double)>& quantity) {
  StepDifferenceSum sum;
  for (int frame = 1; frame <= 20; ++frame) {
    const double t = 0.1 * frame;
    const Vector3 middle = quantity(0.5, t);
    sum.add(quantity(1.0, t) - middle, middle - quantity(0.25, t));
    sum.end_frame(t);
  }
  return sum;
}

TEST(StepDifference, FindsOrderAndErrorOfALaw) {
  for (const double p : {1.0, 2.0, 4.0}) {
    // The truth is (7, t, 0), the error (0, t, 2 t) h^p / 100: largest at the end.
    const StepDifference found = summed([p](double h, double t) {
                                   const double error = 0.01 * t * std::pow(h, p);
                                   return Vector3(7.0, t + error, 2.0 * error);
                                 }).result(10.0);
    ASSERT_TRUE(found.order);
    // Differences of numbers of size 7 have 1e-15, 1e-13 of themselves.
    EXPECT_NEAR(*found.order, p, 1e-11);
    EXPECT_NEAR(found.error(), 0.02 * std::sqrt(5.0), 1e-12);
    EXPECT_NEAR(found.largest, 0.02 * std::sqrt(5.0) * (1.0 - std::exp2(-p)), 1e-13);
    EXPECT_NEAR(found.relative(), 0.1 * found.largest, 1e-15);
    EXPECT_EQ(found.time, 2.0);
    EXPECT_EQ(found.at_end, found.largest);
  }
}

TEST(StepDifference, DifferencesAtOtherTimesHaveNoOrder) {
  // Twice as large, as of first order, but at other times: what moments of impacts that shift by a
  // step make.
  const StepDifference events = summed([](double h, double t) {
                                  return Vector3(h * std::sin(30.0 * t / h), 0.0, 0.0);
                                }).result(1.0);
  EXPECT_FALSE(events.order);
  EXPECT_EQ(events.error(), events.bound);
  EXPECT_GE(events.error(), events.largest);
  // In the other direction.
  const StepDifference swings =
      summed([](double h, double t) {
        return Vector3(t * (h == 1.0 ? 2.0 : (h == 0.5 ? 0.0 : 1.0)), 0.0, 0.0);
      }).result(1.0);
  EXPECT_FALSE(swings.order);
  // And one that hardly falls: h^0.5.
  EXPECT_FALSE(summed([](double h, double t) { return Vector3(t * std::sqrt(h), 0.0, 0.0); })
                   .result(1.0)
                   .order);
}

TEST(StepDifference, WithoutAnOrderIsAtLeastTheErrorOfADelay) {
  // Something that happens at the moment u before the end of a substep is late by what is missing to
  // the end of the substep, of the size h = 1, 1/2 or 1/4; positions are wrong in proportion.
  for (int i = 0; i < 100; ++i) {
    const double moment = (i + 0.5) / 100.0;
    const auto late = [moment](double h, double) {
      return Vector3(std::ceil(moment / h) * h - moment, 0.0, 0.0);
    };
    const StepDifference told = summed(late).result(1.0);
    const double error = late(1.0, 0.0).x();
    SCOPED_TRACE(error);
    // What all three find at the same moment nobody sees.
    if (error <= 0.25) {
      EXPECT_EQ(told.largest, 0.0);
      EXPECT_EQ(told.error(), 0.0);
      continue;
    }
    EXPECT_GE(told.error(), error);
    EXPECT_LE(told.error(), 2.0 * error);
  }
}

TEST(StepDifference, TheBoundIsTheErrorInFirstOrderAndSlightlyMoreInSecond) {
  for (const auto& [p, expected] : {std::pair(1.0, 1.0), std::pair(2.0, 21.0 / 16.0)}) {
    const StepDifference found = summed([p = p](double h, double t) {
                                   return Vector3(0.1 * t * std::pow(h, p), 0.0, 0.0);
                                 }).result(1.0);
    EXPECT_NEAR(found.bound, expected * 0.2, 1e-14);
  }
}

TEST(StepDifference, UnseenErrorsCountWithoutAnOrder) {
  StepDifference told;
  told.bound = 1.0;
  told.unseen = 2.0;
  EXPECT_EQ(told.error(), 2.0);
  told.largest = 0.5;
  told.order = 1.0;
  EXPECT_EQ(told.error(), 1.0);
}

TEST(StepDifference, RoundingHasNoOrder) {
  const auto sum = summed([](double h, double) { return Vector3(1e-10 * h, 0.0, 0.0); });
  EXPECT_FALSE(sum.result(1.0).order);
  EXPECT_TRUE(sum.result(1e-3).order) << "of a smaller scene it is no rounding";
  const auto none = summed([](double, double t) { return Vector3(t, 0.0, 0.0); });
  EXPECT_EQ(none.result(1.0).largest, 0.0);
  EXPECT_EQ(none.result(0.0).relative(), 0.0) << "no difference, even without a scale";
}

TEST(StepDifference, IsARootMeanSquareOverParts) {
  StepDifferenceSum sum;
  for (int part = 0; part < 4; ++part) {
    sum.add({0.0, 3.0, 0.0}, {0.0, 1.5, 0.0});
  }
  sum.end_frame(1.0);
  EXPECT_EQ(sum.last(), 6.0);
  const StepDifference mean = sum.result(10.0, 4);
  EXPECT_EQ(mean.largest, 3.0);
  EXPECT_EQ(mean.at_end, 3.0);
  EXPECT_NEAR(*mean.order, 1.0, 4.0 * test::eps);
}

}  // namespace
}  // namespace sheave::measure
