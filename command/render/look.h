#pragma once
// What is decided about the pictures of a run before the first one is drawn.

#include <span>
#include <string>

#include "command/render/moments.h"
#include "command/render/outputs.h"
#include "command/run/player.h"
#include "render/camera.h"
#include "render/view_builder.h"

namespace sheave::command {

/// What is known about the whole run.
struct Look {
  render::ViewBuilder builder;
  render::Camera camera;
  double tension_max = 0.0;                         ///< [N], at the top of the colour scale
  PictureFormat format = PictureFormat::landscape;  ///< not best
};

/// What a run is to be surveyed for.
struct SurveyOptions {
  const PictureOptions& pictures;
  std::string load_state;  ///< empty: from the scene's start
  double begin = 0.0;      ///< [s]
};

/// The options with width and height as the format, which is not best, has them.
[[nodiscard]] PictureOptions sized(PictureOptions options, PictureFormat format);

/// Plays the scene once, to frame it and to give every tension the same colour in every picture of
/// the run.
[[nodiscard]] Look survey(const Scene& scene, const SurveyOptions& options,
                          std::span<const Moment> moments, Progress& progress);

}  // namespace sheave::command
