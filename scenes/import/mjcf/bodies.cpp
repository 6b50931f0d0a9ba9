// <worldbody>, <body> and <joint>.

#include <algorithm>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {

int Joint::position_count() const {
  return type == JointType::free ? 7 : type == JointType::ball ? 4 : 1;
}
int Joint::velocity_count() const {
  return type == JointType::free ? 6 : type == JointType::ball ? 3 : 1;
}
bool Joint::is_plain() const {
  return !range && stiffness == 0.0 && damping == 0.0 && friction == 0.0 && armature == 0.0;
}

namespace {

JointType joint_type(Attributes& attributes) {
  const std::string type =
      attributes.choice("type", {"free", "ball", "slide", "hinge"}).value_or("hinge");
  return type == "free"    ? JointType::free
         : type == "ball"  ? JointType::ball
         : type == "slide" ? JointType::slide
                           : JointType::hinge;
}

void read_effects(Attributes& attributes, Joint& joint, const Reader& reader) {
  const Option& option = reader.model.option;
  const double unit = joint.type == JointType::slide ? 1.0 : reader.angle(1.0);
  joint.reference = unit * attributes.number("ref").value_or(0.0);
  joint.range = read_range(attributes, reader.model.compiler.auto_limits, "range", "limited");
  if (joint.range) {
    for (double& end : *joint.range) end *= unit;
  }
  joint.stiffness = attributes.positive_or_zero("stiffness").value_or(0.0);
  joint.spring_reference = unit * attributes.number("springref").value_or(0.0);
  joint.damping = attributes.positive_or_zero("damping").value_or(0.0);
  joint.friction = attributes.positive_or_zero("frictionloss").value_or(0.0);
  joint.armature = attributes.positive_or_zero("armature").value_or(0.0);
  if (!option.limits) joint.range.reset();
  if (!option.passive) joint.stiffness = joint.damping = 0.0;
  if (!option.friction) joint.friction = 0.0;
}

void check_place(const Joint& joint, const Body& body, const Reader& reader) {
  const auto fail = [&](const char* text) {
    reader.log.error(*joint.element, text, {}, FaultCode::meaning);
  };
  if (joint.body == 0) return fail("the world has no joints");
  if (joint.type == JointType::free && (body.parent != 0 || !body.joints.empty())) {
    return fail("a free joint is for a body of the world, and its only joint");
  }
  for (const int other : body.joints) {
    if (reader.model.joints[static_cast<std::size_t>(other)].type == JointType::free) {
      return fail("the body has a free joint, which must be its only one");
    }
  }
}

}  // namespace

void read_joint(const xml::Element& element, int body, Reader& reader) {
  Model& model = reader.model;
  const bool freejoint = element.tag == "freejoint";
  Attributes attributes =
      freejoint ? Attributes(element, nullptr, reader.log) : reader.attributes(element, "joint");
  Joint joint;
  joint.element = &element;
  joint.body = body;
  joint.name = attributes.text("name").value_or("");
  joint.type = freejoint ? JointType::free : joint_type(attributes);
  if (!freejoint) {
    joint.position = attributes.vector("pos").value_or(Vector3::Zero());
    joint.axis = attributes.vector("axis").value_or(Vector3(Vector3::UnitZ()));
    const bool directed = joint.type == JointType::hinge || joint.type == JointType::slide;
    const double length = joint.axis.norm();
    if (directed && !(length > 1e-10 && length < 1e100)) {
      attributes.error("axis", "of a length that is not 0", FaultCode::out_of_range);
      return;
    }
    if (directed) joint.axis.normalize();
    read_effects(attributes, joint, reader);
  }
  if (joint.range && attributes.number("margin").value_or(0.0) != 0.0) {
    reader.log.changed(element, "not taken: margin; the stops are at the range itself");
  }
  // The stiffness of limits belongs to MuJoCo's solver: stops are rigid here.
  attributes.finish({"group", "user", "solreflimit", "solimplimit", "solreffriction",
                     "solimpfriction", "margin", "align"});
  check_place(joint, model.bodies[static_cast<std::size_t>(body)], reader);
  joint.qpos = model.position_count;
  joint.qvel = model.velocity_count;
  model.position_count += joint.position_count();
  model.velocity_count += joint.velocity_count();
  const int number = static_cast<int>(model.joints.size());
  reader.enter(model.joint_names, joint.name, number, element);
  model.bodies[static_cast<std::size_t>(body)].joints.push_back(number);
  model.joints.push_back(std::move(joint));
}

