#pragma once
// Verdict on a run with extreme numbers: right within 10 %, or the kind of its failure.
//
// The closed forms are the checks of the scene. Checks of generated scenes have tolerances of
// 1/1000 of the measured value, so an error in units of the tolerance is an error in thousandths,
// also if the right value is zero. The verdict on a scene without checks uses the excess length of
// its rigid cables, relative to them.
//
// Three faults are distinguished from other wrong numbers, because each has its own cause:
//   energy gain   a machine without drives ends with more energy than at its start: by more than
//                 10 % of its largest kinetic energy, and by more than rounding explains
//   false slack   a span that should have a tension has none: a check of a tension above zero
//                 measures less than a millionth of it
//   lost length   the sum of rest lengths and stored lengths differs from the cable's length by
//                 more than 1e-9 of it, where rounding explains 1e-12

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "cable/simulation.h"
#include "scenes/check.h"

namespace sheave::measure {

enum class StressKind {
  right,        ///< error at most 10 %
  wrong,        ///< a larger error, without any of the faults below
  refused,      ///< the scene is not valid and did not run
  diverged,     ///< the run stopped itself: the state is not finite, or bodies have moved too far
  energy_gain,  ///< see above, as all that follow
  false_slack,
  lost_length,
};
inline constexpr std::array<std::string_view, 7> stress_kind_names{
    "right", "wrong", "refused", "diverged", "energy gain", "false slack", "lost length"};

/// Relative errors above this are wrong.
inline constexpr double stress_error_limit = 0.1;

struct StressVerdict {
  StressKind kind = StressKind::right;
  /// relative, the largest of all checks; infinite if diverged, NaN if refused
  double error = 0.0;
  std::string detail;  ///< the worst check, or the failed one

  /// Whether the state or a number is not as the scene requires: every kind except `right` and
  /// `refused`.
  [[nodiscard]] bool failed() const {
    return kind != StressKind::right && kind != StressKind::refused;
  }
};

/// Follows one run and judges it at its end.
class StressJudge {
 public:
  StressJudge(const Scene& scene, const Simulation& simulation);

  /// To be called at time 0 and after every step.
  void observe(const Simulation& simulation);
  /// The verdict on a run that has ended, possibly by a divergence.
  [[nodiscard]] StressVerdict verdict(const Simulation& simulation,
                                      const std::optional<Divergence>& divergence) const;

 private:
  CheckRecorder checks_;
  bool checked_;  // whether the scene has checks
  bool conservative_;
  std::optional<double> first_energy_;  // [J]
  double last_energy_ = 0.0;            // [J]
  double most_kinetic_ = 0.0;           // [J]
  double most_potential_ = 0.0;         // largest magnitude, including elastic energy [J]
  // kinetic energy of the velocities that rounding of positions causes [J]
  double rounding_energy_ = 0.0;
};

/// Whether only gravity and constant forces put energy into the scene: no body moves by a function
/// of time, is driven or has a torque, no joint has a drive, no cable is fed.
[[nodiscard]] bool is_conservative(const Scene& scene);

}  // namespace sheave::measure
