// Mounted rotors. A rotor on an axle with the unit direction a (fixed in its carrier B) through the
// point c of B has one degree of freedom of its own, the absolute spin s about a. The rest of its
// motion is B's: w = w_B - a (a.w_B) + a s. A unit force n at the point p of the rotor has the
// power n.(v_B + w_B x (c - x_B) + w x (p - c)), and collecting the factors of v_B, w_B and s:
//   on B:      linear n,  angular (p - x_B) x n - a (a . ((p - c) x n))
//   on rotor:  angular a (a . ((p - c) x n))
// A unit torque t on the rotor likewise splits into t - a (a.t) on B and a (a.t) on the rotor.

#include "engine/substep.h"

#include <cmath>

#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// The share of a constant force's impulse during `time` [s] that is left at the end under drag
/// with this rate [1/s].
double left_by_drag(double rate, double time) {
  const double x = rate * time;
  return x > 0.0 ? -portable::expm1(-x) / x : 1.0;
}

/// Sets inverse mass and inverse inertia in the world frame at the body's orientation, without
/// drag.
void set_undamped(const BodyProperties& properties, MovingBody& body) {
  const Vector3& axis = properties.axis;
  Matrix3 along = Matrix3::Zero();
  if (properties.mobility != Mobility::free) along = axis * axis.transpose();
  switch (properties.mobility) {
    case Mobility::fixed:
    case Mobility::kinematic:
    case Mobility::knot:
      break;
    case Mobility::free:
      body.inverse_mass = Matrix3::Identity() / properties.mass;
      body.linear_yield = 1.0 / properties.mass;
      body.inverse_inertia = properties.isotropic
                                 ? properties.inverse_inertia
                                 : turned_tensor(body.orientation, properties.inverse_inertia);
      break;
    case Mobility::planar:
      body.inverse_mass = (Matrix3::Identity() - along) / properties.mass;
      body.inverse_inertia = along / properties.axis_inertia;
      body.axis = axis;
      body.linear_yield = 1.0 / properties.mass;
      body.angular_yield = 1.0 / properties.axis_inertia;
      break;
    case Mobility::slider:
      body.inverse_mass = along / properties.mass;
      body.linear_yield = 1.0 / properties.mass;
      break;
    case Mobility::rotor:
      // The cable turns a massless wheel after the substep is complete; forces do not.
      body.axis = axis;
      if (properties.axis_inertia > 0.0 && !properties.prescribed()) {
        body.inverse_inertia = along / properties.axis_inertia;
        body.angular_yield = 1.0 / properties.axis_inertia;
      }
      break;
  }
}

/// Sets inverse mass and inverse inertia with drag during `time`. Drag reduces the effect of
/// constraints as it reduces that of loads (engine/integrators/loads.h); otherwise both would not
/// balance at rest. (The drag of free bodies with different moments of inertia is applied before
/// loads and constraints.)
void set_inverse_masses(const BodySet& bodies, int i, double time, MovingBody& body) {
  const BodyProperties& properties = bodies[i];
  set_undamped(properties, body);
  const BodyDef& definition = bodies.definition(i);
  if (definition.damping > 0.0) {
    const double left = left_by_drag(definition.damping / properties.mass, time);
    body.inverse_mass *= left;
    body.linear_yield *= left;
  }
  if (definition.angular_damping == 0.0) return;
  if (properties.mobility != Mobility::free) {
    const double left = left_by_drag(definition.angular_damping / properties.axis_inertia, time);
    body.inverse_inertia *= left;
    body.angular_yield *= left;
  } else if (properties.isotropic) {
    body.inverse_inertia *=
        left_by_drag(definition.angular_damping * properties.inverse_inertia(0, 0), time);
  }
}

/// Sets the inverse inertia of a rotor on a carrier, about the present direction of its axle.
void set_mounted_inverse_inertia(const BodyProperties& rotor, const Vector3& axle,
                                 MovingBody& body) {
  body.axis = axle;
  if (!(rotor.axis_inertia > 0.0)) return;
  body.inverse_inertia = axle * axle.transpose() / rotor.axis_inertia;
  body.angular_yield = 1.0 / rotor.axis_inertia;
}

/// Updates the inverse masses that change from substep to substep.
void renew_inverse_masses(const BodySet& bodies, int i, double time, MovingBody& body) {
  const BodyProperties& properties = bodies[i];
  if (properties.mount >= 0) return;
  const BodyDef& definition = bodies.definition(i);
  if (definition.damping > 0.0 || definition.angular_damping > 0.0) {
    set_inverse_masses(bodies, i, time, body);
  } else if (properties.mobility == Mobility::free && !properties.isotropic) {
    body.inverse_inertia = turned_tensor(body.orientation, properties.inverse_inertia);
  }
}

}  // namespace

