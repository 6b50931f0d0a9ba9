#include <array>
#include <cstdint>
#include <utility>

#define GLAPI extern
#include <glad/gl.h>
// osmesa.h needs the types of GL/gl.h; glad has declared them already.
#include <GL/osmesa.h>

#include "render/gl/gl_context.h"

namespace sheave::render {
namespace {

/// OSMesa insists on a buffer of its own, like a window. Pictures are drawn into framebuffer
/// objects, so the smallest buffer suffices.
constexpr int buffer_side = 16;

class OsmesaContext final : public GlContext {
 public:
  explicit OsmesaContext(OSMesaContext context) : context_(context) {}
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }

  bool make_current() override {
    return OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, buffer_side,
                             buffer_side) == GL_TRUE;
  }
  bool load() { return gladLoadGLContext(&functions_, OSMesaGetProcAddress) != 0; }
  const GladGLContext& functions() const override { return functions_; }

 private:
  OSMesaContext context_;
  std::array<std::uint8_t, std::size_t{4} * buffer_side * buffer_side> buffer_{};
  GladGLContext functions_{};
};

}  // namespace

Result<std::unique_ptr<GlContext>> make_osmesa_context() {
  const std::array<int, 15> attributes{OSMESA_FORMAT,
                                       OSMESA_RGBA,
                                       OSMESA_DEPTH_BITS,
                                       0,
                                       OSMESA_STENCIL_BITS,
                                       0,
                                       OSMESA_ACCUM_BITS,
                                       0,
                                       OSMESA_PROFILE,
                                       OSMESA_CORE_PROFILE,
                                       OSMESA_CONTEXT_MAJOR_VERSION,
                                       3,
                                       OSMESA_CONTEXT_MINOR_VERSION,
                                       3,
                                       0};
  const OSMesaContext raw = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (raw == nullptr) {
    return Error{
        "", "OSMesa cannot make an OpenGL 3.3 core context; Mesa 22.3 with llvmpipe is known to"};
  }
  auto context = std::make_unique<OsmesaContext>(raw);
  if (!context->make_current()) return Error{"", "OSMesa cannot make its context current"};
  if (!context->load()) return Error{"", "OSMesa lacks entry points of OpenGL 3.3 core"};
  return std::unique_ptr<GlContext>(std::move(context));
}

}  // namespace sheave::render
