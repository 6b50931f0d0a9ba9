// Lengths of substeps from motions that are given, without a world.

#include "engine/step_size.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/model.h"
#include "engine/state.h"

namespace sheave {
namespace {

constexpr double dt = 0.01;

/// One body whose velocity along x is a function of time.
class GivenMotion {
 public:
  explicit GivenMotion(double tolerance, std::function<double(double)> velocity)
      : velocity_(std::move(velocity)) {
    Model model;
    BodyDef& body = model.bodies.emplace_back();
    body.name = "body";
    body.mass = 1.0;
    body.inertia = Vector3(1.0, 1.0, 1.0);
    bodies_ = *BodySet::create(model);
    step_.dt = dt;
    step_.tolerance = tolerance;
  }

  [[nodiscard]] State at_time(double time) const {
    State state = bodies_.initial_state();
    state.time = time;
    state.bodies[0].velocity = {velocity_(time), 0.0, 0.0};
    return state;
  }
  [[nodiscard]] StepSizeControl control() { return {step_, bodies_, memory_}; }
  [[nodiscard]] double length() const { return std::ldexp(dt, -static_cast<int>(memory_.level)); }
  [[nodiscard]] const StepSizeMemory& memory() const { return memory_; }

  /// One attempt at a substep from `time` [s] on.
  StepSizeVerdict attempt(StepSizeControl& sizes, double time) const {
    if (!sizes.knows()) sizes.note(at_time(time), at_time(time + 0.5 * length()));
    return sizes.judge(at_time(time), at_time(time + length()));
  }
  /// Goes on from `time` to `end` [s]; returns the number of substeps that were kept.
  int run(double time, double end) {
    StepSizeControl sizes = control();
    int kept = 0;
    while (time < end) {
      const std::int64_t level = sizes.level();
      const double to = time + length();
      static_cast<void>(attempt(sizes, time));
      if (sizes.level() > level) continue;
      time = to;
      ++kept;
      if (std::fmod(std::round(time / length()), 2.0) == 0.0) sizes.lengthen();
    }
    return kept;
  }

