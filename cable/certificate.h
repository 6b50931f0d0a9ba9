#pragma once
// A run that checks its own numbers: whether what is reported of a substep belongs together.
//
//   sheave::Certificate all;
//   while (simulation->step().ok() && ...) if (auto one = simulation->certificate()) all.merge(*one);
//   if (!all.clean()) std::cerr << all.worst()->sentence();
//
// From the states at both ends of the substep and the reported forces alone, by code that shares
// nothing with the solvers but the model (cable/certificate/): the balances of momentum, the
// distance of every constraint from what it asks for, the laws of friction, the balance of energy,
// the length of the cables. Each figure is relative to its own scale, so that neither units nor
// sizes count. What it cannot see is the error of the time step itself (docs/certificate.md).

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/step_settings.h"

namespace sheave {

struct Simulation;

/// The worst of one kind.
struct CertificateItem {
  enum class Kind {
    momentum,          ///< mass x change of velocity against the reported forces [N]
    angular_momentum,  ///< the same of rotation [N m]
    joint,             ///< how far a joint is from what it locks [m], or [rad]
    span,     ///< how far a taut span is from its rest length, or its spring from its tension [m]
    drive,    ///< how far a drive that is not stalled is from what it prescribes [m, rad, N or N m]
    contact,  ///< how deep bodies overlap, each other or the floor [m]
    complementarity,  ///< what pulls though it is slack, or in a contact [N]
    friction,   ///< what passes the bound of a link, a contact or a joint, or slips below it [N]
    force_law,  ///< springs, dampers and drives of joints against their laws [N or N m]
    energy,     ///< what nothing in the substep explains [J]
    length,     ///< cable that has come from nowhere, or lengths below 0 [m]
  };
  Kind kind = Kind::momentum;
  std::string name;       ///< of the worst: body "drum", hinge "axle", rope.3, link 2 of "rope"
  double value = 0.0;     ///< how far off it is, >= 0
  std::string_view unit;  ///< of value and scale
  double scale =
      0.0;  ///< what it is measured by: the largest force of the balance, a size, what flowed
  double relative = 0.0;  ///< value / scale, without what rounding leaves
  double time = 0.0;      ///< end of the substep [s]
  std::string advice;     ///< what to change, as a clause; empty if it is exact

  /// "at 1.2 s the momentum of body "drum" is off by 3 N, 4 % of 75 N: ..."
  [[nodiscard]] std::string sentence() const;
};
inline constexpr std::size_t certificate_kinds = 11;
inline constexpr std::array<std::string_view, certificate_kinds> certificate_kind_names{
    "momentum",        "angular-momentum", "joint",     "span",   "drive", "contact",
    "complementarity", "friction",         "force-law", "energy", "length"};

/// What checks have found.
struct Certificate {
  /// The worst of every kind that there was something to check of, in the order of the kinds.
  std::vector<CertificateItem> items;
  std::int64_t substeps = 0;  ///< that were checked

  /// The item with the largest relative figure; null if nothing was checked.
  [[nodiscard]] const CertificateItem* worst() const;
  /// Of one kind; null if there was nothing to check of it.
  [[nodiscard]] const CertificateItem* find(CertificateItem::Kind kind) const;
  /// Whether no figure exceeds `trust`.
  [[nodiscard]] bool clean(double trust = 0.01) const;
  /// Takes over what is worse in `other`, and counts its substeps.
  void merge(const Certificate& other);
};

/// Which steps of a run are checked: the first, the last, those with events or with energy from
/// nowhere, and every n-th, with n such that all of it costs no more than a given share of the run, in instructions; of a run of
/// fewer steps than n, first and last cost more. Counts only, no clock: the same run is checked in
/// the same steps everywhere.
class CertificateSchedule {
 public:
  /// For runs of `simulation`. `share` of its cost, > 0.
  explicit CertificateSchedule(const Simulation& simulation, double share = 0.02);

  /// To be called after every step: whether to check it. `is_last`: no step follows. `events`: how
  /// many there have been (CableSystem::events()), ever. `suspicious`: something else speaks against
  /// the step, such as its energy.
  [[nodiscard]] bool is_due(bool is_last = false, std::size_t events = 0, bool suspicious = false);
  /// A step in this many is checked anyway.
  [[nodiscard]] std::int64_t stride() const { return stride_; }

 private:
  std::int64_t stride_ = 1;
  std::int64_t steps_ = 0;
  std::int64_t checked_ = 0;
  std::int64_t since_ = 0;  // the last check
  std::size_t events_ = 0;
  int suspects_ = 0;  // that were checked though they were not affordable
};

/// What helps where a figure of this kind is off in a run with these settings: a clause.
[[nodiscard]] std::string certificate_advice(const CertificateItem& item, const StepSettings& step);

}  // namespace sheave
