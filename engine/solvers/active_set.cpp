#include "engine/solvers/active_set.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseLU>

#include "engine/index.h"

namespace sheave {

void ActiveSetSolver::analyse(int size, std::span<const std::pair<int, int>> entries) {
  entries_.assign(entries.begin(), entries.end());
  factor_.analyse(size, entries);
}

bool ActiveSetSolver::solve(ComplementarityProblem& problem) {
  constexpr int patience = 3;  // block changes without progress
  changes_ = dropped_ = 0;
  int fewest = problem.size + 1;
  int left = patience;
  const int most_tries = 50 + 2 * problem.size;
  for (int tries = 0; tries < most_tries; ++tries) {
    if (!solve_free(problem)) return false;
    mark_violations(problem);
    if (violated_.empty()) return true;
    const auto count = static_cast<int>(violated_.size());
    if (count < fewest) {
      fewest = count;
      left = patience;
    } else {
      --left;
    }
    if (left < 0) violated_ = {violated_.back()};
    for (const int i : violated_) problem.free[at(i)] = problem.free[at(i)] == 0 ? 1 : 0;
    changes_ += static_cast<int>(violated_.size());
  }
  return false;
}

bool ActiveSetSolver::solve_free(const ComplementarityProblem& problem) {
  const std::size_t n = at(problem.size);
  solution_.resize(n);
  residual_.assign(problem.constant.begin(), problem.constant.end());
  for (std::size_t i = 0; i < n; ++i) {
    // Which bound a row is at follows from its sign: only one of them is finite, or the nearer one is meant.
    const bool at_lower = std::isfinite(problem.lower[i]);
    solution_[i] = problem.free[i] != 0 ? 0.0 : at_lower ? problem.lower[i] : problem.upper[i];
  }
  if (!problem.symmetric) {
    if (!solve_asymmetric(problem)) return false;
  } else {
    diagonal_ = problem.diagonal;
    values_ = problem.values;
    std::vector<double>& rhs = residual_;
    for (double& c : rhs) c = -c;
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      const auto [i, j] = entries_[e];
      const bool free_i = problem.free[at(i)] != 0;
      const bool free_j = problem.free[at(j)] != 0;
      if (free_i && free_j) continue;
      if (free_i) rhs[at(i)] -= values_[e] * solution_[at(j)];
      if (free_j) rhs[at(j)] -= values_[e] * solution_[at(i)];
      values_[e] = 0.0;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (problem.free[i] != 0) continue;
      diagonal_[i] = 1.0;
      rhs[i] = solution_[i];
    }
    factor_.factor(diagonal_, values_);
    dropped_ = factor_.dropped();
    factor_.solve(rhs);
    solution_ = rhs;
  }
  // r = c + A dl.
  residual_.assign(problem.constant.begin(), problem.constant.end());
  for (std::size_t i = 0; i < n; ++i) residual_[i] += problem.diagonal[i] * solution_[i];
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    residual_[at(i)] += problem.values[e] * solution_[at(j)];
    const double below = problem.symmetric ? problem.values[e] : problem.lower_values[e];
    residual_[at(j)] += below * solution_[at(i)];
  }
  return true;
}

bool ActiveSetSolver::solve_asymmetric(const ComplementarityProblem& problem) {
  const int n = problem.size;
  Eigen::VectorXd rhs(n);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i) {
    const bool is_free = problem.free[at(i)] != 0;
    triplets.emplace_back(i, i, is_free ? problem.diagonal[at(i)] : 1.0);
    rhs[i] = is_free ? -problem.constant[at(i)] : solution_[at(i)];
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    if (problem.free[at(i)] != 0) triplets.emplace_back(i, j, problem.values[e]);
    if (problem.free[at(j)] != 0) triplets.emplace_back(j, i, problem.lower_values[e]);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor;
  factor.compute(matrix);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::VectorXd x = factor.solve(rhs);
  for (int i = 0; i < n; ++i) solution_[at(i)] = x[i];
  return x.allFinite();
}

void ActiveSetSolver::mark_violations(const ComplementarityProblem& problem) {
  // What rounding leaves of an equation is no violation.
  constexpr double rounding = 1e-13;
  double largest = 0.0;
  for (std::size_t i = 0; i < at(problem.size); ++i) {
    largest = std::max(largest, std::abs(problem.constant[i]));
  }
  violated_.clear();
  for (int i = 0; i < problem.size; ++i) {
    const std::size_t k = at(i);
    const double noise = rounding * largest;
    bool violated = false;
    if (problem.free[k] != 0) {
      const double slack = problem.diagonal[k] > 0.0 ? noise / problem.diagonal[k] : 0.0;
      violated = solution_[k] < problem.lower[k] - slack || solution_[k] > problem.upper[k] + slack;
    } else {
      violated = std::isfinite(problem.lower[k]) ? residual_[k] < -noise : residual_[k] > noise;
    }
    if (violated) violated_.push_back(i);
  }
}

}  // namespace sheave
