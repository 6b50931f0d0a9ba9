// <asset><mesh>: the solid of a mesh, and the corners of its convex hull.

#include <fmt/format.h>

#include "scenes/import/file_within.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

namespace fs = std::filesystem;

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
  for (Vector3& point : mesh.points) point = back * (point - origin);
  scale_mesh(scale, mesh);
}

void read_mesh(const xml::Element& element, std::size_t& left, Reader& reader) {
  Attributes attributes = reader.attributes(element, "mesh");
  const std::optional<std::string> file = attributes.text("file");
  const std::string name =
      attributes.text("name").value_or(fs::path(file.value_or("")).stem().string());
  MeasuredMesh made;
  const auto skip = [&](const std::string& reason) {
    made.fault = fmt::format("mesh \"{}\" (line {}): {}", name, element.line, reason);
    reader.log.skipped(element, reason);
    reader.model.meshes.insert_or_assign(name, made);
  };
  if (!file) return skip("only meshes of files are read");
  const std::string named = mesh_path(reader.model.compiler, *file);
  const std::optional<fs::path> path =
      path_within(folder_of(reader.model.file), named, reader.model.folder);
  if (!path) {
    reader.log.error(element, fmt::format("file \"{}\": {}", named, file_place), {},
                     FaultCode::unreadable);
    return;
  }
  Result<TriangleMesh> mesh = read_mesh_file(*path, left);
  if (!mesh) return skip(fmt::format("file \"{}\": {}", named, mesh.errors().front().message));
  place_mesh(attributes, *mesh);
  if (const auto inertia = attributes.text("inertia"); inertia && *inertia != "exact") {
    reader.log.changed(
        element, fmt::format("inertia {}: the mass is that of the solid, as with exact", *inertia));
  }
  attributes.finish({"class", "smoothnormal", "content_type", "maxhullvert"});
  made = measure_mesh(*mesh);
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
