// Places a body, or all bodies, all or nothing: builds a new state beside the old one and restores it
// if it is valid.

#include <cmath>

#include "cable/cable_system.h"
#include "cable/live_revision.h"
#include "cable/live_world.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Angle of a planar body with this orientation that is nearest to `now` [rad].
double angle_of(const BodyProperties& body, const Quaternion& orientation, double now) {
  const Quaternion turn = orientation * body.start_orientation.conjugate();
  const double angle = 2.0 * portable::atan2(body.axis.dot(turn.vec()), turn.w());
  return angle + 2.0 * pi * std::round((now - angle) / (2.0 * pi));
}

/// Moves the rotors mounted on a body to its new pose; they keep their spins.
void carry_rotors(const BodySet& bodies, int carrier, const BodyState& before, State& state) {
  const BodyState& on = state.bodies[at(carrier)];
  for (const int i : bodies[carrier].mounted_rotors) {
    const BodyProperties& rotor = bodies[i];
    BodyState& now = state.bodies[at(i)];
    const Vector3 offset = on.orientation * rotor.mount_position;
    const Vector3 axis = on.orientation * rotor.axis;
    const double spin = (before.orientation * rotor.axis).dot(now.angular_velocity);
    now.position = on.position + offset;
    now.orientation =
        on.orientation * rotation_by(now.angle * rotor.axis) * rotor.start_orientation;
    now.velocity = on.velocity + on.angular_velocity.cross(offset);
    now.angular_velocity = on.angular_velocity - axis * axis.dot(on.angular_velocity) + spin * axis;
  }
}

}  // namespace

std::string LiveWorld::place_fault(int body) const {
  const World& world = simulation().world;
  const std::string name = "body \"" + world.bodies().name(body) + "\"";
  const Mobility mobility = world.bodies()[body].mobility;
  if (mobility == Mobility::kinematic) return name + " is kinematic; set its motion instead";
  if (mobility == Mobility::fixed) return name + " is static; it stays where it is";
  if (mobility == Mobility::rotor) return name + " is a rotor; it stays on its axle";
  for (std::size_t j = 0; j < world.model().joints.size(); ++j) {
    const JointDef& joint = *world.model().joints[j];
    for (const BodyId held : {joint.body_a, joint.body_b}) {
      const bool its =
          !held.is_world() && (held.index == body || world.bodies()[held.index].mount == body);
      if (!its || is_broken(static_cast<int>(j))) continue;
      return name + " is held by joint \"" + joint.name +
             "\"; only a body without joints can be placed";
    }
  }
  return {};
}

std::string LiveWorld::place_fault(int body, const BodyState& there) const {
  const BodySet& bodies = simulation().world.bodies();
  const BodyProperties& own = bodies[body];
  const BodyState& now = state().bodies[at(body)];
  const Vector3 way = there.position - now.position;
  const double slop = 1e-9 * bodies.scale();
  const std::string name = "body \"" + bodies.name(body) + "\"";
  const Quaternion turn = there.orientation * now.orientation.conjugate();
  constexpr double turn_slop = 1e-9;
  if (own.mobility == Mobility::slider) {
    if (way.cross(own.axis).norm() > slop) return name + " slides along its axis alone";
    if (turn.vec().norm() > turn_slop) return name + " is a slider and cannot turn";
  }
  if (own.mobility == Mobility::planar) {
    if (std::abs(way.dot(own.axis)) > slop) return name + " is planar and cannot leave its plane";
    if (turn.vec().cross(own.axis).norm() > turn_slop)
      return name + " is planar and turns only about its axis";
  }
  return {};
}

