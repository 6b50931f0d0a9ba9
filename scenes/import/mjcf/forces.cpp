// <actuator>, <equality> and <keyframe>.

#include <algorithm>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// Reads gain and bias; false if the actuator's law has no counterpart.
bool read_law(Attributes& attributes, const xml::Element& element, Actuator& actuator, Log& log) {
  const std::string& kind = element.tag;
  if (kind == "position") {
    actuator.gain = attributes.positive_or_zero("kp").value_or(1.0);
    const double kv = attributes.positive_or_zero("kv").value_or(0.0);
    actuator.bias = {0.0, -actuator.gain, -kv};
  } else if (kind == "velocity") {
    actuator.gain = attributes.positive_or_zero("kv").value_or(1.0);
    actuator.bias = {0.0, 0.0, -actuator.gain};
  } else if (kind == "general") {
    const bool dynamic = attributes.text("dyntype").value_or("none") != "none";
    const bool gain = attributes.text("gaintype").value_or("fixed") == "fixed";
    const std::string bias = attributes.text("biastype").value_or("none");
    const auto gains = attributes.numbers("gainprm", 1, 10);
    const auto biases = attributes.numbers("biasprm", 1, 10);
    if (dynamic || !gain || (bias != "none" && bias != "affine")) {
      log.skipped(element,
                  "only dyntype none, gaintype fixed and biastype none or affine have a "
                  "counterpart");
      return false;
    }
    if (!gains.empty()) actuator.gain = gains[0];
    for (std::size_t i = 0; bias == "affine" && i < 3 && i < biases.size(); ++i) {
      actuator.bias[i] = biases[i];
    }
    if (actuator.bias[1] > 0.0 || actuator.bias[2] > 0.0) {
      log.skipped(element, "a bias that grows with length or velocity has no counterpart");
      return false;
    }
  } else if (kind != "motor") {
    log.skipped(element, fmt::format("an actuator of the kind {} has no counterpart; a controller "
                                     "of the scene can set a drive",
                                     kind));
    return false;
  }
  return true;
}

void read_actuator(const xml::Element& element, Reader& reader) {
  Model& model = reader.model;
  Attributes attributes = reader.attributes(element, element.tag);
  Actuator actuator;
  actuator.element = &element;
  actuator.name = attributes.text("name").value_or("");
  const bool on_joint = element.value("joint") != nullptr;
  const bool on_tendon = element.value("tendon") != nullptr;
  const bool muscle = is_muscle(attributes, element);
  const std::string dynamics = attributes.text("dyntype").value_or("none");
  const bool has_state = muscle || element.tag == "intvelocity" || element.tag == "cylinder" ||
                         (element.tag == "general" && dynamics != "none");
  if (has_state) actuator.activation = model.activation_count++;
  bool taken = model.option.actuation;
  if (!taken) reader.log.skipped(element, "actuation is disabled by <flag>");
  const double group = attributes.number("group").value_or(0.0);
  const std::vector<double>& idle = model.option.idle_actuator_groups;
  if (taken && std::find(idle.begin(), idle.end(), group) != idle.end()) {
    reader.log.skipped(element, "its group is disabled by actuatorgroupdisable");
    taken = false;
  }
  if (taken && muscle) {
    actuator.muscle = read_muscle(attributes, element, model.compiler, reader.log);
    taken = actuator.muscle.has_value();
  } else if (taken) {
    taken = read_law(attributes, element, actuator, reader.log);
  }
  if (on_joint) actuator.joint = reader.find(model.joint_names, element, "joint", "joint");
  if (on_tendon) actuator.tendon = reader.find(model.tendon_names, element, "tendon", "tendon");
  if (taken && on_joint == on_tendon) {
    reader.log.skipped(element, "only actuators on one joint or on one tendon have a counterpart");
    taken = false;
  }
  if (taken && muscle && !on_tendon) {
    reader.log.skipped(element,
                       "a muscle lies along a spatial tendon; on a joint it has no "
                       "counterpart");
    taken = false;
  }
  if (const auto gear = attributes.numbers("gear", 1, 6); !gear.empty()) {
    actuator.gear = gear.front();
  }
  actuator.control_range =
      read_range(attributes, model.compiler.auto_limits, "ctrlrange", "ctrllimited");
  if (!model.option.clamps_controls) actuator.control_range.reset();
  actuator.force_range =
      read_range(attributes, model.compiler.auto_limits, "forcerange", "forcelimited");
  if (taken) {
    attributes.finish({"user", "joint", "tendon", "lengthrange"});
  } else {
    actuator.joint = actuator.tendon = -1;
  }
  model.actuators.push_back(std::move(actuator));
}

