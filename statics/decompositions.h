#pragma once
// Dense decompositions of statics and modes, each compiled once: Eigen's templates of them take
// longer to compile than the rest of this folder.

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace sheave {

/// Eigenvalues in increasing order, and in the columns of `vectors` the eigenvectors of norm 1.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Motions that no row of a matrix sees.
struct NullSpace {
  Eigen::MatrixXd basis;  ///< columns of norm 1, at right angles to each other
  int rank = 0;           ///< of the matrix
};

/// The x of least norm among those with the least norm of `matrix` x - `right`; one column per
/// column of `right`. Ranks are judged by Eigen's default threshold.
[[nodiscard]] Eigen::MatrixXd least_norm_solutions(const Eigen::MatrixXd& matrix,
                                                   const Eigen::MatrixXd& right);
/// The same for one column.
[[nodiscard]] Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& matrix,
                                                  const Eigen::VectorXd& right);

/// The x with `matrix` x = `right` after one step of iterative refinement. `matrix` is square, with
/// entries of at most 1; without full rank x is the solution of least norm.
[[nodiscard]] Eigen::VectorXd refined_solution(const Eigen::MatrixXd& matrix,
                                               const Eigen::VectorXd& right);

/// The x with `matrix` x = `right`; nothing if the symmetric `matrix` is not positive definite.
[[nodiscard]] std::optional<Eigen::VectorXd> positive_solution(const Eigen::MatrixXd& matrix,
                                                               const Eigen::VectorXd& right);

/// The lower triangular L with L L^T = `matrix`, which is positive definite.
[[nodiscard]] Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);

/// Of a regular matrix.
[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

/// Of a symmetric matrix; both results are empty for an empty one.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// Of a square matrix that is not empty, in no order.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

/// Singular values of at most `rounding` times the largest count as 0.
[[nodiscard]] NullSpace null_space(const Eigen::MatrixXd& matrix, double rounding);

}  // namespace sheave