Result<Placement> LiveWorld::place(BodyHandle body, const Vector3& position,
                                   std::optional<Quaternion> orientation, Keep keep) {
  std::string fault = busy_fault();
  if (fault.empty()) fault = fault_of(body);
  if (fault.empty()) fault = place_fault(body.slot);
  constexpr double unit_slop = 1e-6;
  const bool unit = !orientation || std::abs(orientation->norm() - 1.0) < unit_slop;
  if (fault.empty() && !(position.allFinite() && unit)) {
    fault = "a position must be finite, and an orientation have length 1";
  }
  if (!fault.empty()) return Error{"", std::move(fault)};
  const BodySet& bodies = simulation().world.bodies();
  State next = state();
  BodyState& there = next.bodies[at(body.slot)];
  const BodyState before = there;
  if (orientation) there.orientation = orientation->normalized();
  there.position = position + there.orientation * bodies[body.slot].center_of_mass;
  fault = place_fault(body.slot, there);
  if (!fault.empty()) return Error{"", std::move(fault)};
  if (bodies[body.slot].mobility == Mobility::planar) {
    there.angle = angle_of(bodies[body.slot], there.orientation, there.angle);
  }
  carry_rotors(bodies, body.slot, before, next);
  fault = take_cables_along(state(), keep, next);
  if (!fault.empty()) return Error{"", std::move(fault)};
  return complete(next);
}

std::string LiveWorld::take_cables_along(const State& from, Keep keep, State& next) {
  CableSystem* cables = revision_->system();
  if (cables == nullptr) return {};
  const BodySet& bodies = simulation().world.bodies();
  CableSystem::Placed placed =
      cables->place(bodies, from, next, from.features.back(), keep == Keep::tension);
  if (!placed.fault.empty()) return placed.fault;
  next.features.back() = std::move(placed.own);
  for (std::size_t c = 0; c < placed.added.size(); ++c) {
    if (placed.added[c] == 0.0) continue;
    const auto index = static_cast<int>(c);
    const CableControl* set = next.controls.cables.find(index);
    CableControl control = set != nullptr ? *set : CableControl{};
    control.added_length += placed.added[c];
    next.controls.cables.put(index, placed.added.size(), control);
  }
  return {};
}

/// Makes `next` the present state and tells the changes.
Result<Placement> LiveWorld::complete(const State& next) {
  World& world = running().world;
  Placement placement;
  const std::size_t cables = revision_->cable_handles.size();
  for (std::size_t c = 0; c < cables; ++c) {
    const auto added = [&](const State& state) {
      const CableControl* set = state.controls.cables.find(static_cast<int>(c));
      return set != nullptr ? set->added_length : 0.0;
    };
    const double more = added(next) - added(state());
    if (more != 0.0) placement.cables.push_back({revision_->cable_handles[c], more});
  }
  const double energy = world.energy_of(next).total();
  if (!std::isfinite(energy)) return Error{"", std::string(energy_fault)};
  placement.energy = energy - world.energy().total();
  Errors errors = world.restore(next);
  if (!errors.empty()) return errors;
  return placement;
}

Result<Placement> LiveWorld::place(std::span<const State> way, Keep keep) {
  std::string fault = busy_fault();
  if (!fault.empty()) return Error{"", std::move(fault)};
  if (way.empty()) return Placement{};
  State now = state();
  for (std::size_t i = 0; i < way.size(); ++i) {
    State next = way[i];
    next.controls.cables = now.controls.cables;
    if (next.features.size() != now.features.size() || next.bodies.size() != now.bodies.size()) {
      return Error{"", "the way to a place must consist of states of this world"};
    }
    if (revision_->system() != nullptr) next.features.back() = now.features.back();
    fault = take_cables_along(now, keep, next);
    if (!fault.empty()) {
      if (i + 1 < way.size()) {
        fault += " (on the way, after " + std::to_string(i + 1) + " of " +
                 std::to_string(way.size()) + " parts)";
      }
      return Error{"", std::move(fault)};
    }
    now = std::move(next);
  }
  return complete(now);
}

Errors LiveWorld::examine(const std::function<void(Simulation&)>& look) {
  std::string fault = busy_fault();
  if (!fault.empty()) return {{"", std::move(fault)}};
  look(running());
  return {};
}

}  // namespace sheave
