#pragma once
// The times at which pictures of a run are taken.

#include <span>
#include <vector>

#include "command/render/outputs.h"
#include "scenes/scene.h"

namespace sheave::command {

/// A time at which the run is inspected.
struct Moment {
  double time = 0.0;   ///< [s]
  bool frame = false;  ///< a frame of the film
  bool still = false;  ///< the requested still
  bool scale = false;  ///< its tensions count for the colour scale
  bool peak = false;   ///< its largest tension counts for the moment of the still
};

/// The frames and the still of a run that begins at `begin` [s], in ascending order. Frames lie on
/// the grid of a run from the scene's start, so that films of two parts fit together. If `interval`
/// [s] is not 0, moments for trails are added at ends of steps, at most `interval` apart. A Failure
/// (2) if there is no such moment.
[[nodiscard]] std::vector<Moment> choose_moments(const Scene& scene, const PictureOptions& options,
                                                 double begin, double interval);

/// Moments spread over the whole run, independent of the drawn part, so that all pictures of the
/// run have the same colour scale.
[[nodiscard]] std::vector<Moment> scale_moments(const Scene& scene, double begin);
/// The ends of all steps, at one of which the tension is highest: those of the tables of a run.
[[nodiscard]] std::vector<Moment> peak_moments(const Scene& scene, double begin);

/// Ends of steps from `begin` [s] to the last of these moments at which the shapes of cut cables are
/// followed; none if no cable of the scene can be cut.
[[nodiscard]] std::vector<Moment> chain_moments(const Scene& scene, std::span<const Moment> moments,
                                                double begin);

/// Both lists in one, in order.
[[nodiscard]] std::vector<Moment> merged(std::span<const Moment> a, std::span<const Moment> b);

[[nodiscard]] std::vector<double> times_of(std::span<const Moment> moments);

}  // namespace sheave::command
