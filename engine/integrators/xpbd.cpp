// The integrator of extended position-based dynamics: predict, project, derive velocities.
//
//   v* = v + h g,  x* = x + h v*,  constraints move x* to x',  v' = (x' - x) / h.
//
// First order: a mass circling on a rigid cable loses speed as w(t) = w0 / sqrt(1 + 2 w0^2 h t),
// because the projection shortens each chord of the circle.
//
// Rotation. Constraints act as impulses, so the angular velocity is w' = w* + (turn' - turn*) / h
// with w* and turn* of the free motion. For bodies with one axis turn* = h w*, and the formula is
// the one for v'. The free motion of other bodies, with mounted rotors of spin angular momentum J s
// a (a gyrostat), conserves L = I w + sum J s a exactly. The motion is an explicit midpoint step of
// second order, after the impulse of the torques (as v* contains that of the forces, so that a body
// that is held has no velocity):
//   q_half = exp(h/2 w) q,   w_half = I(q_half)^-1 (L - sum J s a(q_half)),
//   q* = exp(h w_half) q,    w* = I(q*)^-1 (L - sum J s a(q*)),   turn* = h w_half.
// The bearing passes no torque about a, so s is constant without constraints. For a body with two
// equal moments J, a third moment K about the axis u, and no rotors, the free motion is known for
// any step:
//   q* = exp(h L / J) exp(h s u) q,    s = (1 / K - 1 / J) L . u,    w_half = L / J + s u(h / 2).
// The explicit rule would turn L away from u if h |w| is not small. A thin body would then begin to
// spin about its axis, where no constraint stops the spin, and light links would gain energy in
// every substep until they diverge. The paper's engine instead derives w' from the difference of
// orientations. Its rule aliases beyond half a turn per substep and does not conserve L.

#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/stages.h"

