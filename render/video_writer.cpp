#include "render/video_writer.h"

#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "render/child_process.h"
#include "render/number_text.h"
#include "render/output_file.h"
#include "render/video_check.h"

namespace sheave::render {
namespace {

/// File name extensions and ffmpeg's names for their containers.
struct Container {
  std::string_view extension;
  const char* name;
  bool fast_start;  ///< whether the container has an index that can be moved to the front
};
constexpr std::array<Container, 4> containers{{{".mp4", "mp4", true},
                                               {".mov", "mov", true},
                                               {".mkv", "matroska", false},
                                               {".gif", "gif", false}}};

const Container* container_of(std::string_view path) {
  for (const Container& container : containers) {
    if (path.ends_with(container.extension)) return &container;
  }
  return nullptr;
}

Errors check(const std::string& path, int width, int height, const VideoOptions& options) {
  Errors errors;
  if (container_of(path) == nullptr) {
    errors.push_back({"", "video '" + path + "': the name must end in .mp4, .mov, .mkv or .gif"});
  }
  if (width < 2 || height < 2 || width > 16384 || height > 16384) {
    errors.push_back({"", "video '" + path + "': size is " + std::to_string(width) + " x " +
                              std::to_string(height) + "; each side must be 2 to 16384 pixels"});
  }
  if (!(options.frames_per_second > 0.0 && options.frames_per_second <= 1000.0)) {
    errors.push_back({"/frames_per_second", "video '" + path + "': frames_per_second is " +
                                                std::to_string(options.frames_per_second) +
                                                "; it must be above 0 and at most 1000"});
  }
  if (path.ends_with(".gif") && options.frames_per_second > VideoWriter::most_gif_rate) {
    errors.push_back({"/frames_per_second",
                      "video '" + path + "': frames_per_second is " +
                          std::to_string(options.frames_per_second) +
                          "; of a GIF it must be at most 50, because browsers show no more"});
  }
  if (options.quality < 0 || options.quality > 51) {
    errors.push_back({"/quality", "video '" + path + "': quality is " +
                                      std::to_string(options.quality) +
                                      "; it must be from 0 to 51"});
  }
  return errors;
}

std::vector<std::string> command_line(const Container& container, const std::string& file,
                                      int width, int height, const VideoOptions& options) {
  std::vector<std::string> line{options.program, "-nostdin", "-loglevel", "error", "-y"};
  const auto add = [&](std::initializer_list<std::string> words) {
    line.insert(line.end(), words);
  };
  add({"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
       std::to_string(width) + "x" + std::to_string(height), "-framerate",
       fixed_text(options.frames_per_second, 6), "-i", "pipe:0"});
  if (container.name == std::string_view("gif")) {
    // The palette is that of the first frame, whose legend has all colours of tensions, with eight
    // rows of colours of all kinds for bodies that come later. With one palette a frame holds only
    // the pixels that change. A palette of all frames would need all frames in memory at once.
    // Ordered dithering stands still where the picture does.
    add({"-filter_complex",
         "haldclutsrc=level=3,trim=end_frame=1,scale=" + std::to_string(width) +
             ":8:flags=neighbor[c];[0]split[a][b];[a]trim=end_frame=1[f];[f][c]vstack,palettegen[p]"
             ";"
             "[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
         "-threads", "1", "-fflags", "+bitexact", "-map_metadata", "-1", "-loop", "0", "-f", "gif",
         "file:" + file});
    return line;
  }
  // Unless the file names the matrix, players guess one from the picture size, and the colours
  // shift.
  add({"-vf", "scale=out_color_matrix=bt709:out_range=tv", "-colorspace", "bt709",
       "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"});
  // The number of threads is fixed, because the output of x264 depends on it.
  add({"-c:v", "libx264", "-preset", "veryfast", "-crf", std::to_string(options.quality),
       "-pix_fmt", "yuv420p", "-threads", "2", "-flags:v", "+bitexact", "-fflags", "+bitexact",
       "-map_metadata", "-1"});
  if (container.fast_start) add({"-movflags", "+faststart"});
  add({"-f", container.name, "file:" + file});
  return line;
}

/// Checks that a finished video has all its frames.
Errors check_frames(const std::string& file, std::int64_t frames) {
  const Result<std::int64_t> found = count_video_frames(file);
  if (found && *found == frames) return {};
  const std::string what =
      found ? "it has " + std::to_string(*found) + " of its " + std::to_string(frames) + " frames"
            : found.errors().front().message;
  return {Error{"", "the encoder has left no video: " + what}};
}

}  // namespace

struct VideoWriter::Content {
  int width = 0;
  int height = 0;
  std::int64_t frames = 0;
  OutputFile file;
  ChildProcess encoder;
  std::vector<std::uint8_t> even;  ///< a frame extended to even sizes, kept for reuse

