// <link>: mass and shapes. A link's shapes are those of <collision>, or of <visual> if no part of
// <collision> is a box, a cylinder or a sphere.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/urdf/reader.h"

namespace sheave::import::urdf {
namespace {

using mjcf::Geom;
using mjcf::GeomType;
using mjcf::Inertial;

/// A turn about x, then y, then z, all of the outer frame.
Quaternion from_roll_pitch_yaw(const Vector3& angles) {
  return mjcf::turn_about(Vector3::UnitZ(), angles.z()) *
         mjcf::turn_about(Vector3::UnitY(), angles.y()) *
         mjcf::turn_about(Vector3::UnitX(), angles.x());
}

void read_inertial(const xml::Element& element, mjcf::Body& body, Log& log) {
  const mjcf::Frame frame = read_origin(element, log);
  const xml::Element* const mass = child_of(element, "mass", log);
  const xml::Element* const inertia = child_of(element, "inertia", log);
  if (mass == nullptr || inertia == nullptr) {
    log.error(element, "<mass> and <inertia> are needed", {}, FaultCode::missing_key);
    return;
  }
  Attributes of_mass(*mass, nullptr, log);
  Inertial own;
  own.mass = of_mass.positive_or_zero("value").value_or(0.0);
  of_mass.finish({});
  Attributes moments(*inertia, nullptr, log);
  const auto number = [&](const char* name) { return moments.number(name).value_or(0.0); };
  own.inertia(0, 0) = number("ixx");
  own.inertia(1, 1) = number("iyy");
  own.inertia(2, 2) = number("izz");
  own.inertia(0, 1) = own.inertia(1, 0) = number("ixy");
  own.inertia(0, 2) = own.inertia(2, 0) = number("ixz");
  own.inertia(1, 2) = own.inertia(2, 1) = number("iyz");
  moments.finish({});
  body.inertial = own.seen_from(frame);
  body.given = body.inertial;
  log.same(element, "mass and inertia of the link");
  log.same(*mass, "a part of it");
  log.same(*inertia, "a part of it");
}

/// A size that must be above 0.
double size_of(Attributes& attributes, std::string_view name) {
  const auto value = attributes.number(name);
  if (value && *value > 0.0) return *value;
  if (value || !attributes.has(name))
    attributes.error(name, "given and > 0", FaultCode::out_of_range);
  return 1.0;
}

/// Reads the only child of <geometry>; false if it has no counterpart.
bool read_shape(const xml::Element& shape, Geom& geom, MeshReader& meshes, Log& log) {
  if (shape.tag == "mesh") {
    const std::string fault = meshes.read(shape, geom, log);
    if (!fault.empty()) log.skipped(shape, fault);
    return fault.empty();
  }
  Attributes attributes(shape, nullptr, log);
  if (shape.tag == "box") {
    geom.type = GeomType::box;
    const auto size = attributes.vector("size");
    if (size && size->minCoeff() > 0.0) {
      geom.size = 0.5 * *size;
    } else if (size || !attributes.has("size")) {
      attributes.error("size", "given, three numbers > 0", FaultCode::out_of_range);
    }
  } else if (shape.tag == "sphere") {
    geom.type = GeomType::sphere;
    geom.size[0] = size_of(attributes, "radius");
  } else if (shape.tag == "cylinder" || shape.tag == "capsule") {
    geom.type = shape.tag == "capsule" ? GeomType::capsule : GeomType::cylinder;
    geom.size[0] = size_of(attributes, "radius");
    geom.size[1] = 0.5 * size_of(attributes, "length");
  } else {
    log.skipped(shape, "no shape that is known here");
    return false;
  }
  attributes.finish({});
  return true;
}

/// Reads a <collision> or a <visual>; false if its shape has no counterpart.
bool read_part(const xml::Element& part, int body, mjcf::Model& model, MeshReader& meshes,
               Log& log) {
  const xml::Element* const geometry = child_of(part, "geometry", log);
  if (geometry == nullptr || geometry->children.size() != 1) {
    log.error(part, "<geometry> with one shape is needed", {}, FaultCode::missing_key);
    return false;
  }
  Geom geom;
  geom.element = &part;
  geom.body = body;
  geom.frame = read_origin(part, log);
  if (!read_shape(geometry->children.front(), geom, meshes, log)) return false;
  model.bodies[at(body)].geoms.push_back(static_cast<int>(model.geoms.size()));
  model.geoms.push_back(std::move(geom));
  return true;
}

/// Notes about the inner parts of a <collision> or <visual>, which belong to it.
void note_inner(const xml::Element& part, bool taken, Log& log) {
  for (const xml::Element& child : part.children) {
    if (child.tag == "material") {
      log.skipped(child, "looks have no counterpart");
    } else if (child.tag == "geometry") {
      if (taken) log.same(child, "the shape of a body");
      for (const xml::Element& shape : child.children) {
        if (taken) log.same(shape, "the shape of a body");
      }
    } else if (child.tag != "origin") {
      log.skipped(child, "no part that is known here");
    }
  }
}

}  // namespace

const xml::Element* child_of(const xml::Element& element, std::string_view tag, Log& log) {
  const xml::Element* found = nullptr;
  for (const xml::Element& child : element.children) {
    if (child.tag != tag) continue;
    if (found != nullptr) {
      log.error(child, fmt::format("a second <{}>; give one", tag), {}, FaultCode::meaning);
    }
    found = &child;
  }
  return found;
}

mjcf::Frame read_origin(const xml::Element& element, Log& log) {
  mjcf::Frame frame;
  const xml::Element* const origin = child_of(element, "origin", log);
  if (origin == nullptr) return frame;
  Attributes attributes(*origin, nullptr, log);
  frame.position = attributes.vector("xyz").value_or(Vector3::Zero());
  if (const auto angles = attributes.vector("rpy")) {
    frame.orientation = from_roll_pitch_yaw(*angles);
  }
  attributes.finish({});
  log.same(*origin, "a frame");
  return frame;
}

void read_link(const xml::Element& element, int body, mjcf::Model& model, MeshReader& meshes,
               Log& log) {
  if (const xml::Element* const inertial = child_of(element, "inertial", log)) {
    read_inertial(*inertial, model.bodies[at(body)], log);
  }
  bool collides = false;
  for (const char* const tag : {"collision", "visual"}) {
    for (const xml::Element& child : element.children) {
      if (child.tag != tag) continue;
      if (collides && child.tag == "visual") {
        log.skipped(child, "the shapes of <collision> are taken");
        note_inner(child, false, log);
        continue;
      }
      const bool taken = read_part(child, body, model, meshes, log);
      note_inner(child, taken, log);
      if (!taken) log.skipped(child, "its shape is not taken");
    }
    collides = !model.bodies[at(body)].geoms.empty();
  }
  for (const xml::Element& child : element.children) {
    if (child.tag != "inertial" && child.tag != "collision" && child.tag != "visual") {
      log.skipped(child, "no part of a link that is known here");
    }
  }
}

}  // namespace sheave::import::urdf
