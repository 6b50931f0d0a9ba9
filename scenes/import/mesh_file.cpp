#include "scenes/import/mesh_file.h"

#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "engine/shapes/convex_hull.h"

namespace sheave::import {
namespace {

namespace fs = std::filesystem;

/// Most corners of a polyhedron in a scene.
constexpr std::size_t most_corners = 4096;
/// Most points of which a convex hull is made: some seconds.
constexpr std::size_t most_hull_points = 100'000;

/// The bytes of a regular file; an error if there are more than `most`.
Result<std::string> mesh_bytes(const fs::path& path, std::size_t most) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return Error{"", "there is no such file"};
  const std::uintmax_t size = fs::file_size(path, code);
  if (code || size > most) {
    return Error{"", fmt::format("the meshes of a model have more than {} MB together",
                                 most_mesh_bytes >> 20U)};
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) return Error{"", "the file cannot be read"};
  return bytes;
}

}  // namespace

Result<TriangleMesh> read_mesh_file(const fs::path& path, std::size_t& left) {
  const Result<std::string> bytes = mesh_bytes(path, left);
  if (!bytes) return bytes.errors();
  left -= bytes->size();
  std::string kind = path.extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (kind == ".stl") return read_stl(*bytes);
  if (kind == ".obj") return read_obj(*bytes);
  return Error{"", "only files that end in .stl or .obj are read"};
}

MeasuredMesh measure_mesh(const TriangleMesh& mesh) {
  MeasuredMesh made;
  const Result<MeshSolid> solid = solid_of(mesh);
  if (solid) made.solid = *solid;
  if (!solid) made.no_mass = solid.errors().front().message;
  if (mesh.points.size() <= most_hull_points) {
    const Result<Hull> hull = hull_3d(mesh.points);
    if (hull && hull->vertices.size() <= most_corners) made.corners = hull->vertices;
  }
  return made;
}

void scale_mesh(const Vector3& scale, TriangleMesh& mesh) {
  for (Vector3& point : mesh.points) point = scale.cwiseProduct(point);
  if (scale.prod() >= 0.0) return;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace sheave::import
