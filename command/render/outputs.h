#pragma once
// The picture outputs of a run: a video, a folder of PNG files, a still. One simulation feeds all
// of them.

#include <optional>
#include <string>
#include <vector>

#include "command/output/faults.h"
#include "render/frame_line.h"
#include "render/video_writer.h"

namespace sheave::command {

/// Orientation of a picture.
enum class PictureFormat {
  landscape,  ///< width and height as given
  portrait,   ///< width and height exchanged
  square,     ///< same number of pixels, equal sides
  best,       ///< the format of these that shows the scene largest
};

/// Options of `sheave render` as given by the user.
struct PictureOptions {
  std::string video;         ///< file; empty: none
  std::string png;           ///< folder; empty: none
  std::string still;         ///< file; empty: none
  std::string glb;           ///< animated glTF, file; empty: none
  std::optional<double> at;  ///< time of the still [s]; default: that of the highest tension
  int width = 1280;          ///< [pixels]
  int height = 720;          ///< [pixels]
  double fps = 60.0;         ///< frames per second of the video and of glTF
  double speed = 1.0;        ///< simulated seconds per second of the video
  bool labels = false;       ///< write tensions beside the cables
  bool label_names = false;  ///< the same, and the name of each cable
  bool axes = false;         ///< draw the directions of x, y and z
  bool time_line = false;    ///< write the duration, and draw a line of the time
  int threads = 0;           ///< drawing threads; 0: one for each core, at most 8
  PictureFormat format = PictureFormat::landscape;
  std::optional<double> tension_max;  ///< top of the colour scale [N]; default: the scene's
  std::vector<std::string> trails;    ///< NAME:SECONDS[:X,Y,Z], see command/render/trails.h

  [[nodiscard]] bool has_frames() const { return !video.empty() || !png.empty() || !glb.empty(); }
};

/// Throws a Failure (74) if the still cannot be written.
void check_still(const PictureOptions& options);

/// Opens the outputs that the options name, draws into them, and moves them to their destinations.
/// An output that cannot be written is given up and reported in faults(); the others continue.
class PictureOutputs {
 public:
  /// Throws a Failure at once if a folder cannot be written to, if ffmpeg is missing (74), or if
  /// there is no GL or no thread (70).
  explicit PictureOutputs(const PictureOptions& options);

  /// Starts drawing one frame of the video and the folder, if they are still written, and writes
  /// earlier frames that are complete. A Failure (70) if drawing is impossible.
  void add_frame(render::DrawList list, const render::Camera& camera);
  /// Draws the still, in higher quality.
  void add_still(const render::DrawList& list, const render::Camera& camera);
  /// Writes the frames still being drawn and completes the video. Without frames there is no video.
  void finish();

  /// Whether any output still needs drawings.
  [[nodiscard]] bool any_left() const;
  [[nodiscard]] OutputFaults& faults() { return faults_; }

  [[nodiscard]] bool has_video() const { return video_done_; }
  /// Number of written frames, and number of those in the folder. Until finish() has returned some
  /// frames may be pending.
  [[nodiscard]] long frames() const { return frames_; }
  [[nodiscard]] long png_frames() const { return png_frames_; }
  [[nodiscard]] bool has_still() const { return has_still_; }

 private:
  [[nodiscard]] bool frames_wanted() const {
    return video_ || (!options_.png.empty() && png_well_);
  }
  /// Waits for the oldest pending frame and writes it.
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
  long frames_ = 0;      // written frames
  long png_frames_ = 0;  // written frames in the folder
  bool has_still_ = false;
};

}  // namespace sheave::command
