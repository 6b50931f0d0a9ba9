#pragma once
// Drawing into the pixels of a picture.

#include "render/canvas.h"
#include "render/font.h"
#include "render/image.h"

namespace sheave::render {

class ImageCanvas final : public Canvas {
 public:
  using Canvas::fill;
  explicit ImageCanvas(Image& image) : image_(image) {}

  [[nodiscard]] int width() const override { return image_.width; }
  [[nodiscard]] int height() const override { return image_.height; }
  /// Covers a pixel by a fraction alpha in [0, 1].
  void blend(int x, int y, const Color& color, double alpha);
  void fill(double x, double y, double w, double h, const Color& color, double alpha) override;
  void line(double x0, double y0, double x1, double y1, double width, const Color& color,
            double alpha) override;
  void text(double x, double y, std::string_view text, double pixels, const Color& color,
            double halo) override;

 private:
  void stamp(const TextMask& mask, int left, int top, const Color& color, double alpha);

  Image& image_;
};

}  // namespace sheave::render
