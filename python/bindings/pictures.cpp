// Pictures of simulations.

#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"

#if SHEAVE_HAS_RENDER
#include "render/overlay.h"
#include "render/png_writer.h"
#include "render/renderer.h"
#include "render/view_builder.h"
#include "render/view_survey.h"
#endif

namespace sheave::python {

#if SHEAVE_HAS_RENDER
namespace {

/// The camera of the scene, or one that shows all of what is there now.
render::Camera camera_of(const Scene& scene, std::span<const CableReport> cables,
                         const render::DrawList& list, int width, int height) {
  const Eigen::AlignedBox3d box = render::bounds(list);
  const CameraDef def = scene.camera.value_or(CameraDef{});
  if (!def.position && !def.direction) {
    return render::automatic_camera(scene.model, cables, box, list, width, height);
  }
  const Vector3 direction = def.position ? Vector3(*def.target - *def.position) : *def.direction;
  Vector3 up = def.up.value_or(render::up_direction(scene.model));
  if (direction.normalized().cross(up).norm() < 1e-6) up = any_perpendicular(direction);
  render::FrameOptions options;
  options.aspect = static_cast<double>(width) / height;
  options.margins = render::overlay_margins(list, width, height);
  if (def.projection == Projection::orthographic) options.projection = render::Orthographic{};
  if (def.projection == Projection::perspective && def.vertical_fov) {
    options.projection = render::Perspective{*def.vertical_fov};
  }
  render::Camera camera = render::frame_box(box, direction, up, options);
  if (!def.position) return camera;
  camera.position = *def.position;
  camera.target = *def.target;
  if (def.height) camera.projection = render::Orthographic{*def.height};
  return camera;
}

render::ViewOptions view_options(const Scene& scene) {
  render::ViewOptions options;
  options.title = scene.name;
  if (scene.camera) {
    options.cable_radius = scene.camera->cable_radius;
    options.force_labels = scene.camera->labels;
    options.joints = scene.camera->joints;
  }
  options.body_colors.resize(scene.model.bodies.size());
  for (const PaintDef& paint : scene.paint) {
    if (paint.body.is_world()) continue;
    const Vector3& c = paint.color;
    options.body_colors[static_cast<std::size_t>(paint.body.index)] = render::Color{
        static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())};
  }
  return options;
}

render::Image draw(Core& core, const py::object& width, const py::object& height,
                   const py::object& samples) {
  const auto w = static_cast<int>(
      integer(width, "width", render::Renderer::min_side, render::Renderer::max_side));
  const auto h = static_cast<int>(
      integer(height, "height", render::Renderer::min_side, render::Renderer::max_side));
  render::RendererOptions quality;
  quality.samples = static_cast<int>(integer(samples, "samples", 1, 4));
  const Simulation& simulation = core.simulation();
  const std::vector<CableReport> cables = simulation.cable_reports();
  const render::ViewBuilder builder(simulation.world, cables, view_options(core.scene()));
  const render::DrawList list = builder.build(simulation.world, cables);
  const render::Camera camera = camera_of(core.scene(), cables, list, w, h);
  render::Renderer renderer = value_of(render::Renderer::create(w, h, quality));
  return value_of(renderer.draw(list, camera));
}

py::array_t<std::uint8_t> render_array(Core& core, const py::object& width,
                                       const py::object& height, const py::object& samples) {
  const render::Image image = draw(core, width, height, samples);
  py::array_t<std::uint8_t> pixels({image.height, image.width, 3});
  std::copy(image.rgb.begin(), image.rgb.end(), pixels.mutable_data());
  return pixels;
}

py::bytes render_png(Core& core, const py::object& width, const py::object& height) {
  const render::Image image = draw(core, width, height, py::int_(4));
  const auto bytes = value_of(render::encode_png(image, render::PngEffort::still));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void bind_pictures(py::module_& module, SimulationClass& simulation) {
  module.attr("has_render") = true;
  simulation.def("render", &render_array, py::arg("width") = 1280, py::arg("height") = 720,
                 py::arg("samples") = 4,
                 "A picture: an array of bytes (height, width, 3), red, green, blue.");
  simulation.def("png", &render_png, py::arg("width") = 960, py::arg("height") = 540,
                 "The same as the bytes of a PNG file.");
}

#else

void bind_pictures(py::module_& module, SimulationClass& /*simulation*/) {
  module.attr("has_render") = false;
}

#endif

}  // namespace sheave::python
