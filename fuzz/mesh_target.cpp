#include <cmath>
#include <string_view>

#include "fuzz/target.h"
#include "scenes/import/mesh.h"

namespace sheave::fuzz {
namespace {

void look_at(const Result<import::TriangleMesh>& read) {
  if (!read) {
    require(!read.errors().empty() && !read.errors().front().message.empty(),
            "a mesh that is refused without a message");
    return;
  }
  const import::TriangleMesh& mesh = *read;
  require(mesh.triangles.size() <= import::most_triangles, "more triangles than are allowed");
  for (const Vector3& point : mesh.points) require(point.allFinite(), "a point that is no point");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      require(corner < mesh.points.size(), "a triangle without its points");
    }
    require(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0],
            "a triangle with two corners");
  }
  const Result<import::MeshSolid> solid = import::solid_of(mesh);
  if (!solid) {
    require(!solid.errors().front().message.empty(), "no solid, without a message");
    return;
  }
  require(solid->volume > 0.0, "a solid without volume");
  require(std::isfinite(solid->volume) && solid->center.allFinite() && solid->inertia.allFinite(),
          "a solid whose mass is no number");
}

}  // namespace

void try_mesh(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  look_at(import::read_stl(text));
  look_at(import::read_obj(text));
}

}  // namespace sheave::fuzz
