// <joint>: type, axis, limits, dynamics and mimic.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/urdf/reader.h"

namespace sheave::import::urdf {
namespace {

using mjcf::Joint;
using mjcf::JointType;

/// A joint whose name is that of the element, or none if it is one of several on the body.
void add_joint(JointType type, const Vector3& axis, const std::string& name,
               const xml::Element& element, int body, mjcf::Model& model) {
  Joint joint;
  joint.element = &element;
  joint.name = name;
  joint.type = type;
  joint.body = body;
  joint.axis = axis;
  joint.qpos = model.position_count;
  joint.qvel = model.velocity_count;
  model.position_count += joint.position_count();
  model.velocity_count += joint.velocity_count();
  const int number = static_cast<int>(model.joints.size());
  if (!name.empty()) model.joint_names.emplace(name, number);
  model.bodies[at(body)].joints.push_back(number);
  model.joints.push_back(std::move(joint));
}

Vector3 read_axis(const xml::Element& element, Log& log) {
  const xml::Element* const axis = child_of(element, "axis", log);
  if (axis == nullptr) return Vector3::UnitX();
  Attributes attributes(*axis, nullptr, log);
  const Vector3 given = attributes.vector("xyz").value_or(Vector3::UnitX());
  const double length = given.norm();
  if (!(length > 1e-10 && length < 1e100)) {
    attributes.error("xyz", "of a length that is not 0", FaultCode::out_of_range);
    return Vector3::UnitX();
  }
  attributes.finish({});
  log.same(*axis, "the axis of the joint");
  return given / length;
}

void read_limit(const xml::Element& element, bool is_needed, Joint& joint, Log& log) {
  const xml::Element* const limit = child_of(element, "limit", log);
  if (limit == nullptr) {
    if (is_needed) {
      log.error(element, "<limit> is missing; a joint without limits is \"continuous\"", {},
                FaultCode::missing_key);
    }
    return;
  }
  Attributes attributes(*limit, nullptr, log);
  const double lower = attributes.number("lower").value_or(0.0);
  const double upper = attributes.number("upper").value_or(0.0);
  if (is_needed && lower > upper) {
    attributes.error("lower", fmt::format("at most the upper limit, {}", upper),
                     FaultCode::out_of_range);
  }
  if (is_needed) {
    joint.range = std::array<double, 2>{lower, upper};
    log.same(*limit, "stops of the joint");
  } else {
    log.skipped(*limit, "the joint has no stops");
  }
  std::string other;
  for (const char* const name : {"effort", "velocity"}) {
    if (attributes.number(name)) other += (other.empty() ? "" : " and ") + std::string(name);
  }
  if (!other.empty()) {
    log.changed(*limit, fmt::format("not taken: {}, which are limits of a drive", other));
  }
  attributes.finish({});
}

void read_dynamics(const xml::Element& element, Joint& joint, Log& log) {
  const xml::Element* const dynamics = child_of(element, "dynamics", log);
  if (dynamics == nullptr) return;
  Attributes attributes(*dynamics, nullptr, log);
  joint.damping = attributes.positive_or_zero("damping").value_or(0.0);
  joint.friction = attributes.positive_or_zero("friction").value_or(0.0);
  attributes.finish({});
  log.same(*dynamics, "damping and dry friction of the joint");
}

void note_other_parts(const xml::Element& element, Log& log) {
  for (const xml::Element& child : element.children) {
    const std::string& tag = child.tag;
    if (tag == "parent" || tag == "child") {
      log.same(child, "a body of the joint");
    } else if (tag == "calibration" || tag == "safety_controller") {
      log.skipped(child, "it concerns the robot's own controller");
    } else if (!log.has(child) && tag != "origin" && tag != "mimic") {
      log.skipped(child, "no part of a joint of this type that is known here");
    }
  }
}

/// Two directions across the axis.
std::pair<Vector3, Vector3> across(const Vector3& axis) {
  const Vector3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

}  // namespace

void read_joint(const xml::Element& element, int body, mjcf::Model& model, Log& log) {
  const std::string& name = *element.value("name");
  Attributes attributes(element, nullptr, log);
  const std::string type = attributes
                               .choice("type", {"revolute", "continuous", "prismatic", "fixed",
                                                "floating", "planar", "spherical"})
                               .value_or("");
  if (type.empty() && !attributes.has("type")) {
    attributes.error("type", "given", FaultCode::missing_key);
  }
  attributes.finish({});
  if (type == "fixed") {
    log.same(element, "fixed: the link is a part of its parent");
  } else if (type == "floating") {
    add_joint(JointType::free, Vector3::UnitZ(), name, element, body, model);
  } else if (type == "spherical") {
    add_joint(JointType::ball, Vector3::UnitZ(), name, element, body, model);
    read_dynamics(element, model.joints.back(), log);
  } else if (type == "planar") {
    const Vector3 axis = read_axis(element, log);
    const auto [first, second] = across(axis);
    add_joint(JointType::slide, first, name, element, body, model);
    add_joint(JointType::slide, second, {}, element, body, model);
    add_joint(JointType::hinge, axis, {}, element, body, model);
  } else if (!type.empty()) {
    const bool slides = type == "prismatic";
    const Vector3 axis = read_axis(element, log);
    add_joint(slides ? JointType::slide : JointType::hinge, axis, name, element, body, model);
    read_limit(element, type != "continuous", model.joints.back(), log);
    read_dynamics(element, model.joints.back(), log);
  }
  note_other_parts(element, log);
}

void read_mimic(const xml::Element& element, mjcf::Model& model, Log& log) {
  const xml::Element* const mimic = child_of(element, "mimic", log);
  if (mimic == nullptr) return;
  const auto known = [&](const std::string* name) {
    const auto found = name == nullptr ? model.joint_names.end() : model.joint_names.find(*name);
    if (found == model.joint_names.end()) return -1;
    const bool one = model.bodies[at(model.joints[at(found->second)].body)].joints.size() == 1;
    const JointType type = model.joints[at(found->second)].type;
    const bool moves_alone = type == JointType::hinge || type == JointType::slide;
    return one && moves_alone ? found->second : -1;
  };
  Attributes attributes(*mimic, nullptr, log);
  mjcf::Equality equality;
  equality.element = mimic;
  equality.name = "mimic of " + *element.value("name");
  equality.type = mjcf::EqualityType::joint;
  equality.joint1 = known(element.value("name"));
  equality.joint2 = known(mimic->value("joint"));
  equality.polynomial = {attributes.number("offset").value_or(0.0),
                         attributes.number("multiplier").value_or(1.0), 0.0, 0.0, 0.0};
  attributes.finish({"joint"});
  if (equality.joint1 < 0 || equality.joint2 < 0 || equality.joint1 == equality.joint2) {
    attributes.error("joint",
                     "the name of another joint; both must be revolute, continuous or prismatic",
                     FaultCode::meaning);
    return;
  }
  model.equalities.push_back(std::move(equality));
}

}  // namespace sheave::import::urdf
