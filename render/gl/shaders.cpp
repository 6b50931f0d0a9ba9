#include "render/gl/shaders.h"

namespace sheave::render::shaders {

const std::string_view common = R"glsl(
vec3 linear_from_srgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), c));
}
// The curve of sRGB, once per pixel: an sRGB framebuffer would encode every sample of it.
vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}
// Clip coordinates of a world point whose depth is moved by `towards` of the way to the eye; its
// place in the picture stays.
vec4 nudged(mat4 view_projection, vec3 world, vec3 eye, vec3 eye_direction, float towards) {
  vec4 place = view_projection * vec4(world, 1.0);
  vec3 step = eye_direction == vec3(0.0) ? eye - world : eye_direction * length(eye);
  vec4 moved = view_projection * vec4(world + step * towards, 1.0);
  place.z = moved.z / moved.w * place.w;
  return place;
}
// A light gradient, encoded; height: 0 at the bottom of the picture, 1 at the top.
vec3 background_at(float height) {
  return mix(vec3(0.906, 0.922, 0.941), vec3(0.988, 0.99, 0.993), height);
}
)glsl";

const std::string_view shadow_vertex = R"glsl(
layout(location = 0) in vec3 position;
uniform mat4 shadow_matrix;
uniform mat3 rotation;
uniform vec3 translation;
void main() { gl_Position = shadow_matrix * vec4(rotation * position + translation, 1.0); }
)glsl";

const std::string_view shadow_fragment = R"glsl(
void main() {}
)glsl";

const std::string_view surface_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec4 paint;
uniform mat4 view_projection;
uniform mat4 shadow_matrix;
uniform mat3 rotation;
uniform vec3 translation;
uniform vec3 base_color;
uniform vec3 accent_color;
// World length by which the shadow lookup is moved off the surface, against self-shadowing.
uniform float shadow_offset;
out vec3 world;
out vec3 world_normal;
out vec3 color;
out vec3 shadow_place;
void main() {
  world = rotation * position + translation;
  world_normal = rotation * normal;
  color = mix(base_color * linear_from_srgb(paint.rgb), accent_color, paint.a);
  vec4 light = shadow_matrix * vec4(world + world_normal * shadow_offset, 1.0);
  shadow_place = light.xyz * 0.5 + 0.5;
  gl_Position = view_projection * vec4(world, 1.0);
}
)glsl";

const std::string_view surface_fragment = R"glsl(
in vec3 world;
in vec3 world_normal;
in vec3 color;
in vec3 shadow_place;
uniform sampler2DShadow shadow_map;
uniform float shadow_texel;
uniform vec3 to_light;
uniform vec3 up;
uniform vec3 eye;
uniform vec3 eye_direction;  // towards the eye, for orthographic pictures; zero otherwise
uniform float flatness;      // share of unlit colour: a cable must match the legend
uniform float shadowed;      // 1: the shadow map is drawn; 0: there are no shadows
out vec4 result;

float lit(vec3 place) {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += texture(shadow_map, place + vec3(vec2(x, y) * 1.4 * shadow_texel, 0.0));
  return sum / 9.0;
}

void main() {
  vec3 n = normalize(world_normal);
  vec3 v = eye_direction == vec3(0.0) ? normalize(eye - world) : eye_direction;
  float facing = dot(n, to_light);
  float key = 0.0;
  if (facing > 0.0) key = shadowed > 0.0 ? facing * lit(shadow_place) : facing;
  float sky = 0.5 + 0.5 * dot(n, up);
  vec3 ambient = mix(vec3(0.34, 0.33, 0.33), vec3(0.60, 0.62, 0.65), sky);
  vec3 light = ambient + key * vec3(0.72, 0.70, 0.67);
  // A weak light from the eye keeps surfaces that face the reader readable.
  light += 0.10 * max(dot(n, v), 0.0);
  float shine = pow(max(dot(n, normalize(to_light + v)), 0.0), 48.0);
  vec3 shaded = color * light + vec3(0.10) * shine * step(0.0, facing) * min(1.0, 4.0 * key);
  result = vec4(encoded(mix(shaded, color, flatness)), 1.0);
}
)glsl";

