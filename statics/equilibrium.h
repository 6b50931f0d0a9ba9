#pragma once
// Static equilibrium of a machine, by Newton's method.
//
//   sheave::EquilibriumSettings settings;
//   auto rest = sheave::find_equilibrium(*simulation, settings);
//   if (!rest.converged) report(rest.message);
//   tension = simulation->cable_reports()[0].spans[2].tension;  // the simulation is there now
//
// Equations and method: docs/how-to/statics.md.

#include <string>
#include <vector>

#include "cable/simulation.h"

namespace sheave {

struct EquilibriumSettings {
  int load_steps = 1;    ///< number of steps in which loads grow from 0, 1 ... 10000
  int iterations = 400;  ///< largest number of Newton iterations per load step, at least 1
  /// relative residual: of forces to the largest force, of lengths to the scene's size
  double tolerance = 1e-11;
};

enum class Stability {
  stable,    ///< every small motion takes energy
  neutral,   ///< some motions take none: a wheel without load, a mechanism without stiffness
  unstable,  ///< some motions give energy
};

/// A span without tension.
struct SlackSpan {
  int cable = 0;
  int span = 0;        ///< index in CableReport::spans, followed by wraps
  double slack = 0.0;  ///< rest length - length [m]
};

/// Result of the search. If it has not converged, the numbers are those of its last pose.
struct Equilibrium {
  bool converged = false;
  std::string message;  ///< why it did not converge; empty if it did
  int iterations = 0;
  int solutions = 0;          ///< number of linear systems that were solved
  double force_error = 0.0;   ///< residual force / largest force
  double length_error = 0.0;  ///< residual of rows / size of the scene
  Stability stability = Stability::stable;
  int unstable_motions = 0;  ///< number of unstable independent motions that the rows allow
  int neutral_motions = 0;
  /// Squares of the angular frequencies of all these motions [1/s2], ascending; negative: unstable.
  std::vector<double> eigenvalues;
  int freedoms = 0;     ///< degrees of freedom of the bodies
  int constraints = 0;  ///< active rigid rows
  /// Number of redundant rows among them. Their forces are not unique; those with the smallest norm
  /// are returned.
  int redundant = 0;
  /// Whether dry friction carries load. Statics does not determine its force within the bounds; the
  /// returned value depends on the path from the given pose.
  bool friction_holds = false;
  std::vector<SlackSpan> slack_spans;
  /// Events of cables between the given pose and the result, in order, without contacts that were
  /// touched and left again.
  std::vector<CableEvent> events;
  /// Forces of the rows, per feature of the world and multiplier [N or N m].
  std::vector<std::vector<double>> forces;
};

/// Moves the simulation to an equilibrium near its pose; drives are held in place, and the time
/// stays. If none is found, the simulation is in the last pose of the search.
[[nodiscard]] Equilibrium find_equilibrium(Simulation& simulation,
                                           const EquilibriumSettings& settings = {});

}  // namespace sheave
