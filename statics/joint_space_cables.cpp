// Lengths and moment arms of cables, and the motion near rest, in the coordinates of joints.

#include "cable/cable_system.h"
#include "engine/index.h"
#include "engine/number_text.h"
#include "statics/decompositions.h"
#include "statics/joint_space_content.h"

namespace sheave {

CableArms JointSpace::cable_arms() {
  CableArms result;
  const Simulation& simulation = content_->simulation;
  const Eigen::Index n = content_->count();
  if (simulation.cables == nullptr) {
    result.arms = result.span_arms = ModalMatrix::Zero(0, n);
    return result;
  }
  const auto& cables = simulation.cables->cables();
  Configuration configuration(content_->simulation, content_->state, 1.0);
  const Configuration::SingleRows rows =
      configuration.single_rows(simulation.world.features().size() - 1);
  std::vector<CableGauge> gauges;
  simulation.gauge_cables(gauges);
  const auto count = static_cast<Eigen::Index>(cables.size());
  const int spans = cables.empty() ? 0 : cables.back().first_span + cables.back().span_count;
  result.lengths = result.rates = ModalVector::Zero(count);
  result.arms = ModalMatrix::Zero(count, n);
  // A row is rest length - length.
  const MatrixX by_freedom = -rows.gradients.topRows(spans);
  result.span_arms = by_freedom * content_->basis.motions;
  const VectorX rates = by_freedom * content_->velocities - rows.drift.head(spans);
  for (Eigen::Index c = 0; c < count; ++c) {
    const CompiledCable& cable = cables[static_cast<std::size_t>(c)];
    result.lengths[c] = gauges[static_cast<std::size_t>(c)].total_length;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      result.lengths[c] -= rows.values[k];
      result.rates[c] += rates[k];
      result.arms.row(c) += result.span_arms.row(k);
    }
  }
  return result;
}

Result<LinearMotion> JointSpace::linearise() {
  const Eigen::Index n = content_->count();
  const Modes modes = find_modes(content_->simulation);
  // Rounding and the tolerance of statics leave some 1e-11.
  constexpr double balanced = 1e-6;
  if (!(modes.imbalance <= balanced)) {
    return Error{"", "the machine is not at rest: " + number_text(100.0 * modes.imbalance) +
                         " % of the forces are not balanced; move it to an equilibrium by statics, "
                         "or hold it by drives with forces"};
  }
  if (modes.motions.cols() != n) {
    return Error{"", "rigid cables, contacts, stops, or drives to speeds or positions leave " +
                         std::to_string(modes.motions.cols()) + " of " + std::to_string(n) +
                         " coordinates free; modes have the motions that are left"};
  }
  LinearMotion linear;
  linear.state_matrix = ModalMatrix::Zero(2 * n, 2 * n);
  linear.input_matrix = ModalMatrix::Zero(2 * n, n);
  if (n == 0) return linear;
  const MatrixX to_coordinates = content_->basis.gradients * modes.motions;
  const MatrixX back = inverse_of(to_coordinates);
  linear.state_matrix.topRightCorner(n, n).setIdentity();
  linear.state_matrix.bottomLeftCorner(n, n) =
      to_coordinates * modes.state_matrix.block(n, 0, n, n) * back;
  linear.state_matrix.bottomRightCorner(n, n) =
      to_coordinates * modes.state_matrix.block(n, n, n, n) * back;
  // The modes have the modal mass 1, so M^-1 = T T^T with T from modes to coordinates.
  linear.input_matrix.bottomRows(n) = to_coordinates * to_coordinates.transpose();
  return linear;
}

}  // namespace sheave
