#include "render/gl/mesh_cache.h"

#include "render/solid_mesh.h"

namespace sheave::render {
namespace {

constexpr std::size_t many_meshes = 256;

using Numbers = std::array<double, 5>;

Numbers numbers_of(const BoxShape& s) { return {s.size.x(), s.size.y(), s.size.z()}; }
Numbers numbers_of(const SphereShape& s) { return {s.radius}; }
Numbers numbers_of(const CylinderShape& s) { return {s.radius, s.length}; }
Numbers numbers_of(const CapsuleShape& s) { return {s.radius, s.length}; }
Numbers numbers_of(const SheaveShape& s) {
  return {s.radius, s.length, s.cable_radius, s.groove_width, static_cast<double>(s.spokes)};
}
Numbers numbers_of(const MeshShape& /*s*/) { return {}; }

}  // namespace

MeshCache::Key MeshCache::key_of(const Shape& shape, int segments) {
  Key key;
  key.kind = shape.index();
  key.numbers = std::visit([](const auto& s) { return numbers_of(s); }, shape);
  if (const auto* m = std::get_if<MeshShape>(&shape)) key.mesh = m->mesh.get();
  const bool flat = std::holds_alternative<BoxShape>(shape) || key.mesh != nullptr;
  key.segments = flat ? 0 : segments;
  return key;
}

const GpuMesh& MeshCache::find(const Shape& shape, int segments) {
  Entry& entry = entries_[key_of(shape, segments)];
  if (!entry.mesh) {
    entry.mesh = std::make_unique<GpuMesh>(gl_);
    entry.mesh->upload(make_mesh(shape, segments));
    if (const auto* m = std::get_if<MeshShape>(&shape)) entry.source = m->mesh;
  }
  entry.last_used = frame_;
  return *entry.mesh;
}

void MeshCache::end_frame() {
  if (entries_.size() > many_meshes) {
    std::erase_if(entries_, [&](const auto& item) { return item.second.last_used != frame_; });
  }
  ++frame_;
}

}  // namespace sheave::render
