#pragma once
// Machines from bytes.
//
//   8 bytes         a seed, of which all choices follow that no byte decides
//   64 bytes        the frame: which kind of machine, its step settings, changes of single fields
//   what is left    the machine itself
//
// Two bytes decide one choice (tests/support/random.h). Whatever is missing follows from the seed,
// so any input is a machine, and a short one is a random one.

#include "fuzz/target.h"
#include "tests/support/builders.h"

namespace sheave::fuzz {

/// How long a machine is run.
inline constexpr int run_steps = 20;

/// A machine and how it is to be run.
struct Trial {
  test::Machine machine;
  /// Fields were given values that no generator gives: it may be refused, or be extreme
  bool changed = false;
  int pause = 0;  ///< after so many steps its state is saved and restored
};

[[nodiscard]] Trial trial_from(Bytes bytes);

}  // namespace sheave::fuzz
