#include "cable/certificate/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/certificate/checks.h"
#include "cable/certificate/free_rotation.h"
#include "cable/certificate/hanging.h"
#include "cable/certificate/pushes.h"
#include "cable/links/rolling.h"
#include "cable/links/sheath.h"
#include "cable/links/spool.h"
#include "engine/constraint_batch.h"
#include "engine/dynamics/mounted_drive.h"
#include "engine/joint_feature.h"
#include "engine/substep.h"

namespace sheave::certify {
namespace {

/// A copy of a feature's state in which `forces` replace the first reals.
FeatureState with_forces(const FeatureState& like, const std::vector<double>& forces) {
  FeatureState own = like;
  std::copy(forces.begin(), forces.end(), own.reals.begin());
  return own;
}

/// A drum with layers acts with its radius at the end of the substep.
void let_drums_grow(const Simulation& simulation, const FeatureState& now, FeatureState& acting) {
  const CableSystem& system = *simulation.cables;
  for (std::size_t c = 0; c < simulation.cable_definitions->size(); ++c) {
    const auto& links = (*simulation.cable_definitions)[c].links;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const auto* drum = dynamic_cast<const SpoolLink*>(links[i].get());
      if (drum == nullptr || !(drum->layer_pitch > 0.0 || drum->has_groove())) continue;
      const auto place = static_cast<std::size_t>(
          system.stored_length_index(system.cables()[c].first_link + static_cast<int>(i)));
      acting.reals[place] = now.reals[place];
    }
  }
}

/// The substep that began at `start`, with bodies at their poses in `end`.
Substep placed_at(const BodySet& bodies, const State& start, const State& end, double h) {
  Substep now(bodies, start, h, 1);
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyState& state = end.bodies[at(i)];
    MovingBody& moving = now.moving[at(i)];
    moving.position = state.position;
    moving.orientation = state.orientation;
    moving.turn = bodies[i].mount >= 0
                      ? Vector3((end.bodies[at(bodies[i].mount)].orientation * bodies[i].axis) *
                                (state.angle - start.bodies[at(i)].angle))
                      : Vector3(Vector3::Zero());
  }
  return now;
}

}  // namespace

std::array<std::vector<double>, 2> parts(std::span<const double> total, bool rattle,
                                         std::span<const double> late) {
  std::array<std::vector<double>, 2> result;
  result[last_end].assign(total.begin(), total.end());
  result[first_end].assign(total.size(), 0.0);
  if (!rattle || late.size() != total.size()) return result;
  for (std::size_t i = 0; i < total.size(); ++i) {
    result[last_end][i] = late[i];
    result[first_end][i] = total[i] - late[i];
  }
  return result;
}

Evidence::Evidence(const Simulation& observed, const LastSubstep& last)
    : simulation(observed),
      model(observed.world.model()),
      bodies(observed.world.bodies()),
      start(last.start),
      end(observed.world.state()),
      gravity(start.controls.has_gravity ? start.controls.gravity : bodies.gravity()),
      h(last.h),
      rattle(last.integrator == IntegratorKind::rattle),
      moments{Moment{&bodies, &start.bodies}, Moment{&bodies, &end.bodies}} {
  balances.resize(at(bodies.count()) + 1);
  for (int i = 0; i < bodies.count(); ++i) turns_.push_back(counted_turn(*this, i));
  find_brakes();
  if (simulation.cables != nullptr) collect_cables(last);
  if (!model.joints.empty()) collect_joints(last);
  for (std::size_t f = 0; f < observed.world.features().size(); ++f) {
    if (observed.world.features()[f]->name() == mounted_drives_name) {
      collect_mounted_drives(last, f);
    }
    if (observed.world.features()[f]->name() == "rope inertia") collect_rope_inertia(last, f);
    if (observed.world.features()[f]->name() == "ground contacts") collect_ground(last, f);
    if (observed.world.features()[f]->name() == "contacts") collect_contacts(last, f);
  }
  apply_cables();
  apply_rope_inertia();
  apply_joints();
  apply_mounted_drives();
  apply_bearings();
  apply_contacts();
  for (const Balance& balance : balances) {
    largest_force = std::max(largest_force, balance.largest_force);
  }
  force_rounding = rounding_of_forces();
  // Rigid spans that depend on each other share a load as if each yielded by 1e-9 of its effective
  // inverse mass.
  shared_rounding = std::numeric_limits<double>::epsilon() / 1e-9 * largest_force;
}