namespace sheave {
namespace {

/// Turns a body with two equal moments of inertia under constant angular momentum. Returns the
/// angular velocity at half of the substep.
Vector3 turn_symmetric_body(Substep& substep, int i, const Vector3& momentum) {
  const BodyProperties& body = substep.bodies[i];
  MovingBody& moving = substep.moving[at(i)];
  const Quaternion& start = substep.start.bodies[at(i)].orientation;
  const Vector3& own_axis = *body.symmetry_axis;
  const double along = own_axis.dot(body.inverse_inertia * own_axis);  // 1 / K
  const double across = 0.5 * (body.inverse_inertia.trace() - along);  // 1 / J
  const Vector3 axis = start * own_axis;
  const Vector3 precession = across * momentum;
  const double spin = (along - across) * momentum.dot(axis);
  moving.orientation = turned(turned(start, substep.h * spin * axis), substep.h * precession);
  const Quaternion half = turned(start, 0.5 * substep.h * precession);
  return precession + spin * (half * own_axis);
}

/// Free rotation of a free body over the substep.
void rotate_freely(Substep& substep, int i) {
  const BodyProperties& body = substep.bodies[i];
  const BodyState& start = substep.start.bodies[at(i)];
  MovingBody& moving = substep.moving[at(i)];
  const double h = substep.h;
  const Vector3 torque = torque_on(substep, i, substep.start.bodies);
  Vector3 half_velocity;
  Vector3 end_velocity;
  if (body.isotropic && body.mounted_rotors.empty()) {
    const double rate = substep.bodies.definition(i).angular_damping * body.inverse_inertia(0, 0);
    const auto [keep, gain] = decay(rate, substep.load_share * h);
    end_velocity = sum(keep * start.angular_velocity, gain, times(body.inverse_inertia, torque));
    half_velocity = end_velocity;
    moving.orientation = turned(start.orientation, h * half_velocity);
  } else {
    const auto rotors = [&](const Quaternion& q) {
      return rotor_momentum(substep, body, start.orientation, q);
    };
    const Vector3 velocity = damped_rotation(substep, i, start.orientation, start.angular_velocity,
                                             substep.load_share * h);
    const Vector3 momentum =
        times_inertia(body, start.orientation, false, velocity) + rotors(start.orientation);
    const Vector3 loaded = momentum + substep.load_share * h * torque;
    if (body.symmetry_axis && body.mounted_rotors.empty()) {
      half_velocity = turn_symmetric_body(substep, i, loaded);
    } else {
      const Quaternion half = turned(start.orientation, 0.5 * h * velocity);
      half_velocity = times_inertia(body, half, true, loaded - rotors(half));
      moving.orientation = turned(start.orientation, h * half_velocity);
    }
    end_velocity =
        times_inertia(body, moving.orientation, true, loaded - rotors(moving.orientation));
    // The multipliers of `rattle` act at the start, with the inverse inertia of the start.
    if (substep.load_share == 1.0) {
      moving.inverse_inertia = world_inertia(body, moving.orientation, true);
    }
  }
  moving.turn = h * half_velocity;
  substep.predicted[at(i)].angular_velocity = end_velocity;
}

/// Rotation about one axis: no gyroscopic effects, and turn = h w exactly, except for prescribed
/// drives.
void rotate_about_axis(Substep& substep, int i, const Vector3& axis) {
  const BodyProperties& body = substep.bodies[i];
  MovingBody& moving = substep.moving[at(i)];
  const BodyState& start = substep.start.bodies[at(i)];
  const double from = substep.start.time;
  const double to = substep.next.time;
  double spin = axis.dot(start.angular_velocity);
  double angle = 0.0;
  if (body.prescribed()) {
    const DriveShare share =
        substep.drive_shares.empty() ? DriveShare{} : substep.drive_shares[at(i)];
    spin = share.speed * substep.driven_speed(i);
    angle = share.way * BodyDrive(body, substep.start.controls, i).turn(from, to);
  } else {
    if (body.axis_inertia > 0.0) {
      const double inertia = body.axis_inertia;
      const double torque = axis.dot(torque_on(substep, i, substep.start.bodies));
      const auto [keep, gain] = decay(substep.bodies.definition(i).angular_damping / inertia,
                                      substep.load_share * substep.h);
      spin = keep * spin + gain * torque / inertia;
      if (body.drive == DriveKind::torque) {
        const double middle = from + substep.load_share * (to - from);
        // Drag acts on the mean torque as on a constant torque.
        const BodyDrive drive(body, substep.start.controls, i);
        spin += gain / (middle - from) * drive.integral(from, middle) / inertia;
      }
    }
    angle = substep.h * spin;
  }
  moving.turn = angle * axis;
  if (moving.tracks_orientation) moving.orientation = turned(moving.orientation, moving.turn);
  substep.predicted[at(i)].angular_velocity = spin * axis;
}

}  // namespace

void limit_drives(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features) {
  substep.drive_shares.clear();
  for (const auto& feature : features) {
    if (!feature->limits_drives()) continue;
    substep.drive_shares.resize(at(substep.bodies.count()));
    feature->limit_drives(substep);
  }
}

void move_kinematic_bodies(Substep& substep) {
  for (int i = 0; i < substep.bodies.count(); ++i) {
    if (substep.bodies[i].mobility != Mobility::kinematic) continue;
    const MotionControl* set = substep.start.controls.motions.find(i);
    const double time = substep.next.time;
    const BodyState end = set != nullptr ? set->state_at(substep.bodies, i, time)
                                         : substep.bodies.kinematic_state(i, time);
    MovingBody& moving = substep.moving[at(i)];
    moving.position = end.position;
    moving.orientation = end.orientation;
    moving.turn = set != nullptr ? set->turn_between(substep.bodies, i, substep.start.time, time)
                                 : Vector3(substep.h * end.angular_velocity);
    substep.predicted[at(i)] = end;
  }
}

void predict(Substep& substep) {
  const double h = substep.h;
  substep.time = substep.next.time;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& body = substep.bodies[i];
    const BodyState& start = substep.start.bodies[at(i)];
    MovingBody& moving = substep.moving[at(i)];
    if (moving.translates) {
      // W M (v + h g + h f / m): the inverse mass matrix W contains the mobility and drag.
      const Vector3 force =
          body.mass * substep.gravity + force_on(substep, i, substep.start.bodies);
      const double time = substep.load_share * h;
      const double keep = decay(substep.bodies.definition(i).damping / body.mass, time).keep;
      const Vector3 velocity = sum(keep * start.velocity, time, times(moving.inverse_mass, force));
      moving.position = sum(start.position, h, velocity);
    }
    switch (body.mobility) {
      case Mobility::free:
        rotate_freely(substep, i);
        break;
      case Mobility::planar:
        rotate_about_axis(substep, i, body.axis);
        break;
      case Mobility::rotor: {
        const bool mounted = body.mount >= 0;
        rotate_about_axis(
            substep, i,
            mounted ? Vector3(substep.start.bodies[at(body.mount)].orientation * body.axis)
                    : body.axis);
        break;
      }
      case Mobility::fixed:
      case Mobility::slider:
      case Mobility::kinematic:
      case Mobility::knot:
        break;
    }
    substep.predicted_turn[at(i)] = moving.free_turn = moving.turn;
    moving.free_orientation = moving.orientation;
    moving.free_position = moving.position;
  }
}

