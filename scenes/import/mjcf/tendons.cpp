// <tendon>: spatial tendons through sites, over spheres and cylinders, with one pulley.

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// Why the path of a tendon has no counterpart; empty: it has one.
std::string path_fault(const Tendon& tendon) {
  if (tendon.path.size() < 2) return "a tendon needs two sites";
  for (std::size_t i = 0; i < tendon.path.size(); ++i) {
    if (tendon.path[i].site >= 0) continue;
    const bool inner = i > 0 && i + 1 < tendon.path.size();
    if (!inner || tendon.path[i - 1].site < 0 || tendon.path[i + 1].site < 0) {
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
    if (!tendon.path.empty()) {
      reader.log.skipped(*tendon.element,
                         fmt::format("line {}: a pulley that divides the tendon into branches has "
                                     "no counterpart; a cable over a sheave on a rail has",
                                     part.line));
      return false;
    }
    tendon.divisor = *divisor;
    return true;
  } else {
    reader.log.error(part, "no part of a spatial tendon; allowed are site, geom and pulley", {},
                     FaultCode::unknown_key);
    return false;
  }
  tendon.path.push_back(point);
  return true;
}

void read_spatial(const xml::Element& element, Reader& reader) {
  Model& model = reader.model;
  Attributes attributes = reader.attributes(element, "tendon");
  Tendon tendon;
  tendon.element = &element;
  tendon.name = attributes.text("name").value_or("");
  tendon.range = read_range(attributes, model.compiler.auto_limits, "range", "limited");
  tendon.stiffness = attributes.positive_or_zero("stiffness").value_or(0.0);
  tendon.damping = attributes.positive_or_zero("damping").value_or(0.0);
  if (const auto rest = attributes.numbers("springlength", 1, 2); !rest.empty()) {
    // -1: the length in the reference pose. Below a first number the spring would push.
    if (rest.back() >= 0.0) tendon.spring_length = rest.back();
  }
  for (const std::string_view name : {"frictionloss", "armature"}) {
    if (attributes.number(name).value_or(0.0) != 0.0) {
      reader.log.changed(element, fmt::format("{}: a cable has none along its length", name));
    }
  }
  attributes.finish({"group", "width", "rgba", "material", "user", "solreflimit", "solimplimit",
                     "solreffriction", "solimpfriction", "margin"});
  if (!model.option.limits) tendon.range.reset();
  if (!model.option.passive) tendon.stiffness = tendon.damping = 0.0;
  bool taken = true;
  for (const xml::Element& part : element.children) {
    taken = taken && read_part(part, tendon, reader);
  }
  const int number = static_cast<int>(model.tendons.size());
  reader.enter(model.tendon_names, tendon.name, number, element);
  if (taken) {
    const std::string fault = path_fault(tendon);
    if (!fault.empty()) reader.log.error(element, fault, {}, FaultCode::meaning);
  } else {
    tendon.path.clear();
  }
  model.tendons.push_back(std::move(tendon));
}

}  // namespace

void read_tendons(const xml::Element& element, Reader& reader) {
  for (const xml::Element& child : element.children) {
    if (child.tag == "spatial") {
      read_spatial(child, reader);
      continue;
    }
    reader.log.skipped(child, child.tag == "fixed"
                                  ? "a fixed tendon, a sum of joint coordinates, has no counterpart"
                                  : "no tendon that is known here");
    const std::string* const name = child.value("name");
    if (name == nullptr) continue;
    reader.enter(reader.model.tendon_names, *name, static_cast<int>(reader.model.tendons.size()),
                 child);
    Tendon empty;
    empty.element = &child;
    empty.name = *name;
    reader.model.tendons.push_back(std::move(empty));
  }
}

}  // namespace sheave::import::mjcf
