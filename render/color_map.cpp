#include "render/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace sheave::render {
namespace {

// The lower three quarters of the "plasma" map of van der Walt and Smith (CC0), at even steps. The
// upper quarter is yellow, which vanishes on white.
constexpr std::array<Color, 9> tension_stops = {
    rgb(0x2b0594), rgb(0x4f02a2), rgb(0x7201a8), rgb(0x920fa3), rgb(0xb02991),
    rgb(0xc8437b), rgb(0xdb5c68), rgb(0xeb7655), rgb(0xf79342),
};

constexpr std::array<Color, 2> gray_stops = {rgb(0x202020), rgb(0xa0a0a0)};

template <std::size_t N>
Color interpolate(const std::array<Color, N>& stops, double t) {
  const double position = t * static_cast<double>(N - 1);
  const auto index = std::min(static_cast<std::size_t>(position), N - 2);
  return mix(stops[index], stops[index + 1],
             static_cast<float>(position - static_cast<double>(index)));
}

}  // namespace

Color sample(ColorMap map, double t) {
  const double inside = std::isnan(t) ? 0.0 : std::clamp(t, 0.0, 1.0);
  switch (map) {
    case ColorMap::tension:
      return interpolate(tension_stops, inside);
    case ColorMap::gray:
      return interpolate(gray_stops, inside);
  }
  return {};
}

}  // namespace sheave::render
