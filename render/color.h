#pragma once
// Colours as they are written in a figure: sRGB-encoded components.

#include <cstdint>

namespace sheave::render {

/// sRGB-encoded colour; each component in [0, 1] (values outside are clamped when drawn).
struct Color {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;

  friend bool operator==(const Color&, const Color&) = default;
};

/// The colour 0xRRGGBB.
constexpr Color rgb(std::uint32_t hex) {
  return {static_cast<float>((hex >> 16U) & 0xFFU) / 255.0F,
          static_cast<float>((hex >> 8U) & 0xFFU) / 255.0F,
          static_cast<float>(hex & 0xFFU) / 255.0F};
}

/// The colour a fraction t in [0, 1] of the way from a to b, component by component.
constexpr Color mix(const Color& a, const Color& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

}  // namespace sheave::render
