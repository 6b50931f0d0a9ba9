#pragma once
// Text as coverage masks, from the face that is built into the library (DejaVu Sans).

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace sheave::render {

/// Coverage of a line of text: 0 outside the glyphs, 255 inside.
struct TextMask {
  int width = 0;                       ///< [pixels]
  int height = 0;                      ///< [pixels]
  int left = 0;                        ///< column of the mask at which the pen starts
  int baseline = 0;                    ///< row of the mask on which the text stands
  std::vector<std::uint8_t> coverage;  ///< width * height, rows from the top
};

struct TextSize {
  double width = 0.0;    ///< advance of the pen [pixels]
  double ascent = 0.0;   ///< of the face above the baseline [pixels]
  double descent = 0.0;  ///< below it, positive [pixels]
};

class Font {
 public:
  /// The built-in face.
  static const Font& builtin();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Extent of a line of UTF-8 text at `pixels` from ascent to descent. Malformed bytes and missing
  /// glyphs show as the face's replacement box.
  [[nodiscard]] TextSize measure(std::string_view text, double pixels) const;
  /// The line drawn with `border` empty pixels on each side.
  [[nodiscard]] TextMask draw(std::string_view text, double pixels, int border) const;

 private:
  Font();
  struct Face;
  std::unique_ptr<Face> face_;
};

}  // namespace sheave::render
