// <tendon>: spatial tendons through sites, over spheres and cylinders, behind pulleys; fixed
// tendons, sums of coordinates of joints.

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// Why a path has no counterpart; empty: it has one.
std::string path_fault(const std::vector<PathPoint>& path) {
  if (path.size() < 2) return "a tendon, and each branch of it, needs two sites";
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].site >= 0) continue;
    const bool inner = i > 0 && i + 1 < path.size();
    if (!inner || path[i - 1].site < 0 || path[i + 1].site < 0) {
      return "a geom must stand between two sites";
    }
  }
  return {};
}

/// Reads one part of the path; false if the tendon is to be skipped.
bool read_part(const xml::Element& part, Tendon& tendon, const Reader& reader) {
  const Model& model = reader.model;
  PathPoint point;
  point.element = &part;
  if (part.tag == "site") {
    point.site = reader.find(model.site_names, part, "site", "site");
    if (point.site < 0) return false;
  } else if (part.tag == "geom") {
    point.geom = reader.find(model.geom_names, part, "geom", "geom");
    if (point.geom < 0) return false;
    if (part.value("sidesite") != nullptr) {
      point.side_site = reader.find(model.site_names, part, "sidesite", "site");
      if (point.side_site < 0) return false;
    }
    const GeomType type = model.geoms[static_cast<std::size_t>(point.geom)].type;
    if (type != GeomType::sphere && type != GeomType::cylinder) {
      reader.log.error(part, "a tendon wraps over spheres and cylinders alone", {},
                       FaultCode::meaning);
      return false;
    }
  } else if (part.tag == "pulley") {
    Attributes attributes(part, nullptr, reader.log);
    const auto divisor = attributes.number("divisor");
    if (!divisor || !(*divisor > 0.0)) {
      attributes.error("divisor", "given and > 0", FaultCode::out_of_range);
      return false;
    }
    // A pulley begins a branch, but the first one may stand before any site.
    if (!tendon.path.empty()) {
      tendon.branches.push_back({{}, *divisor});
      return true;
    }
    tendon.divisor = *divisor;
    return true;
  } else {
    reader.log.error(part, "no part of a spatial tendon; allowed are site, geom and pulley", {},
                     FaultCode::unknown_key);
    return false;
  }
  (tendon.branches.empty() ? tendon.path : tendon.branches.back().path).push_back(point);
  return true;
}

/// Reads the settings that both kinds of tendons have.
void read_settings(Attributes& attributes, const Reader& reader, Tendon& tendon) {
  const Model& model = reader.model;
  tendon.name = attributes.text("name").value_or("");
  tendon.range = read_range(attributes, model.compiler.auto_limits, "range", "limited");
  tendon.stiffness = attributes.positive_or_zero("stiffness").value_or(0.0);
  tendon.damping = attributes.positive_or_zero("damping").value_or(0.0);
  if (const auto rest = attributes.numbers("springlength", 1, 2); !rest.empty()) {
    // -1: the length in the reference pose.
    if (rest.back() >= 0.0) tendon.spring_length = rest.back();
    if (rest.size() == 2 && rest[0] < rest[1] && rest[0] >= 0.0) {
      tendon.slack = std::array<double, 2>{rest[0], rest[1]};
    }
  }
  if (tendon.range && attributes.number("margin").value_or(0.0) != 0.0) {
    reader.log.changed(*tendon.element, "not taken: margin; the bounds are those of the range");
  }
  for (const std::string_view name : {"frictionloss", "armature"}) {
    if (attributes.number(name).value_or(0.0) != 0.0) {
      reader.log.changed(*tendon.element, fmt::format("not taken: {} along its length", name));
    }
  }
  attributes.finish({"group", "width", "rgba", "material", "user", "solreflimit", "solimplimit",
                     "solreffriction", "solimpfriction", "margin"});
  if (!model.option.limits) tendon.range.reset();
  if (!model.option.passive) tendon.stiffness = tendon.damping = 0.0;
}

bool read_path(const xml::Element& element, Tendon& tendon, const Reader& reader) {
  for (const xml::Element& part : element.children) {
    if (!read_part(part, tendon, reader)) return false;
  }
  std::string fault = path_fault(tendon.path);
  for (const Branch& branch : tendon.branches) {
    if (fault.empty()) fault = path_fault(branch.path);
  }
  if (!fault.empty()) reader.log.error(element, fault, {}, FaultCode::meaning);
  return fault.empty();
}

bool read_coupled(const xml::Element& element, Tendon& tendon, const Reader& reader) {
  for (const xml::Element& part : element.children) {
    if (part.tag != "joint") {
      reader.log.error(part, "no part of a fixed tendon; allowed is joint", {},
                       FaultCode::unknown_key);
      return false;
    }
    Attributes attributes(part, nullptr, reader.log);
    TendonJoint one;
    one.joint = reader.find(reader.model.joint_names, part, "joint", "joint");
    const auto factor = attributes.number("coef");
    if (!factor && !attributes.has("coef")) {
      attributes.error("coef", "given", FaultCode::missing_key);
    }
    if (one.joint < 0 || !factor) return false;
    const Joint& joint = reader.model.joints[static_cast<std::size_t>(one.joint)];
    if (joint.type != JointType::hinge && joint.type != JointType::slide) {
      reader.log.error(part, "a fixed tendon is for hinges and slides", {}, FaultCode::meaning);
      return false;
    }
    one.factor = *factor;
    tendon.joints.push_back(one);
  }
  if (tendon.joints.empty()) {
    reader.log.error(element, "a fixed tendon needs a joint", {}, FaultCode::meaning);
  }
  return !tendon.joints.empty();
}

void read_tendon(const xml::Element& element, Reader& reader) {
  Model& model = reader.model;
  Attributes attributes = reader.attributes(element, "tendon");
  Tendon tendon;
  tendon.element = &element;
  read_settings(attributes, reader, tendon);
  reader.enter(model.tendon_names, tendon.name, static_cast<int>(model.tendons.size()), element);
  const bool taken = element.tag == "fixed" ? read_coupled(element, tendon, reader)
                                            : read_path(element, tendon, reader);
  if (!taken) {
    tendon.path.clear();
    tendon.joints.clear();
  }
  model.tendons.push_back(std::move(tendon));
}

}  // namespace

void read_tendons(const xml::Element& element, Reader& reader) {
  for (const xml::Element& child : element.children) {
    if (child.tag == "spatial" || child.tag == "fixed") {
      read_tendon(child, reader);
    } else {
      reader.log.skipped(child, "no tendon that is known here");
    }
  }
}

}  // namespace sheave::import::mjcf
