#pragma once
// Checks a run while it goes: single substeps by the schedule, and the energy of all steps.
//
//   sheave::RunCheck check(*simulation);
//   while (...) {
//     const sheave::StepReport report = simulation->step();
//     if (!report.ok()) break;
//     check.observe(*simulation, report.statistics);
//   }
//   if (!check.certificate().clean()) puts(check.certificate().worst()->sentence().c_str());
//
// `sheave run` gives the same verdict: a run is "doubtful" if its certificate is not clean.

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

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
