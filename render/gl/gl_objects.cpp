#include "render/gl/gl_objects.h"

#include <cstddef>
#include <vector>

#include "render/gl/shaders.h"

namespace sheave::render {
namespace {

/// A compiled shader object, or the compiler's message.
Result<GLuint> compile(const GladGLContext& gl, GLenum kind, std::string_view name,
                       std::string_view source) {
  const std::array<std::string_view, 3> parts{"#version 330 core\n", shaders::common, source};
  std::array<const GLchar*, 3> texts{};
  std::array<GLint, 3> lengths{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    texts[i] = parts[i].data();
    lengths[i] = static_cast<GLint>(parts[i].size());
  }
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, static_cast<GLsizei>(parts.size()), texts.data(), lengths.data());
  gl.CompileShader(shader);
  GLint done = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  std::array<GLchar, 1024> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  return Error{"", "shader '" + std::string(name) + "' does not compile: " + log.data()};
}

}  // namespace

Result<std::unique_ptr<Program>> Program::make(const GladGLContext& gl, std::string_view name,
                                               std::string_view vertex, std::string_view fragment) {
  const Result<GLuint> v = compile(gl, GL_VERTEX_SHADER, name, vertex);
  if (!v) return v.errors();
  const Result<GLuint> f = compile(gl, GL_FRAGMENT_SHADER, name, fragment);
  if (!f) {
    gl.DeleteShader(v.value());
    return f.errors();
  }
  const GLuint id = gl.CreateProgram();
  gl.AttachShader(id, v.value());
  gl.AttachShader(id, f.value());
  gl.LinkProgram(id);
  gl.DeleteShader(v.value());
  gl.DeleteShader(f.value());
  auto program = std::make_unique<Program>(gl, id);
  GLint done = GL_FALSE;
  gl.GetProgramiv(id, GL_LINK_STATUS, &done);
  if (done == GL_TRUE) return program;
  std::array<GLchar, 1024> log{};
  gl.GetProgramInfoLog(id, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return Error{"", "shader '" + std::string(name) + "' does not link: " + log.data()};
}

GLint Program::location(const char* name) {
  const auto found = locations_.find(std::string_view(name));
  if (found != locations_.end()) return found->second;
  const GLint place = gl_.GetUniformLocation(id_, name);
  locations_.emplace(name, place);
  return place;
}

GpuMesh::GpuMesh(const GladGLContext& gl) : gl_(gl) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  constexpr auto stride = static_cast<GLsizei>(sizeof(MeshVertex));
  const auto attribute = [&](GLuint index, GLint count, GLenum type, std::size_t offset) {
    const GLboolean normalized = type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE;
    gl_.EnableVertexAttribArray(index);
    // GL takes the offset into the buffer as a pointer.
    gl_.VertexAttribPointer(index, count, type, normalized, stride,
                            reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, GL_FLOAT, offsetof(MeshVertex, position));
  attribute(1, 3, GL_FLOAT, offsetof(MeshVertex, normal));
  attribute(2, 3, GL_FLOAT, offsetof(MeshVertex, outline));
  attribute(3, 4, GL_UNSIGNED_BYTE, offsetof(MeshVertex, paint));
}

GpuMesh::~GpuMesh() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
}

void GpuMesh::upload(const Mesh& mesh) {
  const auto bytes = [](std::size_t count, std::size_t size) {
    return static_cast<GLsizeiptr>(count * size);
  };
  std::vector<std::uint32_t> indices = mesh.triangles;
  indices.insert(indices.end(), mesh.lines.begin(), mesh.lines.end());
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes(mesh.vertices.size(), sizeof(MeshVertex)),
                 mesh.vertices.data(), GL_DYNAMIC_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices.size(), sizeof(std::uint32_t)),
                 indices.data(), GL_DYNAMIC_DRAW);
  triangle_count_ = static_cast<GLsizei>(mesh.triangles.size());
  line_count_ = static_cast<GLsizei>(mesh.lines.size());
}

