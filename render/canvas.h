#pragma once
// Two-dimensional drawing over a finished picture. Coordinates in pixels from the upper left
// corner; parts outside the picture are cut off.

#include <string_view>

#include "render/color.h"

namespace sheave::render {

class Canvas {
 public:
  virtual ~Canvas() = default;

  [[nodiscard]] virtual int width() const = 0;   ///< [pixels]
  [[nodiscard]] virtual int height() const = 0;  ///< [pixels]
  /// Covers the rectangle [x, x + w) x [y, y + h), its edges anti-aliased, by a fraction alpha in
  /// [0, 1].
  virtual void fill(double x, double y, double w, double h, const Color& color, double alpha) = 0;
  void fill(double x, double y, double w, double h, const Color& color) {
    fill(x, y, w, h, color, 1.0);
  }
  /// A straight anti-aliased line of the given width.
  virtual void line(double x0, double y0, double x1, double y1, double width, const Color& color,
                    double alpha) = 0;
  /// Text with the pen starting at x on the baseline y. `pixels`: height from ascent to descent.
  /// `halo`: width of a white halo in pixels.
  virtual void text(double x, double y, std::string_view text, double pixels, const Color& color,
                    double halo) = 0;
};

}  // namespace sheave::render
