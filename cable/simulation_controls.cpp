// Setters of Simulation. Each checks its arguments and writes one entry of the state's controls.
// Error texts are composed only if there is a fault.

#include <cmath>
#include <string>
#include <vector>

#include "cable/cable_system.h"
#include "cable/cut_place.h"
#include "cable/running_cable.h"
#include "cable/simulation.h"
#include "engine/constraint_batch.h"
#include "engine/control_check.h"
#include "engine/index.h"
#include "engine/number_text.h"

namespace sheave {
namespace {

bool has_cable(const Simulation& simulation, int cable) {
  return cable >= 0 && simulation.cables != nullptr &&
         at(cable) < simulation.cables->cables().size();
}

[[gnu::cold, gnu::noinline]] std::string cable_fault(const Simulation& simulation, int cable) {
  const std::size_t count = simulation.cables == nullptr ? 0 : simulation.cables->cables().size();
  return "there is no cable number " + std::to_string(cable) + "; there are " +
         std::to_string(count);
}

[[gnu::cold, gnu::noinline]] Errors refuse(int cable, const std::string& key, std::string fault) {
  return {{"/cables/" + std::to_string(cable) + "/" + key, std::move(fault)}};
}

[[gnu::cold, gnu::noinline]] Errors refuse_link(int cable, int link, const char* key,
                                                std::string fault) {
  return refuse(cable, "links/" + std::to_string(link) + "/" + key, std::move(fault));
}

/// Sets a control of a cable by `change(entry)`.
template <class Change>
Errors change_cable(Simulation& simulation, int cable, const Change& change) {
  simulation.world.controls_of_features().cables.change(cable, simulation.cables->cables().size(),
                                                        change);
  return {};
}

/// The place of a cut in a state, or why the cable cannot be cut there.
Result<CutPlace> free_place(const CableSystem& system, int cable, double place,
                            const FeatureState& own) {
  const CompiledCable& compiled = system.cables()[at(cable)];
  const std::vector<FreeStretch> free = free_stretches(system, compiled, own);
  std::string ranges;
  for (const FreeStretch& one : free) {
    const double end = one.from + one.length;
    if (place > one.from && place < end) return CutPlace{one.span, (place - one.from) / one.length};
    // A cable of a thousand spans needs no list of them; the nearest ones help.
    const bool is_near = std::abs(place - one.from) < 2.0 * one.length ||
                         std::abs(place - end) < 2.0 * one.length || free.size() < 8;
    if (!is_near || !(one.length > 0.0)) continue;
    ranges +=
        (ranges.empty() ? "" : ", ") + number_text(one.from) + " m to " + number_text(end) + " m";
  }
  return Error{"", "cable \"" + compiled.name + "\" is not free at " + number_text(place) +
                       " m from its first link; it can be cut in its free spans" +
                       (ranges.empty() ? "" : ", such as " + ranges)};
}

int link_index(const Simulation& simulation, int cable, int link) {
  return simulation.cables->cables()[at(cable)].first_link + link;
}

/// The same for a link.
template <class Change>
Errors change_link(Simulation& simulation, int cable, int link, const Change& change) {
  simulation.world.controls_of_features().links.change(link_index(simulation, cable, link),
                                                       at(simulation.cables->link_count()), change);
  return {};
}

}  // namespace

Errors Simulation::set_compliance(int cable, double compliance) {
  if (!has_cable(*this, cable)) return refuse(cable, "compliance", cable_fault(*this, cable));
  std::string fault = cables->compliance_fault(cable, compliance);
  if (!fault.empty()) return refuse(cable, "compliance", std::move(fault));
  return change_cable(*this, cable, [&](CableControl& set) { set.compliance = compliance; });
}

Errors Simulation::clear_compliance(int cable) {
  if (!has_cable(*this, cable)) return refuse(cable, "compliance", cable_fault(*this, cable));
  return change_cable(*this, cable, [](CableControl& set) { set.compliance = not_set; });
}

Errors Simulation::set_breaking_tension(int cable, double tension) {
  if (!has_cable(*this, cable)) return refuse(cable, "breaking_tension", cable_fault(*this, cable));
  std::string fault = cables->breaking_fault(cable, tension);
  if (!fault.empty()) return refuse(cable, "breaking_tension", std::move(fault));
  return change_cable(*this, cable, [&](CableControl& set) { set.breaking_tension = tension; });
}

Errors Simulation::clear_breaking_tension(int cable) {
  if (!has_cable(*this, cable)) return refuse(cable, "breaking_tension", cable_fault(*this, cable));
  return change_cable(*this, cable, [](CableControl& set) { set.breaking_tension = not_set; });
}

Errors Simulation::cut_cable(int cable) {
  if (Errors errors = set_breaking_tension(cable, RunningCable::no_tension); !errors.empty())
    return errors;
  State state = world.state();
  auto* system = static_cast<CableSystem*>(world.features().back().get());
  if (!system->part(cable, world.bodies(), state.time, state.features.back())) return {};
  return world.restore(state);
}

Errors Simulation::cut_cable(int cable, double place) {
  if (!has_cable(*this, cable)) return refuse(cable, "place", cable_fault(*this, cable));
  auto* system = static_cast<CableSystem*>(world.features().back().get());
  const FeatureState& now = world.state().features.back();
  if (now.integers[system->cut_index(cable)] != 0) return {};
  const Result<CutPlace> found = free_place(*system, cable, place, now);
  if (!found) return refuse(cable, "place", found.errors().front().message);
  if (Errors errors = set_breaking_tension(cable, RunningCable::no_tension); !errors.empty())
    return errors;
  State state = world.state();
  system->part(cable, world.bodies(), state.time, state.features.back(), &*found);
  return world.restore(state);
}

Errors Simulation::set_wrap_friction(int cable, double friction) {
  if (!has_cable(*this, cable)) return refuse(cable, "wrap_friction", cable_fault(*this, cable));
  std::string fault = cables->wrap_friction_fault(cable, friction);
  if (!fault.empty()) return refuse(cable, "wrap_friction", std::move(fault));
  return change_cable(*this, cable, [&](CableControl& set) { set.wrap_friction = friction; });
}

Errors Simulation::clear_wrap_friction(int cable) {
  if (!has_cable(*this, cable)) return refuse(cable, "wrap_friction", cable_fault(*this, cable));
  return change_cable(*this, cable, [](CableControl& set) { set.wrap_friction = not_set; });
}

Errors Simulation::set_friction(int cable, int link, double friction) {
  if (!has_cable(*this, cable)) {
    return refuse_link(cable, link, "friction", cable_fault(*this, cable));
  }
  std::string fault = cables->friction_fault(cable, link, friction);
  if (!fault.empty()) return refuse_link(cable, link, "friction", std::move(fault));
  return change_link(*this, cable, link, [&](LinkControl& set) { set.friction = friction; });
}

Errors Simulation::clear_friction(int cable, int link) {
  if (!has_cable(*this, cable)) {
    return refuse_link(cable, link, "friction", cable_fault(*this, cable));
  }
  std::string fault = cables->friction_fault(cable, link, 1.0);
  if (!fault.empty()) return refuse_link(cable, link, "friction", std::move(fault));
  return change_link(*this, cable, link, [](LinkControl& set) { set.friction = not_set; });
}

Errors Simulation::set_feed_speed(int cable, int link, const DriveTarget& target) {
  if (!has_cable(*this, cable)) {
    return refuse_link(cable, link, "feed_speed", cable_fault(*this, cable));
  }
  std::string fault = cables->feed_fault(cable, link);
  if (!fault.empty()) return refuse_link(cable, link, "feed_speed", std::move(fault));
  const double time = world.state().time;
  const LinkControl* before = world.state().controls.links.find(link_index(*this, cable, link));
  const double speed = before != nullptr && before->has_feed ? before->feed_speed.at(time)
                                                             : cables->defined_feed(cable, link);
  const DriveNow now{DriveMeaning::speed, speed, 0.0, time, world.control_interval()};
  Ramp ramp;
  if (!make_ramp(now, target, ramp)) {
    return refuse_link(
        cable, link, "feed_speed",
        "the feed of cable \"" + cables->cables()[at(cable)].name + "\"" + ramp_fault(now, target));
  }
  return change_link(*this, cable, link, [&](LinkControl& set) {
    set.has_feed = true;
    set.feed_speed = ramp;
  });
}

Errors Simulation::clear_feed_speed(int cable, int link) {
  if (!has_cable(*this, cable)) {
    return refuse_link(cable, link, "feed_speed", cable_fault(*this, cable));
  }
  std::string fault = cables->feed_fault(cable, link);
  if (!fault.empty()) return refuse_link(cable, link, "feed_speed", std::move(fault));
  return change_link(*this, cable, link, [](LinkControl& set) {
    set.has_feed = false;
    set.feed_speed = Ramp{};
  });
}

}  // namespace sheave
