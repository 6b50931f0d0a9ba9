#include "cable/links/rolling.h"

#include <cmath>
#include <string>
#include <utility>

#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/math/portable.h"

namespace sheave {

std::span<const Field> RollingLink::field_table() {
  static const std::array table = joined(
      wheel_fields<RollingLink>(),
      std::array{
          field<&RollingLink::stored_length>("stored_length", "m", at_least(0.0), optional,
                                             "cable wound on the wheel at time 0; required at the "
                                             "end of an open cable, elsewhere it "
                                             "follows from the tangents"),
          field<&RollingLink::friction>(
              "friction", "", at_least(0.0), optional,
              "capstan coefficient: the cable slips when the ratio of the "
              "tensions passes e^(friction x wrap angle); default: no slip"),
          choice_field<&RollingLink::passes>(
              "passes", passage_names, optional,
              "directions in which cable slides over the wheel, relative to the body; needs "
              "friction; forward is from the cable's first link to its last; with one direction "
              "the wheel is a ratchet, which holds any tension in the other"),
          field<&RollingLink::efficiency>(
              "efficiency", "", {.minimum = 0.0, .maximum = 1.0, .minimum_allowed = false},
              optional,
              "of a rotor's bearing: tension of the cable that comes to it over that of the cable "
              "that goes from it, while it turns steadily; default: 1"),
          field<&RollingLink::lifted>(
              "lifted", "", {}, optional,
              "whether the cable passes the wheel by at time 0; it is wound on "
              "when it comes to touch it"),
          field<&RollingLink::turns>("turns", "", between(0, 1000), optional,
                                     "whole turns in addition to the arc between the tangents; an "
                                     "arc of more than 300 degrees without any is refused"),
      });
  return table;
}

namespace {

/// Why the wheel of a link has no bearing that could have an efficiency; empty if it has one.
std::string bearing_fault(const BodySet& bodies, const LinkGeometry& link) {
  const bool rotor = link.body != bodies.count() && bodies[link.body].mobility == Mobility::rotor;
  if (!rotor) return "only a rotor has a bearing that takes a part of the tension";
  const std::string name = "\"" + bodies.name(link.body) + "\"";
  if (bodies[link.body].prescribed()) {
    return name + " turns as its drive says, whatever its bearing takes; leave efficiency out";
  }
  if (link.outline) return name + " must be circular to have an efficiency; give a \"radius\"";
  if (link.carrier == link.body) {
    return "the bearing of " + name + " is at its centre; put the link's centre on the axle";
  }
  return {};
}

/// Why the cable cannot pass a wheel in one direction only; empty if it can.
std::string ratchet_fault(const RollingLink& definition, const BodySet& bodies,
                          const LinkGeometry& link) {
  if (link.blocked == 0) return {};
  if (!definition.friction) {
    return "cable slides over the wheel in one direction, so the link needs a \"friction\"; give "
           "0 for none";
  }
  if (!link.massless) return {};
  return "the wheel \"" + bodies.name(link.body) +
         "\" has no spin inertia and turns with the cable in both directions; give it one, or take "
         "a static body";
}

}  // namespace

Result<LinkGeometry> RollingLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place(bodies, path);
  if (!link) return link;
  // With a stored length the link is an end of the cable, fixed to the wheel.
  if (stored_length && !link->outline) link->hold_end();
  carry_by_axle(bodies, *link);
  link->given_stored_length = stored_length.value_or(std::numeric_limits<double>::quiet_NaN());
  link->extra_turns = turns;
  link->starts_lifted = lifted;
  link->friction = friction.value_or(std::numeric_limits<double>::quiet_NaN());
  link->blocked = blocked_way(passes);
  const std::string one_way = ratchet_fault(*this, bodies, *link);
  if (!one_way.empty()) return Error{path + "/passes", one_way};
  if (!efficiency || *efficiency == 1.0) return link;
  const std::string fault = bearing_fault(bodies, *link);
  if (!fault.empty()) return Error{path + "/efficiency", fault};
  if (!link->massless) {
    link->bearing_arm = std::abs(link->signed_radius) * (1.0 - *efficiency) / (1.0 + *efficiency);
    return link;
  }
  link->loss_exponent = -portable::log(*efficiency);
  link->wheel = std::exchange(link->body, link->carrier);
  link->mounted = link->body != bodies.count() && bodies[link->body].mount >= 0;
  return link;
}

}  // namespace sheave
