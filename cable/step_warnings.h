#pragma once
// What a step could not do as it was asked, in words: for programs that hold a world, and for the
// command.

#include <string>
#include <vector>

#include "engine/step_statistics.h"

namespace sheave {

class BodySet;
class CableSystem;

/// Something the user should know although the world goes on.
struct Warning {
  std::string kind;     ///< for programs: "no_tangent", "solver_fallback", ...
  std::string subject;  ///< column-like name of what it is about, e.g. "rope.2"; may be empty
  std::string message;  ///< one sentence
};

/// What the solver and the integrator could not do as asked, of a step or of a run's steps together.
void append_solver_warnings(const StepStatistics& statistics, std::vector<Warning>& warnings);

/// What cables could not do as asked for the first time later than `since` [s]: spans without a
/// tangent, wraps without a place, drives without cable, links over which cable slid that should not.
void append_cable_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                           std::vector<Warning>& warnings);

}  // namespace sheave
