// Bearings that brake wheels, with and without inertia, from the settings of rolling links.

#include "cable/cable.h"
#include "cable/certificate/evidence.h"
#include "cable/certificate/losses.h"
#include "cable/links/rolling.h"
#include "engine/index.h"

namespace sheave::certify {

LossEvidence losses_of(const RollingLink& link) {
  const double efficiency = link.efficiency.value_or(1.0);
  return {(1.0 - efficiency) / (1.0 + efficiency) + 0.5 * link.bending_loss,
          link.journal_radius.value_or(0.0) * link.bearing_friction};
}

void Evidence::find_brakes() {
  brakes_.assign(at(bodies.count()), 0);
  if (simulation.cables == nullptr) return;
  for (const CableDef& cable : *simulation.cable_definitions) {
    for (const auto& link : cable.links) {
      const auto* rolling = dynamic_cast<const RollingLink*>(link.get());
      const int body = bodies.index(link->body);
      if (rolling == nullptr || body == bodies.count()) continue;
      if (losses_of(*rolling).any() && bodies[body].massless()) brakes_[at(body)] = 1;
    }
  }
}

bool Evidence::brakes(int body) const { return body < bodies.count() && brakes_[at(body)] != 0; }

Vector3 Evidence::turn_of(int body) const {
  return body == bodies.count() ? Vector3(Vector3::Zero()) : turns_[at(body)];
}

void Evidence::collect_bearing(const CableEvidence& cable, const PassEvidence& pass,
                               const std::array<const LinkReport*, 2>& link) {
  if (pass.link < 0 || cable.has_changed) return;
  const auto* rolling =
      dynamic_cast<const RollingLink*>(cable.definition->links[at(pass.link)].get());
  const int body = bodies.index(link[0]->body);
  if (rolling == nullptr || body == bodies.count() || brakes(body)) return;
  const LossEvidence losses = losses_of(*rolling);
  if (!losses.any()) return;
  BearingEvidence& bearing = bearings.emplace_back();
  bearing.cable = cable.name;
  bearing.link = pass.link;
  bearing.rotor = body;
  const double rope = link[0]->radius * losses.rope;
  bearing.size = rope + losses.pin;
  const double above =
      cable.spans[at(pass.before)].to.above + cable.spans[at(pass.after)].from.above;
  for (const End when : {first_end, last_end}) {
    bearing.torque[at(when)] = link[at(when)]->bearing_torque;
    const double share = rattle ? 0.5 : when == last_end ? 1.0 : 0.0;
    double pressed = above * share;
    for (const int k : {pass.before, pass.after}) pressed += cable.spans[at(k)].force[at(when)];
    bearing.bound[at(when)] = rope * pressed;
    if (losses.pin == 0.0) continue;
    const SpanEvidence& in = cable.spans[at(pass.before)];
    const SpanEvidence& out = cable.spans[at(pass.after)];
    const Vector3 load = out.force[at(when)] * out.direction[at(when)] -
                         in.force[at(when)] * in.direction[at(when)] +
                         share * bodies[body].mass * gravity;
    bearing.bound[at(when)] += losses.pin * load.norm();
  }
  bearing.turn = end.bodies[at(body)].angle - start.bodies[at(body)].angle;
  const int mount = bodies[body].mount;
  Vector3 spin = end.bodies[at(body)].angular_velocity;
  Vector3 axle = bodies[body].axis;
  if (mount >= 0) {
    spin -= end.bodies[at(mount)].angular_velocity;
    axle = end.bodies[at(mount)].orientation * axle;
  }
  bearing.rate = axle.dot(spin);
}

void Evidence::apply_bearings() {
  for (const BearingEvidence& bearing : bearings) {
    const int mount = bodies[bearing.rotor].mount;
    for (const End when : {first_end, last_end}) {
      Vector3 axle = bodies[bearing.rotor].axis;
      if (mount >= 0) axle = moments[at(when)].orientation(mount) * axle;
      twist(when, bearing.rotor, bearing.torque[at(when)] * axle);
      if (mount >= 0) twist(when, mount, -bearing.torque[at(when)] * axle);
    }
  }
}

}  // namespace sheave::certify
