#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/body_id.h"

namespace sheave {

class BodySet;
class ConstraintBatch;
struct State;
struct Substep;

/// The report of a state that is invalid: not finite, out of all proportion to the scene, or one
/// from which a feature cannot continue (ConstraintBatch::dead_end()).
struct Divergence {
  /// The first invalid body; the world if all bodies are valid and a feature is not.
  BodyId body;
  double time = 0.0;    ///< end of the substep that produced the state [s]
  std::string message;  ///< one sentence: body or feature, quantity, time
  /// Name of the first invalid feature, e.g. "cables"; empty if a body is invalid
  std::string feature{};
};

/// The limits of a valid body's state at the end of a substep.
struct Runaway {
  double distance = 0.0;  ///< from the world's origin [m]
  double speed = 0.0;     ///< [m/s]
  double spin = 0.0;      ///< [rad/s]
};
/// The limits for a scene of this size [m] and a substep of `h` [s].
[[nodiscard]] Runaway runaway_limits(double size, double h);

/// The divergence at the end of a complete substep, if any: of the first body that is not finite or
/// exceeds the limits, or else of the first feature that cannot continue.
[[nodiscard]] std::optional<Divergence> find_divergence(
    const Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);

}  // namespace sheave
