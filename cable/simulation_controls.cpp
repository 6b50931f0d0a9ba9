// The setters of Simulation: each checks, then writes one entry of the state's controls.

#include "cable/simulation.h"
#include "engine/control_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

std::string path_of(int cable, const char* key) {
  return "/cables/" + std::to_string(cable) + "/" + key;
}

}  // namespace

std::string Simulation::cable_fault(int cable) const {
  const int count = cables == nullptr ? 0 : static_cast<int>(cables->cables().size());
  if (cable >= 0 && cable < count) return {};
  return "there is no cable number " + std::to_string(cable) + "; there are " +
         std::to_string(count);
}

Errors Simulation::set_cable(int cable, const char* key, const std::string& fault,
                             double CableControl::*member, double value) {
  if (!fault.empty()) return {{path_of(cable, key), fault}};
  ControlTable<CableControl>& table = world.controls_of_features().cables;
  const CableControl* before = table.find(cable);
  CableControl control = before != nullptr ? *before : CableControl{};
  control.*member = value;
  table.put(cable, cables->cables().size(), control);
  return {};
}

Errors Simulation::set_compliance(int cable, double compliance) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->compliance_fault(cable, compliance);
  return set_cable(cable, "compliance", fault, &CableControl::compliance, compliance);
}

Errors Simulation::clear_compliance(int cable) {
  return set_cable(cable, "compliance", cable_fault(cable), &CableControl::compliance, not_set);
}

Errors Simulation::set_breaking_tension(int cable, double tension) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->breaking_fault(cable, tension);
  return set_cable(cable, "breaking_tension", fault, &CableControl::breaking_tension, tension);
}

Errors Simulation::clear_breaking_tension(int cable) {
  return set_cable(cable, "breaking_tension", cable_fault(cable), &CableControl::breaking_tension,
                   not_set);
}

Errors Simulation::set_wrap_friction(int cable, double friction) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->wrap_friction_fault(cable, friction);
  return set_cable(cable, "wrap_friction", fault, &CableControl::wrap_friction, friction);
}

Errors Simulation::clear_wrap_friction(int cable) {
  return set_cable(cable, "wrap_friction", cable_fault(cable), &CableControl::wrap_friction,
                   not_set);
}

LinkControl Simulation::link_control(int cable, int link) const {
  const int index = cables->cables()[at(cable)].first_link + link;
  const LinkControl* before = world.state().controls.links.find(index);
  return before != nullptr ? *before : LinkControl{};
}

Errors Simulation::set_link(int cable, int link, const char* key, const std::string& fault,
                            const LinkControl& control) {
  if (!fault.empty()) {
    return {{path_of(cable, "links/") + std::to_string(link) + "/" + key, fault}};
  }
  const int index = cables->cables()[at(cable)].first_link + link;
  world.controls_of_features().links.put(index, at(cables->link_count()), control);
  return {};
}

Errors Simulation::set_friction(int cable, int link, double friction) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->friction_fault(cable, link, friction);
  LinkControl control = fault.empty() ? link_control(cable, link) : LinkControl{};
  control.friction = friction;
  return set_link(cable, link, "friction", fault, control);
}

Errors Simulation::clear_friction(int cable, int link) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->friction_fault(cable, link, 1.0);
  LinkControl control = fault.empty() ? link_control(cable, link) : LinkControl{};
  control.friction = not_set;
  return set_link(cable, link, "friction", fault, control);
}

Errors Simulation::set_feed_speed(int cable, int link, const DriveTarget& target) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->feed_fault(cable, link);
  LinkControl control;
  if (fault.empty()) {
    control = link_control(cable, link);
    const double time = world.state().time;
    const double now =
        control.has_feed ? control.feed_speed.at(time) : cables->defined_feed(cable, link);
    control.has_feed = true;
    const DriveNow ask{DriveMeaning::speed, now, 0.0, time, world.control_interval()};
    if (!make_ramp(ask, target, control.feed_speed)) {
      fault = "the feed of cable \"" + cables->cables()[at(cable)].name + "\"" +
              ramp_fault(ask, target);
    }
  }
  return set_link(cable, link, "feed_speed", fault, control);
}

Errors Simulation::clear_feed_speed(int cable, int link) {
  std::string fault = cable_fault(cable);
  if (fault.empty()) fault = cables->feed_fault(cable, link);
  LinkControl control = fault.empty() ? link_control(cable, link) : LinkControl{};
  control.has_feed = false;
  control.feed_speed = Ramp{};
  return set_link(cable, link, "feed_speed", fault, control);
}

}  // namespace sheave
