#pragma once
// A video, encoded by the program `ffmpeg` from frames as they are drawn.
//
//   auto video = VideoWriter::create("out/pulley.mp4", 1280, 720, {.frames_per_second = 60});
//   for (...) if (Errors e = video->add(frame); !e.empty()) ...
//   Errors errors = video->finish();   // the file appears here; without it, nothing does

#include <cstdint>
#include <memory>
#include <string>

#include "engine/result.h"
#include "render/child_process.h"
#include "render/image.h"

namespace sheave::render {

struct VideoOptions {
  double frames_per_second = 60.0;  ///< (0, 1000], of a GIF (0, 50]
  /// x264's constant rate factor, 0 (lossless) to 51; lower is better and larger.
  int quality = 18;
  /// Name or path of the encoder, looked up in PATH.
  std::string program = "ffmpeg";
  double stall_seconds = ChildOptions{}.stall_seconds;  ///< see ChildOptions
  StopRequest hurry{};                                  ///< likewise
  StopRequest abandon{};                                ///< likewise
};

/// Writes H.264 in 4:2:0 that every player and browser shows, or an endless GIF. Frames with an odd
/// width or height are extended by repeating the last column or row. The same frames give the same
/// file with the same version of ffmpeg.
class VideoWriter {
 public:
  /// Largest number of frames per second of a GIF in browsers.
  static constexpr double most_gif_rate = 50.0;
  /// `path` must end in .mp4, .mov, .mkv or .gif. Fails at once if the folder cannot be written to
  /// or ffmpeg is not installed.
  static Result<VideoWriter> create(const std::string& path, int width, int height,
                                    const VideoOptions& options = {});
  /// Discards the video unless finish() succeeded.
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Appends a frame of the size given to create().
  [[nodiscard]] Errors add(const Image& frame);
  /// Ends the video, checks that the file has its frames, and moves it to its path. Fails if no
  /// frame was added.
  [[nodiscard]] Errors finish();
  /// Ends the encoder and removes its file.
  void discard();
  [[nodiscard]] std::int64_t frame_count() const;

 private:
  struct Content;
  explicit VideoWriter(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave::render
