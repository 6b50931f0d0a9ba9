#pragma once
// Where the pictures of a run go: a video, a folder of PNG files, a still. All from one simulation.

#include <optional>
#include <string>
#include <vector>

#include "command/output/faults.h"
#include "render/frame_line.h"
#include "render/video_writer.h"

namespace sheave::command {

/// How width and height are used.
enum class PictureFormat {
  landscape,  ///< as they are
  portrait,   ///< the other way round
  square,     ///< as many pixels, as high as wide
  best,       ///< whichever of these shows the scene largest
};

/// Options of `sheave render` as the user wrote them.
struct PictureOptions {
  std::string video;         ///< file; empty: none
  std::string png;           ///< folder; empty: none
  std::string still;         ///< file; empty: none
  std::string glb;           ///< animated glTF, file; empty: none
  std::optional<double> at;  ///< time of the still [s]; default: the end
  int width = 1280;          ///< [pixels]
  int height = 720;          ///< [pixels]
  double fps = 60.0;         ///< frames per second of the video and of glTF
  double speed = 1.0;        ///< simulated seconds per second of the video
  bool labels = false;       ///< write the tensions beside the cables
  int threads = 0;           ///< that draw; 0: one for each core, at most 8
  PictureFormat format = PictureFormat::landscape;
  std::optional<double> tension_max;  ///< at the top of the colour scale [N]; default: the scene's
  std::vector<std::string> trails;    ///< NAME:SECONDS[:X,Y,Z], see command/render/trails.h

  [[nodiscard]] bool has_frames() const { return !video.empty() || !png.empty() || !glb.empty(); }
};

/// Opens what the options name, draws into it, and puts it in place. An output that cannot be
/// written is given up and told in faults(), the others go on.
class PictureOutputs {
 public:
  /// Throws a Failure at once if a folder cannot be written to, ffmpeg is missing (74) or there is
  /// no GL and no thread (70).
  explicit PictureOutputs(const PictureOptions& options);

  /// Begins to draw one frame of the video and the folder, as far as they are still written, and
  /// writes those before it that are done. A Failure (70) if nothing can be drawn.
  void add_frame(render::DrawList list, const render::Camera& camera);
  /// Draws the still, in higher quality.
  void add_still(const render::DrawList& list, const render::Camera& camera);
  /// Writes the frames that are still being drawn and completes the video; without any frame there
  /// is none.
  void finish();

  /// Whether anything is still to be drawn for.
  [[nodiscard]] bool any_left() const;
  [[nodiscard]] OutputFaults& faults() { return faults_; }

  [[nodiscard]] bool has_video() const { return video_done_; }
  /// Frames that were written, and those of them that are in the folder. Some more are under way
  /// until finish() has returned.
  [[nodiscard]] long frames() const { return frames_; }
  [[nodiscard]] long png_frames() const { return png_frames_; }
  [[nodiscard]] bool has_still() const { return has_still_; }

 private:
  [[nodiscard]] bool frames_wanted() const {
    return video_ || (!options_.png.empty() && png_well_);
  }
  /// Waits for the oldest frame that is under way and writes it.
  void write_oldest();
  [[nodiscard]] render::FrameLine::Frame take_oldest();
  [[nodiscard]] std::string frame_path(long frame) const;
  void warn_of_old_frames() const;

  PictureOptions options_;
  std::optional<render::FrameLine> line_;
  std::optional<render::VideoWriter> video_;
  OutputFaults faults_;
  bool png_well_ = true;
  bool still_well_ = true;
  bool video_done_ = false;
  long frames_ = 0;      // that were written
  long png_frames_ = 0;  // of them in the folder
  bool has_still_ = false;
};

}  // namespace sheave::command
