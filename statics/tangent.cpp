#include "statics/tangent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "statics/decompositions.h"

namespace sheave {
namespace {

/// Singular values below this share of the largest are rounding; rows have norm 1.
constexpr double rank_rounding = 1e-10;

/// The first step of differences, relative to the scene's size and in radians; then the factor and
/// the largest number of reductions that improve it.
constexpr double difference_step = 1e-4;
constexpr double shorter = 0.125;
constexpr int most_steps = 5;
/// Relative accuracy at which the reductions stop, per degree of freedom.
constexpr double good_enough = 1e-9;

/// Change of the forces with one degree of freedom.
struct TurnColumn {
  VectorX forces;
  double error = 0.0;  ///< a bound
};

TurnColumn column_of(Configuration& configuration, const VectorX& unknowns, int freedom,
                     double step) {
  VectorX displacement = VectorX::Zero(configuration.freedoms());
  const auto forces = [&](double displaced) {
    displacement[freedom] = displaced;
    configuration.place(displacement);
    return configuration.balance_at(unknowns).forces;
  };
  const VectorX near = (forces(step) - forces(-step)) / (2.0 * step);
  const VectorX far = (forces(2.0 * step) - forces(-2.0 * step)) / (4.0 * step);
  return {(4.0 * near - far) / 3.0, (far - near).cwiseAbs().maxCoeff() / 3.0};
}

}  // namespace

ForceTurn turn_of_forces(Configuration& configuration, const VectorX& unknowns, double size) {
  const int n = configuration.freedoms();
  ForceTurn turn;
  turn.forces = MatrixX::Zero(n, n);
  double largest = 0.0;
  double off = 0.0;
  for (int k = 0; k < n; ++k) {
    const bool moves = configuration.reach(VectorX::Unit(n, k)).translation > 0.0;
    double step = difference_step * (moves ? size : 1.0);
    TurnColumn best = column_of(configuration, unknowns, k, step);
    for (int i = 1; i < most_steps; ++i) {
      if (best.error <= good_enough * best.forces.cwiseAbs().maxCoeff()) break;
      step *= shorter;
      TurnColumn column = column_of(configuration, unknowns, k, step);
      if (!(column.error < best.error)) break;  // rounding dominates from here on
      best = std::move(column);
    }
    turn.forces.col(k) = best.forces;
    largest = std::max(largest, best.forces.cwiseAbs().maxCoeff());
    off = std::max(off, best.error);
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
  return tangent;
}

}  // namespace sheave