Vector3 Evidence::displacement(int body, const Vector3& point, End at_end) const {
  if (body == bodies.count()) return Vector3::Zero();
  const Vector3 center = moments[at(at_end)].center(body);
  const Vector3 arm = point - center;
  // The carrier leads a mounted rotor; its rotation counts to first order.
  const int mount = bodies[body].mount;
  if (mount >= 0) return displacement(mount, center, at_end) + turn_of(body).cross(arm);
  return end.bodies[at(body)].position - start.bodies[at(body)].position + turn_of(body).cross(arm);
}

void Evidence::push(End when, End place, int body, const Vector3& point, const Vector3& force) {
  if (body == bodies.count() || is_zero(force)) return;
  const Moment& now = moments[at(place)];
  const double size = force.norm();
  const auto add = [&](int to, const Vector3& linear, const Vector3& torque) {
    Balance& balance = balances[at(to)];
    balance.force[at(when)] += linear;
    balance.torque[at(when)] += torque;
    balance.largest_force = std::max(balance.largest_force, linear.norm());
    balance.largest_torque = std::max(balance.largest_torque, torque.norm());
  };
  const int mount = bodies[body].mount;
  balances[at(body)].own_force[at(when)] += force;
  balances[at(body)].own_torque[at(when)] += (point - now.center(body)).cross(force);
  if (mount < 0) {
    add(body, force, (point - now.center(body)).cross(force));
  } else if (brakes(body)) {
    // A torque that the bearing holds acts on the carrier.
    add(mount, force, (point - now.center(mount)).cross(force));
    balances[at(body)].largest_force = std::max(balances[at(body)].largest_force, size);
  } else {
    // The bearing transmits everything except the torque about the axle.
    const Vector3 axle = now.orientation(mount) * bodies[body].axis;
    const Vector3 spin = axle * axle.dot((point - now.center(body)).cross(force));
    add(mount, force, (point - now.center(mount)).cross(force) - spin);
    add(body, Vector3::Zero(), spin);
    balances[at(body)].largest_force = std::max(balances[at(body)].largest_force, size);
  }
  // A force that stops a body has passed all of its energy, so the larger of both powers counts.
  balances[at(body)].power +=
      std::max(std::abs(force.dot(moments[first_end].velocity(body, point))),
               std::abs(force.dot(moments[last_end].velocity(body, point))));
}

void Evidence::twist(End when, int body, const Vector3& torque) {
  if (body == bodies.count() || is_zero(torque)) return;
  const int mount = bodies[body].mount;
  balances[at(body)].own_torque[at(when)] += torque;
  const auto add = [&](int to, const Vector3& part) {
    balances[at(to)].torque[at(when)] += part;
    balances[at(to)].largest_torque = std::max(balances[at(to)].largest_torque, part.norm());
  };
  if (mount < 0) {
    add(body, torque);
  } else {
    const Vector3 axle = moments[at(when)].orientation(mount) * bodies[body].axis;
    const Vector3 spin = axle * axle.dot(torque);
    add(mount, torque - spin);
    add(body, spin);
  }
  balances[at(body)].power +=
      std::max(std::abs(torque.dot(start.bodies[at(body)].angular_velocity)),
               std::abs(torque.dot(end.bodies[at(body)].angular_velocity)));
}

void Evidence::mark_unknown(int body) {
  balances[at(body)].unknown = true;
  if (body < bodies.count() && bodies[body].mount >= 0) {
    balances[at(bodies[body].mount)].unknown = true;
  }
}

// Cables.

