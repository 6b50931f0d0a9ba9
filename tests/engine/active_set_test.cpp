#include "engine/solvers/active_set.h"

#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// A random problem with lower, upper and no bounds; `skew` makes it asymmetric.
struct RandomProblem {
  ComplementarityProblem problem;
  std::vector<std::pair<int, int>> entries;
  Eigen::MatrixXd matrix;

  RandomProblem(int n, double skew, std::mt19937& generator) {
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    Eigen::MatrixXd b(n, n);
    for (int i = 0; i < n * n; ++i) b(i / n, i % n) = value(generator);
    matrix = b * b.transpose() + 0.5 * Eigen::MatrixXd::Identity(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        const double part = skew * value(generator);
        matrix(i, j) += part;  // x^T A x stays positive
        matrix(j, i) -= part;
        entries.emplace_back(i, j);
        problem.values.push_back(matrix(i, j));
        problem.lower_values.push_back(matrix(j, i));
      }
      problem.diagonal.push_back(matrix(i, i));
      problem.constant.push_back(value(generator));
      const int kind = i % 3;
      problem.lower.push_back(kind == 0 ? -0.5 * std::abs(value(generator)) : -no_bound);
      problem.upper.push_back(kind == 1 ? 0.5 * std::abs(value(generator)) : no_bound);
      problem.free.push_back(static_cast<char>(value(generator) > 0.0 || kind == 2));
    }
    problem.size = n;
    problem.symmetric = skew == 0.0;
  }
};

TEST(ActiveSet, FindsMultipliersThatMeetAllConditions) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 300; ++trial) {
    const double skew = trial % 2 == 0 ? 0.0 : 0.3;
    RandomProblem random(1 + trial % 12, skew, generator);
    ComplementarityProblem& p = random.problem;
    ActiveSetSolver solver;
    solver.analyse(p.size, random.entries);
    ASSERT_TRUE(solver.solve(p));
    Eigen::VectorXd x(p.size);
    for (int i = 0; i < p.size; ++i) x[i] = solver.solution()[static_cast<std::size_t>(i)];
    const Eigen::VectorXd c = Eigen::Map<Eigen::VectorXd>(p.constant.data(), p.size);
    const Eigen::VectorXd r = random.matrix * x + c;
    for (int i = 0; i < p.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      constexpr double rounding = 1e-10;  // condition numbers reach some 1e3
      EXPECT_GE(x[i], p.lower[k] - rounding);
      EXPECT_LE(x[i], p.upper[k] + rounding);
      if (x[i] > p.lower[k] + rounding) {
        EXPECT_LE(r[i], rounding);
      }
      if (x[i] < p.upper[k] - rounding) {
        EXPECT_GE(r[i], -rounding);
      }
    }
  }
}

TEST(ActiveSet, KeepsItsFactorsWhileTheSetsStayRight) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  int refined = 0;
  for (int trial = 0; trial < 300; ++trial) {
    RandomProblem random(2 + trial % 11, trial % 2 == 0 ? 0.0 : 0.3, generator);
    ComplementarityProblem& p = random.problem;
    ActiveSetSolver solver;
    solver.analyse(p.size, random.entries);
    ASSERT_TRUE(solver.solve(p));
    const std::vector<double> last(solver.solution().begin(), solver.solution().end());
    std::vector<double> change(p.constant.size());
    for (std::size_t i = 0; i < change.size(); ++i) {
      change[i] = 0.1 * value(generator);
      p.constant[i] += change[i];
      p.lower[i] -= 0.05 * std::abs(value(generator));
      p.upper[i] += 0.05 * std::abs(value(generator));
    }
    const std::vector<char> sets = p.free;
    const bool fits = solver.refine(p, change, true);
    const std::vector<double> found(solver.solution().begin(), solver.solution().end());
    ActiveSetSolver afresh;
    afresh.analyse(p.size, random.entries);
    ASSERT_TRUE(afresh.solve(p));
    // The solution of a problem like these is the only one.
    EXPECT_EQ(fits, p.free == sets);
    const std::span<const double> expected = fits ? afresh.solution() : std::span(last);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-10);
    refined += fits ? 1 : 0;
  }
  EXPECT_GT(refined, 50);
  EXPECT_LT(refined, 300);
}

