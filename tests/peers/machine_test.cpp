// The comparison with other engines: that all are given the same problem, and that errors mean what
// they say.

#include "bench/peers/machine.h"

#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/peers/mujoco_machine.h"
#include "scenes/generators.h"
#include "tests/support/rounding.h"

namespace sheave::peers {
namespace {

std::vector<Problem> problems() {
  Result<std::vector<Problem>> all = all_problems(SHEAVE_SOURCE_DIR);
  if (!all) throw std::runtime_error(all.errors().front().message);
  return std::move(all).value();
}

StepSettings direct(IntegratorKind integrator) {
  return {1.0 / 60.0, 1, 10, SolverKind::direct, integrator};
}

TEST(Peers, ProblemsEqualTheScenes) {
  const std::vector<Problem> all = problems();
  ASSERT_EQ(all.size(), 4U);
  for (const auto& [index, wheels] : {std::pair{0, 1}, std::pair{2, 64}, std::pair{3, 256}}) {
    WheelTrainOptions options;
    options.wheels = wheels;
    const Problem& problem = all[static_cast<std::size_t>(index)];
    EXPECT_EQ(problem.coordinates.size(), static_cast<std::size_t>(wheels) + 2U);
    // Sums of some hundred numbers, each rounded.
    EXPECT_NEAR(problem.acceleration(), options.acceleration(), 1e3 * test::eps * problem.gravity);
  }
  EXPECT_NEAR(all[1].acceleration(), 0.0, 16.0 * test::eps * all[1].gravity);
}

TEST(Peers, SheaveSolvesThemAll) {
  for (const Problem& problem : problems()) {
    const auto exact = sheave_machine(problem, direct(IntegratorKind::rattle));
    ASSERT_TRUE(exact);
    const MachineError error = error_of(problem, **exact);
    EXPECT_LT(error.position, 1e-10) << problem.name;
    EXPECT_LT(error.speed, 1e-10) << problem.name;
    EXPECT_LT(error.stretch, 1e-12) << problem.name;
    // The first-order integrator falls a h t / 2 too far, along all coordinates alike.
    const auto first = sheave_machine(problem, direct(IntegratorKind::xpbd));
    ASSERT_TRUE(first);
    const double late =
        0.5 * std::abs(problem.acceleration()) * problem.dt * problem.duration() / problem.scale;
    EXPECT_NEAR(error_of(problem, **first).position, late, 1e-3 * late + 1e-12) << problem.name;
  }
}

TEST(Peers, MujocoIsGivenTheSameProblems) {
  for (const Problem& problem : problems()) {
    MujocoSettings settings;
    settings.jacobian = "sparse";
    settings.tolerance = 1e-10;
    settings.time_constant = 0.0;
    const auto machine = mujoco_machine(problem, settings);
    ASSERT_TRUE(machine) << machine.errors().front().message;
    const MachineError error = error_of(problem, **machine);
    // Its limits are soft: a span that carries T is longer by some 1e-4 T dt^2 / m, 1e-6 m here.
    EXPECT_LT(error.speed, 1e-3) << problem.name;
    EXPECT_LT(error.stretch, 1e-5) << problem.name;
    // And it is run again from its start.
    EXPECT_EQ(error_of(problem, **machine).position, error.position) << problem.name;
  }
}

TEST(Peers, MujocoReportsUnknownSettings) {
  MujocoSettings settings;
  settings.solver = "Oracle";
  const auto machine = mujoco_machine(problems().front(), settings);
  ASSERT_FALSE(machine);
  EXPECT_THAT(machine.errors().front().message, testing::HasSubstr("Oracle"));
}

/// Moves with twice the right acceleration, the last coordinate ahead of the others.
class WrongMachine final : public Machine {
 public:
  explicit WrongMachine(const Problem& problem) : problem_(problem) {}
  void restart() override { time_ = 0.0; }
  bool step() override {
    time_ += problem_.dt;
    return true;
  }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    const double a = 2.0 * problem_.acceleration();
    positions.assign(problem_.coordinates.size(), 0.5 * a * time_ * time_);
    rates.assign(problem_.coordinates.size(), a * time_);
    positions.back() += 0.01;
  }

 private:
  const Problem& problem_;
  double time_ = 0.0;
};

TEST(Peers, ErrorsAreThoseOfTheClosedForms) {
  const Problem problem = problems().front();
  WrongMachine machine(problem);
  const MachineError error = error_of(problem, machine);
  EXPECT_NEAR(error.speed, 1.0, 1e-12);
  EXPECT_NEAR(error.stretch, 0.01 / problem.scale, 1e-12);
  // a t^2 / 2 of two coordinates, and 0.01 m more of the third.
  const double way = 0.5 * problem.acceleration();
  const double square = (2.0 * way * way + (way + 0.01) * (way + 0.01)) / 3.0;
  EXPECT_NEAR(error.position, std::sqrt(square) / problem.scale, 1e-12);
}

}  // namespace
}  // namespace sheave::peers
