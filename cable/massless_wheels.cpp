#include "cable/massless_wheels.h"

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

Rolled roll(const StoredStrain& stored, double passed, double before, double behind) {
  Rolled rolled;
  if (passed >= 0.0) {
    rolled.way = passed * (1.0 + before);
    rolled.length = stored.rest_of(StoredStrain::End::outgoing, rolled.way, before);
    rolled.rate = (1.0 + before) / (1.0 + stored.strain_at(1.0));
    return rolled;
  }
  // Pieces of the stored cable do not depend on the law of the energy.
  StoredStrain rest = stored;
  const StoredStrain::Piece off = rest.take(StoredStrain::End::incoming, -passed, {});
  const double beyond = std::max(-passed - off.length, 0.0);
  rolled.way = -(off.length + off.stretch + beyond * (1.0 + behind));
  rolled.length = rolled.way / (1.0 + behind);
  rolled.rate = (1.0 + stored.strain_at(0.0)) / (1.0 + behind);
  return rolled;
}

void MasslessWheels::find(const Substep& substep, const CompiledCable& cable,
                          cable_parts::Run run) {
  std::vector<int>& wheels = s_.run_work_.wheels;
  // At rest cable passes without a way. The strain of a rope with memory counts with its spans.
  if (substep.at_rest || cable.memory) return;
  for (int i = 0, k = run.first; i + 1 < run.count; ++i, k = s_.next_span(cable, k)) {
    const int link = s_.spans_[at(k)].second;
    if (s_.links_[at(link)].wheel < 0 || s_.strain_places_[at(link)] < 0) continue;
    wheels[at(i)] = link;
    s_.run_work_.has_wheels = true;
  }
}

MasslessWheels::Kept MasslessWheels::kept(const CableSystem& system,
                                          std::span<const double> weights,
                                          std::optional<double> of_run) {
  const cable_parts::RunWork& work = system.run_work_;
  Kept kept;
  if (!work.has_wheels || !of_run) return kept;
  const double strain = *of_run;
  const auto mean_strain = [&](std::size_t i) {
    const cable_parts::StretchedSpan& span = work.stretched[i];
    return std::max(0.5 * (span.start_strain + span.damping.end(weights[i] * strain)), 0.0);
  };
  double passed = 0.0;
  double rate = 0.0;  // of `passed` by the strain
  for (std::size_t i = 0; i + 1 < work.wheels.size(); ++i) {
    const cable_parts::StretchedSpan& span = work.stretched[i];
    const double own = span.damping.end(weights[i] * strain);
    const double rest_length = span.length / (1.0 + own);
    passed += span.rest_length_at(own) - rest_length;
    rate += weights[i] / (1.0 + span.damping.share) * rest_length / (1.0 + own);
    if (const cable_parts::SlidingArc& arc = work.arcs[i]; arc.link >= 0) {
      const cable_parts::ArcSum sum = system.arc_with(arc, strain);
      passed -= sum.unstretched - arc.before.length;
      rate += sum.slope;
    }
    const int link = work.wheels[i];
    if (link < 0) continue;
    const Rolled rolled = roll(system.stored_[at(system.strain_places_[at(link)])], passed,
                               mean_strain(i), mean_strain(i + 1));
    kept.length += passed - rolled.length;
    kept.slope -= rate * (1.0 - rolled.rate);
    passed = rolled.length;
    rate *= rolled.rate;
  }
  return kept;
}

double MasslessWheels::mean_strain(int i) const {
  const cable_parts::StretchedSpan& span = s_.run_work_.stretched[at(i)];
  return 0.5 * (span.start_strain + span.end_strain);
}

void MasslessWheels::keep_slack(std::span<const double> spare, std::vector<double>& kept) const {
  double passed = 0.0;
  double gain = 0.0;  // of the wheel before the span
  for (std::size_t i = 0; i < spare.size(); ++i) {
    passed += spare[i] - kept[i];
    kept[i] = spare[i] - gain;
    gain = 0.0;
    const int link = s_.run_work_.wheels[i];
    if (link < 0) continue;
    const StoredStrain& stored = s_.stored_[at(s_.strain_places_[at(link)])];
    const auto k = static_cast<int>(i);
    const Rolled rolled = roll(stored, passed, mean_strain(k), mean_strain(k + 1));
    gain = passed - rolled.length;
    passed = rolled.length;
  }
}

double MasslessWheels::pass(Substep& substep, int i, int span, double passed, FeatureState& next) {
  const int link = s_.run_work_.wheels[at(i)];
  if (link < 0) {
    turn(substep, span, passed * (1.0 + passing_strain(substep, span)));
    return passed;
  }
  const CompiledCable& cable = s_.cables_[at(s_.spans_[at(span)].cable)];
  StoredStrain stored = s_.stored_strain(next, link);
  const double before = mean_strain(i);
  const double behind = mean_strain(i + 1);
  Rolled rolled = roll(stored, passed, before, behind);
  rolled.length = cable.quantised(rolled.length);
  double& creep = next.reals[s_.creep_index(s_.strain_places_[at(link)])];
  const StrainEnergy energy = cable.strain_energy();
  if (passed >= 0.0) {
    stored.put(StoredStrain::End::incoming, passed, before, energy);
    creep +=
        creep_loss(cable, stored.take(StoredStrain::End::outgoing, rolled.length, energy), behind);
  } else {
    stored.put(StoredStrain::End::outgoing, -rolled.length, behind, energy);
    creep += creep_loss(cable, stored.take(StoredStrain::End::incoming, -passed, energy), before);
  }
  next.reals[s_.stored_length_index(link)] += passed - rolled.length;
  s_.save_strain(stored, link, next);
  turn(substep, span, rolled.way);
  return rolled.length;
}

void MasslessWheels::stop(Substep& substep, int wheel) {
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

double MasslessWheels::passing_strain(const Substep& substep, int span) const {
  const CompiledCable& cable = s_.cables_[at(s_.spans_[at(span)].cable)];
  // Both sides have the same tension and, without dampers, the same strain.
  const int behind = s_.next_span(cable, span);
  if (s_.weighs_now(substep, cable)) {
    return 0.5 * (s_.hanging_[at(span)].strains[1] + s_.hanging_[at(behind)].strains[0]);
  }
  const double own = s_.end_strains_[at(span)];
  if (cable.is_damped() && CableSystem::strains_runs(cable) && own >= 0.0) {
    return 0.5 * (own + s_.end_strains_[at(behind)]);
  }
  return cable.strain_under(s_.multipliers_[at(span)] / (substep.h * substep.h));
}

void MasslessWheels::turn(Substep& substep, int span, double way) const {
  if (way == 0.0) return;
  const LinkGeometry& geometry = s_.links_[at(s_.spans_[at(span)].second)];
  const int turned = geometry.touched();
  const BodyProperties& wheel = substep.bodies[turned];
  BodyState& next = substep.next.bodies[at(turned)];
  const Quaternion carrier = wheel.mount >= 0 ? substep.next.bodies[at(wheel.mount)].orientation
                                              : Quaternion(Quaternion::Identity());
  const Vector3 axis = carrier * wheel.axis;
  const Quaternion& link_frame = geometry.carrier == turned ? next.orientation : carrier;
  const double sense = axis.dot(link_frame * geometry.normal) > 0.0 ? 1.0 : -1.0;
  const double turn = sense * way / geometry.signed_radius;
  next.angle += turn;
  next.angular_velocity += turn / substep.h * axis;
  next.orientation = carrier * rotation_by(next.angle * wheel.axis) * wheel.start_orientation;
}

}  // namespace sheave
