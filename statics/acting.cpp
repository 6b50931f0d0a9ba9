#include "statics/acting.h"

#include <algorithm>
#include <cmath>

#include "statics/decompositions.h"

namespace sheave {
namespace {

/// Relative residual, to the scene's size, below which a row is closed.
constexpr double closed_within = 1e-8;
/// Relative distance from a bound below which a force is at it.
constexpr double at_bound = 1e-8;

/// Rows without compliance whose forces follow from balance.
class RigidBalance {
 public:
  RigidBalance(Acting& acting, std::vector<Eigen::Index> rigid, const MatrixX& mass)
      : acting_(acting), rigid_(std::move(rigid)) {
    sum_ = acting.rows.loads + acting.rows.actions.transpose() * acting.unknowns;
    weights_ = mass.diagonal().cwiseSqrt().cwiseInverse();
  }

  /// Releases rows beyond their bounds one by one.
  void solve() {
    while (!rigid_.empty()) {
      solve_all();
      const std::size_t worst = worst_row();
      if (worst == rigid_.size()) break;
      const Eigen::Index gone = rigid_[worst];
      const ForceUnknown& unknown = acting_.rows.unknowns[static_cast<std::size_t>(gone)];
      double& force = acting_.unknowns[gone];
      force = force > 0.5 * (unknown.lower + unknown.upper) ? unknown.upper : unknown.lower;
      if (force != 0.0) sum_ += force * acting_.rows.actions.row(gone).transpose();
      acting_.acts[static_cast<std::size_t>(gone)] = 0;
      rigid_.erase(rigid_.begin() + static_cast<std::ptrdiff_t>(worst));
    }
  }

 private:
  void solve_all() {
    MatrixX columns(sum_.size(), static_cast<Eigen::Index>(rigid_.size()));
    norms_.resize(columns.cols());
    for (Eigen::Index r = 0; r < columns.cols(); ++r) {
      columns.col(r) = weights_.cwiseProduct(
          acting_.rows.actions.row(rigid_[static_cast<std::size_t>(r)]).transpose());
      norms_[r] = std::max(columns.col(r).norm(), 1e-300);
      columns.col(r) /= norms_[r];
    }
    scaled_ = least_norm_solution(columns, -weights_.cwiseProduct(sum_));
    for (Eigen::Index r = 0; r < scaled_.size(); ++r) {
      acting_.unknowns[rigid_[static_cast<std::size_t>(r)]] = scaled_[r] / norms_[r];
    }
  }

  /// The row whose force is farthest beyond its bound; the number of rows if there is none.
  [[nodiscard]] std::size_t worst_row() const {
    std::size_t worst = rigid_.size();
    double most = 1e-9 * scaled_.cwiseAbs().maxCoeff();
    for (Eigen::Index r = 0; r < scaled_.size(); ++r) {
      const auto i = static_cast<std::size_t>(rigid_[static_cast<std::size_t>(r)]);
      const ForceUnknown& unknown = acting_.rows.unknowns[i];
      const double force = acting_.unknowns[static_cast<Eigen::Index>(i)];
      double beyond = unknown.lower == 0.0 ? -force : unknown.upper == 0.0 ? force : 0.0;
      // The bound of a row with a variable pressing force is not checked.
      if (unknown.dry_friction() && !unknown.is_pressed()) {
        const double bound = unknown.upper;
        // A force exactly at its bound counts as little as possible.
        if (std::abs(force) >= (1.0 - at_bound) * bound) {
          beyond = std::max(std::abs(force) - bound, 2.0 * most / norms_[r]);
        }
      }
      if (beyond * norms_[r] <= most) continue;
      most = beyond * norms_[r];
      worst = static_cast<std::size_t>(r);
    }
    return worst;
  }

  Acting& acting_;
  std::vector<Eigen::Index> rigid_;
  VectorX sum_;      // of loads and known forces
  VectorX weights_;  // per degree of freedom
  VectorX norms_;    // of the rows' weighted actions
  VectorX scaled_;   // forces times the norms
};

}  // namespace

Acting find_acting(Configuration& configuration, double size) {
  Acting acting{configuration.rows(), {}, {}, false};
  const auto count = static_cast<Eigen::Index>(acting.rows.unknowns.size());
  acting.unknowns = VectorX::Zero(count);
  acting.acts.assign(acting.rows.unknowns.size(), 0);
  std::vector<Eigen::Index> rigid;
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
    if (unknown.damper) continue;
    double force = 0.0;
    bool acts = false;
    if (unknown.given()) {
      force = unknown.lower;
    } else if (unknown.compliance > 0.0) {
      force = std::clamp(-unknown.value / unknown.compliance, unknown.lower, unknown.upper);
      acts = unknown.lower < force && force < unknown.upper;
    } else {
      acts = unknown.lower == 0.0   ? unknown.value <= closed_within * size
             : unknown.upper == 0.0 ? unknown.value >= -closed_within * size
                                    : true;
      if (acts) rigid.push_back(i);
    }
    acting.unknowns[i] = force;
    acting.acts[static_cast<std::size_t>(i)] = acts ? 1 : 0;
  }
  RigidBalance(acting, std::move(rigid), configuration.mass()).solve();
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
    if (unknown.lower == 0.0) acting.unknowns[i] = std::max(acting.unknowns[i], 0.0);
    if (unknown.upper == 0.0) acting.unknowns[i] = std::min(acting.unknowns[i], 0.0);
  }
  acting.slides = acting.rows.weighted;
  return acting;
}

}  // namespace sheave
