#pragma once
// All data that a step changes, as one value: copy it for a snapshot, assign it to go back.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/controls.h"
#include "engine/motion_history.h"
#include "engine/result.h"
#include "engine/step_size.h"
#include "engine/vector.h"

namespace sheave {

/// Motion of one body.
struct BodyState {
  Vector3 position = Vector3::Zero();               ///< of the centre of mass [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
  Vector3 velocity = Vector3::Zero();               ///< of the centre of mass [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]
  /// Planar bodies and rotors: angle turned about the axis since time 0 [rad], with whole turns;
  /// for a mounted rotor relative to its carrier. 0 for other bodies.
  double angle = 0.0;
};

/// The data that one feature (a batch of joints, the cables) carries from substep to substep. The
/// feature documents the layout.
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
  Controls controls;                   ///< set by programs; a step reads but never changes them
  /// Guess of the next motion; empty where no solver of all rows at once has used one.
  MotionHistory history;
  /// Lengths of substeps; empty without a tolerance.
  StepSizeMemory step_size;
  /// Memory of the program that sets controls (World::memory()). No motion depends on it.
  std::vector<double> memory;
  /// Hash of the meaning of these numbers: kinds, names and order of bodies, joints, cables, links
  /// and colliders; 0: unknown. A world refuses states of another layout. hash() and to_bytes()
  /// leave it out.
  std::uint64_t layout = 0;
};

/// Order-dependent 64-bit hash of every bit of the state (FNV-1a over 8-byte words). A control that
/// has been set and cleared does not contribute.
[[nodiscard]] std::uint64_t hash(const State& state);

/// The machine to which a state belongs; 0: unknown.
struct StateOrigin {
  std::uint64_t scene = 0;   ///< hash of the machine's definition
  std::uint64_t layout = 0;  ///< hash of the meaning of the state's numbers
};

/// A state from a file.
struct SavedState {
  State state;
  StateOrigin origin;
  /// Whether the file has a checksum and it is right; false for files of old versions
  bool checked = false;
};

/// The state as bytes, for a file: a tag, the numbers, and a checksum, which detects every change
/// of one 8-byte word. A state is restored bit for bit, on machines of any byte order.
[[nodiscard]] std::string to_bytes(const State& state, const StateOrigin& origin = {});
/// The inverse of to_bytes(); an error names the fault of `bytes`. States with a tolerance have the
/// format SHSTATE5, others SHSTATE4, which has no lengths of substeps. Older formats are read: SHSTATE3,
/// which has no history of motion, SHSTATE2, which has no checksum either, and SHSTATE1, which has
/// no controls either.
[[nodiscard]] Result<SavedState> saved_state_from_bytes(const std::string& bytes);
/// The state alone, without its origin.
[[nodiscard]] Result<State> state_from_bytes(const std::string& bytes);

}  // namespace sheave
