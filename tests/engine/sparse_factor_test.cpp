#include "engine/solvers/sparse_factor.h"

#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace sheave {
namespace {

/// A sparse positive (semi)definite matrix B B^T with `rank` random columns of `width` entries
/// each.
struct SparseMatrix {
  Eigen::MatrixXd dense;
  std::vector<std::pair<int, int>> entries;
  std::vector<double> diagonal;
  std::vector<double> values;

  explicit SparseMatrix(Eigen::MatrixXd full) : dense(std::move(full)) {
    for (int i = 0; i < dense.rows(); ++i) {
      diagonal.push_back(dense(i, i));
      for (int j = i + 1; j < dense.cols(); ++j) {
        if (dense(i, j) == 0.0) continue;
        // Either order is allowed.
        entries.emplace_back(j % 2 == 0 ? i : j, j % 2 == 0 ? j : i);
        values.push_back(dense(i, j));
      }
    }
  }
  static SparseMatrix random(int n, int rank, int width, std::mt19937& generator) {
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    std::uniform_int_distribution<int> row(0, n - 1);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, rank);
    for (int j = 0; j < rank; ++j) {
      for (int k = 0; k < width; ++k) b(row(generator), j) = value(generator);
    }
    return SparseMatrix(b * b.transpose());
  }
};

TEST(SparseFactor, AgreesWithADenseSolver) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 30;
    SparseMatrix a = SparseMatrix::random(n, 2 * n, 3, generator);
    for (int i = 0; i < n; ++i) {
      a.dense(i, i) += 0.1;
      a.diagonal[static_cast<std::size_t>(i)] += 0.1;
    }
    SparseFactor factor;
    factor.analyse(n, a.entries);
    factor.factor(a.diagonal, a.values);
    EXPECT_EQ(factor.dropped(), 0);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    std::vector<double> x(b.data(), b.data() + n);
    factor.solve(x);
    const Eigen::VectorXd solution = Eigen::Map<Eigen::VectorXd>(x.data(), n);
    // The condition number is below 6 n^2 / 0.1 or so.
    EXPECT_NEAR((a.dense * solution - b).norm(), 0.0, 1e-12 * n);
  }
}

TEST(SparseFactor, SolvesUnsymmetricMatrices) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 30;
    SparseMatrix a = SparseMatrix::random(n, 2 * n, 3, generator);
    std::vector<double> transposed = a.values;
    for (std::size_t e = 0; e < a.entries.size(); ++e) {
      const auto [i, j] = a.entries[e];
      const double skew = 0.2 * value(generator);
      a.values[e] += skew;
      transposed[e] -= skew;
      a.dense(i, j) = a.values[e];
      a.dense(j, i) = transposed[e];
    }
    for (int i = 0; i < n; ++i) {
      a.dense(i, i) += 0.1;
      a.diagonal[static_cast<std::size_t>(i)] += 0.1;
    }
    SparseFactor factor;
    factor.analyse(n, a.entries);
    factor.factor(a.diagonal, a.values, transposed);
    EXPECT_EQ(factor.dropped(), 0);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    std::vector<double> x(b.data(), b.data() + n);
    factor.solve(x);
    const Eigen::VectorXd solution = Eigen::Map<Eigen::VectorXd>(x.data(), n);
    // x^T A x >= 0.1 x^2, so no pivot is small, and the skew part lets entries grow by a few times
    // 10 at most.
    EXPECT_NEAR((a.dense * solution - b).norm(), 0.0, 1e-11 * n);
  }
}

TEST(SparseFactor, AChainHasNoFillInAnyOrderOfItsEntries) {
  constexpr int n = 1000;
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i + 1 < n; ++i) entries.emplace_back(i, i + 1);
  SparseFactor factor;
  factor.analyse(n, entries);
  EXPECT_EQ(factor.fill(), n - 1);
  // An arrow that points the wrong way: in its own order it would fill everything.
  entries.clear();
  for (int i = 1; i < n; ++i) entries.emplace_back(0, i);
  factor.analyse(n, entries);
  EXPECT_EQ(factor.fill(), n - 1);
}

