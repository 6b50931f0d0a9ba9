#pragma once
// Choices about the pictures of a run that must be made before the first one is drawn.

#include <optional>
#include <span>
#include <string>

#include "command/render/moments.h"
#include "command/render/outputs.h"
#include "command/run/player.h"
#include "render/camera_path.h"
#include "render/view_builder.h"

namespace sheave::command {

/// Properties of the whole run.
struct Look {
  render::ViewBuilder builder;
  render::CameraPath camera;
  double tension_max = 0.0;                         ///< [N], at the top of the colour scale
  PictureFormat format = PictureFormat::landscape;  ///< never `best`
  std::optional<double> highest;  ///< time of the highest tension of a run that ends well [s]
};

/// The part of a run to survey.
struct SurveyOptions {
  const PictureOptions& pictures;
  double begin = 0.0;          ///< [s]
  bool finds_highest = false;  ///< whether Look::highest is wanted
};

/// The options with the width and height of `format`, which must not be `best`.
[[nodiscard]] PictureOptions sized(PictureOptions options, PictureFormat format);

/// Plays the scene once to find the camera and one colour scale of tensions for all pictures of the
/// run.
[[nodiscard]] Look survey(const Scene& scene, const SurveyOptions& options,
                          std::span<const Moment> moments, Progress& progress);

}  // namespace sheave::command