void Evidence::collect_cables(const LastSubstep& last) {
  const CableSystem& system = *simulation.cables;
  const std::size_t feature = end.features.size() - 1;
  const FeatureState& before = start.features[feature];
  const FeatureState& now = end.features[feature];
  const auto spans = static_cast<std::size_t>(system.span_count());
  const auto tensions = std::span(now.reals).subspan(system.tension_index(0), spans);
  const auto bearing_count = static_cast<std::size_t>(system.bearing_count());
  const auto torques = std::span(now.reals).subspan(system.bearing_index(0), bearing_count);
  const auto late = last.late_forces.size() > feature
                        ? std::span<const double>(last.late_forces[feature])
                        : std::span<const double>();
  const bool has_late = late.size() >= spans + bearing_count;
  const auto force = parts(tensions, rattle, has_late ? late.first(spans) : late);
  const auto torque = parts(torques, rattle, has_late ? late.subspan(spans, bearing_count) : late);
  // The substep acted with the course of its start.
  FeatureState first = before;
  FeatureState second = before;
  for (std::size_t k = 0; k < spans; ++k) {
    first.reals[system.tension_index(static_cast<int>(k))] = force[first_end][k];
    second.reals[system.tension_index(static_cast<int>(k))] = force[last_end][k];
    second.reals[system.rest_length_index(static_cast<int>(k))] = now.reals[k];
  }
  for (std::size_t b = 0; b < bearing_count; ++b) {
    first.reals[system.bearing_index(static_cast<int>(b))] = torque[first_end][b];
    second.reals[system.bearing_index(static_cast<int>(b))] = torque[last_end][b];
  }
  let_drums_grow(simulation, now, second);
  follow_controls();
  const std::vector<CableReport> at_start = system.report(bodies, start, first);
  const std::vector<CableReport> at_end = system.report(bodies, end, second);
  const std::vector<CableReport> after = system.report(bodies, end, now);
  for (std::size_t c = 0; c < after.size(); ++c) {
    CableEvidence& cable = cables.emplace_back();
    cable.definition = controlled_.empty() ? &(*simulation.cable_definitions)[c] : &controlled_[c];
    cable.first_link = system.cables()[c].first_link;
    cable.name = cable.definition->name;
    cable.start = at_start[c];
    cable.end = after[c];
    const CompiledCable& layout = system.cables()[c];
    const auto differs = [&](std::size_t i) { return before.integers[i] != now.integers[i]; };
    // The way in which a wheel has been left does not matter to the cable that passes it.
    const auto mode = [&](const FeatureState& state, int link) {
      return std::min(state.integers[system.mode_index(link)], RunningLink::lifted_mode);
    };
    cable.has_changed = differs(system.cut_index(static_cast<int>(c)));
    for (int i = layout.first_link; i < layout.first_link + layout.link_count; ++i) {
      cable.has_changed = cable.has_changed || mode(before, i) != mode(now, i) ||
                          differs(system.next_index(i)) || differs(system.wrap_index(i));
    }
    const std::vector<CableEvent>& events = system.events();
    for (std::size_t i = events.size(); i-- > 0;) {
      const CableEvent& event = events[i];
      if (event.time < start.time) break;
      cable.was_changed =
          cable.was_changed || (event.time == start.time && event.cable == cable.name);
    }
    if (!cable.start.cut) collect_cable(cable, at_start[c], at_end[c]);
  }
}

namespace {

void find_directions(SpanEvidence& span) {
  for (const End when : {first_end, last_end}) {
    const Vector3 along = span.to.point[at(when)] - span.from.point[at(when)];
    const double length = along.norm();
    span.direction[at(when)] = length > 0.0 ? Vector3(along / length) : Vector3(Vector3::Zero());
  }
}

/// Whether attachments cannot keep their places, as in cable/cable_system.cpp.
bool must_follow(const SpanEvidence& span) {
  const auto must = [&](const SpanSide& side) {
    return side.winding != 0 &&
           (side.outlined ||
            std::abs(side.normal[first_end].dot(span.direction[first_end])) > 1e-6);
  };
  return must(span.from) || must(span.to);
}

}  // namespace

void Evidence::freeze(SpanEvidence& span) const {
  const Vector3 from = moments[first_end].own_point(span.from.body, span.from.point[first_end]);
  const Vector3 to = moments[first_end].own_point(span.to.body, span.to.point[first_end]);
  span.from.point[last_end] = moments[last_end].point(span.from.body, from);
  span.to.point[last_end] = moments[last_end].point(span.to.body, to);
  find_directions(span);
}

