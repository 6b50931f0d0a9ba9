// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "tools/scene_look.h"

namespace sheave::tools {

render::ViewOptions view_options(const Scene& scene, const render::ViewSurvey& survey) {
  render::ViewOptions view;
  view.tension_max = survey.tension_max();
  view.run_bounds = survey.bounds();
  view.title = scene.name;
  if (scene.camera) {
    view.joints = scene.camera->joints;
    view.cable_radius = scene.camera->cable_radius;
  }
  view.body_colors.resize(scene.model.bodies.size());
  for (const PaintDef& paint : scene.paint) {
    view.body_colors[static_cast<std::size_t>(paint.body.index)] =
        render::Color{static_cast<float>(paint.color.x()), static_cast<float>(paint.color.y()),
                      static_cast<float>(paint.color.z())};
  }
  return view;
}

}  // namespace sheave::tools

#endif  // SHEAVE_HAS_RENDER