Substep::Substep(const BodySet& body_set, const State& state_at_start, double length, int sweeps)
    : bodies(body_set), start(state_at_start), h(length), iterations(sweeps) {
  const std::size_t count = at(bodies.count());
  moving.resize(count + 1);
  predicted.resize(count);
  predicted_turn.resize(count, Vector3::Zero());
  for (int i = 0; i < bodies.count(); ++i) {
    MovingBody& body = moving[at(i)];
    const Mobility mobility = bodies[i].mobility;
    body.translates =
        mobility == Mobility::free || mobility == Mobility::planar || mobility == Mobility::slider;
    body.rotates =
        mobility == Mobility::free || mobility == Mobility::planar ||
        (mobility == Mobility::rotor && !bodies[i].prescribed() && bodies[i].axis_inertia > 0.0);
    body.prescribed = mobility == Mobility::kinematic || bodies[i].prescribed();
    body.tracks_orientation = mobility != Mobility::rotor;
    body.orientation = start.bodies[at(i)].orientation;
    if (bodies[i].mount < 0) set_inverse_masses(bodies, i, h, body);
  }
  restart();
}

void Substep::restart() {
  asks_for_guess = guessed = false;
  may_guess = true;
  time = start.time;
  gravity = start.controls.has_gravity ? start.controls.gravity : bodies.gravity();
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyState& from = start.bodies[at(i)];
    MovingBody& body = moving[at(i)];
    body.position = body.start_position = body.free_position = from.position;
    body.orientation = from.orientation;
    body.turn.setZero();
    body.free_orientation = body.orientation;
    body.free_turn.setZero();
    const BodyProperties& properties = bodies[i];
    renew_inverse_masses(bodies, i, load_share * h, body);
    if (properties.mount >= 0) {
      set_mounted_inverse_inertia(
          properties, rotated(start.bodies[at(properties.mount)].orientation, properties.axis),
          body);
    }
    predicted_turn[at(i)].setZero();
  }
}

double Substep::driven_speed(int body) const {
  const BodyDrive drive(bodies[body], start.controls, body);
  const bool half_steps = load_share != 1.0;
  return drive.speed(start.time, next.time, h, half_steps);
}

void Substep::update_inertias() {
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& properties = bodies[i];
    MovingBody& body = moving[at(i)];
    renew_inverse_masses(bodies, i, load_share * h, body);
    if (properties.mount >= 0) {
      set_mounted_inverse_inertia(properties,
                                  moving[at(properties.mount)].orientation * properties.axis, body);
    }
  }
}

Quaternion Substep::orientation(int body) const {
  const BodyProperties& properties = bodies[body];
  if (properties.mount < 0) {
    const MovingBody& own = moving[at(body)];
    return own.tracks_orientation ? own.orientation : turned(own.orientation, own.turn);
  }
  const MovingBody& carrier = moving[at(properties.mount)];
  const Vector3 axis = carrier.orientation * properties.axis;
  const double angle =
      start.bodies[at(body)].angle + axis.dot(moving[at(body)].turn - carrier.turn);
  return carrier.orientation * rotation_by(angle * properties.axis) * properties.start_orientation;
}

Vector3 Substep::position(int body) const {
  const BodyProperties& properties = bodies[body];
  if (properties.mount < 0) return moving[at(body)].position;
  const MovingBody& carrier = moving[at(properties.mount)];
  return carrier.position + rotated(carrier.orientation, properties.mount_position);
}

void Substep::add_force_on_rotor(Row& row, int body, const Vector3& at_point,
                                 const Vector3& direction) const {
  const int mount = bodies[body].mount;
  const MovingBody& carrier = moving[at(mount)];
  const Vector3 axis = rotated(carrier.orientation, bodies[body].axis);
  const Vector3 spin = axis * dot(axis, cross(at_point - position(body), direction));
  const Vector3 arm = at_point - carrier.position;
  row.add(mount, direction, cross(arm, direction) - spin, dot(arm, direction));
  row.add(body, Vector3::Zero(), spin);
}

void Substep::add_torque(Row& row, int body, const Vector3& direction) const {
  const int mount = bodies[body].mount;
  if (mount < 0) {
    row.add(body, Vector3::Zero(), direction);
    return;
  }
  const Vector3 axis = moving[at(mount)].orientation * bodies[body].axis;
  const Vector3 spin = axis * axis.dot(direction);
  row.add(mount, Vector3::Zero(), direction - spin);
  row.add(body, Vector3::Zero(), spin);
}

}  // namespace sheave