/// Reads the two bodies of connect or weld; false if it is to be skipped.
bool read_bodies_joined(Attributes& attributes, const xml::Element& element, const Reader& reader,
                        Equality& equality) {
  const Model& model = reader.model;
  if (element.value("body1") == nullptr) {
    reader.log.skipped(element, "between sites it has no counterpart; name two bodies");
    return false;
  }
  equality.body1 = reader.find(model.body_names, element, "body1", "body");
  if (element.value("body2") != nullptr) {
    equality.body2 = reader.find(model.body_names, element, "body2", "body");
  }
  if (equality.body1 < 0 || equality.body2 < 0) return false;
  if (equality.type == EqualityType::weld) {
    const auto pose = attributes.numbers("relpose", 7, 7);
    if (!pose.empty() && (pose[3] != 0.0 || pose[4] != 0.0 || pose[5] != 0.0 || pose[6] != 0.0)) {
      reader.log.skipped(element, "relpose: bodies are welded as they stand; leave relpose out");
      return false;
    }
    return true;
  }
  const auto anchor = attributes.vector("anchor");
  if (!anchor) {
    if (!attributes.has("anchor")) {
      attributes.error("anchor", "given [m], in body1", FaultCode::missing_key);
    }
    return false;
  }
  equality.anchor = *anchor;
  return true;
}

/// Reads the joints and the polynomial of an equality of joints; false if there is a fault.
bool read_joints_coupled(Attributes& attributes, const xml::Element& element, const Reader& reader,
                         Equality& equality) {
  const Model& model = reader.model;
  equality.joint1 = reader.find(model.joint_names, element, "joint1", "joint");
  if (equality.joint1 < 0) return false;
  if (element.value("joint2") != nullptr) {
    equality.joint2 = reader.find(model.joint_names, element, "joint2", "joint");
    if (equality.joint2 < 0) return false;
    if (equality.joint2 == equality.joint1) {
      reader.log.error(element, "joint1 and joint2 must be two joints", {}, FaultCode::meaning);
      return false;
    }
  }
  for (const int joint : {equality.joint1, equality.joint2}) {
    if (joint < 0) continue;
    const JointType type = model.joints[static_cast<std::size_t>(joint)].type;
    if (type == JointType::hinge || type == JointType::slide) continue;
    reader.log.error(element, "only hinges and slides can be coupled", {}, FaultCode::meaning);
    return false;
  }
  const auto factors = attributes.numbers("polycoef", 1, 5);
  for (std::size_t i = 0; i < factors.size(); ++i) equality.polynomial[i] = factors[i];
  return true;
}

void read_equality(const xml::Element& element, Reader& reader) {
  Model& model = reader.model;
  if (element.tag != "connect" && element.tag != "weld" && element.tag != "joint") {
    reader.log.skipped(element, "only connect, weld and joint have a counterpart");
    return;
  }
  Attributes attributes = reader.attributes(element, "equality");
  Equality equality;
  equality.element = &element;
  equality.name = attributes.text("name").value_or("");
  equality.type = element.tag == "weld"    ? EqualityType::weld
                  : element.tag == "joint" ? EqualityType::joint
                                           : EqualityType::connect;
  const bool taken = equality.type == EqualityType::joint
                         ? read_joints_coupled(attributes, element, reader, equality)
                         : read_bodies_joined(attributes, element, reader, equality);
  if (!taken) return;
  if (!attributes.flag("active").value_or(true) || !model.option.equality) {
    reader.log.skipped(element, "it is not active");
    return;
  }
  attributes.finish(
      {"solref", "solimp", "body1", "body2", "joint1", "joint2", "anchor", "torquescale"});
  model.equalities.push_back(std::move(equality));
}

std::vector<double> read_state(Attributes& attributes, std::string_view name, std::size_t count) {
  constexpr std::size_t most = 1'000'000;
  std::vector<double> list = attributes.numbers(name, 1, most);
  if (!list.empty() && list.size() != count) {
    attributes.error(
        name,
        fmt::format("{} numbers, as the model has coordinates, actuators or activations", count),
        FaultCode::meaning);
    list.clear();
  }
  return list;
}

}  // namespace

void read_actuators(const xml::Element& element, Reader& reader) {
  for (const xml::Element& child : element.children) read_actuator(child, reader);
}

void read_equalities(const xml::Element& element, Reader& reader) {
  for (const xml::Element& child : element.children) read_equality(child, reader);
}

void read_keyframes(const xml::Element& element, Reader& reader) {
  Model& model = reader.model;
  for (const xml::Element& child : element.children) {
    if (child.tag != "key") {
      reader.log.skipped(child, "no keyframe");
      continue;
    }
    Attributes attributes(child, nullptr, reader.log);
    Keyframe key;
    key.element = &child;
    key.name = attributes.text("name").value_or("");
    key.positions = read_state(attributes, "qpos", static_cast<std::size_t>(model.position_count));
    key.velocities = read_state(attributes, "qvel", static_cast<std::size_t>(model.velocity_count));
    key.controls = read_state(attributes, "ctrl", model.actuators.size());
    key.activations =
        read_state(attributes, "act", static_cast<std::size_t>(model.activation_count));
    attributes.finish({"time"});
    model.keyframes.push_back(std::move(key));
  }
}

}  // namespace sheave::import::mjcf