void GpuMesh::draw_triangles() const {
  gl_.BindVertexArray(array_);
  gl_.DrawElements(GL_TRIANGLES, triangle_count_, GL_UNSIGNED_INT, nullptr);
}

void GpuMesh::draw_lines() const {
  const auto offset = static_cast<std::size_t>(triangle_count_) * sizeof(std::uint32_t);
  gl_.BindVertexArray(array_);
  gl_.DrawElements(GL_LINES, line_count_, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset));
}

RenderTarget::RenderTarget(const GladGLContext& gl, int width, int height)
    : gl_(gl), width_(width), height_(height) {}

RenderTarget::~RenderTarget() {
  gl_.DeleteFramebuffers(static_cast<GLsizei>(framebuffers_.size()), framebuffers_.data());
  gl_.DeleteRenderbuffers(static_cast<GLsizei>(storages_.size()), storages_.data());
}

GLuint RenderTarget::add_storage(GLenum format, int samples, GLenum attachment) {
  GLuint id = 0;
  gl_.GenRenderbuffers(1, &id);
  storages_.push_back(id);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, id);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width_,
                                     height_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, id);
  return id;
}

bool RenderTarget::complete() const {
  return gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

Result<std::unique_ptr<RenderTarget>> RenderTarget::make(const GladGLContext& gl, int width,
                                                         int height, int samples) {
  auto target = std::make_unique<RenderTarget>(gl, width, height);
  const std::size_t count = samples > 1 ? 2 : 1;
  target->framebuffers_.resize(count);
  gl.GenFramebuffers(static_cast<GLsizei>(count), target->framebuffers_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const int here = i == 0 ? samples : 0;
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffers_[i]);
    target->add_storage(GL_RGBA8, here, GL_COLOR_ATTACHMENT0);
    if (i == 0) target->add_storage(GL_DEPTH_COMPONENT24, here, GL_DEPTH_ATTACHMENT);
    if (!target->complete() || gl.GetError() != GL_NO_ERROR) {
      return Error{"", "the driver gives no " + std::to_string(width) + " x " +
                           std::to_string(height) + " framebuffer with " + std::to_string(samples) +
                           " samples"};
    }
  }
  return target;
}

void RenderTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_.front());
  gl_.Viewport(0, 0, width_, height_);
}

void RenderTarget::read(std::vector<std::uint8_t>& rgba) const {
  rgba.resize(std::size_t{4} * static_cast<std::size_t>(width_) *
              static_cast<std::size_t>(height_));
  if (framebuffers_.size() > 1) {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0]);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[1]);
    gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                        GL_NEAREST);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_.back());
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

ShadowMap::ShadowMap(const GladGLContext& gl, int side) : gl_(gl), side_(side) {
  gl_.GenTextures(1, &texture_);
  gl_.GenFramebuffers(1, &framebuffer_);
}

ShadowMap::~ShadowMap() {
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteTextures(1, &texture_);
}

Result<std::unique_ptr<ShadowMap>> ShadowMap::make(const GladGLContext& gl, int side) {
  auto map = std::make_unique<ShadowMap>(gl, side);
  gl.BindTexture(GL_TEXTURE_2D, map->texture_);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT,
                GL_UNSIGNED_INT, nullptr);
  const auto parameter = [&](GLenum name, GLint value) {
    gl.TexParameteri(GL_TEXTURE_2D, name, value);
  };
  parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  parameter(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  parameter(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  parameter(GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  constexpr std::array<float, 4> lit{1.0F, 1.0F, 1.0F, 1.0F};
  gl.TexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit.data());
  gl.BindFramebuffer(GL_FRAMEBUFFER, map->framebuffer_);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map->texture_, 0);
  gl.DrawBuffer(GL_NONE);
  gl.ReadBuffer(GL_NONE);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE ||
      gl.GetError() != GL_NO_ERROR) {
    return Error{"", "the driver gives no shadow map of side " + std::to_string(side)};
  }
  return map;
}

void ShadowMap::bind_for_drawing() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, side_, side_);
}

}  // namespace sheave::render
