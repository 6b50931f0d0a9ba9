// The passes of one frame: depth from the light, then surfaces, silhouettes and edges, then planes
// and the background. By then surfaces hide most of the planes and the background, so these cost
// little.
#include "render/gl/frame_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "render/gl/shaders.h"
#include "render/tube_mesh.h"

namespace sheave::render {
namespace {

Eigen::Vector3f linear(const Color& color) {
  const auto decode = [](float c) {
    const float x = std::clamp(c, 0.0F, 1.0F);
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
  };
  return {decode(color.r), decode(color.g), decode(color.b)};
}

/// Number of facets round a curved surface with a radius of so many pixels.
int facets(double pixels) {
  constexpr std::array<std::pair<double, int>, 5> steps{
      {{6.0, 12}, {20.0, 24}, {60.0, 40}, {180.0, 64}, {500.0, 96}}};
  for (const auto& [radius, count] : steps) {
    if (pixels < radius) return count;
  }
  return 160;
}

int tube_sides(double pixels) { return pixels < 2.0 ? 6 : pixels < 6.0 ? 10 : 16; }

/// A square of side 2 in the xy plane, seen from +z.
Mesh square() {
  MeshBuilder builder;
  const std::array<Vector3, 4> corners{Vector3{-1.0, -1.0, 0.0}, Vector3{1.0, -1.0, 0.0},
                                       Vector3{1.0, 1.0, 0.0}, Vector3{-1.0, 1.0, 0.0}};
  builder.add_polygon(corners, Vector3::UnitZ());
  return builder.finish();
}

}  // namespace

/// An object that one call draws.
struct FrameRenderer::Item {
  const GpuMesh* mesh = nullptr;
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Vector3f translation = Eigen::Vector3f::Zero();  ///< relative to the view's origin
  Eigen::Vector3f color = Eigen::Vector3f::Ones();
  Eigen::Vector3f accent = Eigen::Vector3f::Ones();
  float flatness = 0.0F;
};

struct FrameRenderer::Programs {
  std::unique_ptr<Program> shadow, surface, outline, line, plane, background;
};

struct FrameRenderer::Frame {
  View view;
  Light light;
  bool has_shadows = false;
  std::vector<Item> items;
};

FrameRenderer::FrameRenderer(const GladGLContext& gl, const FrameSettings& settings)
    : gl_(gl), settings_(settings), programs_(std::make_unique<Programs>()), meshes_(gl) {}

FrameRenderer::~FrameRenderer() = default;

Result<std::unique_ptr<FrameRenderer>> FrameRenderer::make(const GladGLContext& gl,
                                                           const FrameSettings& settings) {
  std::unique_ptr<FrameRenderer> self(new FrameRenderer(gl, settings));
  Programs& p = *self->programs_;
  namespace s = shaders;
  struct Source {
    std::unique_ptr<Program>& program;
    std::string_view name, vertex, fragment;
  };
  const std::array<Source, 6> sources{{
      {p.shadow, "shadow", s::shadow_vertex, s::shadow_fragment},
      {p.surface, "surface", s::surface_vertex, s::surface_fragment},
      {p.outline, "outline", s::outline_vertex, s::outline_fragment},
      {p.line, "line", s::line_vertex, s::line_fragment},
      {p.plane, "plane", s::plane_vertex, s::plane_fragment},
      {p.background, "background", s::background_vertex, s::background_fragment},
  }};
  for (const Source& source : sources) {
    auto program = Program::make(gl, source.name, source.vertex, source.fragment);
    if (!program) return program.errors();
    source.program = std::move(program).value();
  }
  auto target = RenderTarget::make(gl, settings.width, settings.height, settings.samples);
  if (!target) return target.errors();
  self->target_ = std::move(target).value();
  auto shadow_map = ShadowMap::make(gl, std::max(settings.shadow_side, 1));
  if (!shadow_map) return shadow_map.errors();
  self->shadow_map_ = std::move(shadow_map).value();
  self->tubes_ = std::make_unique<GpuMesh>(gl);
  self->plane_ = std::make_unique<GpuMesh>(gl);
  self->plane_->upload(square());
  return self;
}

void FrameRenderer::collect(const DrawList& list, const Camera& camera, Frame& frame) {
  const Projector projector(camera, settings_.width, settings_.height);
  const Vector3& origin = frame.view.origin;
  const auto pixels_of = [&](const Vector3& place, double size) {
    const double depth = std::max(projector.depth_of(place), 1e-3 * frame.view.radius);
    return size * projector.scale_at(depth);
  };
  for (const Solid& solid : list.solids) {
    Item item;
    const double reach = 0.5 * bounds(solid).diagonal().norm();
    item.mesh = &meshes_.find(solid.shape, facets(pixels_of(solid.position, reach)));
    item.rotation = solid.orientation.toRotationMatrix().cast<float>();
    item.translation = (solid.position - origin).cast<float>();
    item.color = linear(solid.color);
    item.accent = linear(solid.accent);
    frame.items.push_back(item);
  }
  Mesh mesh;
  for (const Tube& tube : list.tubes) {
    if (tube.points.empty()) continue;
    const double pixels = pixels_of(tube.points.front().position, tube.radius);
    append_tube(tube, origin, tube_sides(pixels), mesh);
  }
  if (mesh.triangles.empty()) return;
  tubes_->upload(mesh);
  frame.items.push_back({.mesh = tubes_.get(), .flatness = 0.6F});
}

void FrameRenderer::set_eye(Program& program, const Frame& frame) {
  program.set("eye", frame.view.eye);
  program.set("eye_direction", frame.view.eye_direction);
  program.set("nudge", frame.view.nudge);
}

void FrameRenderer::draw_shadows(const Frame& frame) {
  shadow_map_->bind_for_drawing();
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  if (!frame.has_shadows) return;
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(2.0F, 3.0F);
  Program& program = *programs_->shadow;
  program.use();
  program.set("shadow_matrix", frame.light.shadow_matrix);
  for (const Item& item : frame.items) {
    program.set("rotation", item.rotation);
    program.set("translation", item.translation);
    item.mesh->draw_triangles();
  }
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void FrameRenderer::draw_surfaces(const Frame& frame) {
  Program& program = *programs_->surface;
  program.use();
  program.set("view_projection", frame.view.view_projection);
  program.set("shadow_matrix", frame.light.shadow_matrix);
  program.set("shadow_offset", static_cast<float>(1.6 * frame.light.texel));
  program.set("shadow_map", 0);
  program.set("shadowed", frame.has_shadows ? 1.0F : 0.0F);
  program.set("shadow_texel", 1.0F / static_cast<float>(shadow_map_->side()));
  program.set("to_light", frame.light.to_light);
  program.set("up", frame.view.up);
  set_eye(program, frame);
  for (const Item& item : frame.items) {
    program.set("rotation", item.rotation);
    program.set("translation", item.translation);
    program.set("base_color", item.color);
    program.set("accent_color", item.accent);
    program.set("flatness", item.flatness);
    item.mesh->draw_triangles();
  }
}

void FrameRenderer::draw_outlines(const Frame& frame) {
  Program& program = *programs_->outline;
  program.use();
  program.set("view_projection", frame.view.view_projection);
  program.set("pixel", Eigen::Vector2f(2.0F / static_cast<float>(settings_.width),
                                       2.0F / static_cast<float>(settings_.height)));
  program.set("width", static_cast<float>(settings_.line_width));
  set_eye(program, frame);
  gl_.CullFace(GL_FRONT);
  for (const Item& item : frame.items) {
    program.set("rotation", item.rotation);
    program.set("translation", item.translation);
    program.set("base_color", item.color);
    item.mesh->draw_triangles();
  }
  gl_.CullFace(GL_BACK);
}

void FrameRenderer::draw_lines(const Frame& frame) {
  Program& program = *programs_->line;
  program.use();
  program.set("view_projection", frame.view.view_projection);
  set_eye(program, frame);
  for (const Item& item : frame.items) {
    if (!item.mesh->has_lines()) continue;
    program.set("rotation", item.rotation);
    program.set("translation", item.translation);
    program.set("base_color", item.color);
    item.mesh->draw_lines();
  }
}

void FrameRenderer::draw_planes(const DrawList& list, const Frame& frame) {
  Program& program = *programs_->plane;
  program.use();
  program.set("view_projection", frame.view.view_projection);
  program.set("shadow_matrix", frame.light.shadow_matrix);
  program.set("shadow_map", 0);
  program.set("shadow_texel", 1.0F / static_cast<float>(shadow_map_->side()));
  program.set("picture_height", static_cast<float>(settings_.height));
  const double radius = frame.view.ground_radius;
  for (const Plane& plane : list.planes) {
    const Vector3 normal = plane.normal.normalized();
    const Vector3 u = any_perpendicular(normal);
    const Vector3 v = normal.cross(u);
    const Vector3 centre = frame.view.origin - normal * normal.dot(frame.view.origin - plane.point);
    Eigen::Matrix3f rotation;
    rotation << u.cast<float>(), v.cast<float>(), normal.cast<float>();
    program.set("rotation", rotation);
    program.set("translation", Eigen::Vector3f((centre - frame.view.origin).cast<float>()));
    program.set("radius", static_cast<float>(radius));
    program.set("base_color", linear(plane.color));
    const bool grid = plane.grid_spacing > 0.0;
    const double spacing = grid ? plane.grid_spacing : radius;
    // The grid is fixed to the plane's own point and not to the point the camera looks at.
    const Vector3 offset = centre - plane.point;
    const auto phase = [&](const Vector3& axis) {
      const double lines = axis.dot(offset) / spacing;
      return static_cast<float>(lines - std::floor(lines));
    };
    program.set("grid_origin", Eigen::Vector2f(phase(u), phase(v)));
    program.set("grid_scale", static_cast<float>(radius / spacing));
    program.set("grid_strength", grid ? 0.12F : 0.0F);
    plane_->draw_triangles();
  }
}

void FrameRenderer::draw_background() {
  Program& program = *programs_->background;
  program.use();
  program.set("picture_height", static_cast<float>(settings_.height));
  gl_.DepthFunc(GL_LEQUAL);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.DepthFunc(GL_LESS);
}

Image FrameRenderer::read_image() {
  target_->read(pixels_);
  Image image(settings_.width, settings_.height);
  const auto width = static_cast<std::size_t>(settings_.width);
  for (int y = 0; y < settings_.height; ++y) {
    // GL counts rows from the bottom.
    const std::uint8_t* from =
        pixels_.data() + static_cast<std::size_t>(settings_.height - 1 - y) * width * 4U;
    std::uint8_t* to = image.pixel(0, y);
    for (std::size_t x = 0; x < width; ++x) {
      to[3 * x] = from[4 * x];
      to[3 * x + 1] = from[4 * x + 1];
      to[3 * x + 2] = from[4 * x + 2];
    }
  }
  return image;
}

Result<Image> FrameRenderer::draw(const DrawList& list, const Camera& camera) {
  const Eigen::AlignedBox3d contents = bounds(list);
  Frame frame;
  frame.view = make_view(camera, settings_.width, settings_.height, contents);
  const Vector3 up = list.planes.empty() ? axes(camera).up : list.planes.front().normal;
  frame.light = make_light(camera, up, frame.view, contents, shadow_map_->side());
  collect(list, camera, frame);

  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_CULL_FACE);
  gl_.Enable(GL_MULTISAMPLE);
  gl_.DepthFunc(GL_LESS);
  gl_.ActiveTexture(GL_TEXTURE0);
  // Shadows show the place above a ground. Without one they take time and say little.
  frame.has_shadows = settings_.shadow_side > 0 && !list.planes.empty();
  if (!list.planes.empty()) draw_shadows(frame);
  target_->bind();
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  shadow_map_->bind_for_reading();
  draw_surfaces(frame);
  draw_outlines(frame);
  draw_lines(frame);
  draw_planes(list, frame);
  draw_background();
  Image image = read_image();
  meshes_.end_frame();
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    return Error{"", "OpenGL reports error " + std::to_string(error) + " while drawing a frame"};
  }
  return image;
}

}  // namespace sheave::render
