#include "statics/tangent.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace sheave {
namespace {

/// Singular values below this share of the largest are rounding; rows have norm 1.
constexpr double rank_rounding = 1e-10;

/// The shortest step that rounding leaves exact enough, as a share of the scene's size and in
/// radians.
constexpr double difference_step = 1e-4;

}  // namespace

ForceTurn turn_of_forces(Configuration& configuration, const VectorX& unknowns) {
  const int n = configuration.freedoms();
  ForceTurn turn;
  turn.forces = MatrixX::Zero(n, n);
  turn.yields = MatrixX::Zero(unknowns.size(), n);
  VectorX displacement = VectorX::Zero(n);
  constexpr std::array steps{difference_step, -difference_step, 2.0 * difference_step,
                             -2.0 * difference_step};
  std::array<VectorX, 4> sums;
  std::array<VectorX, 4> yields;
  double largest = 0.0;
  double off = 0.0;
  for (int k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      displacement[k] = steps[i];
      configuration.place(displacement);
      configuration.forces_at(unknowns, sums[i], yields[i]);
    }
    displacement[k] = 0.0;
    const VectorX near = (sums[0] - sums[1]) / (2.0 * difference_step);
    const VectorX far = (sums[2] - sums[3]) / (4.0 * difference_step);
    turn.forces.col(k) = (4.0 * near - far) / 3.0;
    turn.yields.col(k) =
        (8.0 * (yields[0] - yields[1]) - (yields[2] - yields[3])) / (12.0 * difference_step);
    largest = std::max(largest, turn.forces.col(k).cwiseAbs().maxCoeff());
    off = std::max(off, (far - near).cwiseAbs().maxCoeff() / 3.0);
  }
  configuration.place(displacement);
  turn.error = largest > 0.0 ? off / largest : 0.0;
  return turn;
}

MatrixX Tangent::reduced_stiffness() const {
  const MatrixX reduced = motions.transpose() * stiffness * motions;
  return 0.5 * (reduced + reduced.transpose());
}

MatrixX Tangent::reduced_damping() const { return motions.transpose() * damping * motions; }

Tangent make_tangent(const Configuration& configuration, const ConfigurationRows& rows,
                     const ForceTurn& turn, const std::vector<char>& acts) {
  const int n = configuration.freedoms();
  Tangent tangent;
  tangent.mass = configuration.mass();
  tangent.damping = configuration.body_drag();
  tangent.stiffness = -turn.forces;
  tangent.difference_error = turn.error;
  std::vector<Eigen::Index> rigid;
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    const auto i = static_cast<Eigen::Index>(g);
    if (unknown.damper) {
      tangent.damping += unknown.damping * rows.actions.row(i).transpose() * rows.gradients.row(i);
      continue;
    }
    if (acts[g] == 0) continue;
    if (unknown.compliance == 0.0) {
      if (rows.gradients.row(i).norm() > 0.0) rigid.push_back(i);
      continue;
    }
    const VectorX gradient = (rows.gradients.row(i) + turn.yields.row(i)).transpose();
    tangent.stiffness +=
        rows.actions.row(i).transpose() * gradient.transpose() / unknown.compliance;
    tangent.damping += unknown.damping * rows.actions.row(i).transpose() * rows.gradients.row(i);
  }
  // In coordinates y = L^T q of M = L L^T every motion of norm 1 has the same energy.
  const MatrixX root = Eigen::LLT<MatrixX>(tangent.mass).matrixL();
  tangent.constraints = MatrixX::Zero(static_cast<Eigen::Index>(rigid.size()), n);
  for (std::size_t r = 0; r < rigid.size(); ++r) {
    tangent.constraints.row(static_cast<Eigen::Index>(r)) = rows.gradients.row(rigid[r]);
  }
  MatrixX null = MatrixX::Identity(n, n);
  if (!rigid.empty() && n > 0) {
    MatrixX scaled =
        root.triangularView<Eigen::Lower>().solve(tangent.constraints.transpose()).transpose();
    for (Eigen::Index r = 0; r < scaled.rows(); ++r) scaled.row(r).normalize();
    const Eigen::BDCSVD<MatrixX> svd(scaled, Eigen::ComputeFullV);
    const VectorX& values = svd.singularValues();
    while (tangent.rank < values.size() && values[tangent.rank] > rank_rounding * values[0]) {
      ++tangent.rank;
    }
    null = svd.matrixV().rightCols(n - tangent.rank);
  }
  tangent.motions = MatrixX::Zero(n, null.cols());
  if (null.size() > 0) {
    tangent.motions = root.transpose().triangularView<Eigen::Upper>().solve(null);
  }
  constexpr double of_differences = 1e-9;
  constexpr double of_rows = 1e-13;
  const MatrixX turning = tangent.motions.transpose() * turn.forces * tangent.motions;
  tangent.rounding = std::max(of_differences, turn.error) * turning.norm() +
                     of_rows * tangent.reduced_stiffness().norm();
  return tangent;
}

}  // namespace sheave
