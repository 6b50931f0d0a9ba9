#pragma once
// A check of a run's own numbers: whether the reported quantities of a substep agree.
//
//   sheave::Certificate all;
//   while (simulation->step().ok()) {
//     if (auto one = simulation->certificate()) all.merge(*one);
//   }
//   if (!all.clean()) std::cerr << all.worst()->sentence();
//
// The check reads only the states at both ends of the substep and the reported forces. Its code
// (cable/certificate/) shares only the model with the solvers. The code checks the balances of
// momentum, the residual of every constraint, the laws of friction, the balance of energy and the
// length of the cables. Each figure is relative to its own scale, so units and sizes have no
// influence. The check cannot see the discretisation error of the time step
// (docs/explanation/certificate.md).

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/step_settings.h"

namespace sheave {

struct Simulation;

/// The worst figure of one kind.
struct CertificateItem {
  enum class Kind {
    momentum,          ///< mass x change of velocity minus the reported impulse, as a force [N]
    angular_momentum,  ///< the same for rotation [N m]
    joint,             ///< distance of a joint from the pose that it locks [m], or [rad]
    span,              ///< stretch of a rigid span, or distance of an elastic span from its law [m]
    drive,    ///< distance of a drive from its target, unless it is stalled [m, rad, N or N m]
    contact,  ///< penetration of two bodies, or of a body and the floor [m]
    complementarity,  ///< tension of a slack span, or force in a contact that is open [N]
    friction,   ///< force beyond the bound of a link, contact or joint, or slip below the bound [N]
    force_law,  ///< distance of springs, dampers and drives of joints from their laws [N or N m]
    energy,     ///< energy that no work in the substep explains [J]
    length,     ///< cable length that has appeared or vanished, or a length below 0 [m]
    tolerance,  ///< estimated error of a substep that could not keep the tolerance [m]
  };
  Kind kind = Kind::momentum;
  std::string name;    ///< of the worst object: body "drum", hinge "axle", rope.3, link 2 of "rope"
  double value = 0.0;  ///< the error, >= 0
  std::string_view unit;  ///< of value and scale
  /// the reference of `relative`: the largest force of the balance, a size, or an energy flow
  double scale = 0.0;
  double relative = 0.0;  ///< (value - rounding) / scale, at least 0
  double time = 0.0;      ///< end of the substep [s]
  std::string advice;     ///< the setting to change, as a clause; empty if the figure is exact

  /// "at 1.2 s the momentum of body "drum" is off by 3 N, 4 % of 75 N: ..."
  [[nodiscard]] std::string sentence() const;
};
inline constexpr std::size_t certificate_kinds = 12;
inline constexpr std::array<std::string_view, certificate_kinds> certificate_kind_names{
    "momentum",        "angular-momentum", "joint",     "span",   "drive",  "contact",
    "complementarity", "friction",         "force-law", "energy", "length", "tolerance"};

/// The results of checks.
struct Certificate {
  /// The worst figure of every kind that occurred in the run, in the order of the kinds.
  std::vector<CertificateItem> items;
  std::int64_t substeps = 0;  ///< number of checked substeps

  /// The item with the largest relative figure; null if nothing was checked.
  [[nodiscard]] const CertificateItem* worst() const;
  /// The item of one kind; null if nothing of that kind was checked.
  [[nodiscard]] const CertificateItem* find(CertificateItem::Kind kind) const;
  /// Whether no figure exceeds `trust`.
  [[nodiscard]] bool clean(double trust = 0.01) const;
  /// Takes over the items of `other` that are worse, and adds its substeps.
  void merge(const Certificate& other);
};

/// Selects the steps of a run that are checked: the first, the last, those with events or with an
/// unexplained change of energy, and every n-th step. n is such that all checks cost at most a
/// given share of the run, in instructions; in a run shorter than n steps the first and the last
/// check cost more. The choice depends on counts only, not on the clock, so the same run is checked
/// in the same steps on every machine.
class CertificateSchedule {
 public:
  /// For runs of `simulation`. `share`: cost of the checks relative to the run, > 0.
  explicit CertificateSchedule(const Simulation& simulation, double share = 0.02);

  /// Whether to check the step that has just been done; to be called after every step. `is_last`:
  /// no step follows. `events`: number of events so far (CableSystem::events()). `suspicious`:
  /// another check doubts the step, e.g. because of its energy.
  [[nodiscard]] bool is_due(bool is_last = false, std::size_t events = 0, bool suspicious = false);
  /// Every stride()-th step is checked.
  [[nodiscard]] std::int64_t stride() const { return stride_; }

 private:
  std::int64_t stride_ = 1;
  std::int64_t steps_ = 0;
  std::int64_t checked_ = 0;
  std::int64_t since_ = 0;  // steps since the last check
  std::size_t events_ = 0;
  int suspects_ = 0;  // suspicious steps that were checked beyond the share
};

/// Advice for a figure of this kind that is off, in a run with these settings: a clause. Empty for
/// a figure that is mere rounding.
[[nodiscard]] std::string certificate_advice(const CertificateItem& item, const StepSettings& step);

}  // namespace sheave
