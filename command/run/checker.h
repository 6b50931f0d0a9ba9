#pragma once
// The texts about a run's certificate (cable/run_check.h).

#include <string>

#include "cable/certificate.h"

namespace sheave::command {

/// Default of --trust: a figure above this part of its own scale makes a run doubtful.
inline constexpr double default_trust = 0.01;

/// One line: "checked: constraints within 3e-12 m, ..." or "doubtful: at 1.2 s ...", without a line
/// break.
[[nodiscard]] std::string certificate_text(const Certificate& certificate, double trust);
/// The worst item, and the other items above `trust` by their kinds. Only for a certificate that is
/// not clean.
[[nodiscard]] std::string doubt_text(const Certificate& certificate, double trust);

}  // namespace sheave::command
