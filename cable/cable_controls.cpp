// Controls of cables in a running world (engine/controls.h). A substep derives the compiled cables
// that it reads from the definitions and from the controls of its state, so the result depends on
// the state alone. A world without controls never runs this code.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

double set_or(double set, double defined) { return std::isnan(set) ? defined : set; }

bool is_above_zero(double value) { return value > 0.0 && std::isfinite(value); }

std::string above_zero_fault(const std::string& what, double value) {
  return what + " must be finite and above 0, not " + number_text(value);
}

}  // namespace

void CableSystem::follow_state(const Substep& substep, const FeatureState& state) {
  const Controls& controls = substep.start.controls;
  if (controlled_ || controls.cables_any()) follow_controls(controls);
  if (!course_changes_ && has_cut(state)) expect_cuts();
  // An earlier attempt at this substep may have moved geodesics.
  const bool lies_smoothly = std::any_of(
      links_.begin(), links_.end(), [](const LinkGeometry& l) { return l.geodesic.has_value(); });
  if (course_changes_ && (lies_smoothly || !follows(state))) {
    follow_course(substep.bodies, state);
  } else if (!changing_links_.empty()) {
    refresh_ends(state, links_, spans_);
  }
  if (controls_links_) control_links(substep, state);
}

void CableSystem::follow_controls(const Controls& controls) {
  const CableControl nothing;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    CompiledCable& cable = cables_[c];
    const CableControl* found = controls.cables.find(static_cast<int>(c));
    const CableControl& set = found != nullptr ? *found : nothing;
    const double compliance = set_or(set.compliance, defined_[c].compliance);
    // The rows of affine spans contain the compliance, too.
    if (compliance != cable.compliance) affine_.clear();
    cable.compliance = compliance;
    cable.breaking_tension = set_or(set.breaking_tension, defined_[c].breaking_tension);
    cable.wrap_friction = set_or(set.wrap_friction, defined_[c].wrap_friction);
    cable.added_length = set.added_length;
    if (std::isfinite(cable.breaking_tension) && !cable.course_changes) expect_cuts();
  }
  // One more time after the last control was cleared, to restore the definitions.
  controls_links_ = controls.cables_any() || controlled_;
  controlled_ = controls.cables_any();
}

void CableSystem::expect_cuts() {
  for (CompiledCable& cable : cables_) cable.course_changes = true;
  course_changes_ = true;
}

bool CableSystem::has_cut(const FeatureState& own) const {
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    if (own.integers[cut_index(static_cast<int>(c))] != 0) return true;
  }
  return false;
}

void CableSystem::control_links(const Substep& substep, const FeatureState& state) {
  const Controls& controls = substep.start.controls;
  const double from = substep.start.time;
  const double to = substep.next.time;
  for (const CompiledCable& cable : cables_) {
    for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
      LinkGeometry& link = links_[at(i)];
      const LinkGeometry& definition = definitions_[at(i)];
      const LinkControl* set = controls.links.find(i);
      const bool listed = i <= cable.last_listed_link();
      if (!listed && state.integers[wrap_index(i)] != 0) link.friction = cable.wrap_friction;
      if (!listed) continue;
      link.friction =
          set != nullptr ? set_or(set->friction, definition.friction) : definition.friction;
      const bool fed = set != nullptr && set->has_feed;
      link.feed_speed =
          fed ? set->feed_speed.integral(from, to) / (to - from) : definition.feed_speed;
      link.feed_end_speed = fed ? set->feed_speed.at(to) : definition.feed_end_speed;
    }
  }
  controls_links_ = controlled_;
}

double CableSystem::compliance_under(const Controls& controls, int cable,
                                     double rest_length) const {
  const CableControl* set = controls.cables.find(cable);
  const double defined = defined_[at(cable)].compliance;
  return (set != nullptr ? set_or(set->compliance, defined) : defined) +
         cables_[at(cable)].inverse_stiffness * std::max(rest_length, 0.0);
}

