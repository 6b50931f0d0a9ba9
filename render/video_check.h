#pragma once
// Whether a video that an encoder has left is one: its containers fit into each other and into the
// file, and it has its frames. Encoders end with success on a full disk, too.

#include <cstdint>
#include <string>

#include "engine/result.h"

namespace sheave::render {

/// The number of pictures in a file of the MP4 (.mp4, .mov), Matroska (.mkv) or GIF format, by its
/// first bytes. An error, which does not name the file, if it cannot be read, ends early, has no
/// index or is of no such format.
[[nodiscard]] Result<std::int64_t> count_video_frames(const std::string& path);

}  // namespace sheave::render