void Evidence::collect_cable(CableEvidence& cable, const CableReport& first,
                             const CableReport& second) {
  std::vector<int> places;
  const CableReport from = first.with_wraps_in_place(&places);
  const CableReport to = second.with_wraps_in_place();
  const auto count = static_cast<int>(from.links.size());
  for (int i = 0; i < static_cast<int>(from.spans.size()); ++i) {
    if (!from.links[at(i)].touched) continue;
    int next = i;
    do {
      next = (next + 1) % count;
    } while (!from.links[at(next)].touched && next != i);
    SpanEvidence& span = cable.spans.emplace_back();
    span.cable = cable.name;
    span.place = places[at(i)];
    for (const End when : {first_end, last_end}) {
      const CableReport& report = when == first_end ? from : to;
      const SpanReport& reported = report.spans[at(i)];
      const auto side = [&](SpanSide& own, int link, const Vector3& point) {
        const LinkReport& seen = report.links[at(link)];
        own.body = bodies.index(&own == &span.from ? seen.exit_body : seen.body);
        own.link = link;
        own.place = places[at(link)];
        own.radius[at(when)] = seen.radius;
        own.winding = seen.winding;
        own.outlined = !seen.path.empty() && seen.winding != 0;
        own.point[at(when)] = own.laid = point;
        own.center[at(when)] = seen.center;
        own.normal[at(when)] = seen.normal;
        own.stored[at(when)] = seen.stored_length;
        own.lies[at(when)] = seen.stored_length + seen.stored_stretch;
        if (seen.groove) follow_groove(bodies, cable, when, own);
      };
      side(span.from, i, reported.start);
      side(span.to, next, reported.end);
      span.length[at(when)] = reported.length;
      span.rest_length[at(when)] = reported.rest_length;
      span.remembered[at(when)] = reported.remembered;
      span.force[at(when)] = reported.tension;
      span.has_tangent = span.has_tangent && reported.has_tangent;
    }
    cable.free_length += span.length[last_end];
    span.laid = laid_evidence(*cable.definition, from.spans[at(i)], gravity);
    find_directions(span);
  }
  find_loads(*this, cable);
  collect_passes(cable, from, to, places);
  const auto follows = [](const PassEvidence& pass) { return pass.passes && pass.has_arc; };
  const bool arcs = cable.definition->has_material() &&
                    std::any_of(cable.passes.begin(), cable.passes.end(), follows);
  cable.frozen = cable.definition->tangent_update == TangentUpdate::substep && !arcs &&
                 std::none_of(cable.spans.begin(), cable.spans.end(), must_follow);
  if (cable.frozen) {
    for (SpanEvidence& span : cable.spans) freeze(span);
  }
}

namespace {

/// Travel of a braked wheel's rim relative to its carrier, towards the next span [m]; 0 for other
/// links.
double braked_travel(const Evidence& evidence, const LinkReport& link) {
  const int body = evidence.bodies.index(link.body);
  if (link.winding == 0 || !evidence.brakes(body)) return 0.0;
  const BodyProperties& wheel = evidence.bodies[body];
  Vector3 axis = wheel.axis;
  if (wheel.mount >= 0) axis = evidence.moments[first_end].orientation(wheel.mount) * axis;
  const double turn = evidence.end.bodies[at(body)].angle - evidence.start.bodies[at(body)].angle;
  return (axis.dot(link.normal) > 0.0 ? turn : -turn) * link.winding * link.radius;
}

}  // namespace

void Evidence::collect_passes(CableEvidence& cable, const CableReport& first,
                              const CableReport& second, const std::vector<int>& places) {
  const CableReport after = cable.has_changed ? first : cable.end.with_wraps_in_place();
  const auto change = [&](int link, double LinkReport::*of) {
    return after.links[at(link)].*of - first.links[at(link)].*of;
  };
  for (SpanEvidence& span : cable.spans) {
    // Feeds exist only at the ends of a cable.
    span.fed = change(span.from.link, &LinkReport::fed) + change(span.to.link, &LinkReport::fed);
  }
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    const int link = cable.spans[k].from.link;
    const auto before = std::find_if(cable.spans.begin(), cable.spans.end(),
                                     [&](const SpanEvidence& s) { return s.to.link == link; });
    if (before == cable.spans.end()) continue;
    PassEvidence pass;
    pass.before = static_cast<int>(before - cable.spans.begin());
    pass.after = static_cast<int>(k);
    pass.link = places[at(link)];
    pass.cable = cable.name;
    pass.slip = change(link, &LinkReport::slip);
    describe_pass(*this, cable, first.links[at(link)], second.links[at(link)], pass);
    pass.travel =
        pass.slip * (1.0 + mean_strain(cable, pass)) + braked_travel(*this, first.links[at(link)]);
    pass.has_arc = first.links[at(link)].winding != 0 && !pass.massless;
    pass.stretches = pass.passes && pass.has_arc && cable.definition->has_material() &&
                     (pass.friction == 0.0 || pass.slip != 0.0);
    if (pass.stretches) {
      pass.laid = after.links[at(link)];
      pass.gained = change(link, &LinkReport::stored_length);
      const LinkReport& was = first.links[at(link)];
      if (was.stored_length > 0.0) pass.start_strain = was.stored_stretch / was.stored_length;
      find_carried(*this, cable, pass);
    } else if (first.links[at(link)].type == SheathLink::type_name) {
      pass.gained = change(link, &LinkReport::stored_length);
    }
    cable.passes.push_back(pass);
    collect_bearing(cable, pass, {&first.links[at(link)], &second.links[at(link)]});
  }
}

