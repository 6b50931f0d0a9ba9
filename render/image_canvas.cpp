#include "render/image_canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sheave::render {
namespace {

/// The mask grown by `radius` pixels, with a soft edge one pixel wide.
TextMask grow(const TextMask& mask, double radius) {
  const int reach = static_cast<int>(std::ceil(radius + 0.5));
  TextMask grown = mask;
  const auto side = static_cast<std::size_t>(2 * reach + 1);
  std::vector<double> weight(side * side);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      weight[static_cast<std::size_t>(dy + reach) * side + static_cast<std::size_t>(dx + reach)] =
          std::clamp(radius + 0.5 - std::hypot(dx, dy), 0.0, 1.0);
    }
  }
  const auto index = [&](int x, int y) { return static_cast<std::size_t>(y * mask.width + x); };
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const std::uint8_t coverage = mask.coverage[index(x, y)];
      if (coverage == 0) continue;
      for (int dy = std::max(-reach, -y); dy <= std::min(reach, mask.height - 1 - y); ++dy) {
        for (int dx = std::max(-reach, -x); dx <= std::min(reach, mask.width - 1 - x); ++dx) {
          const double w = weight[static_cast<std::size_t>(dy + reach) * side +
                                  static_cast<std::size_t>(dx + reach)];
          std::uint8_t& to = grown.coverage[index(x + dx, y + dy)];
          to = std::max(to, static_cast<std::uint8_t>(std::lround(coverage * w)));
        }
      }
    }
  }
  return grown;
}

}  // namespace

void ImageCanvas::blend(int x, int y, const Color& color, double alpha) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height || !(alpha > 0.0)) return;
  const double a = std::min(alpha, 1.0);
  std::uint8_t* to = image_.pixel(x, y);
  const auto channel = [a](std::uint8_t& value, float wanted) {
    const double full = 255.0 * std::clamp(static_cast<double>(wanted), 0.0, 1.0);
    value = static_cast<std::uint8_t>(std::lround(value + (full - value) * a));
  };
  channel(to[0], color.r);
  channel(to[1], color.g);
  channel(to[2], color.b);
}

void ImageCanvas::fill(double x, double y, double w, double h, const Color& color, double alpha) {
  const int x0 = std::max(0, static_cast<int>(std::floor(x)));
  const int y0 = std::max(0, static_cast<int>(std::floor(y)));
  const int x1 = std::min(image_.width, static_cast<int>(std::ceil(x + w)));
  const int y1 = std::min(image_.height, static_cast<int>(std::ceil(y + h)));
  const auto share = [](int cell, double low, double high) {
    return std::clamp(std::min(cell + 1.0, high) - std::max<double>(cell, low), 0.0, 1.0);
  };
  for (int py = y0; py < y1; ++py) {
    for (int px = x0; px < x1; ++px) {
      blend(px, py, color, alpha * share(px, x, x + w) * share(py, y, y + h));
    }
  }
}

void ImageCanvas::line(double x0, double y0, double x1, double y1, double width, const Color& color,
                       double alpha) {
  const double margin = 0.5 * width + 1.0;
  const int left = std::max(0, static_cast<int>(std::floor(std::min(x0, x1) - margin)));
  const int top = std::max(0, static_cast<int>(std::floor(std::min(y0, y1) - margin)));
  const int right =
      std::min(image_.width - 1, static_cast<int>(std::ceil(std::max(x0, x1) + margin)));
  const int bottom =
      std::min(image_.height - 1, static_cast<int>(std::ceil(std::max(y0, y1) + margin)));
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  const double squared = dx * dx + dy * dy;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double px = x + 0.5 - x0;
      const double py = y + 0.5 - y0;
      const double t = squared > 0.0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - t * dx, py - t * dy);
      blend(x, y, color, alpha * std::clamp(0.5 * width + 0.5 - distance, 0.0, 1.0));
    }
  }
}

void ImageCanvas::stamp(const TextMask& mask, int left, int top, const Color& color, double alpha) {
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const std::uint8_t coverage = mask.coverage[static_cast<std::size_t>(y * mask.width + x)];
      if (coverage != 0) blend(left + x, top + y, color, alpha * coverage / 255.0);
    }
  }
}

void ImageCanvas::text(double x, double y, std::string_view text, double pixels, const Color& color,
                       double halo) {
  if (text.empty()) return;
  const int border = static_cast<int>(std::ceil(halo)) + 1;
  const TextMask mask = Font::builtin().draw(text, pixels, border);
  const int left = static_cast<int>(std::lround(x)) - mask.left;
  const int top = static_cast<int>(std::lround(y)) - mask.baseline;
  if (halo > 0.0) stamp(grow(mask, halo), left, top, Color{1.0F, 1.0F, 1.0F}, 0.85);
  stamp(mask, left, top, color, 1.0);
}

}  // namespace sheave::render
