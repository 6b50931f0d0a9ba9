// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/render/outputs.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/interrupt.h"
#include "command/parallel.h"
#include "command/terminal.h"
#include "render/destination.h"
#include "render/output_file.h"
#include "render/overlay.h"
#include "render/png_writer.h"
#include "view/svg_canvas.h"

namespace sheave::command {
namespace {

// Each pixel of a still is the average of this many samples in each direction.
constexpr int still_supersample = 2;

template <class T>
T value_or_fail(Result<T> result, ExitCode code) {
  if (!result) throw Failure(code, to_text(result.errors()));
  return std::move(result).value();
}

void check(const Errors& errors, ExitCode code) {
  if (!errors.empty()) throw Failure(code, to_text(errors));
}

/// A file can be made there; nothing is left behind.
void check_writable(const std::string& path, render::Link link = render::Link::followed) {
  value_or_fail(render::OutputFile::create(path, link), ExitCode::io);
}

void make_folder(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (code) throw Failure(ExitCode::io, path + ": cannot make this folder: " + code.message());
}

/// One context per core, at most 8. Mesa rasterises for all contexts with the same threads, one per
/// core; only the remaining work on a frame runs in parallel, and further contexts would only cost
/// memory.
int default_threads() { return std::min(core_count(), 8); }

/// Mesa's software renderer starts threads for its contexts, and waits for ever for threads that the
/// system refuses. So it gets threads only if the system grants as many to a trial. Without threads
/// the pictures are the same, and frames are drawn one after the other. LP_NUM_THREADS of the user
/// stays.
void choose_threads_of_mesa(int contexts) {
  if (std::getenv("LP_NUM_THREADS") != nullptr) return;
  const int each = std::min(core_count(), 8);
  // One more context may draw a still, and the command and an encoder need some threads, too.
  constexpr int others = 8;
  const bool granted = can_start_threads((contexts + 1) * (each + 1) + others);
  ::setenv("LP_NUM_THREADS", granted ? std::to_string(each).c_str() : "0", 0);
}

}  // namespace

void check_still(const PictureOptions& options) {
  if (!options.still.empty()) check_writable(options.still);
}

PictureOutputs::PictureOutputs(const PictureOptions& options) : options_(options) {
  if (!options.png.empty()) {
    make_folder(options.png);
    check_writable(frame_path(0), render::Link::replaced);
  }
  check_still(options);
  if (!options.video.empty()) {
    video_ = value_or_fail(
        render::VideoWriter::create(
            options.video, options.width, options.height,
            {.frames_per_second = options.fps, .hurry = interrupted, .abandon = hurried}),
        ExitCode::io);
  }
  if (!frames_wanted()) return;
  render::FrameLineOptions line{.threads =
                                    options.threads > 0 ? options.threads : default_threads()};
  choose_threads_of_mesa(line.threads);
  if (!options.png.empty()) line.png = render::PngEffort::sequence;
  line_ =
      value_or_fail(render::FrameLine::create(options.width, options.height, line), ExitCode::io);
}

std::string PictureOutputs::frame_path(long frame) const {
  return fmt::format("{}/frame_{:06}.png", options_.png, frame);
}

void PictureOutputs::add_frame(render::DrawList list, const render::Camera& camera) {
  if (!line_) return;
  while (line_->full()) write_oldest();
  line_->put(std::move(list), camera);
}

render::FrameLine::Frame PictureOutputs::take_oldest() {
  try {
    return value_or_fail(line_->take(), ExitCode::internal);
  } catch (...) {
    line_.reset();  // after a lost frame no later frame may be written
    throw;
  }
}

void PictureOutputs::write_oldest() {
  const render::FrameLine::Frame frame = take_oldest();
  // A video with missing frames is of no use, so the first fault of the encoder ends it.
  if (video_ && !faults_.attempt([&] { check(video_->add(frame.image), ExitCode::io); })) {
    video_.reset();
  }
  if (!options_.png.empty() && png_well_) {
    const std::string path = frame_path(frames_);
    // Waiting for the disk after each frame would take longer than drawing it. A link of this name
    // is none that somebody has asked to be followed.
    png_well_ = faults_.attempt([&] {
      check(
          render::write_file(path, frame.png, render::Durability::process, render::Link::replaced),
          ExitCode::io);
    });
    if (png_well_) ++png_frames_;
  }
  ++frames_;
}

void PictureOutputs::add_still(const render::DrawList& list, const render::Camera& camera) {
  // The still's renderer is created late, because its memory is not needed earlier.
  const bool svg = options_.still.ends_with(".svg");
  choose_threads_of_mesa(1);
  render::Renderer renderer =
      value_or_fail(render::Renderer::create(options_.width, options_.height,
                                             {.supersample = still_supersample, .text = !svg}),
                    ExitCode::internal);
  const render::Image image = value_or_fail(renderer.draw(list, camera), ExitCode::internal);
  std::vector<std::uint8_t> content =
      value_or_fail(render::encode_png(image, render::PngEffort::still), ExitCode::internal);
  if (svg) {
    view::SvgCanvas canvas(options_.width, options_.height);
    render::draw_overlay(list, camera, canvas);
    const std::string text = canvas.document({content.begin(), content.end()}, list.title);
    content.assign(text.begin(), text.end());
  }
  still_well_ = faults_.attempt([&] {
    check(render::write_file(options_.still, content, render::Durability::power_loss),
          ExitCode::io);
  });
  has_still_ = still_well_;
}

bool PictureOutputs::any_left() const {
  const bool folder = !options_.png.empty() && png_well_;
  const bool still = !options_.still.empty() && !has_still_ && still_well_;
  return video_.has_value() || folder || still;
}

void PictureOutputs::finish() {
  while (line_ && frames_wanted() && !line_->empty()) write_oldest();
  line_.reset();
  if (video_ && frames_ > 0) {
    video_done_ = faults_.attempt([&] { check(video_->finish(), ExitCode::io); });
  }
  if (options_.png.empty() || png_frames_ == 0) return;
  // Synchronises all frames with the disk at once.
  render::synchronise_files_beside(frame_path(0));
  if (png_well_) warn_of_old_frames();
}

void PictureOutputs::warn_of_old_frames() const {
  std::error_code code;
  if (std::filesystem::exists(frame_path(frames_), code)) {
    print_warning(fmt::format("{} holds more frames, from an earlier run: {} and on", options_.png,
                              frame_path(frames_)));
  }
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
