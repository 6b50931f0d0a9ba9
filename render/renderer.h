#pragma once
// From a draw list to a picture.
//
//   auto renderer = Renderer::create(1280, 720);
//   if (!renderer) return renderer.errors();
//   Result<Image> picture = renderer->draw(list, camera);
//   if (picture) write_png("pulley.png", *picture);

#include <memory>

#include "engine/result.h"
#include "render/camera.h"
#include "render/draw_list.h"
#include "render/image.h"

namespace sheave::render {

struct RendererOptions {
  /// Samples per pixel on edges: 1, 2 or 4.
  int samples = 4;
  /// Factor of the drawn size in both directions before averaging, 1 to 4. For stills; the cost
  /// grows with its square.
  int supersample = 1;
  /// Side of the shadow map [texels], 64 to 8192; 0 draws no shadows.
  int shadow_side = 2048;
  /// Width of silhouettes [pixels of the finished picture], 0 to 10.
  double line_width = 1.1;
  /// Whether title, time, caption, legend and labels are drawn.
  bool text = true;
};

/// Draws off-screen, without a window system. The same input gives the same bytes on one machine.
/// One thread at a time; different renderers may be used by different threads.
class Renderer {
 public:
  static constexpr int min_side = 16;    ///< [pixels]
  static constexpr int max_side = 8192;  ///< [pixels], also after supersampling

  /// Fails if a size or option is out of range, or if no GL context can be created.
  static Result<Renderer> create(int width, int height, const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  /// The picture, or all faults of the list and the camera.
  [[nodiscard]] Result<Image> draw(const DrawList& list, const Camera& camera);

 private:
  struct Content;
  explicit Renderer(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// Faults that make a list undrawable: sizes that are not positive or not finite, missing meshes,
/// indices of missing corners, an empty legend range. Empty if it can be drawn.
[[nodiscard]] Errors validate(const DrawList& list);

}  // namespace sheave::render
