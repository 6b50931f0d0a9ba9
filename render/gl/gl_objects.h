#pragma once
// Owners of GL objects. Each keeps a reference to the function table of its context. The context
// must outlive the owner and be current whenever an owner is made, used or destroyed.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>
#include <glad/gl.h>

#include "engine/result.h"
#include "render/mesh.h"

namespace sheave::render {

/// A linked vertex and fragment shader.
class Program {
 public:
  /// `name` appears in errors. Compiles "#version 330 core" + common + each source.
  static Result<std::unique_ptr<Program>> make(const GladGLContext& gl, std::string_view name,
                                               std::string_view vertex, std::string_view fragment);
  Program(const GladGLContext& gl, GLuint id) : gl_(gl), id_(id) {}
  ~Program() { gl_.DeleteProgram(id_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { gl_.UseProgram(id_); }
  // Setters act on the program in use. A name that the linker removed is ignored.
  void set(const char* name, int value) { gl_.Uniform1i(location(name), value); }
  void set(const char* name, float value) { gl_.Uniform1f(location(name), value); }
  void set(const char* name, const Eigen::Vector2f& v) {
    gl_.Uniform2f(location(name), v[0], v[1]);
  }
  void set(const char* name, const Eigen::Vector3f& v) {
    gl_.Uniform3f(location(name), v[0], v[1], v[2]);
  }
  void set(const char* name, const Eigen::Matrix3f& m) {
    gl_.UniformMatrix3fv(location(name), 1, GL_FALSE, m.data());
  }
  void set(const char* name, const Eigen::Matrix4f& m) {
    gl_.UniformMatrix4fv(location(name), 1, GL_FALSE, m.data());
  }

 private:
  GLint location(const char* name);

  const GladGLContext& gl_;
  GLuint id_;
  std::map<std::string, GLint, std::less<>> locations_;
};

/// A mesh in buffers of the GPU.
class GpuMesh {
 public:
  explicit GpuMesh(const GladGLContext& gl);
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  void upload(const Mesh& mesh);
  void draw_triangles() const;
  void draw_lines() const;
  [[nodiscard]] bool has_lines() const { return line_count_ > 0; }

 private:
  const GladGLContext& gl_;
  GLuint array_ = 0;
  std::array<GLuint, 2> buffers_{};  ///< vertices, indices (triangles, then lines)
  GLsizei triangle_count_ = 0;       ///< indices
  GLsizei line_count_ = 0;
};

/// A framebuffer with colour and depth. A multisampled one resolves into a plain one for reading.
class RenderTarget {
 public:
  /// samples: number of samples per pixel; 0 or 1 means no multisampling.
  static Result<std::unique_ptr<RenderTarget>> make(const GladGLContext& gl, int width, int height,
                                                    int samples);
  RenderTarget(const GladGLContext& gl, int width, int height);
  ~RenderTarget();
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;

  void bind() const;
  /// Pixels as RGBA rows from bottom to top.
  void read(std::vector<std::uint8_t>& rgba) const;

 private:
  GLuint add_storage(GLenum format, int samples, GLenum attachment);
  [[nodiscard]] bool complete() const;

  const GladGLContext& gl_;
  int width_;
  int height_;
  /// the framebuffer for drawing; then, if multisampled, the plain one for reading
  std::vector<GLuint> framebuffers_;
  std::vector<GLuint> storages_;
};

/// A depth texture seen from the light, with hardware comparison.
class ShadowMap {
 public:
  static Result<std::unique_ptr<ShadowMap>> make(const GladGLContext& gl, int side);
  ShadowMap(const GladGLContext& gl, int side);
  ~ShadowMap();
  ShadowMap(const ShadowMap&) = delete;
  ShadowMap& operator=(const ShadowMap&) = delete;

  void bind_for_drawing() const;
  void bind_for_reading() const { gl_.BindTexture(GL_TEXTURE_2D, texture_); }
  [[nodiscard]] int side() const { return side_; }

 private:
  const GladGLContext& gl_;
  int side_;
  GLuint framebuffer_ = 0;
  GLuint texture_ = 0;
};

}  // namespace sheave::render
