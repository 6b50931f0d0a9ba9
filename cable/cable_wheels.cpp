// Wheels without inertia turn exactly as far as cable passes over them.

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::stop_wheel(Substep& substep, int wheel) const {
  // Undoes the predicted rotation, which the bearing does not allow.
  const BodyProperties& properties = substep.bodies[wheel];
  BodyState& next = substep.next.bodies[at(wheel)];
  next.angle = substep.start.bodies[at(wheel)].angle;
  next.orientation = rotation_by(next.angle * properties.axis) * properties.start_orientation;
  next.angular_velocity = Vector3::Zero();
  if (properties.mount < 0) return;
  const BodyState& carrier = substep.next.bodies[at(properties.mount)];
  next.orientation = carrier.orientation * next.orientation;
  next.angular_velocity = carrier.angular_velocity;
}

void CableSystem::turn_massless_wheel(Substep& substep, int span, double moved) const {
  const CompiledCable& cable = cables_[at(spans_[at(span)].cable)];
  // Both sides have the same tension and, without dampers, the same strain.
  double strain = cable.strain_under(multipliers_[at(span)] / (substep.h * substep.h));
  const double own = end_strains_[at(span)];
  const int behind = next_span(cable, span);
  if (weighs_now(substep, cable)) {
    strain = 0.5 * (hanging_[at(span)].strains[1] + hanging_[at(behind)].strains[0]);
  } else if (cable.is_damped() && strains_runs(cable) && own >= 0.0) {
    strain = 0.5 * (own + end_strains_[at(behind)]);
  }
  const double length = moved * (1.0 + strain);
  if (length == 0.0) return;
  const LinkGeometry& geometry = links_[at(spans_[at(span)].second)];
  const int turned = geometry.touched();
  const BodyProperties& wheel = substep.bodies[turned];
  BodyState& next = substep.next.bodies[at(turned)];
  const Quaternion carrier = wheel.mount >= 0 ? substep.next.bodies[at(wheel.mount)].orientation
                                              : Quaternion(Quaternion::Identity());
  const Vector3 axis = carrier * wheel.axis;
  const Quaternion& link_frame = geometry.carrier == turned ? next.orientation : carrier;
  const double sense = axis.dot(link_frame * geometry.normal) > 0.0 ? 1.0 : -1.0;
  const double turn = sense * length / geometry.signed_radius;
  next.angle += turn;
  next.angular_velocity += turn / substep.h * axis;
  next.orientation = carrier * rotation_by(next.angle * wheel.axis) * wheel.start_orientation;
}

}  // namespace sheave
