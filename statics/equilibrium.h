#pragma once
// Where a machine rests: static equilibrium by Newton's method.
//
//   sheave::EquilibriumSettings settings;
//   auto rest = sheave::find_equilibrium(*simulation, settings);
//   if (!rest.converged) report(rest.message);
//   tension = simulation->cable_reports()[0].spans[2].tension;  // the simulation is there now
//
// What it solves and how: docs/statics.md.

#include <string>
#include <vector>

#include "cable/simulation.h"

namespace sheave {

struct EquilibriumSettings {
  int load_steps = 1;    ///< loads grow from 0 in so many steps, 1 ... 10000
  int iterations = 400;  ///< of Newton's method, for each of them, at least 1
  double tolerance =
      1e-11;  ///< of forces, as a share of the largest; of lengths, of the scene's size
};

enum class Stability {
  stable,    ///< every small motion takes energy
  neutral,   ///< some take none: a wheel without load, a mechanism without stiffness
  unstable,  ///< some give energy
};

/// A span that bears nothing.
struct SlackSpan {
  int cable = 0;
  int span = 0;        ///< as in CableReport::spans, and wraps behind them
  double slack = 0.0;  ///< rest length less length [m]
};

/// What was found. Unless it has converged the numbers are those of where the search ended.
struct Equilibrium {
  bool converged = false;
  std::string message;  ///< why not; empty if it has
  int iterations = 0;
  double force_error = 0.0;   ///< what is left of forces, as a share of the largest
  double length_error = 0.0;  ///< of rows, as a share of the scene's size
  Stability stability = Stability::stable;
  int unstable_motions = 0;  ///< of the independent motions that rows leave
  int neutral_motions = 0;
  /// Squares of angular frequencies of all of them [1/s2], ascending; negative: unstable.
  std::vector<double> eigenvalues;
  int freedoms = 0;     ///< of the bodies
  int constraints = 0;  ///< rigid rows that act
  /// Of these so many more than needed: their forces are one choice of many, that with the smallest
  /// norm.
  int redundant = 0;
  /// Dry friction bears something. Statics leaves what it bears open, within its bounds; what is
  /// told is what the way from the given pose to here has left.
  bool friction_holds = false;
  std::vector<SlackSpan> slack_spans;
  /// What has become of cables between the given pose and here, in order; what was touched and left
  /// again is not told.
  std::vector<CableEvent> events;
  /// Of the rows of each feature of the world, by multiplier [N or N m].
  std::vector<std::vector<double>> forces;
};

/// Moves the simulation to an equilibrium near the pose that it has, with its drives held where
/// they are and its time as it is. Where it is not found the simulation is where the search ended.
[[nodiscard]] Equilibrium find_equilibrium(Simulation& simulation,
                                           const EquilibriumSettings& settings = {});

}  // namespace sheave