TEST(ActiveSet, StaysAtTheSolution) {
  std::mt19937 generator(4);
  RandomProblem random(10, 0.0, generator);
  ActiveSetSolver solver;
  solver.analyse(10, random.entries);
  ASSERT_TRUE(solver.solve(random.problem));
  const std::vector<char> found = random.problem.free;
  ASSERT_TRUE(solver.solve(random.problem));
  EXPECT_EQ(solver.changes(), 0);
  EXPECT_EQ(random.problem.free, found);
}

TEST(ActiveSet, AContradictionOfTheSizeOfRoundingIsNoViolation) {
  // A wheel held between two walls: one span is too long by more than the other has to spare, all
  // of it rounding.
  ComplementarityProblem p;
  p.size = 2;
  p.diagonal = {1.0, 1.0};
  p.values = {-1.0};
  p.constant = {1e-15, -2e-15};
  p.lower = {0.0, 0.0};
  p.upper = {no_bound, no_bound};
  ActiveSetSolver solver;
  solver.analyse(2, std::vector<std::pair<int, int>>{{0, 1}});
  p.free = {1, 1};
  EXPECT_FALSE(solver.solve(p));
  p.free = {1, 1};
  p.rounding = 1e-14;
  EXPECT_TRUE(solver.solve(p));
  // Beyond rounding there is none, and that is told.
  p.constant = {1e-13, -2e-13};
  p.free = {1, 1};
  EXPECT_FALSE(solver.solve(p));
}

TEST(ActiveSet, EachRowHasItsOwnScale) {
  // A joint that turns by a radian in a substep, and beside it, nothing between them, a span in a
  // machine of a micrometre that is too long by 1e-14 m. The span must be pulled back however large
  // the other number is.
  ComplementarityProblem p;
  p.size = 2;
  p.diagonal = {10.0, 1e3};
  p.constant = {1.0, -1e-14};
  p.lower = {-no_bound, 0.0};
  p.upper = {no_bound, no_bound};
  p.free = {1, 0};
  ActiveSetSolver solver;
  solver.analyse(2, {});
  ASSERT_TRUE(solver.solve(p));
  EXPECT_DOUBLE_EQ(solver.solution()[0], -0.1);
  EXPECT_DOUBLE_EQ(solver.solution()[1], 1e-17);
  // And lets go when it is as much too short.
  p.constant[1] = 1e-14;
  p.free[1] = 1;
  ASSERT_TRUE(solver.solve(p));
  EXPECT_EQ(solver.solution()[1], 0.0);
}

// One coordinate, pushed up by all rows alike: A is a matrix of ones, of rank 1. The last row asks
// for more than the others, so it alone pushes; whichever rows are free to begin with, and in
// whichever order they are eliminated.
TEST(ActiveSet, ARedundantRowThatContradictsTheOthersReleasesThem) {
  for (const int n : {2, 3, 5}) {
    for (const double skew : {0.0, 1e-3}) {
      for (int asking = 0; asking < n; ++asking) {
        for (int set = 0; set < 1 << n; ++set) {
          ComplementarityProblem p;
          p.size = n;
          p.symmetric = skew == 0.0;
          std::vector<std::pair<int, int>> entries;
          for (int i = 0; i < n; ++i) {
            p.diagonal.push_back(1.0);
            p.constant.push_back(i == asking ? -0.5 : -0.01 * i);
            p.lower.push_back(0.0);
            p.upper.push_back(no_bound);
            p.free.push_back(static_cast<char>((set >> i) & 1));
            for (int j = i + 1; j < n; ++j) entries.emplace_back(i, j);
          }
          // Gradients as of two moments: A(i, j) = 1 + skew for i < j, 1 - skew below.
          p.values.assign(entries.size(), 1.0 + skew);
          p.lower_values.assign(entries.size(), 1.0 - skew);
          ActiveSetSolver solver;
          solver.analyse(n, entries);
          ASSERT_TRUE(solver.solve(p));
          double sum = 0.0;
          for (int i = 0; i < n; ++i) {
            const double x = solver.solution()[static_cast<std::size_t>(i)];
            EXPECT_GE(x, -1e-13);
            sum += x;
          }
          // A sum of 0.5 satisfies the asking row; with the skew, within 2 skew of it.
          EXPECT_NEAR(sum, 0.5, 1e-12 + 2.0 * skew) << n << ' ' << asking << ' ' << set;
        }
      }
    }
  }
}