 private:
  std::function<double(double)> velocity_;
  BodySet bodies_;
  StepSettings step_;
  StepSizeMemory memory_;
};

TEST(StepSizeControl, FollowsTheJerk) {
  // h^2 j / 6 <= tolerance / 1 s, so a hundred times the jerk takes a tenth of the length, within
  // the factor of 2 by which lengths differ.
  for (const double jerk : {1.0, 100.0, 1e4}) {
    GivenMotion motion(1e-4, [=](double t) { return 0.5 * jerk * t * t; });
    motion.run(0.0, 1.0);
    const double longest = std::sqrt(6.0 * 1e-4 / jerk);
    EXPECT_LE(motion.length(), longest);
    EXPECT_GT(motion.length(), std::min(dt, 0.25 * longest) * 0.999);
  }
}

TEST(StepSizeControl, TakesTheLongestSubstepsWhereNothingChanges) {
  GivenMotion motion(1e-6, [](double t) { return -9.81 * t; });
  EXPECT_EQ(motion.run(0.0, 1.0), 100);
  EXPECT_EQ(motion.length(), dt);
}

TEST(StepSizeControl, KeepsTheLengthThroughVibrations) {
  GivenMotion motion(1e-4, [](double t) { return std::sin(20.0 * t); });
  motion.run(0.0, 0.64);
  const double first = motion.length();
  for (double time = 0.64; time < 6.0; time += 0.16) {
    motion.run(time, time + 0.16);
    ASSERT_EQ(motion.length(), first) << time;
  }
}

TEST(StepSizeControl, PutsAJumpOfTheVelocityIntoAShortSubstep) {
  // The place is wrong by at most h v, a quarter of the tolerance.
  constexpr double v = 3.0;
  constexpr double tolerance = 1e-4;
  GivenMotion motion(tolerance, [](double t) { return t < 0.12345 ? 0.0 : v; });
  StepSizeControl sizes = motion.control();
  double time = 0.12;
  double jumped = 0.0;
  while (time < 0.13) {
    const std::int64_t level = sizes.level();
    const double h = motion.length();
    const StepSizeVerdict verdict = motion.attempt(sizes, time);
    if (sizes.level() > level) continue;
    EXPECT_TRUE(verdict.accepted);
    if (time <= 0.12345 && 0.12345 <= time + h) jumped = h;
    time += h;
  }
  EXPECT_GT(jumped, 0.0);
  EXPECT_LE(jumped * v, 0.25 * tolerance);
}

TEST(StepSizeControl, ResidualOfAPositionShortensNoSubstep) {
  // A position is off by r at 0.1 s, which is a velocity r / h in a substep h. Half the length has
  // twice the velocity, so the whole one is the best, and no shorter one is tried.
  constexpr double r = 1e-10;
  const GivenMotion* self = nullptr;
  GivenMotion motion(1e-9, [&](double t) { return t > 0.1 ? r / self->length() : 0.0; });
  self = &motion;
  motion.run(0.0, 0.1);
  StepSizeControl sizes = motion.control();
  ASSERT_EQ(sizes.level(), 0);
  EXPECT_FALSE(motion.attempt(sizes, 0.1).is_last);
  EXPECT_EQ(sizes.level(), 1);
  EXPECT_FALSE(motion.attempt(sizes, 0.1).is_last);
  EXPECT_EQ(sizes.level(), 0);
  const StepSizeVerdict verdict = motion.attempt(sizes, 0.1);
  EXPECT_TRUE(verdict.is_last);
  EXPECT_TRUE(verdict.is_placed);
  // Of a body of 1 m, 5e-12 m are rounding.
  EXPECT_NEAR(verdict.jump, (r - 5e-12) / dt, 1e-6 * r / dt);
  EXPECT_EQ(sizes.level(), 0);
}

TEST(StepSizeControl, IsLongAgainSoonAfterAnEvent) {
  GivenMotion motion(1e-4, [](double t) { return t < 0.12345 ? 0.0 : 3.0; });
  // 2 log2(0.01 s x 3 m/s / 0.25e-4 m) = 21 substeps down and up, and those of the other 49 steps.
  EXPECT_LE(motion.run(0.0, 0.5), 49 + 3 * 21);
  EXPECT_EQ(motion.length(), dt);
}

TEST(StepSizeControl, TellsThatNoLengthIsShortEnough) {
  // A velocity that has another value at every look: the jerk grows as substeps become shorter.
  int calls = 0;
  GivenMotion motion(1e-12, [&](double) { return ++calls % 2 == 0 ? 1.0 : -1.0; });
  StepSizeControl sizes = motion.control();
  StepSizeVerdict verdict;
  int attempts = 0;
  std::int64_t level = -1;
  while (sizes.level() > level) {
    level = sizes.level();
    verdict = motion.attempt(sizes, 0.0);
    ASSERT_LE(++attempts, StepSizeControl::finest + 1);
  }
  EXPECT_FALSE(verdict.accepted);
  EXPECT_GT(verdict.error, 0.0);
  EXPECT_EQ(verdict.body, 0);
}

TEST(StepSizeMemory, IsSavedAndHashedWithTheState) {
  State state;
  state.step_size = {3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
  const std::string bytes = to_bytes(state);
  EXPECT_EQ(bytes.substr(0, 8), "SHSTATE5");
  const Result<State> read = state_from_bytes(bytes);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->step_size, state.step_size);
  EXPECT_EQ(hash(*read), hash(state));
  StepSizeMemory& size = state.step_size;
  for (double* number : {&size.middle, &size.window, &size.jerk_before, &size.jerk,
                         &size.acceleration_before, &size.acceleration, &size.accelerations[4]}) {
    const double kept = *number;
    *number = kept + 1.0;
    EXPECT_NE(hash(state), hash(*read));
    *number = kept;
  }
  ++size.level;
  EXPECT_NE(hash(state), hash(*read));
  EXPECT_FALSE(state_from_bytes(bytes.substr(0, bytes.size() - 8)).ok());
}

TEST(StepSizeMemory, LeavesStatesOfFixedSubstepsAsTheyWere) {
  EXPECT_EQ(to_bytes(State{}).substr(0, 8), "SHSTATE4");
}

TEST(StepSizeMemory, ThatFitsNoWorldIsUnsound) {
  const StepSizeMemory good{3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, std::vector<double>(12)};
  EXPECT_TRUE(StepSizeMemory{}.is_sound(2));
  EXPECT_TRUE(good.is_sound(2));
  EXPECT_FALSE(good.is_sound(3));
  StepSizeMemory bad = good;
  bad.level = StepSizeControl::finest + 1;
  EXPECT_FALSE(bad.is_sound(2));
  bad = good;
  bad.level = -1;
  EXPECT_FALSE(bad.is_sound(2));
  bad = good;
  bad.jerk = -1.0;
  EXPECT_FALSE(bad.is_sound(2));
  for (double StepSizeMemory::*member :
       {&StepSizeMemory::middle, &StepSizeMemory::window, &StepSizeMemory::jerk_before,
        &StepSizeMemory::acceleration}) {
    bad = good;
    bad.*member = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(bad.is_sound(2));
  }
  bad = good;
  bad.accelerations[3] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(bad.is_sound(2));
}

}  // namespace
}  // namespace sheave
