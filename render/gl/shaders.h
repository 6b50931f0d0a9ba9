#pragma once
// GLSL sources. Lighting is computed with linear colours; the framebuffer encodes to sRGB.

#include <string_view>

namespace sheave::render::shaders {

/// Begins every source: functions shared by several shaders.
extern const std::string_view common;

extern const std::string_view shadow_vertex, shadow_fragment;    ///< depth seen from the light
extern const std::string_view surface_vertex, surface_fragment;  ///< solids and tubes
extern const std::string_view outline_vertex, outline_fragment;  ///< silhouettes: a grown back side
extern const std::string_view line_vertex, line_fragment;        ///< sharp edges
extern const std::string_view plane_vertex, plane_fragment;      ///< ground with grid
extern const std::string_view background_vertex, background_fragment;

}  // namespace sheave::render::shaders
