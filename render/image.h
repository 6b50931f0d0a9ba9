#pragma once
// A picture in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheave::render {

/// 8-bit sRGB pixels, rows from top to bottom, no padding.
struct Image {
  int width = 0;   ///< [pixels]
  int height = 0;  ///< [pixels]
  /// width * height * 3 bytes: r, g, b.
  std::vector<std::uint8_t> rgb;

  Image() = default;
  /// A black picture.
  Image(int w, int h)
      : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3U) {}

  /// First byte of pixel (x, y); x in [0, width), y in [0, height), y grows downwards.
  [[nodiscard]] std::uint8_t* pixel(int x, int y) { return rgb.data() + offset(x, y); }
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const { return rgb.data() + offset(x, y); }

  friend bool operator==(const Image&, const Image&) = default;

 private:
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           3U;
  }
};

}  // namespace sheave::render
