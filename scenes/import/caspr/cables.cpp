// <cable_set>: cables between attachments. An ideal cable is rigid, with its length at the start.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/caspr/reader.h"
#include "scenes/import/mjcf/pose.h"

namespace sheave::import::caspr {
namespace {

class CableReader {
 public:
  CableReader(const xml::Element& element, mjcf::Model& model, opensim::Properties& properties,
              Log& log)
      : element_(element), model_(model), properties_(properties), log_(log) {}

  void read() {
    const std::string& tag = element_.tag;
    if (tag != "cable_ideal" && tag != "cable_linear_spring" &&
        tag != "cable_passive_linear_spring") {
      log_.skipped(element_,
                   "no cable that is known here; known are cable_ideal, cable_linear_spring and "
                   "cable_passive_linear_spring");
      return;
    }
    mjcf::Tendon tendon;
    tendon.element = &element_;
    if (const std::string* name = element_.value("name")) tendon.name = *name;
    if (!read_path(tendon)) return;
    set_law(tendon);
    if (log_.failed()) return;
    model_.tendons.push_back(std::move(tendon));
  }

 private:
  bool read_path(mjcf::Tendon& tendon) {
    const xml::Element* const attachments = properties_.child(element_, "attachments");
    if (attachments == nullptr) {
      log_.error(element_, "<attachments> is missing", {}, FaultCode::missing_key);
      return false;
    }
    for (const xml::Element& one : attachments->children) {
      properties_.mark(one);
      const bool pulley = one.tag == "base_rotating_pulley";
      if (!pulley && one.tag != "attachment") {
        log_.skipped(one, "no attachment that is known here");
        log_.skipped(element_, "one of its attachments has no counterpart");
        return false;
      }
      if (!add_point(one, pulley, tendon)) return false;
    }
    if (tendon.path.size() >= 2) return true;
    log_.error(element_, "a cable needs at least two attachments", {}, FaultCode::missing_key);
    return false;
  }

  bool add_point(const xml::Element& one, bool pulley, mjcf::Tendon& tendon) {
    const double link = pulley ? 0.0 : properties_.number(one, "link").value_or(-1.0);
    const auto point = properties_.vector(one, pulley ? "fixed_location" : "location");
    const auto found = link == 0.0 ? model_.body_names.end()
                                   : model_.body_names.find(fmt::format("link {}", link));
    if (!point || (link != 0.0 && found == model_.body_names.end())) {
      log_.error(one, "<link> must be 0 or the number of a link, and <location> three numbers", {},
                 FaultCode::meaning);
      return false;
    }
    if (pulley) {
      log_.changed(one,
                   "a point at fixed_location: its pulley, which turns to the cable, is not "
                   "taken");
    }
    mjcf::Site site;
    site.element = &one;
    site.body = link == 0.0 ? 0 : found->second;
    site.frame.position = *point;
    if (site.body != 0 && from_center()) {
      site.frame.position += model_.bodies[at(site.body)].inertial.center;
    }
    tendon.path.push_back({&one, static_cast<int>(model_.sites.size()), -1, -1});
    model_.sites.push_back(std::move(site));
    return true;
  }

  [[nodiscard]] bool from_center() const {
    const std::string* const about = element_.value("attachment_reference");
    if (about == nullptr || (*about != "com" && *about != "joint")) {
      log_.error(element_, "attachment_reference must be com or joint",
                 about == nullptr ? "" : *about, FaultCode::unknown_choice);
      return false;
    }
    return *about == "com";
  }

  void set_law(mjcf::Tendon& tendon) {
    const xml::Element* const settings = properties_.child(element_, "properties");
    const double length = length_of(tendon);
    const auto number = [&](const char* name) {
      return settings == nullptr ? std::nullopt : properties_.number(*settings, name);
    };
    const bool bounded = number("force_min").has_value() || number("force_max").has_value();
    if (bounded) {
      log_.changed(*settings, "not taken: force_min and force_max, which bound the winch");
    }
    if (element_.tag == "cable_ideal") {
      tendon.is_rigid = true;
      return;
    }
    double stiffness = number("K").value_or(0.0);
    if (!(stiffness > 0.0)) {
      log_.error(element_, "<K> must be given and > 0", {}, FaultCode::out_of_range);
      return;
    }
    tendon.spring_length = number("l0").value_or(length);
    if (element_.tag == "cable_linear_spring") {
      // K is the stiffness of 1 m.
      stiffness /= length;
      log_.changed(element_, "the winch holds the length of the start, without force there");
    }
    tendon.stiffness = stiffness;
  }

  /// Length of the path at the start.
  [[nodiscard]] double length_of(const mjcf::Tendon& tendon) const {
    const mjcf::Pose pose = mjcf::pose_of(model_, model_.start_positions, {});
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < tendon.path.size(); ++i) {
      const auto point = [&](std::size_t k) -> Vector3 {
        const mjcf::Site& site = model_.sites[at(tendon.path[k].site)];
        return pose.bodies[at(site.body)].frame.point(site.frame.position);
      };
      length += (point(i + 1) - point(i)).norm();
    }
    return length;
  }

  const xml::Element& element_;
  mjcf::Model& model_;
  opensim::Properties& properties_;
  Log& log_;
};

}  // namespace

void read_cables(const xml::Element& root, mjcf::Model& model, opensim::Properties& properties,
                 Log& log) {
  const std::string* const wanted = root.value("default_cable_set");
  const xml::Element* chosen = nullptr;
  for (const xml::Element& set : root.children) {
    const std::string* const id = set.value("id");
    const bool is_wanted = wanted == nullptr || (id != nullptr && *id == *wanted);
    if (set.tag == "cable_set" && is_wanted && chosen == nullptr) chosen = &set;
  }
  if (chosen == nullptr) {
    log.error(root, "there is no <cable_set> with the id that default_cable_set names",
              wanted == nullptr ? "" : *wanted, FaultCode::meaning);
    return;
  }
  for (const xml::Element& set : root.children) {
    if (&set == chosen) {
      properties.mark(set);
    } else {
      log.skipped(set, "default_cable_set names another set");
    }
  }
  log.same(*chosen, "the cables");
  for (const xml::Element& cable : chosen->children) {
    properties.mark(cable);
    CableReader(cable, model, properties, log).read();
    if (log.failed()) return;
  }
}

}  // namespace sheave::import::caspr