TEST(ActiveSet, ContradictoryRowsAreSolvedByLeastSquares) {
  // A = J J^T of more rows than unknowns of motion, so c is mostly out of reach. The least sum of
  // r^2 / D has A r / D = 0: with the softness e = 1e-6, and s the eigenvalues of S = D^-1/2 A
  // D^-1/2, what is left of a part c' of D^-1/2 c is c' (1 - (s / (s + e))^2), and S times that at
  // most 2 e c'. Along null vectors, s = 0, dl is rounding over e^2.
  constexpr double softness = 1e-6;
  std::mt19937 generator(8);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 4 + trial % 5;
    const int motions = 3;
    Eigen::MatrixXd gradients(n, motions);
    for (int i = 0; i < n * motions; ++i) gradients(i / motions, i % motions) = value(generator);
    const Eigen::MatrixXd matrix = gradients * gradients.transpose();
    ComplementarityProblem p;
    p.size = n;
    std::vector<std::pair<int, int>> entries;
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        entries.emplace_back(i, j);
        p.values.push_back(matrix(i, j));
      }
      p.diagonal.push_back(matrix(i, i));
      p.constant.push_back(value(generator));
      p.lower.push_back(-no_bound);
      p.upper.push_back(no_bound);
      p.free.push_back(1);
    }
    ActiveSetSolver solver;
    solver.analyse(n, entries);
    ASSERT_TRUE(solver.solve(p, true));
    EXPECT_TRUE(solver.contradicts());
    Eigen::VectorXd x(n);
    for (int i = 0; i < n; ++i) x[i] = solver.solution()[static_cast<std::size_t>(i)];
    const Eigen::VectorXd c = Eigen::Map<Eigen::VectorXd>(p.constant.data(), n);
    const Eigen::VectorXd root = matrix.diagonal().cwiseSqrt();
    const Eigen::VectorXd scaled_residual = (matrix * x + c).cwiseQuotient(root);
    const Eigen::VectorXd scaled_constant = c.cwiseQuotient(root);
    const Eigen::VectorXd slope =
        (matrix * scaled_residual.cwiseQuotient(root)).cwiseQuotient(root);
    EXPECT_LE(slope.norm(), 2.1 * softness * scaled_constant.norm());
    // Left to themselves some rows are left out, and their residuals are not shared.
    ASSERT_TRUE(solver.solve(p));
    EXPECT_TRUE(solver.contradicts());
  }
}

// Friction, bounded, of a coordinate that a lock holds: A is of rank one. With both free the lock
// is left out as redundant, and friction bears its load, more than it can. What the two rows want
// differs by d: at one of its bounds friction wants to move by d against what it does there, at the
// other it is content, however small d is.
TEST(ActiveSet, FindsTheBoundOfFrictionBesideALock) {
  for (const double d : {1e-3, 1e-11, -1e-11, 2.7e-14, -2.7e-14}) {
    for (const double lever : {1.0, 0.0025}) {
      constexpr double most = 1e-6;
      ComplementarityProblem p;
      p.size = 2;
      p.diagonal = {1.0, lever * lever};
      p.values = {lever};
      p.constant = {-1e-5 + d, -1e-5 * lever};
      p.rounding = 2e-14;
      p.lower = {-most, -no_bound};
      p.upper = {most, no_bound};
      p.free = {1, 1};
      ActiveSetSolver solver;
      solver.analyse(2, std::vector<std::pair<int, int>>{{0, 1}});
      ASSERT_TRUE(solver.solve(p)) << d << ' ' << lever;
      const double x = solver.solution()[0];
      const double y = solver.solution()[1];
      constexpr double slop = 3e-14;
      EXPECT_LE(std::abs(x), most * (1.0 + 1e-12));
      EXPECT_NEAR(lever * (x + lever * y - 1e-5), 0.0, slop);
      const double r = x + lever * y - 1e-5 + d;
      if (x > -most) {
        EXPECT_LE(r, slop) << d << ' ' << lever;
      }
      if (x < most) {
        EXPECT_GE(r, -slop) << d << ' ' << lever;
      }
    }
  }
}

}  // namespace
}  // namespace sheave
