#pragma once
// What a run under extreme numbers came to: right within a tenth, or how it failed.
//
// The closed forms are the checks of the scene. Those of generated scenes have tolerances of a
// thousandth of what they measure, so an error in units of the tolerance is an error in
// thousandths, and stays one where the right value is zero. A scene without checks is judged by how
// much longer than allowed its rigid cables are, relative to them.
//
// Three faults are told apart from numbers that are merely wrong, because each has its own cause:
//   energy gain   a machine without drives ends with more energy than it had: by more than a tenth of the largest kinetic
//                 energy that it ever had, and by more than rounding explains
//   false slack   a span that should pull does not at all: a tension check that wants more than zero measures less than a
//                 millionth of it
//   lost length   rest lengths and stored lengths no longer add up to the cable: by more than 1e-9 of it, where rounding
//                 explains 1e-12

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "cable/simulation.h"
#include "scenes/check.h"

namespace sheave::measure {

enum class StressKind {
  right,        ///< error at most a tenth
  wrong,        ///< a larger error, but none of the faults below
  refused,      ///< the scene is not valid; nothing was run
  diverged,     ///< the run stopped itself: not finite, or run away
  energy_gain,  ///< as above, like all that follow
  false_slack,
  lost_length,
};
inline constexpr std::array<std::string_view, 7> stress_kind_names{
    "right", "wrong", "refused", "diverged", "energy gain", "false slack", "lost length"};

/// Relative errors above this are wrong.
inline constexpr double stress_error_limit = 0.1;

struct StressVerdict {
  StressKind kind = StressKind::right;
  double error =
      0.0;  ///< relative, the largest of all checks; infinite if diverged, NaN if refused
  std::string detail;  ///< the worst check, or what failed

  /// The state or a number shown is not what the scene asks for: everything but `right` and
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
  /// The verdict on a run that ended, perhaps by a divergence.
  [[nodiscard]] StressVerdict verdict(const Simulation& simulation,
                                      const std::optional<Divergence>& divergence) const;

 private:
  CheckRecorder checks_;
  bool checked_;  // whether there are any
  bool conservative_;
  std::optional<double> first_energy_;  // [J]
  double last_energy_ = 0.0;            // [J]
  double most_kinetic_ = 0.0;           // [J]
  double most_potential_ = 0.0;         // in size, elastic energy with it [J]
  double rounding_energy_ = 0.0;  // kinetic, of what rounding of positions does to velocities [J]
};

/// Whether nothing but gravity and constant forces puts energy into the scene: no body moves by a
/// function of time, is driven or has a torque, no joint has a drive, no cable is fed.
[[nodiscard]] bool is_conservative(const Scene& scene);

}  // namespace sheave::measure
