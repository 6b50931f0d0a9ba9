// Bodies: those without joints are parts of their parents.

#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "engine/shapes/ellipsoid.h"
#include "scenes/import/mjcf/scene.h"

namespace sheave::import::mjcf {
namespace {

constexpr double least_mass = 1e-15;  // of a body that moves; MuJoCo has the same bound

/// Whether a geom gives a shape.
bool has_shape(const Geom& geom, const Model& model) {
  if (geom.type == GeomType::mesh) return !model.meshes.at(geom.mesh).corners.empty();
  if (geom.type == GeomType::ellipsoid) {
    return geom.size.maxCoeff() <= Ellipsoid::most_ratio * geom.size.minCoeff();
  }
  return geom.type == GeomType::sphere || geom.type == GeomType::capsule ||
         geom.type == GeomType::cylinder || geom.type == GeomType::box;
}

Json shape_of(const Geom& geom, const Model& model, const Frame& frame) {
  Json shape;
  switch (geom.type) {
    case GeomType::mesh:
      shape = {{"type", "polyhedron"}, {"points", Json::array()}};
      for (const Vector3& corner : model.meshes.at(geom.mesh).corners) {
        shape["points"].push_back(json_of(corner));
      }
      break;
    case GeomType::sphere:
      shape = {{"type", "sphere"}, {"radius", geom.size[0]}};
      break;
    case GeomType::box:
      shape = {{"type", "box"}, {"size", json_of(Vector3(2.0 * geom.size))}};
      break;
    case GeomType::ellipsoid:
      shape = {{"type", "ellipsoid"}, {"half_axes", json_of(geom.size)}};
      break;
    default:
      shape = {{"type", geom.type == GeomType::capsule ? "capsule" : "cylinder"},
               {"radius", geom.size[0]},
               {"length", 2.0 * geom.size[1]}};
  }
  shape["position"] = json_of(frame.position);
  shape["orientation"] = json_of(frame.orientation);
  return shape;
}

/// The armature of a joint whose axis stands still is inertia of the body, whose only motion is that
/// along the axis. About a hinge a body may have it in all directions: this changes neither the
/// moment about the axis nor the products of inertia, and the tensor stays that of a body. For a
/// slide armature is mass without weight.
void add_armature(const Writer& writer, int number, Inertial& inertial, Json& body) {
  const Body& own = writer.model.bodies[at(number)];
  if (own.joints.size() != 1) return;
  const Joint& joint = writer.model.joints[at(own.joints.front())];
  if (!is_armature_of_body(writer, joint)) return;
  if (joint.type == JointType::hinge || joint.type == JointType::ball) {
    inertial.inertia += joint.armature * Matrix3::Identity();
  } else if (joint.type == JointType::slide) {
    inertial.mass += joint.armature;
    body["force"] = json_of(Vector3(-joint.armature * writer.model.option.gravity));
  }
}

void write_mass(const Inertial& inertial, Json& body) {
  const Matrix3& i = inertial.inertia;
  body["mass"] = inertial.mass;
  body["center_of_mass"] = json_of(inertial.center);
  body["inertia"] = json_of(Vector3(i.diagonal()));
  const Vector3 products(i(0, 1), i(0, 2), i(1, 2));
  if (!products.isZero(0.0)) body["products_of_inertia"] = json_of(products);
}

void write_free_damping(const Writer& writer, int number, Json& body) {
  const Body& own = writer.model.bodies[at(number)];
  if (own.joints.size() != 1) return;
  const Joint& joint = writer.model.joints[at(own.joints.front())];
  if (joint.type != JointType::free) return;
  if (joint.damping > 0.0) {
    body["damping"] = joint.damping;
    body["angular_damping"] = joint.damping;
    if (writer.inertials[at(number)].center.norm() > 1e-12) {
      writer.log.changed(*joint.element,
                         "damping acts at the centre of mass, not at the origin of the body");
    }
  }
  if (joint.stiffness > 0.0 || joint.friction > 0.0 || joint.armature > 0.0) {
    writer.log.changed(*joint.element,
                       "not taken: stiffness, frictionloss and armature of a free joint");
  }
}

/// Shapes of all parts of a carrier.
Json shapes_of(Writer& writer, int carrier) {
  Json list = Json::array();
  const Model& model = writer.model;
  for (const int g : writer.geoms[at(carrier)]) {
    const Geom& geom = model.geoms[at(g)];
    const Carrier& part = writer.carriers[at(geom.body)];
    if (!has_shape(geom, model)) {
      if (geom.type == GeomType::ellipsoid) {
        writer.log.changed(*geom.element,
                           "mass and inertia are taken, the shape is not: one half axis is more "
                           "than 100 times another");
      } else if (geom.type == GeomType::mesh && model.meshes.at(geom.mesh).fault.empty()) {
        writer.log.changed(*geom.element,
                           "mass and inertia are taken, the shape is not: its convex hull has no "
                           "volume or more than 4096 corners, or the mesh more than 100000 points");
      }
      continue;
    }
    writer.shapes[at(g)] = static_cast<int>(list.size());
    list.push_back(shape_of(geom, model, part.frame * geom.frame));
    writer.log.same(*geom.element,
                    fmt::format("a shape of \"{}\", {} kg", writer.body_names[at(carrier)],
                                number_text(geom.inertial.mass, 6)));
  }
  return list;
}

Json body_json(Writer& writer, int number) {
  const Body& own = writer.model.bodies[at(number)];
  const BodyPose& pose = writer.start.bodies[at(number)];
  const bool moves = writer.carriers[at(number)].moves;
  Json body = {{"name", writer.body_names[at(number)]}};
  if (!moves) body["mobility"] = "static";
  body["position"] = json_of(pose.frame.position);
  body["orientation"] = json_of(pose.frame.orientation);
  if (moves) {
    Inertial inertial = writer.inertials[at(number)];
    if (!pose.velocity.isZero(0.0)) body["velocity"] = json_of(pose.velocity);
    if (!pose.angular_velocity.isZero(0.0)) {
      body["angular_velocity"] = json_of(pose.angular_velocity);
    }
    if (!(inertial.mass > least_mass) || !(inertial.inertia.diagonal().minCoeff() > 0.0)) {
      writer.log.error(*own.element,
                       "a body that moves needs mass and inertia; give it a geom or an <inertial>",
                       {}, FaultCode::meaning);
    }
    add_armature(writer, number, inertial, body);
    write_mass(inertial, body);
    write_free_damping(writer, number, body);
  }
  Json shapes = shapes_of(writer, number);
  if (!shapes.empty()) body["shapes"] = std::move(shapes);
  if (number > 0) {
    writer.log.same(*own.element, fmt::format("the {}body \"{}\"", moves ? "" : "static ",
                                              writer.body_names[at(number)]));
  }
  return body;
}

void note_contacts(const Writer& writer) {
  bool collide = false;
  for (const Geom& geom : writer.model.geoms) {
    for (const char* const key : {"contype", "conaffinity"}) {
      const std::string* const value = geom.element->value(key);
      collide = collide || value == nullptr || *value != "0";
    }
  }
  if (!writer.model.has_contacts || !collide || writer.model.geoms.size() < 2) return;
  writer.log.changed(*writer.model.bodies.front().element,
                     "geoms do not touch each other; name bodies in \"colliders\" for contacts");
}

}  // namespace

void merge_bodies(Writer& writer) {
  const Model& model = writer.model;
  Names names;
  writer.carriers.resize(model.bodies.size());
  writer.inertials.resize(model.bodies.size());
  writer.body_names.resize(model.bodies.size());
  writer.shapes.assign(model.geoms.size(), -1);
  writer.body_names[0] = "world";
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const Carrier& parent = writer.carriers[at(body.parent)];
    Carrier& own = writer.carriers[i];
    writer.inertials[i] = body.inertial;
    if (!body.joints.empty() || body.parent == 0) {
      own = {static_cast<int>(i), {}, !body.joints.empty()};
      writer.body_names[i] = names.take(body.name, fmt::format("body {}", i));
      continue;
    }
    own = {parent.body, parent.frame * body.frame, parent.moves};
    writer.inertials[at(own.body)].add(body.inertial.seen_from(own.frame));
    writer.body_names[i] = writer.body_names[at(own.body)];
    writer.log.same(*body.element,
                    fmt::format("has no joint: a part of the body \"{}\"", writer.body_names[i]));
  }
  writer.geoms.resize(model.bodies.size());
  for (std::size_t g = 0; g < model.geoms.size(); ++g) {
    const int carrier = writer.carriers[at(model.geoms[g].body)].body;
    writer.geoms[at(carrier)].push_back(static_cast<int>(g));
  }
  // Geoms of the world need a body to carry them.
  writer.body_names[0] = names.take("", "ground shapes");
}

void write_bodies(Writer& writer) {
  Json list = Json::array();
  for (std::size_t i = 0; i < writer.model.bodies.size(); ++i) {
    if (writer.carriers[i].body != static_cast<int>(i)) continue;
    Json body = body_json(writer, static_cast<int>(i));
    if (i == 0 && !body.contains("shapes")) continue;  // it would only be the world again
    writer.log.origin(*writer.model.bodies[i].element, fmt::format("/bodies/{}", list.size()));
    list.push_back(std::move(body));
  }
  writer.scene["bodies"] = std::move(list);
  note_contacts(writer);
}

}  // namespace sheave::import::mjcf
