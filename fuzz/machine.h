#pragma once
// Machines from bytes.
//
//   8 bytes         a seed, of which all choices follow that no byte decides
//   64 bytes        the frame: which kind of machine, its step settings, changes of single fields
//   the rest        the machine itself
//
// Two bytes determine one choice (tests/support/random.h). Missing bytes follow from the seed, so
// any input is a machine, and a short input is a random one.

#include "fuzz/target.h"
#include "tests/support/builders.h"

namespace sheave::fuzz {

/// Number of steps of a run.
inline constexpr int run_steps = 20;

/// A machine and the way to run it.
struct Trial {
  test::Machine machine;
  /// Some fields have values that no generator makes, so the machine may be refused or extreme.
  bool changed = false;
  int pause = 0;  ///< after this number of steps the state is saved and restored
};

[[nodiscard]] Trial trial_from(Bytes bytes);

}  // namespace sheave::fuzz