TEST(SparseFactor, AChainIsSolvedLikeAnyMatrix) {
  // Symmetric and not, its entries given either way round, in pieces, and with a redundant
  // equation.
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 1 + trial % 12;
    const bool symmetric = trial % 2 == 0;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
    std::vector<std::pair<int, int>> entries;
    std::vector<double> diagonal;
    std::vector<double> values;
    std::vector<double> transposed;
    for (int i = 0; i < n; ++i) {
      dense(i, i) = 2.5 + value(generator);  // more than the row's other entries together
      diagonal.push_back(dense(i, i));
    }
    for (int i = 0; i + 1 < n; ++i) {
      if (trial % 5 == 4 && i % 3 == 2) continue;
      const bool turned = value(generator) > 0.0;
      const int row = turned ? i + 1 : i;
      const int column = turned ? i : i + 1;
      entries.emplace_back(row, column);
      values.push_back(0.7 * value(generator));
      transposed.push_back(symmetric ? values.back() : 0.7 * value(generator));
      dense(row, column) = values.back();
      dense(column, row) = transposed.back();
    }
    SparseFactor factor;
    factor.analyse(n, entries);
    if (symmetric) {
      factor.factor(diagonal, values);
    } else {
      factor.factor(diagonal, values, transposed);
    }
    const Eigen::VectorXd wanted = Eigen::VectorXd::Random(n);
    Eigen::VectorXd x = dense * wanted;
    factor.solve({x.data(), static_cast<std::size_t>(n)});
    EXPECT_NEAR((x - wanted).norm(), 0.0, 1e-13 * n) << trial;
    EXPECT_EQ(factor.dropped(), 0);
  }
  // Two equal equations: the second is left out, and the first is satisfied.
  SparseFactor factor;
  factor.analyse(2, std::vector<std::pair<int, int>>{{0, 1}});
  factor.factor(std::vector{2.0, 2.0}, std::vector{2.0});
  std::vector<double> x{3.0, 3.0};
  factor.solve(x);
  EXPECT_EQ(factor.dropped(), 1);
  EXPECT_EQ(x, (std::vector{1.5, 0.0}));
}

TEST(SparseFactor, LeavesOutRedundantEquations) {
  std::mt19937 generator(2);
  int dropped = 0;
  int redundant = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 4 + trial % 20;
    const SparseMatrix a = SparseMatrix::random(n, n / 2, 4, generator);
    SparseFactor factor;
    factor.analyse(n, a.entries);
    factor.factor(a.diagonal, a.values);
    // Hardly any is kept: where a pivot that is itself all but rounding comes before.
    dropped += factor.dropped();
    redundant += n - n / 2;
    // An equation that can be satisfied is.
    const Eigen::VectorXd b = a.dense * Eigen::VectorXd::Random(n);
    std::vector<double> x(b.data(), b.data() + n);
    factor.solve(x);
    const Eigen::VectorXd solution = Eigen::Map<Eigen::VectorXd>(x.data(), n);
    EXPECT_NEAR((a.dense * solution - b).norm(), 0.0, 1e-7);
  }
  EXPECT_GT(dropped, redundant * 99 / 100);
}

TEST(SparseFactor, KeepsNearlyRedundantEquations) {
  // Two opposite rows, as a light wheel makes them: s (1, -1; -1, 1) + w (1, 0; 0, 1) with s / w =
  // 1e10.
  SparseFactor factor;
  const std::vector<std::pair<int, int>> entries{{0, 1}};
  factor.analyse(2, entries);
  factor.factor(std::vector{1e10 + 1.0, 1e10 + 2.0}, std::vector{-1e10});
  EXPECT_EQ(factor.dropped(), 0);
  std::vector x{1.0, 1.0};
  factor.solve(x);
  // x1 = x2 = 2 / 3 to first order; subtracting 1e10 from 1e10 + 1 leaves 1e-6.
  EXPECT_NEAR(x[0], 2.0 / 3.0, 1e-5);
  EXPECT_NEAR(x[1], 2.0 / 3.0, 1e-5);
}

// Rows a, a + d, and b, which is a combination of these: with d of 1e-3 of a the second pivot is
// 1e-6, and a z of 1e3 makes of its rounding what is left of the third, 1e-16 z^2. Kept it would
// be a yield, and rounding of the right-hand side a force.
TEST(SparseFactor, LeavesOutRedundantEquationsBehindNearlyRedundantOnes) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  const auto random = [&](int n) -> Eigen::VectorXd {
    return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return value(generator); });
  };
  int above = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd rows(3, 5);
    const double apart = std::pow(10.0, -3.0 + 0.7 * value(generator));
    rows.row(0) = random(5).transpose();
    rows.row(1) = rows.row(0) + apart * random(5).transpose();
    rows.row(2) = (rows.row(1) - rows.row(0)) / apart + value(generator) * rows.row(0);
    const SparseMatrix a(rows * rows.transpose());
    // The third is the last to be eliminated, and all three are one block.
    for (const bool symmetric : {true, false}) {
      SparseFactor factor;
      factor.analyse(3, a.entries);
      if (symmetric) {
        factor.factor(a.diagonal, a.values);
      } else {
        factor.factor(a.diagonal, a.values, a.values);
      }
      EXPECT_EQ(factor.dropped(), 1) << trial;
      // A motion x of which rounding is 1e-16 asks for forces of that over the smallest pivot.
      const Eigen::VectorXd b = rows * random(5);
      std::vector<double> x(b.data(), b.data() + 3);
      factor.solve(x);
      const double largest = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
      EXPECT_LT(largest, 100.0 / (apart * apart)) << trial;
    }
    const Eigen::LDLT<Eigen::MatrixXd> exact(a.dense);
    above += exact.vectorD().cwiseAbs().minCoeff() > SparseFactor::dropped_pivot ? 1 : 0;
  }
  // That has not been found by the pivots alone.
  EXPECT_GT(above, 20);
}

}  // namespace
}  // namespace sheave
