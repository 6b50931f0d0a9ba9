#pragma once
// The losses of a sheave as the certificate sees them, from the settings of its link.

#include "cable/links/rolling.h"

namespace sheave::certify {

/// At most radius x rope x (T1 + T2) + pin x (load of the pin) brakes the sheave.
struct LossEvidence {
  double rope = 0.0;
  double pin = 0.0;  ///< [m]
  [[nodiscard]] bool any() const { return rope > 0.0 || pin > 0.0; }
};

[[nodiscard]] LossEvidence losses_of(const RollingLink& link);

}  // namespace sheave::certify
