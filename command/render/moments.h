#pragma once
// When pictures of a run are taken.

#include <span>
#include <vector>

#include "command/render/outputs.h"
#include "scenes/scene.h"

namespace sheave::command {

/// A moment at which the run is looked at.
struct Moment {
  double time = 0.0;   ///< [s]
  bool frame = false;  ///< of the film
  bool still = false;  ///< the picture that is asked for
  bool scale = false;  ///< its tensions count for the colour scale
};

/// The frames and the still of a run that begins at `begin` [s], in order. Frames are those of a run
/// from the start as far as they lie behind it, so that films of two parts fit together. Between
/// them, if `interval` [s] is not 0, moments for trails, at ends of steps at most so far apart. A
/// Failure (2) if there is no such moment.
[[nodiscard]] std::vector<Moment> choose_moments(const Scene& scene, const PictureOptions& options,
                                                 double begin, double interval);

/// Moments spread over the whole run, whatever is drawn of it, so that all pictures of it get one
/// scale.
[[nodiscard]] std::vector<Moment> scale_moments(const Scene& scene, double begin);

/// Both lists in one, in order.
[[nodiscard]] std::vector<Moment> merged(std::span<const Moment> a, std::span<const Moment> b);

[[nodiscard]] std::vector<double> times_of(std::span<const Moment> moments);

}  // namespace sheave::command
