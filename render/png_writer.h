#pragma once
// Pictures as PNG.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/result.h"
#include "render/image.h"

namespace sheave::render {

enum class PngEffort {
  sequence,  ///< fast: for frames that are read once and discarded
  still,     ///< small: for pictures that are kept
};

/// The bytes of a PNG file. The same image gives the same bytes.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const Image& image, PngEffort effort);

/// Writes a PNG file, which appears completely or not at all.
[[nodiscard]] Errors write_png(const std::string& path, const Image& image,
                               PngEffort effort = PngEffort::still);

}  // namespace sheave::render
