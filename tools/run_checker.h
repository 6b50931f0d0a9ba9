#pragma once
// A run that checks its own numbers (cable/certificate.h), and what it says of them.

#include <cstdint>
#include <string>

#include "cable/certificate.h"
#include "cable/simulation.h"

namespace sheave::tools {

/// Figures above this part of their own scale make a run doubtful, unless the user says otherwise.
inline constexpr double default_trust = 0.01;

/// Checks steps of a run as they are due (CertificateSchedule).
class RunChecker {
 public:
  /// For a run of this simulation until `last_step` steps are complete.
  RunChecker(const Simulation& simulation, std::int64_t last_step);
  /// To be called after every step.
  void observe(const Simulation& simulation);
  /// What was found so far.
  [[nodiscard]] const Certificate& certificate() const { return certificate_; }

 private:
  CertificateSchedule schedule_;
  std::int64_t last_step_;
  Certificate certificate_;
};

/// One line: "checked: constraints within 3e-12 m, ..." or "doubtful: at 1.2 s ...", without a line
/// break.
[[nodiscard]] std::string certificate_text(const Certificate& certificate, double trust);
/// The worst item and, by their kinds, the others that are above `trust`; for a certificate that is
/// not clean.
[[nodiscard]] std::string doubt_text(const Certificate& certificate, double trust);

}  // namespace sheave::tools
