#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <dlfcn.h>

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

/// The functions of OSMesa. The library is loaded for the first picture, because LLVM comes with it and
/// takes five times as long to load as the rest of the program.
struct OsmesaLibrary {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) function_of = nullptr;

  /// Why the library cannot be loaded; empty: it is.
  [[nodiscard]] std::string load() {
    // Threads of LLVM outlive contexts, so the library stays.
    void* const library = dlopen(SHEAVE_OSMESA, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    const bool found = library != nullptr && find(library, "OSMesaCreateContextAttribs", create) &&
                       find(library, "OSMesaDestroyContext", destroy) &&
                       find(library, "OSMesaMakeCurrent", make_current) &&
                       find(library, "OSMesaGetProcAddress", function_of);
    if (found) return {};
    const char* const reason = dlerror();
    return std::string(
               "pictures are drawn by OSMesa (Debian: libosmesa6), which cannot be loaded: ") +
           (reason != nullptr ? reason : SHEAVE_OSMESA);
  }

 private:
  template <class Function>
  static bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
  }
};

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext(const OsmesaLibrary& library, OSMesaContext context)
      : library_(library), context_(context) {}
  ~OsmesaContext() override { library_.destroy(context_); }

  bool make_current() override {
    return library_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, buffer_side,
                                 buffer_side) == GL_TRUE;
  }
  bool load() { return gladLoadGLContext(&functions_, library_.function_of) != 0; }
  const GladGLContext& functions() const override { return functions_; }

 private:
  OsmesaLibrary library_;
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
  OsmesaLibrary library;
  if (std::string fault = library.load(); !fault.empty()) return Error{"", std::move(fault)};
  const OSMesaContext raw = library.create(attributes.data(), nullptr);
  if (raw == nullptr) {
    return Error{
        "", "OSMesa cannot make an OpenGL 3.3 core context; Mesa 22.3 with llvmpipe is known to"};
  }
  auto context = std::make_unique<OsmesaContext>(library, raw);
  if (!context->make_current()) return Error{"", "OSMesa cannot make its context current"};
  if (!context->load()) return Error{"", "OSMesa lacks entry points of OpenGL 3.3 core"};
  return std::unique_ptr<GlContext>(std::move(context));
}

}  // namespace sheave::render
