#pragma once
// Drawing as SVG: lines and texts stay vector graphics, over a picture of pixels.

#include <string>

#include "render/canvas.h"

namespace sheave::view {

class SvgCanvas final : public render::Canvas {
 public:
  using Canvas::fill;
  SvgCanvas(int width, int height) : width_(width), height_(height) {}

  [[nodiscard]] int width() const override { return width_; }
  [[nodiscard]] int height() const override { return height_; }
  void fill(double x, double y, double w, double h, const render::Color& color,
            double alpha) override;
  void line(double x0, double y0, double x1, double y1, double width, const render::Color& color,
            double alpha) override;
  /// The text is as wide as in the built-in face, even if the reader's program uses another font.
  void text(double x, double y, std::string_view text, double pixels, const render::Color& color,
            double halo) override;

  /// The SVG file: the drawing over the picture `png`, the bytes of a PNG file of any size. Invalid
  /// UTF-8 and characters that XML does not allow are shown as U+FFFD.
  [[nodiscard]] std::string document(const std::string& png, const std::string& title) const;

 private:
  int width_;
  int height_;
  std::string elements_;
};

}  // namespace sheave::view
