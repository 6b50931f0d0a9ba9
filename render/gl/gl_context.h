#pragma once
// A GL context without a screen. This interface hides how the context is created; the rest of
// render/gl uses only the function table.

#include <memory>

#include "engine/result.h"

struct GladGLContext;

namespace sheave::render {

class GlContext {
 public:
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes this the calling thread's context; needed before any call through functions().
  /// False if the driver refuses.
  [[nodiscard]] virtual bool make_current() = 0;
  /// GL 3.3 core entry points; valid as long as the context.
  [[nodiscard]] virtual const GladGLContext& functions() const = 0;

 protected:
  GlContext() = default;
};

/// A GL 3.3 core context of Mesa's software rasteriser; current on return.
[[nodiscard]] Result<std::unique_ptr<GlContext>> make_osmesa_context();

}  // namespace sheave::render
