#include "statics/tangent.h"

#include <algorithm>
#include <cmath>

#include "statics/decompositions.h"
#include "statics/difference.h"

namespace sheave {
namespace {

/// Singular values below this share of the largest are rounding; rows have norm 1.
constexpr double rank_rounding = 1e-10;

/// The first step of differences, relative to the scene's size and in radians.
constexpr double difference_step = 1e-4;

/// Error of the geometric stiffness and of approximate rows / largest entry of both.
double error_of_differences(const ForceTurn& turn, const ConfigurationRows& rows) {
  const auto largest = [](const MatrixX& of) {
    return of.size() > 0 ? of.cwiseAbs().maxCoeff() : 0.0;
  };
  const double turning = largest(turn.forces);
  const double refined = largest(rows.refined_stiffness);
  const double most = std::max(turning, refined);
  return most > 0.0 ? (turn.error * turning + rows.refined_error * refined) / most : 0.0;
}

}  // namespace

ForceTurn turn_of_forces(Configuration& configuration, const VectorX& unknowns, double size) {
  const int n = configuration.freedoms();
  ForceTurn turn;
  turn.forces = MatrixX::Zero(n, n);
  double largest = 0.0;
  double off = 0.0;
  for (int k = 0; k < n; ++k) {
    const VectorX way = VectorX::Unit(n, k);
    const auto forces = [&](double displaced) {
      configuration.place(displaced * way);
      return configuration.balance_at(unknowns).forces;
    };
    const bool moves = configuration.reach(way).translation > 0.0;
    const Difference column = difference(forces, difference_step * (moves ? size : 1.0));
    turn.forces.col(k) = column.slope;
    largest = std::max(largest, column.slope.cwiseAbs().maxCoeff());
    off = std::max(off, column.error);
  }
  configuration.place(VectorX::Zero(n));
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
  tangent.difference_error = error_of_differences(turn, rows);
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
    tangent.stiffness +=
        rows.actions.row(i).transpose() * rows.gradients.row(i) / unknown.compliance;
    // A damper resists the row's own change. The force per multiplier of an approximate row may also
    // have changes of loads.
    const auto along = unknown.approximate ? rows.gradients.row(i) : rows.actions.row(i);
    tangent.damping += unknown.damping * along.transpose() * rows.gradients.row(i);
  }
  // In coordinates y = L^T q with M = L L^T all motions of norm 1 have the same energy.
  const MatrixX root = cholesky_factor(tangent.mass);
  tangent.constraints = MatrixX::Zero(static_cast<Eigen::Index>(rigid.size()), n);
  for (std::size_t r = 0; r < rigid.size(); ++r) {
    tangent.constraints.row(static_cast<Eigen::Index>(r)) = rows.gradients.row(rigid[r]);
  }
  MatrixX null = MatrixX::Identity(n, n);
  if (!rigid.empty() && n > 0) {
    MatrixX scaled =
        root.triangularView<Eigen::Lower>().solve(tangent.constraints.transpose()).transpose();
    for (Eigen::Index r = 0; r < scaled.rows(); ++r) scaled.row(r).normalize();
    NullSpace unseen = null_space(scaled, rank_rounding);
    tangent.rank = unseen.rank;
    null = std::move(unseen.basis);
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
  if (rows.refined_stiffness.size() > 0) {
    const MatrixX refined = tangent.motions.transpose() * rows.refined_stiffness * tangent.motions;
    tangent.rounding += std::max(of_rows, rows.refined_rounding) * refined.norm();
  }
  return tangent;
}

}  // namespace sheave
