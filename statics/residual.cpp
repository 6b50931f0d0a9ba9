#include "statics/residual.h"

#include <cmath>

namespace sheave {
namespace {

double force_scale(const ConfigurationRows& rows, const VectorX& unknowns, const MatrixX& mass) {
  constexpr double most_leverage = 100.0;
  VectorX forces = unknowns.cwiseAbs();
  const VectorX all = rows.loads.cwiseAbs() + rows.actions.cwiseAbs().transpose() * forces;
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    if (unknown.compliance == 0.0 && !unknown.given()) forces[static_cast<Eigen::Index>(g)] = 0.0;
  }
  const VectorX given = rows.loads.cwiseAbs() + rows.actions.cwiseAbs().transpose() * forces;
  double largest = 0.0;
  double largest_given = 0.0;
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    const double root = std::sqrt(mass(i, i));
    largest = std::max(largest, all[i] / root);
    largest_given = std::max(largest_given, given[i] / root);
  }
  return largest_given > 0.0 ? std::min(largest, most_leverage * largest_given) : largest;
}

/// The force of friction beyond its bound, in the units of force_scale(); for friction in several
/// directions at its first row.
double excess_friction(const ConfigurationRows& rows, const VectorX& unknowns, const MatrixX& mass,
                       std::size_t g) {
  const auto first = static_cast<Eigen::Index>(g);
  const int count = std::max(rows.unknowns[g].shares, 1);
  const double bound = rows.unknowns[g].largest_friction(unknowns);
  const double excess = unknowns.segment(first, count).norm() - bound;
  double most = 0.0;
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    most = std::max(most, std::abs(rows.actions(first, i)) / std::sqrt(mass(i, i)));
  }
  return std::max(excess, 0.0) * most;
}

}  // namespace

Residual residual_of(const ConfigurationRows& rows, const VectorX& unknowns,
                     const std::vector<char>& acts, const ResidualScales& scales) {
  if (unknowns.size() != static_cast<Eigen::Index>(rows.unknowns.size())) return {1.0, 1.0};
  Residual residual;
  const VectorX sum = rows.loads + rows.actions.transpose() * unknowns;
  const double scale = force_scale(rows, unknowns, scales.mass);
  const auto note_force = [&](double force) {
    if (force > 0.0) residual.force = std::max(residual.force, force / scale);
  };
  for (Eigen::Index i = 0; i < sum.size(); ++i) {
    note_force(std::abs(sum[i]) / std::sqrt(scales.mass(i, i)));
  }
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    if (unknown.dry_friction()) note_force(excess_friction(rows, unknowns, scales.mass, g));
    if (unknown.damper || unknown.given() || unknown.dry_friction()) continue;
    const double value =
        unknown.value + unknown.compliance * unknowns[static_cast<Eigen::Index>(g)];
    double off = std::abs(value);
    if (acts[g] == 0) off = unknown.lower == 0.0 ? std::max(-value, 0.0) : std::max(value, 0.0);
    residual.length = std::max(residual.length, off / scales.size);
  }
  return residual;
}

}  // namespace sheave
