#pragma once
// What a run says of the check of its own numbers (cable/run_check.h).

#include <string>

#include "cable/certificate.h"

namespace sheave::command {

/// Figures above this part of their own scale make a run doubtful, unless the user says otherwise.
inline constexpr double default_trust = 0.01;

/// One line: "checked: constraints within 3e-12 m, ..." or "doubtful: at 1.2 s ...", without a line
/// break.
[[nodiscard]] std::string certificate_text(const Certificate& certificate, double trust);
/// The worst item and, by their kinds, the others that are above `trust`; for a certificate that is
/// not clean.
[[nodiscard]] std::string doubt_text(const Certificate& certificate, double trust);

}  // namespace sheave::command
