// Pictures and videos of simulations.

#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"

#if SHEAVE_HAS_RENDER
#include "render/png_writer.h"
#include "render/renderer.h"
#include "render/scene_view.h"
#include "render/video_writer.h"
#include "render/view_survey.h"
#endif

namespace sheave::python {

#if SHEAVE_HAS_RENDER
namespace {

int side(const py::object& value, const char* name) {
  return static_cast<int>(
      integer(value, name, render::Renderer::min_side, render::Renderer::max_side));
}

render::Image draw(Core& core, const py::object& width, const py::object& height,
                   const py::object& samples) {
  const int w = side(width, "width");
  const int h = side(height, "height");
  render::RendererOptions quality;
  quality.samples = static_cast<int>(integer(samples, "samples", 1, 4));
  const Simulation& simulation = core.simulation();
  const std::vector<CableReport> cables = simulation.cable_reports();
  const render::ViewBuilder builder(simulation.world, cables,
                                    render::scene_view_options(core.scene()));
  const render::DrawList list = builder.build(simulation.world, cables);
  const render::Camera camera =
      render::scene_camera(core.scene(), cables, render::bounds(list), list, w, h)
          .at(simulation.world.state().time);
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

/// Surveys the future of a simulation and restores its state, so that one camera suits all frames
/// and colours mean the same forces in all of them.
render::ViewSurvey look_ahead(const py::object& self, double begin, double fps,
                              std::int64_t frames) {
  Core& core = self.cast<Core&>();
  const live::KeptSnapshot start = core.session().keep();
  const std::deque<Event> events = core.events;
  const std::int64_t dropped = core.dropped_events;
  const auto put_back = [&] {
    live::SessionState& session = core.session();
    check(session.world.restore(start.snapshot));
    session.revision = start.revision;
    session.refresh();
    core.events = events;
    core.dropped_events = dropped;
  };
  render::ViewSurvey survey;
  try {
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      core.step(core.steps_until(begin + static_cast<double>(frame) / fps), self, py::none(),
                py::none());
      survey.add(core.simulation().world, core.simulation().cable_reports());
    }
  } catch (...) {
    put_back();
    throw;
  }
  put_back();
  return survey;
}

/// A video of one simulation, under construction.
class Video {
 public:
  Video(const py::object& simulation, const py::object& path, const py::object& width,
        const py::object& height, double fps, std::int64_t frames)
      : core_(simulation.cast<std::shared_ptr<Core>>()),
        // Invalid arguments are refused before the survey.
        writer_(value_of(render::VideoWriter::create(text(path, "path"), side(width, "width"),
                                                     side(height, "height"), options(fps)))),
        renderer_(
            value_of(render::Renderer::create(side(width, "width"), side(height, "height")))) {
    const Core& core = *core_;
    const render::ViewSurvey survey = look_ahead(simulation, core_->world().time(), fps, frames);
    const Simulation& now = core_->simulation();
    const std::vector<CableReport> cables = now.cable_reports();
    render::ViewOptions view = render::scene_view_options(core.scene());
    if (!view.tension_max) view.tension_max = survey.tension_max();
    view.run_bounds = survey.bounds();
    view.travels = survey.travels();
    builder_.emplace(now.world, cables, view);
    camera_ = render::scene_camera(core.scene(), cables, survey.bounds(),
                                   builder_->build(now.world, cables), side(width, "width"),
                                   side(height, "height"));
  }

  /// Appends the present view of the simulation.
  void add() {
    const Simulation& now = core_->simulation();
    const std::vector<CableReport> cables = now.cable_reports();
    ropes_.follow(now.world, cables);
    const render::DrawList list = builder_->build(now.world, cables, &ropes_);
    const py::gil_scoped_release unlocked;
    const Result<render::Image> image = renderer_.draw(list, camera_->at(now.world.state().time));
    const Errors errors = image ? writer_.add(*image) : image.errors();
    const py::gil_scoped_acquire locked;
    check(errors);
  }
  void finish() {
    Errors errors;
    {
      const py::gil_scoped_release unlocked;
      errors = writer_.finish();
    }
    check(errors);
  }

 private:
  static render::VideoOptions options(double fps) {
    render::VideoOptions options;
    options.frames_per_second = fps;
    return options;
  }

  std::shared_ptr<Core> core_;
  render::VideoWriter writer_;
  render::Renderer renderer_;
  std::optional<render::ViewBuilder> builder_;
  render::CutRopes ropes_;
  std::optional<render::CameraPath> camera_;
};

void bind_video(py::module_& module) {
  py::class_<Video>(module, "_Video", "A video in progress; the file appears at its end.")
      .def(
          py::init([](const py::object& simulation, const py::object& path, const py::object& width,
                      const py::object& height, const py::object& fps, const py::object& frames) {
            return std::make_unique<Video>(simulation, path, width, height, number(fps, "fps"),
                                           integer(frames, "frames", 1, 10'000'000));
          }),
          py::arg("simulation"), py::arg("path"), py::arg("width"), py::arg("height"),
          py::arg("fps"), py::arg("frames"))
      .def("add", &Video::add, "Appends a picture of the simulation as it is now.")
      .def("finish", &Video::finish, "The file appears.");
}

}  // namespace

void bind_pictures(py::module_& module, SimulationClass& simulation) {
  module.attr("has_render") = true;
  simulation.def("render", &render_array, py::arg("width") = 1280, py::arg("height") = 720,
                 py::arg("samples") = 4,
                 "A picture: an array of bytes (height, width, 3), red, green, blue.");
  simulation.def("png", &render_png, py::arg("width") = 960, py::arg("height") = 540,
                 "The same as the bytes of a PNG file.");
  bind_video(module);
}

#else

void bind_pictures(py::module_& module, SimulationClass& /*simulation*/) {
  module.attr("has_render") = false;
}

#endif

}  // namespace sheave::python
