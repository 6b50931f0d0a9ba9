#pragma once
// Warnings of a step as sentences, for programs that own a world and for the command line.

#include <string>
#include <vector>

#include "engine/step_statistics.h"

namespace sheave {

class BodySet;
class CableSystem;

/// A warning to the user. The run goes on.
struct Warning {
  std::string kind;     ///< for programs: "no_tangent", "solver_fallback", ...
  std::string subject;  ///< the object concerned, as in column names, e.g. "rope.2"; may be empty
  std::string message;  ///< one sentence
};

/// Warnings of solver and integrator, from the statistics of one step or of a run's steps together.
void append_solver_warnings(const StepStatistics& statistics, std::vector<Warning>& warnings);

/// Warnings of cables whose fault first occurred later than `since` [s]: spans without a tangent,
/// wraps without a place, drives without cable, links without slip over which cable slid.
void append_cable_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                           std::vector<Warning>& warnings);

}  // namespace sheave
