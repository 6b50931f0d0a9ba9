#pragma once
// All that a step changes, as one value: copy it to take a snapshot, assign it to go back.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/controls.h"
#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

/// Motion of one body.
struct BodyState {
  Vector3 position = Vector3::Zero();               ///< of the centre of mass [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
  Vector3 velocity = Vector3::Zero();               ///< of the centre of mass [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]
  /// Planar bodies and rotors: angle turned about the axis since time 0 [rad], unwrapped; of a
  /// mounted rotor relative to its carrier. 0 for others.
  double angle = 0.0;
};

/// What one feature (a batch of joints, the cables) carries from substep to substep. The feature
/// documents the layout.
struct FeatureState {
  std::vector<double> reals;
  std::vector<std::int64_t> integers;
};

/// The state of a world between two substeps.
struct State {
  std::int64_t steps = 0;              ///< completed steps
  double time = 0.0;                   ///< [s]
  std::vector<BodyState> bodies;       ///< one per body of the model
  std::vector<FeatureState> features;  ///< one per feature of the world, in its order
  Controls controls;                   ///< what has been set; a step reads and never changes it
  /// What a program that sets controls remembers from step to step (World::memory()); nothing that
  /// moves depends on it.
  std::vector<double> memory;
};

/// Order-dependent 64-bit hash of every bit of the state (FNV-1a over 8-byte words). Of the
/// controls what is set counts, and not what has been set and cleared.
[[nodiscard]] std::uint64_t hash(const State& state);

/// Of which machine a state is; 0: nobody has said so.
struct StateOrigin {
  std::uint64_t scene = 0;   ///< hash of all that the machine is made of
  std::uint64_t layout = 0;  ///< hash of what the numbers of the state belong to
};

/// A state from a file.
struct SavedState {
  State state;
  StateOrigin origin;
  bool checked = false;  ///< the file has a checksum, and it is right; of old ones nobody knows
};

/// The state as bytes, for a file: a tag, its numbers, and a checksum of all of them, in which every
/// change of one 8-byte word shows. Restores bit for bit, on machines of any byte order.
[[nodiscard]] std::string to_bytes(const State& state, const StateOrigin& origin = {});
/// The inverse of to_bytes; an error names what is wrong with `bytes`. Of the versions before,
/// SHSTATE2 had no checksum, and SHSTATE1 no controls, either: states in which nothing is set.
[[nodiscard]] Result<SavedState> saved_state_from_bytes(const std::string& bytes);
/// The same, for who does not ask where it is from.
[[nodiscard]] Result<State> state_from_bytes(const std::string& bytes);

}  // namespace sheave
