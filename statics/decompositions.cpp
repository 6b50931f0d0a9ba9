#include "statics/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace sheave {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd least_norm_solutions(const MatrixXd& matrix, const MatrixXd& right) {
  return Eigen::CompleteOrthogonalDecomposition<MatrixXd>(matrix).solve(right);
}

VectorXd least_norm_solution(const MatrixXd& matrix, const VectorXd& right) {
  return least_norm_solutions(matrix, right);
}

VectorXd refined_solution(const MatrixXd& matrix, const VectorXd& right) {
  // Below this reciprocal condition the matrix does not have full rank.
  constexpr double least_condition = 1e-13;
  constexpr double rank_threshold = 1e-11;
  VectorXd solution;
  const Eigen::PartialPivLU<MatrixXd> lu(matrix);
  // The estimate of the condition can miss a pivot that is rounding.
  const VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
  const bool full = pivots.size() == 0 || pivots.minCoeff() > least_condition * pivots.maxCoeff();
  if (full && lu.rcond() > least_condition) {
    solution = lu.solve(right);
    solution += lu.solve(right - matrix * solution);
  }
  // With a pivot of 0 the estimate of the condition is NaN or arbitrary.
  if (solution.size() == 0 || !solution.allFinite()) {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
    decomposition.setThreshold(rank_threshold);
    decomposition.compute(matrix);
    solution = decomposition.solve(right);
    solution += decomposition.solve(right - matrix * solution);
  }
  return solution;
}

std::optional<VectorXd> positive_solution(const MatrixXd& matrix, const VectorXd& right) {
  const Eigen::LLT<MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return VectorXd(factor.solve(right));
}

MatrixXd cholesky_factor(const MatrixXd& matrix) { return Eigen::LLT<MatrixXd>(matrix).matrixL(); }

MatrixXd inverse_of(const MatrixXd& matrix) { return matrix.inverse(); }

SymmetricEigen symmetric_eigen(const MatrixXd& matrix) {
  // The solver would access the largest entry of an empty matrix.
  if (matrix.size() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::vector<std::complex<double>> eigenvalues_of(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix, false);
  return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

NullSpace null_space(const MatrixXd& matrix, double rounding) {
  const Eigen::BDCSVD<MatrixXd> svd(matrix, Eigen::ComputeFullV);
  const VectorXd& values = svd.singularValues();
  NullSpace result;
  while (result.rank < values.size() && values[result.rank] > rounding * values[0]) {
    ++result.rank;
  }
  result.basis = svd.matrixV().rightCols(matrix.cols() - result.rank);
  return result;
}

}  // namespace sheave
