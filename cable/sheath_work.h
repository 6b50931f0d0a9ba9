#pragma once
// A sheath in a substep; internal to the cable library.

#include "cable/sheath_profile.h"

namespace sheave::cable_parts {

/// A link of the type `sheath` with its rope.
struct SheathWork {
  int link = 0;  ///< index among the links of all cables
  SheathLaw law;
  SheathProfile start;  ///< at the start of the substep
  /// Way in which the whole rope slides in the rows of this round: +1 towards the next span, -1
  /// back, 0 it is stuck somewhere.
  int slides = 0;
  int flips = 0;      ///< number of changes of `slides` in this substep
  SheathProfile end;  ///< at the end of the substep, as last solved
  /// Unstretched rope that has come in at the entry and at the exit in the substep [m].
  double from_entry = 0.0;
  double from_exit = 0.0;
  double loss = 0.0;  ///< energy that friction has taken in the substep [J]
};

}  // namespace sheave::cable_parts
