#pragma once
// Checks the video file of an encoder: its containers must fit into each other and into the file,
// and it must have its frames. Encoders return success on a full disk, too.

#include <cstdint>
#include <string>

#include "engine/result.h"

namespace sheave::render {

/// The number of pictures in a file of the MP4 (.mp4, .mov), Matroska (.mkv) or GIF format,
/// recognised by its first bytes. An error, which does not name the file, if it cannot be read,
/// ends early, has no index or has another format.
[[nodiscard]] Result<std::int64_t> count_video_frames(const std::string& path);

}  // namespace sheave::render
