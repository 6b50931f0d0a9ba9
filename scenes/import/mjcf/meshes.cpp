// <asset><mesh>: the solid of a mesh, and the corners of its convex hull.

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "engine/shapes/convex_hull.h"
#include "scenes/import/file_within.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
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

/// The path that a mesh names, with the folder of meshes.
std::string mesh_path(const Compiler& compiler, const std::string& file) {
  const fs::path named = compiler.strip_paths ? fs::path(file).filename() : fs::path(file);
  return (fs::path(compiler.mesh_folder) / named).string();
}

/// Moves the points by refpos, refquat and scale, in this order as MuJoCo does.
void place_mesh(Attributes& attributes, TriangleMesh& mesh) {
  const Vector3 origin = attributes.vector("refpos").value_or(Vector3::Zero());
  const std::vector<double> turn = attributes.numbers("refquat", 4, 4);
  const Vector3 scale = attributes.vector("scale").value_or(Vector3(Vector3::Ones()));
  Quaternion back = Quaternion::Identity();
  if (!turn.empty()) {
    const Quaternion given(turn[0], turn[1], turn[2], turn[3]);
    if (given.norm() > 1e-15) back = given.normalized().conjugate();
  }
  for (Vector3& point : mesh.points) point = scale.cwiseProduct(back * (point - origin));
  if (scale.prod() >= 0.0) return;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

/// Reads the file of a mesh; the error is without the name of the mesh.
Result<TriangleMesh> mesh_of_file(const fs::path& path, std::size_t& left) {
  const Result<std::string> bytes = mesh_bytes(path, left);
  if (!bytes) return bytes.errors();
  left -= bytes->size();
  std::string kind = path.extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (kind == ".stl") return read_stl(*bytes);
  if (kind == ".obj") return read_obj(*bytes);
  return Error{"", "only files that end in .stl or .obj are read"};
}

void read_mesh(const xml::Element& element, std::size_t& left, Reader& reader) {
  Attributes attributes = reader.attributes(element, "mesh");
  const std::optional<std::string> file = attributes.text("file");
  const std::string name =
      attributes.text("name").value_or(fs::path(file.value_or("")).stem().string());
  Mesh made;
  const auto skip = [&](const std::string& reason) {
    made.fault = fmt::format("mesh \"{}\" (line {}): {}", name, element.line, reason);
    reader.log.skipped(element, reason);
    reader.model.meshes.insert_or_assign(name, made);
  };
  if (!file) return skip("only meshes of files are read");
  const std::string named = mesh_path(reader.model.compiler, *file);
  const std::optional<fs::path> path = path_within(folder_of(reader.model.file), named);
  if (!path) {
    reader.log.error(element,
                     fmt::format("file \"{}\": the file must lie in the folder of the model or "
                                 "below; copy it there",
                                 named),
                     {}, FaultCode::unreadable);
    return;
  }
  Result<TriangleMesh> mesh = mesh_of_file(*path, left);
  if (!mesh) return skip(fmt::format("file \"{}\": {}", named, mesh.errors().front().message));
  place_mesh(attributes, *mesh);
  if (const auto inertia = attributes.text("inertia"); inertia && *inertia != "exact") {
    reader.log.changed(
        element, fmt::format("inertia {}: the mass is that of the solid, as with exact", *inertia));
  }
  attributes.finish({"class", "smoothnormal", "content_type", "maxhullvert"});
  const Result<MeshSolid> solid = solid_of(*mesh);
  if (solid) made.solid = *solid;
  if (!solid) made.no_mass = solid.errors().front().message;
  if (mesh->points.size() <= most_hull_points) {
    const Result<Hull> hull = hull_3d(mesh->points);
    if (hull && hull->vertices.size() <= most_corners) made.corners = hull->vertices;
  }
  reader.log.same(element, fmt::format("{} triangles, the hull has {} corners",
                                       mesh->triangles.size(), made.corners.size()));
  reader.model.meshes.insert_or_assign(name, std::move(made));
}

}  // namespace

void read_meshes(const xml::Element& element, std::size_t& left, Reader& reader) {
  for (const xml::Element& child : element.children) {
    if (child.tag == "mesh") read_mesh(child, left, reader);
  }
}

}  // namespace sheave::import::mjcf
