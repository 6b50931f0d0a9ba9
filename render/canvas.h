#pragma once
// Two-dimensional drawing on a finished picture. Coordinates in pixels from the upper left corner;
// whatever lies outside the picture is cut off.

#include <string_view>

#include "render/color.h"
#include "render/font.h"
#include "render/image.h"

namespace sheave::render {

class Canvas {
 public:
  explicit Canvas(Image& image) : image_(image) {}

  /// Covers a pixel by a fraction alpha in [0, 1].
  void blend(int x, int y, const Color& color, double alpha);
  /// Covers the rectangle [x, x + w) x [y, y + h), its edges anti-aliased.
  void fill(double x, double y, double w, double h, const Color& color, double alpha = 1.0);
  /// A straight anti-aliased line of the given width.
  void line(double x0, double y0, double x1, double y1, double width, const Color& color,
            double alpha = 1.0);
  /// Text with the pen starting at x on the baseline y, over a white halo of so many pixels.
  void text(double x, double y, std::string_view text, double pixels, const Color& color,
            double halo);

 private:
  void stamp(const TextMask& mask, int left, int top, const Color& color, double alpha);

  Image& image_;
};

}  // namespace sheave::render