void derive_velocities(Substep& substep) {
  const double h = substep.h;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& body = substep.bodies[i];
    const MovingBody& moving = substep.moving[at(i)];
    const BodyState& start = substep.start.bodies[at(i)];
    BodyState& next = substep.next.bodies[at(i)];
    if (body.mount >= 0 || body.mobility == Mobility::fixed) continue;
    next.position = moving.position;
    next.orientation = moving.orientation;
    if (body.mobility == Mobility::kinematic) {
      next.velocity = substep.predicted[at(i)].velocity;
      next.angular_velocity = substep.predicted[at(i)].angular_velocity;
      continue;
    }
    if (moving.translates) {
      next.velocity = allowed_velocity(body, (moving.position - start.position) / h);
    }
    if (moving.rotates || body.mobility == Mobility::rotor) {
      next.angular_velocity = substep.predicted[at(i)].angular_velocity +
                              (moving.turn - substep.predicted_turn[at(i)]) / h;
    }
    if (body.mobility == Mobility::planar || body.mobility == Mobility::rotor) {
      // The pose of a body with one axis is a function of its angle, so angle and orientation
      // cannot drift apart.
      next.angle = start.angle + body.axis.dot(moving.turn);
      next.orientation = rotation_by(next.angle * body.axis) * body.start_orientation;
    }
  }
}

void place_mounted_rotors(Substep& substep) {
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& rotor = substep.bodies[i];
    if (rotor.mount < 0) continue;
    const MovingBody& moving = substep.moving[at(i)];
    const MovingBody& carrier_moving = substep.moving[at(rotor.mount)];
    const BodyState& carrier = substep.next.bodies[at(rotor.mount)];
    BodyState& next = substep.next.bodies[at(i)];
    // The spin is stored along the axle of the start of the substep; the carrier has turned the
    // axle since.
    const Vector3 start_axis = substep.start.bodies[at(rotor.mount)].orientation * rotor.axis;
    const Vector3 axis = carrier.orientation * rotor.axis;
    const double spin = start_axis.dot(substep.predicted[at(i)].angular_velocity +
                                       (moving.turn - substep.predicted_turn[at(i)]) / substep.h);
    const Vector3 offset = carrier.orientation * rotor.mount_position;
    next.angle = substep.start.bodies[at(i)].angle + axis.dot(moving.turn - carrier_moving.turn);
    next.position = carrier.position + offset;
    next.orientation =
        carrier.orientation * rotation_by(next.angle * rotor.axis) * rotor.start_orientation;
    next.velocity = carrier.velocity + carrier.angular_velocity.cross(offset);
    next.angular_velocity =
        carrier.angular_velocity - axis * axis.dot(carrier.angular_velocity) + spin * axis;
  }
}

void follow_carriers(Substep& substep) {
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyProperties& rotor = substep.bodies[i];
    if (rotor.mount < 0) continue;
    const BodyState& carrier = substep.next.bodies[at(rotor.mount)];
    BodyState& next = substep.next.bodies[at(i)];
    const Vector3 axis = carrier.orientation * rotor.axis;
    const double spin = axis.dot(next.angular_velocity);
    next.velocity = carrier.velocity +
                    carrier.angular_velocity.cross(carrier.orientation * rotor.mount_position);
    next.angular_velocity =
        carrier.angular_velocity - axis * axis.dot(carrier.angular_velocity) + spin * axis;
  }
}

}  // namespace sheave
