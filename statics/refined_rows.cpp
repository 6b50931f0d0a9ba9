#include "statics/refined_rows.h"

#include <cmath>

namespace sheave {
namespace {

/// Steps of the differences: relative to the size of the scene, to a radian, and to the unknown. The
/// error is of fourth order of the step, and rounding is divided by it.
constexpr double refining_step = 1e-3;

/// Differences of a balance with two steps.
template <class At>
Configuration::Balance derivative(const At& at, double step) {
  const auto change = [&](double by) {
    Configuration::Balance up = at(by);
    const Configuration::Balance down = at(-by);
    up.forces = (up.forces - down.forces) / (2.0 * by);
    up.residuals = (up.residuals - down.residuals) / (2.0 * by);
    return up;
  };
  Configuration::Balance near = change(step);
  const Configuration::Balance far = change(2.0 * step);
  near.forces = (4.0 * near.forces - far.forces) / 3.0;
  near.residuals = (4.0 * near.residuals - far.residuals) / 3.0;
  return near;
}

}  // namespace

void refine_rows(Configuration& configuration, const VectorX& unknowns, double size,
                 ConfigurationRows& rows) {
  std::vector<Eigen::Index> approximate;
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    if (rows.unknowns[g].approximate && unknowns[i] != 0.0) approximate.push_back(i);
  }
  if (approximate.empty()) return;
  const ConfigurationRows named = rows;
  for (const Eigen::Index i : approximate) {
    const auto displaced = [&](double by) {
      VectorX changed = unknowns;
      changed[i] += by;
      configuration.assume(configuration.forces_of(named, changed));
      return configuration.balance_at(changed);
    };
    const Configuration::Balance change = derivative(displaced, refining_step * unknowns[i]);
    rows.actions.row(i) = change.forces.transpose();
    double& compliance = rows.unknowns[static_cast<std::size_t>(i)].compliance;
    if (compliance > 0.0) compliance = change.residuals[i];
  }
  configuration.assume(configuration.forces_of(named, unknowns));
  const int n = configuration.freedoms();
  for (int k = 0; k < n; ++k) {
    const VectorX way = VectorX::Unit(n, k);
    const double unit = configuration.reach(way).translation > 0.0 ? size : 1.0;
    const auto displaced = [&](double by) {
      configuration.place(by * way);
      return configuration.balance_at(unknowns);
    };
    const Configuration::Balance change = derivative(displaced, refining_step * unit);
    for (const Eigen::Index i : approximate) rows.gradients(i, k) = change.residuals[i];
  }
  configuration.place(VectorX::Zero(n));
}

}  // namespace sheave
