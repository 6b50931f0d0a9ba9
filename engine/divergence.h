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

/// A state that no longer means anything: not finite, out of all proportion to the scene, or one
/// that a feature cannot go on from (ConstraintBatch::dead_end()).
struct Divergence {
  /// The first bad body; the world if all bodies are well and a feature is not.
  BodyId body;
  double time = 0.0;      ///< end of the substep that produced it [s]
  std::string message;    ///< one sentence: body or feature, quantity, time
  std::string feature{};  ///< name of the first bad feature, e.g. "cables"; empty if it is a body
};

/// Beyond these a body's state at the end of a substep means nothing any more.
struct Runaway {
  double distance = 0.0;  ///< from the world's origin [m]
  double speed = 0.0;     ///< [m/s]
  double spin = 0.0;      ///< [rad/s]
};
/// Of a scene of this size [m], in a substep of `h` [s].
[[nodiscard]] Runaway runaway_limits(double size, double h);

/// What is wrong with the state at the end of a complete substep, if anything: its first body that
/// is not finite or has run away, or else its first feature.
[[nodiscard]] std::optional<Divergence> find_divergence(
    const Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);

/// Which number of a state that has been read or made by hand is not finite, as a sentence; empty
/// if all are. Those of features are numbered from 0.
[[nodiscard]] std::string infinite_number(
    const State& state, const BodySet& bodies,
    std::span<const std::unique_ptr<ConstraintBatch>> features);

}  // namespace sheave
