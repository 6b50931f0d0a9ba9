#pragma once
// Checks a run while it goes: single substeps by the schedule, and the energy of all steps.
//
//   sheave::RunCheck check(*simulation);
//   while (...) {
//     const sheave::StepReport report = simulation->step({}, check.within(*simulation), {});
//     if (!report.ok()) break;
//     check.observe(*simulation, report.statistics);
//   }
//   if (!check.certificate().clean()) puts(check.certificate().worst()->sentence().c_str());
//
// `sheave run` gives the same verdict: a run is "doubtful" if its certificate is not clean.

#include <functional>
#include <memory>

#include "cable/certificate.h"
#include "cable/simulation.h"

namespace sheave {

class RunCheck {
 public:
  /// The run begins with the present state of the simulation. `share` as in CertificateSchedule.
  explicit RunCheck(const Simulation& simulation, double share = 0.02);
  ~RunCheck();
  RunCheck(RunCheck&&) noexcept;
  RunCheck& operator=(RunCheck&&) noexcept;

  /// For the argument `before` of Simulation::step(): a function that checks substeps within the
  /// next step. Where a machine starts, or the speed drive of a rotor jumps, the first substep is
  /// unlike all others, and the last substep of the step, which observe() may check, does not show
  /// it. The function checks the first substep of the run, and up to 8 substeps of each of at most
  /// 16 steps in which such a drive changes its speed by more than a tenth of its largest speed.
  /// Drives of joints are not followed. If the machine has drives, moved bodies, torques or feeds,
  /// the function follows their work in every substep; without it that work is unknown, and so is
  /// the balance of energy of steps with several substeps. The function is empty if there is
  /// nothing to do, and must not outlive this object or the simulation.
  [[nodiscard]] std::function<void()> within(const Simulation& simulation);
  /// To be called after every completed step. `is_last`: no step follows. After a state has been
  /// restored or edited, call restart() first.
  void observe(const Simulation& simulation, const StepStatistics& statistics,
               bool is_last = false);
  /// To be called when anything but a step has changed the state. The balance of energy begins
  /// anew; earlier findings stay.
  void restart(const Simulation& simulation);

  /// The findings so far: the worst figures of the checked substeps, and of the run's energy (name
  /// "the whole run", kind `energy`).
  [[nodiscard]] Certificate certificate() const;
  /// Energy of the last observed state.
  [[nodiscard]] const Energy& energy() const;
  /// Energy that the integrator has taken from smooth motion since the run began, or since the last
  /// restart() [J]; 0 for substeps of `rattle`. For a short run it may be negative, because
  /// positions lag behind by half a substep.
  [[nodiscard]] double energy_taken() const;
  /// Energy exchanged by drives, friction, damping and impacts in the same time [J], >= 0: the sum
  /// of the absolute values of all changes that the integrator does not explain.
  [[nodiscard]] double energy_exchanged() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
