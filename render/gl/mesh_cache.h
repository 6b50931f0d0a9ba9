#pragma once
// Meshes of the shapes on the GPU, kept from frame to frame.

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>

#include "render/draw_list.h"
#include "render/gl/gl_objects.h"

namespace sheave::render {

class MeshCache {
 public:
  explicit MeshCache(const GladGLContext& gl) : gl_(gl) {}

  /// The mesh of a shape with `segments` facets round curved surfaces; valid until the next
  /// end_frame().
  const GpuMesh& find(const Shape& shape, int segments);
  /// Drops the meshes that the last frame did not use, once the cache is large.
  void end_frame();
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  /// All inputs of the mesh: the kind of shape, its numbers, and for a mesh its identity. The entry
  /// keeps the object alive, so that its address cannot be reused by another mesh.
  struct Key {
    std::size_t kind = 0;
    std::array<double, 5> numbers{};
    const TriangleMesh* mesh = nullptr;
    int segments = 0;
    auto operator<=>(const Key&) const = default;
  };
  struct Entry {
    std::unique_ptr<GpuMesh> mesh;
    std::shared_ptr<const TriangleMesh> source;
    std::uint64_t last_used = 0;
  };
  static Key key_of(const Shape& shape, int segments);

  const GladGLContext& gl_;
  std::map<Key, Entry> entries_;
  std::uint64_t frame_ = 0;
};

}  // namespace sheave::render
