// <mesh>: its file, and masses of links that have none.
//
// "package://NAME/REST" is the file REST of the package NAME. A package is a folder of this name: the
// folder of the model, one around it, or one in such a folder, as far as Options::folder reaches.

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/file_within.h"
#include "scenes/import/mjcf/reader.h"
#include "scenes/import/urdf/reader.h"

namespace sheave::import::urdf {
namespace {

namespace fs = std::filesystem;

constexpr double shape_density = 1000.0;  // [kg/m3], of links without mass, as MuJoCo has it

/// An existing file of a package in the folders around that of the model; none if there is no such.
std::optional<fs::path> file_of_package(const fs::path& home, const std::string& named,
                                        const fs::path& allowed) {
  constexpr int most_folders = 32;
  const std::size_t slash = named.find('/');
  if (slash == std::string::npos) return {};
  const fs::path package = named.substr(0, slash);
  const fs::path rest = named.substr(slash + 1);
  if (rest.is_absolute() || package.empty()) return {};
  std::error_code code;
  std::string up;
  for (int i = 0; i < most_folders; ++i, up += "../") {
    const fs::path folder = fs::weakly_canonical(home / up, code);
    if (code) return {};
    std::vector<fs::path> candidates{fs::path(up) / package / rest};
    if (folder.filename() == package) candidates.push_back(fs::path(up) / rest);
    for (const fs::path& candidate : candidates) {
      const auto path = path_within(home, candidate.string(), allowed);
      if (path && fs::is_regular_file(*path, code)) return path;
    }
    if (folder == folder.parent_path()) return {};
  }
  return {};
}

/// The path of a mesh; none if there is none that may be read.
std::optional<fs::path> file_of_mesh(const mjcf::Model& model, const std::string& named) {
  const fs::path home = folder_of(model.file);
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (named.starts_with(scheme)) {
      return file_of_package(home, named.substr(scheme.size()), model.folder);
    }
  }
  return path_within(home, named, model.folder);
}

}  // namespace

MeasuredMesh MeshReader::measured(const std::string& named, const Vector3& scale) {
  MeasuredMesh made;
  const std::optional<fs::path> path = file_of_mesh(model_, named);
  if (!path) {
    made.fault = fmt::format("file \"{}\": {}", named, file_place);
    return made;
  }
  Result<TriangleMesh> mesh = read_mesh_file(*path, left_);
  if (!mesh) {
    made.fault = fmt::format("file \"{}\": {}", named, mesh.errors().front().message);
    return made;
  }
  scale_mesh(scale, *mesh);
  return measure_mesh(*mesh);
}

std::string MeshReader::read(const xml::Element& element, mjcf::Geom& geom, Log& log) {
  Attributes attributes(element, nullptr, log);
  const std::string file = attributes.text("filename").value_or("");
  const Vector3 scale = attributes.vector("scale").value_or(Vector3(Vector3::Ones()));
  attributes.finish({});
  if (file.empty()) {
    attributes.error("filename", "the name of a file", FaultCode::missing_key);
    return "it has no file";
  }
  geom.type = mjcf::GeomType::mesh;
  geom.mesh = fmt::format("{} {} {} {}", file, scale.x(), scale.y(), scale.z());
  const auto [place, is_new] = model_.meshes.try_emplace(geom.mesh);
  if (is_new) place->second = measured(file, scale);
  return place->second.fault;
}

void find_masses_of_shapes(mjcf::Model& model, Log& log) {
  const std::vector<mjcf::Inertial> carried = mjcf::carried_masses(model);
  std::vector<bool> lacks(model.bodies.size(), false);
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    mjcf::Body& body = model.bodies[i];
    lacks[i] = body.joints.empty() ? lacks[at(body.parent)] : carried[i].mass == 0.0;
    if (!lacks[i]) continue;
    for (const int geom : body.geoms) {
      body.inertial.add(mjcf::solid_inertial(model.geoms[at(geom)], model, shape_density));
    }
    if (body.inertial.mass == 0.0) continue;
    log.changed(*body.element,
                fmt::format("without mass in the model; here it has {} kg, the mass of its shapes "
                            "at {} kg/m3",
                            number_text(body.inertial.mass, 6), shape_density));
  }
}

}  // namespace sheave::import::urdf
