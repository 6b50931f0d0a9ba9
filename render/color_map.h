#pragma once
// Colour maps for quantities along a cable.

#include "render/color.h"

namespace sheave::render {

enum class ColorMap {
  /// Perceptually uniform, from dark blue over magenta to orange. Its lightness rises evenly and
  /// stops where a line on a light background would become hard to see.
  tension,
  /// From dark to middle grey.
  gray,
};

/// The colour at t in [0, 1]; t outside is clamped, NaN counts as 0.
Color sample(ColorMap map, double t);

/// A cable without tension. The colour is outside every map, so that slack cannot be mistaken for a
/// small tension.
inline constexpr Color slack_color = rgb(0x8d98a5);
/// The place where a cable is fixed to a body.
inline constexpr Color knot_color = rgb(0x3b4656);

}  // namespace sheave::render