namespace {

void read_body(const xml::Element& element, int parent, Reader& reader);

/// Elements whose loss would change the machine.
bool makes_bodies(std::string_view tag) {
  return tag == "frame" || tag == "replicate" || tag == "composite" || tag == "flexcomp" ||
         tag == "attach";
}

void read_content(const xml::Element& element, int body, Reader& reader) {
  // MuJoCo numbers coordinates before those of inner bodies, whatever the order of the text.
  for (const xml::Element& child : element.children) {
    if (child.tag == "joint" || child.tag == "freejoint") {
      read_joint(child, body, reader);
    } else if (child.tag == "inertial") {
      if (body == 0) {
        reader.log.error(child, "the world has no mass", {}, FaultCode::meaning);
      } else {
        read_inertial(child, reader.model.bodies[static_cast<std::size_t>(body)], reader);
      }
    }
  }
  for (const xml::Element& child : element.children) {
    if (child.tag == "body") {
      read_body(child, body, reader);
    } else if (child.tag == "geom") {
      read_geom(child, body, reader);
    } else if (child.tag == "site") {
      read_site(child, body, reader);
    } else if (makes_bodies(child.tag)) {
      reader.log.error(child,
                       "it makes or places bodies in a way that is not read here; load the model "
                       "in MuJoCo and save it, which writes them out",
                       {}, FaultCode::meaning);
    } else if (child.tag == "light" || child.tag == "camera") {
      reader.log.skipped(child, "a scene has settings of pictures of its own");
    } else if (child.tag != "joint" && child.tag != "freejoint" && child.tag != "inertial") {
      reader.log.skipped(child, "no part of a body that is known here");
    }
  }
}

void read_body(const xml::Element& element, int parent, Reader& reader) {
  Attributes attributes(element, nullptr, reader.log);
  Body body;
  body.element = &element;
  body.parent = parent;
  body.name = attributes.text("name").value_or("");
  body.frame = read_frame(attributes, reader.model.compiler);
  const std::string outer = reader.child_class;
  if (const auto inner = attributes.text("childclass")) {
    if (*inner != "main" && !reader.defaults.has(*inner)) {
      attributes.error("childclass", "the name of a default class", FaultCode::meaning);
    } else {
      reader.child_class = *inner;
    }
  }
  if (attributes.flag("mocap").value_or(false)) {
    reader.log.changed(element, "mocap: the body stands still; a kinematic body can be moved");
  }
  if (attributes.number("gravcomp").value_or(0.0) != 0.0) {
    reader.log.changed(element, "gravcomp: gravity acts on the body in full");
  }
  attributes.finish({"user", "sleep"});
  const int number = static_cast<int>(reader.model.bodies.size());
  reader.enter(reader.model.body_names, body.name, number, element);
  reader.model.bodies.push_back(std::move(body));
  read_content(element, number, reader);
  reader.child_class = outer;
}

}  // namespace

void read_bodies(const xml::Element& element, Reader& reader) {
  // Several <worldbody>, of several files, are one.
  if (reader.model.bodies.empty()) {
    Body world;
    world.element = &element;
    world.name = "world";
    reader.model.bodies.push_back(std::move(world));
    reader.model.body_names.emplace("world", 0);
  }
  if (element.value("childclass") != nullptr) reader.child_class = *element.value("childclass");
  read_content(element, 0, reader);
  reader.child_class.clear();
}

}  // namespace sheave::import::mjcf
