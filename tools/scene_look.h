#pragma once
// How a scene is drawn, once it is known what happens in it.

#include "render/view_builder.h"
#include "render/view_survey.h"
#include "scenes/scene.h"

namespace sheave::tools {

/// What the scene says of its looks; room and colours for the whole run that `survey` has seen.
[[nodiscard]] render::ViewOptions view_options(const Scene& scene,
                                               const render::ViewSurvey& survey);

}  // namespace sheave::tools
