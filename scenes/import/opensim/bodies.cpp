// <Body> and <Ground>: names, masses; and wrap objects.

#include <algorithm>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr double point_radius = 1e-4;  // of a body without inertia [m]

Vector3 three(const std::vector<double>& list, std::size_t first) {
  return {list[first], list[first + 1], list[first + 2]};
}

void read_mass(const xml::Element& element, mjcf::Inertial& inertial, Reader& reader) {
  Properties& properties = reader.properties;
  inertial.mass = properties.number(element, "mass").value_or(0.0);
  if (inertial.mass < 0.0) {
    reader.log.error(element, "mass must be >= 0", properties.text(element, "mass"),
                     FaultCode::out_of_range);
  }
  inertial.center = properties.vector(element, "mass_center").value_or(Vector3::Zero());
  Vector3 moments = Vector3::Zero();
  Vector3 products = Vector3::Zero();  // xy, xz, yz
  if (const auto all = properties.numbers(element, "inertia", 6, 6); !all.empty()) {
    moments = three(all, 0);
    products = three(all, 3);
  } else {
    const auto number = [&](const char* name) {
      return properties.number(element, name).value_or(0.0);
    };
    moments = {number("inertia_xx"), number("inertia_yy"), number("inertia_zz")};
    products = {number("inertia_xy"), number("inertia_xz"), number("inertia_yz")};
  }
  if (inertial.mass > 0.0 && moments.isZero(0.0) && products.isZero(0.0)) {
    moments.setConstant(inertial.mass * point_radius * point_radius);
    reader.log.changed(element, fmt::format("a point mass: its radius of gyration is {} m here",
                                            number_text(point_radius, 6)));
  }
  Matrix3& tensor = inertial.inertia;
  tensor.diagonal() = moments;
  tensor(0, 1) = tensor(1, 0) = products[0];
  tensor(0, 2) = tensor(2, 0) = products[1];
  tensor(1, 2) = tensor(2, 1) = products[2];
}

int add_site(const xml::Element& element, int body, const Vector3& point, Reader& reader) {
  mjcf::Site site;
  site.element = &element;
  site.body = body;
  site.frame.position = point;
  reader.model.sites.push_back(std::move(site));
  return static_cast<int>(reader.model.sites.size()) - 1;
}

/// Reads type and size; false if it has no counterpart.
bool read_surface(const xml::Element& element, mjcf::Geom& geom, Reader& reader) {
  Properties& properties = reader.properties;
  const auto size = [&](const char* tag) {
    return properties.positive(element, tag).value_or(1.0);
  };
  if (element.tag == "WrapSphere") {
    geom.type = mjcf::GeomType::sphere;
    geom.size[0] = size("radius");
  } else if (element.tag == "WrapCylinder") {
    geom.type = mjcf::GeomType::cylinder;
    geom.size[0] = size("radius");
    geom.size[1] = 0.5 * size("length");
  } else if (element.tag == "WrapEllipsoid") {
    geom.type = mjcf::GeomType::ellipsoid;
    geom.size = properties.vector(element, "dimensions").value_or(Vector3::Ones());
    if (!(geom.size.minCoeff() > 0.0) || geom.size.maxCoeff() > 100.0 * geom.size.minCoeff()) {
      reader.log.skipped(element,
                         "an ellipsoid needs half axes > 0, the longest at most 100 times "
                         "the shortest");
      return false;
    }
  } else {
    reader.log.skipped(element,
                       "no surface that is known here; known are WrapSphere, WrapCylinder and "
                       "WrapEllipsoid");
    return false;
  }
  return true;
}

/// A site beyond the surface in the direction of its quadrant, such as "-y"; -1: all directions.
int side_of(const xml::Element& element, const mjcf::Geom& geom, Reader& reader) {
  std::string word = reader.properties.text(element, "quadrant");
  if (word.empty() || word == "all" || word == "Unassigned") return -1;
  const xml::Element& property = *reader.properties.child(element, "quadrant");
  const double sign = word.front() == '-' ? -1.0 : 1.0;
  if (word.front() == '-' || word.front() == '+') word.erase(0, 1);
  if (word.size() != 1 || word[0] < 'x' || word[0] > 'z') {
    reader.log.error(property, "must be one of x, -x, y, -y, z, -z, all", property.text,
                     FaultCode::unknown_choice);
    return -1;
  }
  if (geom.type == mjcf::GeomType::cylinder && word[0] == 'z') {
    reader.log.changed(property, "a cylinder has no side along its axis; taken as all");
    return -1;
  }
  constexpr double beyond = 2.0;
  const Vector3 point = sign * beyond * geom.size.maxCoeff() * Vector3::Unit(word[0] - 'x');
  return add_site(property, geom.body, geom.frame.point(point), reader);
}

