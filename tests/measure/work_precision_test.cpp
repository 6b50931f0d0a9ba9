#include "measure/work_precision.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sheave::measure {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double none = std::numeric_limits<double>::infinity();

// In no order; 1 is dominated by 0 in cost and by 4 in both, 3 failed, 5 costs as much as 4 for
// less.
const std::vector<WorkPoint> some_points{{1.0, 0.5},  {8.0, 0.1},  {16.0, 1e-3}, {none, none},
                                         {4.0, 0.01}, {4.0, 0.02}, {2.0, none},  {32.0, 1e-3}};

TEST(ParetoFront, KeepsPointsThatNoOtherDominates) {
  EXPECT_THAT(pareto_front(some_points), ElementsAre(0U, 4U, 2U));
  EXPECT_THAT(pareto_front({}), IsEmpty());
  const std::vector<WorkPoint> failed{{none, 0.0}, {1.0, none}, {NAN, NAN}};
  EXPECT_THAT(pareto_front(failed), IsEmpty());
  const std::vector<WorkPoint> twins{{1.0, 0.1}, {1.0, 0.1}};
  EXPECT_THAT(pareto_front(twins), ElementsAre(0U));
  const std::vector<WorkPoint> near{{1.0, 0.1}, {2.0, 0.0995}, {3.0, 0.098}};
  EXPECT_THAT(pareto_front(near), ElementsAre(0U, 2U));
  EXPECT_EQ(cheapest_within(near, 0.0999), 1U);
}

TEST(WorkPrecision, AnswersWithOneRun) {
  EXPECT_EQ(cheapest_within(some_points, 1.0), 0U);
  EXPECT_EQ(cheapest_within(some_points, 0.1), 4U);
  EXPECT_EQ(cheapest_within(some_points, 0.01), 4U);
  EXPECT_EQ(cheapest_within(some_points, 0.0099), 2U);
  EXPECT_EQ(cheapest_within(some_points, 1e-4), std::nullopt);
  EXPECT_EQ(best_within(some_points, 0.5), std::nullopt);
  EXPECT_EQ(best_within(some_points, 3.0), 0U);
  EXPECT_EQ(best_within(some_points, 8.0), 4U);
  // The fourth and the last are equally good: the cheaper one.
  EXPECT_EQ(best_within(some_points, 100.0), 2U);
}

TEST(FittedOrder, IsTheExponentOfAPowerLaw) {
  std::vector<StepError> errors;
  for (const double h : {0.08, 0.04, 0.02, 0.01}) errors.push_back({h, 3.0 * h * h, 0.0});
  const auto fit = fitted_order(errors);
  ASSERT_TRUE(fit);
  // Logarithms of numbers of order 1 and sums of four: rounding.
  EXPECT_NEAR(fit->order, 2.0, 1e-12);
  EXPECT_EQ(fit->points, 4);
}

TEST(FittedOrder, LeavesOutPointsThatDoNotFollowTheLaw) {
  std::vector<StepError> errors;
  for (const double h : {0.04, 0.02, 0.01}) errors.push_back({h, h, 1e-3});
  errors.push_back({0.5, 0.3, 1e-3});      // saturated
  errors.push_back({0.001, 2e-3, 1e-3});   // not above the doubt
  errors.push_back({0.0001, 1e-13, 0.0});  // rounding
  errors.push_back({0.16, none, 0.0});     // failed
  const auto fit = fitted_order(errors);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 1.0, 1e-12);
  EXPECT_EQ(fit->points, 3);
}

TEST(FittedOrder, NeedsThreeSteps) {
  const std::vector<StepError> two{{0.1, 1e-2, 0.0}, {0.05, 5e-3, 0.0}, {0.05, 6e-3, 0.0}};
  EXPECT_FALSE(fitted_order(two));
  EXPECT_FALSE(fitted_order({}));
}

}  // namespace
}  // namespace sheave::measure
