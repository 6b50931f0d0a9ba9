#pragma once
// A run that checks itself while it goes: single substeps as they are due, the energy of all.
//
//   sheave::RunCheck check(*simulation);
//   while (...) {
//     const sheave::StepReport report = simulation->step();
//     if (!report.ok()) break;
//     check.observe(*simulation, report.statistics);
//   }
//   if (!check.certificate().clean()) puts(check.certificate().worst()->sentence().c_str());
//
// This is the verdict that `sheave run` gives: "doubtful", where it is not clean.

#include <memory>

#include "cable/certificate.h"
#include "cable/simulation.h"

namespace sheave {

class RunCheck {
 public:
  /// Of a run that begins with the state that the simulation has now. `share` as in
  /// CertificateSchedule.
  explicit RunCheck(const Simulation& simulation, double share = 0.02);
  ~RunCheck();
  RunCheck(RunCheck&&) noexcept;
  RunCheck& operator=(RunCheck&&) noexcept;

  /// To be called after every step that is complete. `is_last`: no step follows. A state that has
  /// been restored or edited since is told by restart().
  void observe(const Simulation& simulation, const StepStatistics& statistics,
               bool is_last = false);
  /// To be called when the state has been changed by anything but a step: the energy is counted
  /// anew from here. What was found before stays.
  void restart(const Simulation& simulation);

  /// What was found so far: the worst of the substeps that were checked, and of the run's energy
  /// ("the whole run", of the kind `energy`).
  [[nodiscard]] Certificate certificate() const;
  /// Energy of the state that was observed last.
  [[nodiscard]] const Energy& energy() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
