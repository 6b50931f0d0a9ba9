#include "statics/refined_rows.h"

#include <algorithm>
#include <vector>

#include "statics/difference.h"

namespace sheave {
namespace {

/// The first steps of differences: relative to the unknown, to the size of the scene, and to a
/// radian. A stiff rope needs a long step of its tension, or its length hardly changes.
constexpr double unknown_step = 0.1;
constexpr double pose_step = 1e-4;

/// Bounds of the errors of one row.
struct RowErrors {
  double action = 0.0;
  double gradient = 0.0;
  double compliance = 0.0;
};

/// Bounds of the errors of an entry of the stiffness: of all of it, and without a common factor of the
/// row, which leaves motions that do not stretch the rope as they are.
struct StiffnessErrors {
  double whole = 0.0;
  double direction = 0.0;
};

/// Adds the stiffness of the row to that of `rows`, and its errors to `sum`.
void add_stiffness(Eigen::Index i, const RowErrors& errors, ConfigurationRows& rows,
                   StiffnessErrors& sum) {
  const double compliance = rows.unknowns[static_cast<std::size_t>(i)].compliance;
  if (!(compliance > 0.0)) return;
  const auto action = rows.actions.row(i);
  const auto gradient = rows.gradients.row(i);
  rows.refined_stiffness += action.transpose() * gradient / compliance;
  const double pull = action.cwiseAbs().maxCoeff();
  const double turn = gradient.cwiseAbs().maxCoeff();
  const double direction = (errors.action * turn + pull * errors.gradient) / compliance;
  sum.direction += direction;
  sum.whole += direction + pull * turn * errors.compliance / (compliance * compliance);
}

}  // namespace

void refine_rows(Configuration& configuration, const VectorX& unknowns, double size,
                 ConfigurationRows& rows) {
  std::vector<Eigen::Index> approximate;
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    if (rows.unknowns[g].approximate && unknowns[i] != 0.0) approximate.push_back(i);
  }
  const int n = configuration.freedoms();
  if (approximate.empty() || n == 0) return;
  const ConfigurationRows named = rows;
  std::vector<RowErrors> errors(approximate.size());
  for (std::size_t r = 0; r < approximate.size(); ++r) {
    const Eigen::Index i = approximate[r];
    const auto balance = [&](double by) {
      VectorX changed = unknowns;
      changed[i] += by;
      configuration.assume(configuration.forces_of(named, changed));
      return configuration.balance_at(changed);
    };
    const double step = unknown_step * unknowns[i];
    const Difference action = difference([&](double by) { return balance(by).forces; }, step);
    rows.actions.row(i) = action.slope.transpose();
    errors[r].action = action.error;
    double& compliance = rows.unknowns[static_cast<std::size_t>(i)].compliance;
    if (!(compliance > 0.0)) continue;
    const Difference yield =
        difference([&](double by) { return VectorX(balance(by).residuals.segment(i, 1)); }, step);
    compliance = yield.slope[0];
    errors[r].compliance = yield.error;
  }
  configuration.assume(configuration.forces_of(named, unknowns));
  for (int k = 0; k < n; ++k) {
    const VectorX way = VectorX::Unit(n, k);
    const double unit = configuration.reach(way).translation > 0.0 ? size : 1.0;
    const auto residuals = [&](double by) {
      configuration.place(by * way);
      return VectorX(configuration.balance_at(unknowns).residuals(approximate));
    };
    const Difference gradient = difference(residuals, pose_step * unit);
    for (std::size_t r = 0; r < approximate.size(); ++r) {
      rows.gradients(approximate[r], k) = gradient.slope[static_cast<Eigen::Index>(r)];
      errors[r].gradient = std::max(errors[r].gradient, gradient.error);
    }
  }
  configuration.place(VectorX::Zero(n));
  rows.refined_stiffness = MatrixX::Zero(n, n);
  StiffnessErrors off;
  for (std::size_t r = 0; r < approximate.size(); ++r) {
    add_stiffness(approximate[r], errors[r], rows, off);
  }
  const double largest = rows.refined_stiffness.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return;
  rows.refined_error = off.whole / largest;
  rows.refined_rounding = off.direction / largest;
}

}  // namespace sheave
