#include "engine/motion_history.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/state.h"

namespace sheave {
namespace {

constexpr double step = 0.01;
const std::vector<double> levers{1.0, 0.5};

/// Accelerations at substep n: polynomials of this degree in n.
std::vector<double> polynomial(int degree, int n) {
  std::vector<double> values{0.0, 0.0};
  for (int k = 0; k <= degree; ++k) {
    values[0] += (1.0 + k) * std::pow(0.1 * n, k);
    values[1] += (2.0 - k) * std::pow(0.2 * n, k);
  }
  return values;
}

MotionHistory after(int degree, int substeps) {
  MotionHistory history;
  // A velocity of the start that guesses badly.
  const std::vector<double> by_start{100.0, 100.0};
  for (int n = 0; n < substeps; ++n) history.add(step, polynomial(degree, n), by_start, levers);
  return history;
}

TEST(MotionHistory, GuessesPolynomialsOfItsOrderExactly) {
  for (int degree = 0; degree < MotionHistory::most_known; ++degree) {
    const int substeps = degree + 2;
    const MotionHistory history = after(degree, substeps);
    ASSERT_TRUE(history.tells(step, levers.size()));
    std::vector<double> guess(2);
    history.guess(guess);
    const std::vector<double> exact = polynomial(degree, substeps);
    // Sums of at most four differences of numbers below 20.
    for (std::size_t d = 0; d < 2; ++d) EXPECT_NEAR(guess[d], exact[d], 1e-12) << degree;
  }
}

TEST(MotionHistory, TellsNothingOfASubstepOfAnotherLength) {
  const MotionHistory history = after(1, 3);
  EXPECT_FALSE(history.tells(0.5 * step, levers.size()));
  EXPECT_FALSE(history.tells(step, levers.size() + 1));
  EXPECT_FALSE(MotionHistory{}.tells(step, levers.size()));
}

TEST(MotionHistory, BeginsAnewWithAnotherStep) {
  MotionHistory history = after(3, 6);
  EXPECT_EQ(history.known, MotionHistory::most_known);
  history.add(2.0 * step, polynomial(0, 0), std::vector<double>{0.0, 0.0}, levers);
  EXPECT_EQ(history.known, 1);
  EXPECT_EQ(history.step, 2.0 * step);
}

TEST(MotionHistory, TakesTheVelocityWhereItGuessesBest) {
  MotionHistory history = after(2, 6);
  // An impact: the velocity of the start tells the motion, the accelerations before do not.
  const std::vector<double> jump{1e6, -1e6};
  history.add(step, jump, jump, levers);
  EXPECT_EQ(history.order, MotionHistory::by_velocity);
  EXPECT_FALSE(history.tells(step, levers.size()));
}

TEST(MotionHistory, IsSoundWithTheSizesOfItsMachineAlone) {
  const MotionHistory history = after(2, 5);
  EXPECT_TRUE(history.is_sound(levers.size()));
  EXPECT_TRUE(MotionHistory{}.is_sound(levers.size()));
  EXPECT_FALSE(history.is_sound(levers.size() + 1));
  MotionHistory bad = history;
  bad.differences[3] = std::nan("");
  EXPECT_FALSE(bad.is_sound(levers.size()));
  bad = history;
  bad.known = MotionHistory::most_known + 1;
  EXPECT_FALSE(bad.is_sound(levers.size()));
  bad = history;
  bad.order = bad.known;
  EXPECT_FALSE(bad.is_sound(levers.size()));
}

TEST(MotionHistory, IsSavedAndHashedWithTheState) {
  State state;
  state.history = after(2, 5);
  const Result<State> read = state_from_bytes(to_bytes(state));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(hash(*read), hash(state));
  EXPECT_EQ(read->history.differences, state.history.differences);
  for (double& number : state.history.differences) {
    const double kept = number;
    number = kept + 1.0;
    EXPECT_NE(hash(state), hash(*read));
    number = kept;
  }
  state.history.order -= 1;
  EXPECT_NE(hash(state), hash(*read));
}

}  // namespace
}  // namespace sheave
