#pragma once
// Draws the three-dimensional part of a draw list with GL; text is added by overlay.h.

#include <memory>
#include <vector>

#include "render/draw_list.h"
#include "render/gl/gl_context.h"
#include "render/gl/gl_objects.h"
#include "render/gl/mesh_cache.h"
#include "render/gl/view.h"
#include "render/image.h"

namespace sheave::render {

struct FrameSettings {
  int width = 1280;         ///< [pixels]
  int height = 720;         ///< [pixels]
  int samples = 4;          ///< per pixel
  int shadow_side = 2048;   ///< [texels]; 0: no shadows
  double line_width = 1.0;  ///< [pixels] of silhouettes
};

class FrameRenderer {
 public:
  /// The context must be current during this call and every later one.
  static Result<std::unique_ptr<FrameRenderer>> make(const GladGLContext& gl,
                                                     const FrameSettings& settings);
  ~FrameRenderer();

  /// Draws a valid list with a valid camera.
  Result<Image> draw(const DrawList& list, const Camera& camera);

 private:
  struct Item;
  struct Programs;
  struct Frame;

  FrameRenderer(const GladGLContext& gl, const FrameSettings& settings);
  void collect(const DrawList& list, const Camera& camera, Frame& frame);
  static void set_eye(Program& program, const Frame& frame);
  void draw_shadows(const Frame& frame);
  void draw_surfaces(const Frame& frame);
  void draw_outlines(const Frame& frame);
  void draw_lines(const Frame& frame);
  void draw_planes(const DrawList& list, const Frame& frame);
  void draw_background();
  Image read_image();

  const GladGLContext& gl_;
  FrameSettings settings_;
  std::unique_ptr<Programs> programs_;
  std::unique_ptr<RenderTarget> target_;
  std::unique_ptr<ShadowMap> shadow_map_;
  std::unique_ptr<GpuMesh> tubes_;
  std::unique_ptr<GpuMesh> plane_;
  MeshCache meshes_;
  std::vector<std::uint8_t> pixels_;  ///< kept between frames to avoid allocation
};

}  // namespace sheave::render
