#pragma once
// Drawing as SVG: lines and texts that stay such, over a picture of pixels.

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
  /// As wide as the built-in face would be, whatever the reader's is.
  void text(double x, double y, std::string_view text, double pixels, const render::Color& color,
            double halo) override;

  /// The file: what has been drawn over a picture, which are the bytes of a PNG file of any number
  /// of pixels. Bytes that are no UTF-8, and characters that XML cannot hold, show as U+FFFD.
  [[nodiscard]] std::string document(const std::string& png, const std::string& title) const;

 private:
  int width_;
  int height_;
  std::string elements_;
};

}  // namespace sheave::view
