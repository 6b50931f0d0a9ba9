// <geom>, <site> and <inertial>.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"
#include "scenes/import/mjcf/shells.h"

namespace sheave::import::mjcf {
namespace {

GeomType type_of(const std::string& word) {
  if (word == "plane") return GeomType::plane;
  if (word == "sphere") return GeomType::sphere;
  if (word == "capsule") return GeomType::capsule;
  if (word == "ellipsoid") return GeomType::ellipsoid;
  if (word == "cylinder") return GeomType::cylinder;
  if (word == "box") return GeomType::box;
  if (word == "mesh") return GeomType::mesh;
  return GeomType::other;
}

/// How many sizes a type has.
std::size_t sizes_of(GeomType type) {
  switch (type) {
    case GeomType::sphere:
      return 1;
    case GeomType::capsule:
    case GeomType::cylinder:
      return 2;
    default:
      return 3;
  }
}

double volume_of(const Geom& geom) {
  const Vector3& s = geom.size;
  switch (geom.type) {
    case GeomType::sphere:
      return 4.0 / 3.0 * pi * s[0] * s[0] * s[0];
    case GeomType::capsule:
      return pi * s[0] * s[0] * (4.0 / 3.0 * s[0] + 2.0 * s[1]);
    case GeomType::cylinder:
      return pi * s[0] * s[0] * 2.0 * s[1];
    case GeomType::ellipsoid:
      return 4.0 / 3.0 * pi * s[0] * s[1] * s[2];
    case GeomType::box:
      return 8.0 * s[0] * s[1] * s[2];
    default:
      return 0.0;
  }
}

/// Moments of inertia about the centre, own axes.
Vector3 moments_of(const Geom& geom, double mass) {
  const Vector3 s = geom.size;
  const Vector3 squares = s.cwiseProduct(s);
  switch (geom.type) {
    case GeomType::sphere:
      return Vector3::Constant(0.4 * mass * squares[0]);
    case GeomType::cylinder: {
      const double across = mass * (3.0 * squares[0] + 4.0 * squares[1]) / 12.0;
      return {across, across, 0.5 * mass * squares[0]};
    }
    case GeomType::capsule: {
      const double length = 2.0 * s[1];
      const double balls = mass * 4.0 * s[0] / (4.0 * s[0] + 3.0 * length);
      const double bar = mass - balls;
      const double own = 0.4 * balls * squares[0];
      const double across = bar * (3.0 * squares[0] + length * length) / 12.0 + own +
                            balls * length * (3.0 * s[0] + 2.0 * length) / 8.0;
      return {across, across, 0.5 * bar * squares[0] + own};
    }
    default: {
      const double share = geom.type == GeomType::ellipsoid ? mass / 5.0 : mass / 3.0;
      return share *
             Vector3(squares[1] + squares[2], squares[0] + squares[2], squares[0] + squares[1]);
    }
  }
}

/// Sets position, orientation and length from the two ends; false if they are not given.
bool read_ends(Attributes& attributes, Frame& frame, double& half_length) {
  const std::vector<double> ends = attributes.numbers("fromto", 6, 6);
  if (ends.empty()) return false;
  const Vector3 from(ends[0], ends[1], ends[2]);
  const Vector3 to(ends[3], ends[4], ends[5]);
  half_length = 0.5 * (to - from).norm();
  if (!(half_length > 0.0)) {
    attributes.error("fromto", "two different points", FaultCode::out_of_range);
    return false;
  }
  frame.position = 0.5 * (from + to);
  frame.orientation = from_z_axis(to - from);
  return true;
}

void read_size(Attributes& attributes, Geom& geom) {
  const std::vector<double> sizes = attributes.numbers("size", 1, 3);
  if (sizes.empty() && attributes.has("size")) return;  // a fault already
  for (std::size_t i = 0; i < sizes.size(); ++i) geom.size[static_cast<int>(i)] = sizes[i];
  double half_length = 0.0;
  const bool by_ends = read_ends(attributes, geom.frame, half_length);
  const bool round = geom.type == GeomType::capsule || geom.type == GeomType::cylinder;
  if (by_ends) geom.size[round ? 1 : 2] = half_length;
  if (geom.type == GeomType::plane || geom.type == GeomType::other || geom.type == GeomType::mesh) {
    return;
  }
  for (std::size_t i = 0; i < sizes_of(geom.type); ++i) {
    if (geom.size[static_cast<int>(i)] > 0.0) continue;
    attributes.error("size", "given and > 0 [m]: radius, or half lengths", FaultCode::out_of_range);
    return;
  }
}

/// The known mesh of a geom; null if there is none.
const MeasuredMesh* mesh_of(const Geom& geom, const Model& model) {
  const auto found = model.meshes.find(geom.mesh);
  return found == model.meshes.end() || !found->second.fault.empty() ? nullptr : &found->second;
}

void read_mass(Attributes& attributes, Geom& geom, const Model& model) {
  const Compiler& compiler = model.compiler;
  const auto mass = attributes.positive_or_zero("mass");
  const auto density = attributes.positive_or_zero("density");
  const auto group = attributes.number("group").value_or(0.0);
  const bool shell = attributes.flag("shellinertia").value_or(false);
  if (geom.type == GeomType::plane || geom.type == GeomType::other) return;
  if (group < compiler.groups[0] || group > compiler.groups[1]) return;
  const MeasuredMesh* const mesh = geom.type == GeomType::mesh ? mesh_of(geom, model) : nullptr;
  if (geom.type == GeomType::mesh && (mesh == nullptr || !mesh->no_mass.empty())) return;
  // The density of a shell is that per area.
  const double volume = mesh != nullptr ? mesh->solid.volume
                        : shell         ? shell_area(geom)
                                        : volume_of(geom);
  const double value = mass ? *mass : density.value_or(1000.0) * volume;
  if (!std::isfinite(value)) {
    attributes.error("size", "such that the mass is finite", FaultCode::out_of_range);
    return;
  }
  if (!(value > 0.0)) return;
  const Vector3 moments = shell ? shell_moments(geom, value) : moments_of(geom, value);
  const Inertial own =
      mesh != nullptr ? Inertial{value, mesh->solid.center, value / volume * mesh->solid.inertia}
                      : Inertial{value, Vector3::Zero(), moments.asDiagonal()};
  geom.inertial = own.seen_from(geom.frame);
}

/// Tells how a mesh is taken; false if there is none of that name.
bool note_mesh(Attributes& attributes, const Geom& geom, Reader& reader) {
  const auto found = reader.model.meshes.find(geom.mesh);
  if (found == reader.model.meshes.end()) {
    attributes.error("mesh", "the name of a mesh in <asset>", FaultCode::meaning);
    return false;
  }
  const MeasuredMesh& mesh = found->second;
  if (!mesh.fault.empty()) {
    reader.log.skipped(*geom.element, "neither shape nor mass: " + mesh.fault);
  } else if (!mesh.no_mass.empty()) {
    reader.log.changed(*geom.element,
                       fmt::format("mesh \"{}\" has no mass: {}; give the body an <inertial>",
                                   geom.mesh, mesh.no_mass));
  }
  return true;
}

}  // namespace

Inertial solid_inertial(const Geom& geom, const Model& model, double density) {
  const MeasuredMesh* const mesh = geom.type == GeomType::mesh ? mesh_of(geom, model) : nullptr;
  if (geom.type == GeomType::mesh && (mesh == nullptr || !mesh->no_mass.empty())) return {};
  if (mesh != nullptr) {
    return Inertial{density * mesh->solid.volume, mesh->solid.center, density * mesh->solid.inertia}
        .seen_from(geom.frame);
  }
  const double mass = density * volume_of(geom);
  return Inertial{mass, Vector3::Zero(), moments_of(geom, mass).asDiagonal()}.seen_from(geom.frame);
}

void read_geom(const xml::Element& element, int body, Reader& reader) {
  Attributes attributes = reader.attributes(element, "geom");
  Geom geom;
  geom.element = &element;
  geom.body = body;
  geom.name = attributes.text("name").value_or("");
  const std::string type = attributes
                               .choice("type", {"plane", "hfield", "sphere", "capsule", "ellipsoid",
                                                "cylinder", "box", "mesh", "sdf"})
                               .value_or("sphere");
  geom.type = type_of(type);
  geom.frame = read_frame(attributes, reader.model.compiler);
  read_size(attributes, geom);
  if (geom.type == GeomType::mesh) geom.mesh = attributes.text("mesh").value_or("");
  read_mass(attributes, geom, reader.model);
  if (geom.type == GeomType::mesh && !note_mesh(attributes, geom, reader)) return;
  if (geom.type == GeomType::mesh && attributes.flag("shellinertia").value_or(false)) {
    reader.log.changed(element, "shellinertia: the mass of a mesh is that of its solid");
  }
  if (geom.type == GeomType::other) {
    reader.log.skipped(element, fmt::format("a {} gives neither shape nor mass here", type));
  } else if (geom.type == GeomType::plane) {
    reader.log.skipped(element,
                       "a plane is for contacts alone; a scene has \"ground\" or "
                       "\"colliders\" for them");
  }
  // Looks and contacts; the report tells about contacts once.
  attributes.finish({"rgba", "material", "user", "contype", "conaffinity", "condim", "priority",
                     "friction", "solmix", "solref", "solimp", "margin", "gap", "fitscale",
                     "hfield", "mesh", "fluidshape", "fluidcoef"});
  const int number = static_cast<int>(reader.model.geoms.size());
  reader.enter(reader.model.geom_names, geom.name, number, element);
  reader.model.bodies[static_cast<std::size_t>(body)].geoms.push_back(number);
  reader.model.geoms.push_back(std::move(geom));
}

void read_site(const xml::Element& element, int body, Reader& reader) {
  Attributes attributes = reader.attributes(element, "site");
  Site site;
  site.element = &element;
  site.body = body;
  site.name = attributes.text("name").value_or("");
  site.frame = read_frame(attributes, reader.model.compiler);
  double half_length = 0.0;
  read_ends(attributes, site.frame, half_length);
  attributes.finish({"type", "size", "group", "rgba", "material", "user"});
  reader.enter(reader.model.site_names, site.name, static_cast<int>(reader.model.sites.size()),
               element);
  reader.model.sites.push_back(std::move(site));
}

void read_inertial(const xml::Element& element, Body& body, Reader& reader) {
  Attributes attributes(element, nullptr, reader.log);
  const auto mass = attributes.positive_or_zero("mass");
  if (!mass) {
    if (!attributes.has("mass")) attributes.error("mass", "given [kg]", FaultCode::missing_key);
    return;
  }
  const Frame frame = read_frame(attributes, reader.model.compiler);
  Inertial inertial{*mass, Vector3::Zero(), Matrix3::Zero()};
  if (const auto d = attributes.vector("diaginertia")) inertial.inertia = d->asDiagonal();
  if (const auto f = attributes.numbers("fullinertia", 6, 6); !f.empty()) {
    inertial.inertia << f[0], f[3], f[4], f[3], f[1], f[5], f[4], f[5], f[2];
    if (attributes.has("diaginertia")) {
      attributes.error("fullinertia", "left out, or diaginertia", FaultCode::exclusive_keys);
    }
  }
  attributes.finish({});
  body.given = inertial.seen_from(frame);
  reader.log.same(element, fmt::format("mass {} kg", *mass));
}

}  // namespace sheave::import::mjcf