void read_wrap(const xml::Element& element, const FixedFrame& around, Reader& reader) {
  Properties& properties = reader.properties;
  const std::string* const name = element.value("name");
  WrapSurface wrap;
  wrap.element = &element;
  wrap.active = properties.flag(element, "active", true);
  mjcf::Geom geom;
  geom.element = &element;
  geom.name = name == nullptr ? "" : *name;
  geom.body = reader.bodies[at(around.body)].number;
  mjcf::Frame own;
  own.position = properties.vector(element, "translation").value_or(Vector3::Zero());
  own.orientation =
      from_xyz(properties.vector(element, "xyz_body_rotation").value_or(Vector3::Zero()));
  geom.frame = around.frame * own;
  if (read_surface(element, geom, reader)) {
    wrap.side_site = side_of(element, geom, reader);
    wrap.geom = static_cast<int>(reader.model.geoms.size());
    reader.model.bodies[at(geom.body)].geoms.push_back(wrap.geom);
    reader.model.geoms.push_back(std::move(geom));
  }
  if (name != nullptr && reader.wraps.emplace(*name, wrap).second) return;
  reader.log.error(element, "a wrap object needs a name of its own", name == nullptr ? "" : *name,
                   FaultCode::duplicate_name);
}

void read_wraps_of(const xml::Element& element, const FixedFrame& frame, Reader& reader) {
  for (const char* const tag : {"WrapObjectSet", "wrap_object_set"}) {
    for (const xml::Element* const wrap : reader.properties.objects(element, tag)) {
      read_wrap(*wrap, frame, reader);
    }
  }
}

void add_raw(const xml::Element& element, Reader& reader) {
  RawBody body;
  body.element = &element;
  const std::string* const name = element.value("name");
  if (name == nullptr || name->empty()) {
    reader.log.error(element, "\"name\" is missing", {}, FaultCode::missing_key);
    return;
  }
  body.name = *name;
  read_mass(element, body.inertial, reader);
  if (!reader.body_names.emplace(*name, static_cast<int>(reader.bodies.size())).second) {
    reader.log.error(element, "another body has the same name", *name, FaultCode::duplicate_name);
    return;
  }
  reader.bodies.push_back(std::move(body));
}

}  // namespace

void read_bodies(Reader& reader) {
  RawBody ground;
  ground.element = &reader.root;
  ground.name = "ground";
  ground.number = 0;
  const xml::Element* const element = reader.properties.child(reader.root, "Ground");
  if (element != nullptr) {
    ground.element = element;
    reader.log.same(*element, "the world");
  }
  reader.bodies.push_back(std::move(ground));
  reader.body_names.emplace("ground", 0);
  for (const xml::Element* const object : reader.properties.objects(reader.root, "BodySet")) {
    const std::string* const name = object->value("name");
    if (object->tag != "Body") {
      reader.log.error(*object, "no body that is known here; allowed is Body", {},
                       FaultCode::unknown_key);
    } else if (name != nullptr && *name == "ground") {
      // Ground is a body in versions before 4.
      reader.bodies.front().element = object;
      for (const char* const mass : {"mass", "mass_center", "inertia_xx", "inertia_yy",
                                     "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"}) {
        static_cast<void>(reader.properties.child(*object, mass));
      }
      reader.log.same(*object, "the world");
    } else {
      add_raw(*object, reader);
    }
  }
}

void read_wraps(Reader& reader) {
  for (std::size_t i = 0; i < reader.bodies.size(); ++i) {
    read_wraps_of(*reader.bodies[i].element, {static_cast<int>(i), {}}, reader);
  }
  for (const auto& [path, element] : reader.frames) {
    const bool has = std::any_of(element->children.begin(), element->children.end(),
                                 [](const auto& c) { return c.tag == "WrapObjectSet"; });
    if (!has) continue;
    const std::string inside = path.substr(0, path.rfind('/'));
    FixedFrame frame = frame_of(*element, "parent", inside, reader);
    if (frame.body < 0) continue;
    mjcf::Frame own;
    own.position = reader.properties.vector(*element, "translation").value_or(Vector3::Zero());
    own.orientation =
        from_xyz(reader.properties.vector(*element, "orientation").value_or(Vector3::Zero()));
    frame.frame = frame.frame * own;
    reader.properties.mark(*element);
    read_wraps_of(*element, frame, reader);
  }
}

}  // namespace sheave::import::opensim