  /// Bytes of the frame with both sides even, as 4:2:0 subsampling requires.
  std::span<const std::uint8_t> extended(const Image& frame) {
    if (width % 2 == 0 && height % 2 == 0) return frame.rgb;
    const auto row = static_cast<std::size_t>(width) * 3U;
    even.clear();
    for (int y = 0; y < height + height % 2; ++y) {
      const std::uint8_t* from = frame.pixel(0, std::min(y, height - 1));
      even.insert(even.end(), from, from + row);
      if (width % 2 != 0) even.insert(even.end(), from + row - 3, from + row);
    }
    return even;
  }
};

VideoWriter::VideoWriter(std::unique_ptr<Content> content) : content_(std::move(content)) {}
VideoWriter::~VideoWriter() { discard(); }
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

Result<VideoWriter> VideoWriter::create(const std::string& path, int width, int height,
                                        const VideoOptions& options) {
  if (Errors errors = check(path, width, height, options); !errors.empty()) return errors;
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) return file.errors();
  // Only the name was needed, because the encoder opens the file itself.
  if (Errors errors = file->close(); !errors.empty()) return errors;
  Result<ChildProcess> encoder =
      ChildProcess::start(command_line(*container_of(path), file->temporary_path(),
                                       width + width % 2, height + height % 2, options),
                          {.stall_seconds = options.stall_seconds,
                           .hurry = options.hurry,
                           .abandon = options.abandon,
                           .if_missing = "videos need ffmpeg (Debian: apt install ffmpeg)"});
  if (!encoder) return encoder.errors();
  // An aggregate, which make_unique cannot initialise with every compiler.
  // NOLINTNEXTLINE(modernize-make-unique)
  return VideoWriter(std::unique_ptr<Content>(
      new Content{width, height, 0, std::move(file).value(), std::move(encoder).value(), {}}));
}

Errors VideoWriter::add(const Image& frame) {
  if (!content_) return {Error{"", "the video is already finished or discarded"}};
  if (frame.width != content_->width || frame.height != content_->height ||
      frame.rgb.size() != std::size_t{3} * static_cast<std::size_t>(frame.width) *
                              static_cast<std::size_t>(frame.height)) {
    return {Error{"", "video '" + content_->file.path() + "': the frame is " +
                          std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                          " pixels; it must be " + std::to_string(content_->width) + " x " +
                          std::to_string(content_->height)}};
  }
  Errors errors = content_->encoder.write(content_->extended(frame));
  for (Error& error : errors)
    error.message = "video '" + content_->file.path() + "': " + error.message;
  if (errors.empty()) ++content_->frames;
  return errors;
}

Errors VideoWriter::finish() {
  if (!content_) return {Error{"", "the video is already finished or discarded"}};
  const std::unique_ptr<Content> content = std::move(content_);
  const std::string name = "video '" + content->file.path() + "': ";
  if (content->frames == 0) return {Error{"", name + "it has no frames"}};
  Errors errors = content->encoder.finish();
  // An encoder may report success and still have written no file or half a file.
  if (errors.empty()) {
    errors = check_frames(content->file.temporary_path(), content->frames);
    const std::string said = content->encoder.last_words();
    if (!errors.empty() && !said.empty()) errors.front().message += ": " + said;
  }
  for (Error& error : errors) error.message = name + error.message;
  if (!errors.empty()) return errors;
  return content->file.commit();
}

void VideoWriter::discard() { content_.reset(); }

std::int64_t VideoWriter::frame_count() const { return content_ ? content_->frames : 0; }

}  // namespace sheave::render
