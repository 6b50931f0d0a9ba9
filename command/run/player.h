#pragma once
// Plays a scene and shows it at given times, which need not be ends of steps.

#include <functional>
#include <span>
#include <vector>

#include "command/run/simulate.h"
#include "scenes/scene.h"

namespace sheave::command {

/// The simulation of a scene that has been loaded, at its start. A Failure (75) if the scene starts
/// at rest and has no rest.
[[nodiscard]] Simulation make_simulation(const Scene& scene);
/// The same in the pose of the scene, wherever it starts.
[[nodiscard]] Simulation make_in_pose(const Scene& scene);

/// Simulates `scene` and calls `show(k, simulation)` for every time k of `times` [s], which are in
/// ascending order. At a time between two steps the shown bodies and cables are interpolated.
/// `show` returns false to end the play. Playing the same scene twice shows the same states. The
/// play ends after the last of `times`, or early (see RunOutcome); times that were not reached are
/// not shown.
RunOutcome play(const Scene& scene, std::span<const double> times, Progress& progress,
                const std::function<bool(std::size_t, const Simulation&)>& show);

/// The cables of a simulation of `scene`, for a picture. At the scene's start no tension has been
/// computed, and a taut cable would look slack, so the tensions of one step from that state are
/// used. A state that has tensions, such as an equilibrium from statics, is shown with them.
[[nodiscard]] std::vector<CableReport> reports_to_show(const Scene& scene,
                                                       const Simulation& simulation);

}  // namespace sheave::command