const std::string_view outline_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 2) in vec3 outline;
layout(location = 3) in vec4 paint;
uniform mat4 view_projection;
uniform mat3 rotation;
uniform vec3 translation;
uniform vec3 base_color;
uniform vec2 pixel;   // size of a pixel in clip coordinates
uniform float width;  // [pixels]
uniform vec3 eye;
uniform vec3 eye_direction;
uniform float nudge;
out vec3 color;
void main() {
  color = mix(base_color * linear_from_srgb(paint.rgb), vec3(0.012, 0.016, 0.026), 0.78);
  // Behind the surface itself, so that only what reaches beyond the silhouette shows.
  vec3 world = rotation * position + translation;
  vec4 place = nudged(view_projection, world, eye, eye_direction, -nudge);
  vec2 direction = (view_projection * vec4(rotation * outline, 0.0)).xy / pixel;
  float size = length(direction);
  if (size > 0.0) place.xy += direction / size * width * pixel * place.w;
  gl_Position = place;
}
)glsl";

const std::string_view outline_fragment = R"glsl(
in vec3 color;
out vec4 result;
void main() { result = vec4(encoded(color), 1.0); }
)glsl";

const std::string_view line_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 3) in vec4 paint;
uniform mat4 view_projection;
uniform mat3 rotation;
uniform vec3 translation;
uniform vec3 base_color;
uniform vec3 eye;
uniform vec3 eye_direction;
uniform float nudge;
out vec3 color;
void main() {
  color = base_color * linear_from_srgb(paint.rgb) * 0.38;
  // In front of the surfaces that meet at the edge.
  vec3 world = rotation * position + translation;
  gl_Position = nudged(view_projection, world, eye, eye_direction, nudge);
}
)glsl";

const std::string_view line_fragment = outline_fragment;

const std::string_view plane_vertex = R"glsl(
layout(location = 0) in vec3 position;
uniform mat4 view_projection;
uniform mat4 shadow_matrix;
uniform mat3 rotation;
uniform vec3 translation;
uniform float radius;
out vec2 place;  // in the plane, in radii
out vec2 grid_place;
out vec3 shadow_place;
uniform vec2 grid_origin;  // of the grid, in lines
uniform float grid_scale;  // lines per radius
void main() {
  place = position.xy;
  grid_place = position.xy * grid_scale + grid_origin;
  vec4 world = vec4(rotation * (position * radius) + translation, 1.0);
  vec4 light = shadow_matrix * world;
  shadow_place = light.xyz * 0.5 + 0.5;
  gl_Position = view_projection * world;
}
)glsl";

const std::string_view plane_fragment = R"glsl(
in vec2 place;
in vec2 grid_place;
in vec3 shadow_place;
uniform sampler2DShadow shadow_map;
uniform float shadow_texel;
uniform vec3 base_color;
uniform float grid_strength;
uniform float picture_height;
out vec4 result;

// Places on a spiral [texels]: wide enough for a soft edge, close enough not to show steps.
const vec2 spiral[12] = vec2[](
    vec2(0.919, 0.000), vec2(-1.173, 1.075), vec2(0.180, -2.046),
    vec2(1.479, 1.929), vec2(-2.714, -0.480), vec2(2.571, -1.635),
    vec2(-0.860, 3.198), vec2(-1.640, -3.157), vec2(3.558, 1.299),
    vec2(-3.701, 1.528), vec2(1.784, -3.813), vec2(1.318, 4.203));

float lit(vec3 at) {
  // Most of a ground is outside the shadow map; a software rasteriser gains by skipping it.
  if (any(greaterThan(abs(at - 0.5), vec3(0.51)))) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < 12; ++i)
    sum += texture(shadow_map, vec3(at.xy + spiral[i] * shadow_texel, at.z));
  return sum / 12.0;
}

// Share of the pixel covered by grid lines; fades where lines come closer than pixels can show.
float grid() {
  vec2 change = max(fwidth(grid_place), vec2(1e-6));
  vec2 distance_to_line = abs(fract(grid_place - 0.5) - 0.5) / change;
  vec2 line = 1.0 - smoothstep(0.3, 1.3, distance_to_line);
  line *= 1.0 - smoothstep(0.12, 0.5, change);
  return max(line.x, line.y);
}

void main() {
  float fade = 1.0 - smoothstep(0.25, 1.0, length(place));
  vec3 color = base_color * mix(0.62, 1.0, lit(shadow_place));
  color *= 1.0 - grid_strength * grid();
  vec3 behind = background_at(gl_FragCoord.y / picture_height);
  result = vec4(mix(behind, encoded(color), fade), 1.0);
}
)glsl";

const std::string_view background_vertex = R"glsl(
void main() {
  // One triangle that covers the picture, at the far plane.
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  gl_Position = vec4(corner, 1.0, 1.0);
}
)glsl";

const std::string_view background_fragment = R"glsl(
uniform float picture_height;
out vec4 result;
void main() { result = vec4(background_at(gl_FragCoord.y / picture_height), 1.0); }
)glsl";

}  // namespace sheave::render::shaders