void Evidence::apply_cables() {
  for (const CableEvidence& cable : cables) {
    for (const SpanEvidence& span : cable.spans) {
      if (cable.has_changed || !span.has_tangent) {
        mark_unknown(span.from.body);
        mark_unknown(span.to.body);
        continue;
      }
      for (const End when : {first_end, last_end}) {
        for (const SpanPush& one : pushes_of(span, when)) {
          if (is_zero(one.force)) continue;
          push(when, when, one.body, one.point, one.force);
        }
      }
    }
  }
}

// Joints.

void Evidence::collect_joints(const LastSubstep& last) {
  struct Course {
    std::string_view type;
    std::size_t feature;
    const JointFeature* batch;
    std::array<FeatureState, 2> acting;
    int next = 0;
  };
  std::vector<Course> courses;
  const auto features = simulation.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const auto* batch = dynamic_cast<const JointFeature*>(features[f].get());
    if (batch == nullptr) continue;
    const std::vector<double>& reals = end.features[f].reals;
    const auto late = last.late_forces.size() > f ? std::span<const double>(last.late_forces[f])
                                                  : std::span<const double>();
    const auto rows = static_cast<std::size_t>(batch->row_count());
    const auto force = parts(std::span(reals).first(rows), rattle, late);
    courses.push_back({batch->type(),
                       f,
                       batch,
                       {with_forces(start.features[f], force[first_end]),
                        with_forces(start.features[f], force[last_end])}});
  }
  const Substep at_start(bodies, start, h, 1);
  const Substep at_end = placed_at(bodies, start, end, h);
  const Substep after(bodies, end, h, 1);
  int coordinate = 0;
  for (const auto& joint : model.joints) {
    const int first_coordinate = coordinate;
    coordinate += static_cast<int>(joint->coordinates().size());
    for (Course& course : courses) {
      if (course.type != joint->type()) continue;
      const int index = course.next++;
      JointEvidence& found = joints.emplace_back();
      found.definition = joint.get();
      found.first_coordinate = first_coordinate;
      found.acting[first_end] = course.batch->report(index, at_start, course.acting[first_end]);
      found.acting[last_end] = course.batch->report(index, at_end, course.acting[last_end]);
      found.start = course.batch->report(index, at_start, start.features[course.feature]);
      found.end = course.batch->report(index, after, end.features[course.feature]);
      found.broken = found.start.broken_at.has_value();
      found.hold = course.batch->hold(index, start.features[course.feature]);
      break;
    }
  }
}

void Evidence::apply_joints() {
  for (const JointEvidence& joint : joints) {
    if (joint.broken) continue;
    for (const End when : {first_end, last_end}) {
      const JointPushes pushes = pushes_of(*this, joint, when);
      for (const JointPush& one : pushes) {
        if (one.unknown) mark_unknown(one.body);
        push(when, when, one.body, one.point, one.force);
        twist(when, one.body, one.torque);
      }
    }
  }
}

void Evidence::collect_mounted_drives(const LastSubstep& last, std::size_t feature) {
  const auto late = last.late_forces.size() > feature
                        ? std::span<const double>(last.late_forces[feature])
                        : std::span<const double>();
  const auto torque = parts(end.features[feature].reals, rattle, late);
  std::size_t next = 0;
  for (int i = 0; i < bodies.count(); ++i) {
    if (bodies[i].mounted_drive == DriveKind::none) continue;
    mounted_drives.push_back({i, {torque[first_end][next], torque[last_end][next]}});
    ++next;
  }
}

void Evidence::apply_mounted_drives() {
  for (const MountedDriveEvidence& drive : mounted_drives) {
    const int mount = bodies[drive.rotor].mount;
    for (const End when : {first_end, last_end}) {
      const Vector3 axle = moments[at(when)].orientation(mount) * bodies[drive.rotor].axis;
      twist(when, drive.rotor, drive.torque[at(when)] * axle);
      twist(when, mount, -drive.torque[at(when)] * axle);
    }
  }
}

}  // namespace sheave::certify
