#include "cable/links/rolling.h"

#include <cmath>
#include <string>
#include <utility>

#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/math/portable.h"
#include "engine/number_text.h"

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
          field<&RollingLink::bending_loss>(
              "bending_loss", "", {.minimum = 0.0, .maximum = 1.0, .maximum_allowed = false},
              optional,
              "share of the tension that the rope loses by being bent onto the wheel and "
              "straightened again; only on a rotor, in place of efficiency"),
          field<&RollingLink::bearing_friction>(
              "bearing_friction", "", at_least(0.0), optional,
              "coefficient of friction of the pin, whose load is the vector sum of the tensions "
              "and, if the wheel has a spin inertia, of its weight; only on a rotor, in place of "
              "efficiency"),
          field<&RollingLink::journal_radius>(
              "journal_radius", "m", above(0.0), optional,
              "radius of the pin on which the wheel turns; needed with bearing_friction"),
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

/// Why the wheel of a link has no bearing that could have the losses of a setting; empty if it has
/// one.
std::string bearing_fault(const BodySet& bodies, const LinkGeometry& link,
                          const std::string& loss) {
  const bool rotor = link.body != bodies.count() && bodies[link.body].mobility == Mobility::rotor;
  if (!rotor) return "only a rotor has a bearing that takes a part of the tension";
  const std::string name = "\"" + bodies.name(link.body) + "\"";
  if (bodies[link.body].prescribed()) {
    return name + " turns as its drive says, whatever its bearing takes; leave " + loss + " out";
  }
  if (link.outline) return name + " must be circular to have losses; give a \"radius\"";
  if (link.carrier == link.body) {
    return "the bearing of " + name + " is at its centre; put the link's centre on the axle";
  }
  return {};
}

struct LossFault {
  std::string field;
  std::string message;  ///< empty: there is none
};

/// The first fault of the losses of a wheel with the radius [m].
LossFault loss_fault(const RollingLink& link, double radius) {
  const bool rubs = link.bearing_friction > 0.0;
  if (link.efficiency && (link.bending_loss > 0.0 || rubs)) {
    return {"efficiency",
            "one number stands for all losses of the sheave; leave efficiency out, or leave "
            "bending_loss and bearing_friction out"};
  }
  if (rubs && !link.journal_radius) {
    return {"journal_radius",
            "the friction of a bearing acts on its pin; give the radius of the "
            "pin [m], or leave bearing_friction out"};
  }
  if (!rubs && link.journal_radius) {
    return {"journal_radius",
            "a pin without friction takes nothing; give a bearing_friction, or "
            "leave journal_radius out"};
  }
  if (!rubs) return {};
  const double arm = *link.journal_radius * link.bearing_friction;
  const double most = radius * (1.0 - 0.5 * link.bending_loss);
  if (arm < most) return {};
  return {"bearing_friction",
          "the pin would hold the wheel whatever the tensions: journal_radius x bearing_friction "
          "is " +
              number_text(arm) + " m, and must be less than " + number_text(most) +
              " m, the radius of the wheel less half of its bending_loss"};
}

/// A wheel without inertia stands on its carrier as a post over which the cable slides.
void turn_by_cable(const BodySet& bodies, LinkGeometry& link) {
  link.wheel = std::exchange(link.body, link.carrier);
  link.mounted = link.body != bodies.count() && bodies[link.body].mount >= 0;
}

/// The link of a wheel with a bending loss or a bearing with friction (cable/bearing_loss.h).
LinkGeometry with_losses(const RollingLink& settings, const BodySet& bodies, LinkGeometry link) {
  const double radius = std::abs(link.signed_radius);
  link.loss.rope = 0.5 * settings.bending_loss;
  const double pin = settings.journal_radius.value_or(0.0) * settings.bearing_friction;
  link.loss.pin = pin / radius;
  if (link.massless) {
    link.loss_exponent = link.loss.exponent(pi);
    turn_by_cable(bodies, link);
  } else {
    link.bearing_arm = radius * link.loss.rope + pin;
    link.pin_share = pin / link.bearing_arm;
  }
  return link;
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
  const LossFault wrong = loss_fault(*this, std::abs(link->signed_radius));
  if (!wrong.message.empty()) return Error{path + "/" + wrong.field, wrong.message};
  const bool parts = bending_loss > 0.0 || bearing_friction > 0.0;
  if (!parts && (!efficiency || *efficiency == 1.0)) return link;
  const std::string loss = !parts               ? "efficiency"
                           : bending_loss > 0.0 ? "bending_loss"
                                                : "bearing_friction";
  const std::string fault = bearing_fault(bodies, *link, loss);
  if (!fault.empty()) return Error{path + "/" + loss, fault};
  if (parts) return with_losses(*this, bodies, std::move(*link));
  if (!link->massless) {
    link->bearing_arm = std::abs(link->signed_radius) * (1.0 - *efficiency) / (1.0 + *efficiency);
    return link;
  }
  link->loss_exponent = -portable::log(*efficiency);
  turn_by_cable(bodies, *link);
  return link;
}

}  // namespace sheave