std::string CableSystem::compliance_fault(int cable, double compliance) const {
  if (defined_[at(cable)].compliance > 0.0 && is_above_zero(compliance)) return {};
  const std::string name = "cable \"" + cables_[at(cable)].name + "\"";
  if (!(defined_[at(cable)].compliance > 0.0)) {
    return name +
           (cables_[at(cable)].inverse_stiffness > 0.0
                ? " has an axial_stiffness or a tension_table and no compliance"
                : " is rigid") +
           "; only a compliance above 0 in the model can be changed";
  }
  return above_zero_fault("the compliance of " + name, compliance);
}

std::string CableSystem::breaking_fault(int cable, double tension) const {
  if (cables_[at(cable)].axial_inertia) {
    return "cable \"" + cables_[at(cable)].name +
           "\" has axial_inertia, and a rope with inertia does not break";
  }
  if (is_above_zero(tension)) return {};
  return above_zero_fault("the breaking tension of cable \"" + cables_[at(cable)].name + "\"",
                          tension);
}

std::string CableSystem::wrap_friction_fault(int cable, double friction) const {
  if (defined_[at(cable)].wrap_friction > 0.0 && is_above_zero(friction)) return {};
  const std::string name = "cable \"" + cables_[at(cable)].name + "\"";
  if (!(defined_[at(cable)].wrap_friction > 0.0)) {
    return name + " has no wrap_friction; only one above 0 in the model can be changed";
  }
  return above_zero_fault("the wrap_friction of " + name, friction);
}

std::string CableSystem::link_fault(int cable, int link) const {
  const CompiledCable& own = cables_[at(cable)];
  if (link >= 0 && link < own.listed_links) return {};
  return "cable \"" + own.name + "\" has no link number " + std::to_string(link) + "; it has " +
         std::to_string(own.listed_links);
}

std::string CableSystem::friction_fault(int cable, int link, double friction) const {
  std::string fault = link_fault(cable, link);
  if (!fault.empty()) return fault;
  const double defined = definitions_[at(cables_[at(cable)].first_link + link)].friction;
  if (defined > 0.0 && is_above_zero(friction)) return {};
  const std::string name =
      "link " + std::to_string(link) + " of cable \"" + cables_[at(cable)].name + "\"";
  if (sheath_places_[at(cables_[at(cable)].first_link + link)] >= 0) {
    return name + " is a sheath, whose friction stays that of the model";
  }
  if (!(defined > 0.0)) {
    return name + " has no friction; only one above 0 in the model can be changed";
  }
  return above_zero_fault("the friction of " + name, friction);
}

std::string CableSystem::feed_fault(int cable, int link) const {
  std::string fault = link_fault(cable, link);
  if (!fault.empty()) return fault;
  if (definitions_[at(cables_[at(cable)].first_link + link)].feeds) return {};
  return "link " + std::to_string(link) + " of cable \"" + cables_[at(cable)].name +
         "\" feeds no cable; give it a feed_speed in the model, which may be 0";
}

bool CableSystem::accepts_controls(const Controls& controls) const {
  if (controls.cables.entries().size() > cables_.size() ||
      controls.links.entries().size() > definitions_.size()) {
    return false;
  }
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    if (const CableControl* set = controls.cables.find(c)) {
      if ((!std::isnan(set->compliance) && !compliance_fault(c, set->compliance).empty()) ||
          (!std::isnan(set->breaking_tension) &&
           !breaking_fault(c, set->breaking_tension).empty()) ||
          (!std::isnan(set->wrap_friction) &&
           !wrap_friction_fault(c, set->wrap_friction).empty()) ||
          !std::isfinite(set->added_length)) {
        return false;
      }
    }
    const CompiledCable& cable = cables_[at(c)];
    for (int i = 0; i < cable.link_count; ++i) {
      const LinkControl* set = controls.links.find(cable.first_link + i);
      if (set == nullptr) continue;
      if ((!std::isnan(set->friction) && !friction_fault(c, i, set->friction).empty()) ||
          (set->has_feed && !(feed_fault(c, i).empty() && set->feed_speed.is_sound()))) {
        return false;
      }
    }
  }
  return true;
}

double CableSystem::defined_feed(int cable, int link) const {
  return definitions_[at(cables_[at(cable)].first_link + link)].feed_speed;
}

}  // namespace sheave
