#include "cable/certificate/free_rotation.h"

#include <Eigen/LU>

#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

double first_part(const Evidence& evidence) { return evidence.rattle ? 0.5 : 1.0; }

FreeRotation rotation_of_ball(const Evidence& evidence, int i) {
  const BodyProperties& body = evidence.bodies[i];
  const BodyState& from = evidence.start.bodies[at(i)];
  const double inverse = body.inverse_inertia(0, 0);
  const double first = first_part(evidence) * evidence.h;
  const Drag drag(evidence.bodies.definition(i).angular_damping * inverse, first);
  const Vector3 free =
      drag.keep * from.angular_velocity +
      drag.share * first * inverse * load_torque_with_rotors(evidence, i, first_end);
  return {turned(from.orientation, evidence.h * free), evidence.h * free, Vector3::Zero()};
}

}  // namespace

Drag::Drag(double rate, double time) {
  const double x = rate * time;
  if (!(x > 0.0)) return;
  keep = portable::exp(-x);
  share = -portable::expm1(-x) / x;
}

FreeRotation free_rotation(const Evidence& evidence, int i) {
  const BodyProperties& body = evidence.bodies[i];
  if (body.isotropic && body.mounted_rotors.empty()) return rotation_of_ball(evidence, i);
  const BodyState& from = evidence.start.bodies[at(i)];
  const double h = evidence.h;
  const Matrix3 inertia = in_world(body.inertia, from.orientation);
  const Vector3 spin = damped_spin(evidence, i, inertia, from.angular_velocity);
  FreeRotation result;
  result.momentum = inertia * spin + rotor_momentum(evidence, i, from.orientation, first_end);
  const Vector3 loaded =
      result.momentum + first_part(evidence) * h * load_torque_with_rotors(evidence, i, first_end);
  if (body.symmetry_axis && body.mounted_rotors.empty()) {
    // Precession about the angular momentum, spin about the axis of symmetry.
    const Vector3& own = *body.symmetry_axis;
    const double along = own.dot(body.inverse_inertia * own);
    const double across = 0.5 * (body.inverse_inertia.trace() - along);
    const Vector3 axis = from.orientation * own;
    const double about = (along - across) * loaded.dot(axis);
    result.orientation = turned(turned(from.orientation, h * about * axis), h * across * loaded);
    const Quaternion half = turned(from.orientation, 0.5 * h * across * loaded);
    result.turn = h * (across * loaded + about * (half * own));
    return result;
  }
  const Quaternion half = turned(from.orientation, 0.5 * h * spin);
  result.turn = h * (in_world(body.inverse_inertia, half) *
                     (loaded - rotor_momentum(evidence, i, half, first_end)));
  result.orientation = turned(from.orientation, result.turn);
  return result;
}

Vector3 counted_turn(const Evidence& evidence, int i) {
  const BodyState& from = evidence.start.bodies[at(i)];
  const BodyState& to = evidence.end.bodies[at(i)];
  const BodyProperties& body = evidence.bodies[i];
  if (body.mount >= 0) {
    const Vector3 axis = evidence.end.bodies[at(body.mount)].orientation * body.axis;
    return counted_turn(evidence, body.mount) + (to.angle - from.angle) * axis;
  }
  if (body.mobility == Mobility::planar || body.mobility == Mobility::rotor) {
    return (to.angle - from.angle) * body.axis;
  }
  FreeRotation free{from.orientation};
  if (body.mobility == Mobility::free) free = free_rotation(evidence, i);
  Quaternion change = to.orientation * free.orientation.conjugate();
  if (change.w() < 0.0) change.coeffs() = -change.coeffs();
  const double sine = change.vec().norm();
  if (!(sine > 0.0)) return free.turn;
  return free.turn + 2.0 * portable::atan2(sine, change.w()) / sine * change.vec();
}

Vector3 load_torque_with_rotors(const Evidence& evidence, int i, End when) {
  const BodySet& bodies = evidence.bodies;
  const Quaternion orientation = evidence.moments[at(when)].orientation(i);
  Vector3 torque = evidence.load_torque(i, when);
  for (const int r : bodies[i].mounted_rotors) {
    const Vector3 own = evidence.load_torque(r, when);
    const Vector3 axle = orientation * bodies[r].axis;
    torque += (orientation * bodies[r].mount_position).cross(evidence.load_force(r, when)) + own -
              axle * axle.dot(own);
  }
  return torque;
}

Vector3 rotor_momentum(const Evidence& evidence, int i, const Quaternion& orientation, End when) {
  Vector3 sum = Vector3::Zero();
  for (const int r : evidence.bodies[i].mounted_rotors) {
    const BodyProperties& rotor = evidence.bodies[r];
    const Vector3 axle = evidence.moments[at(when)].orientation(i) * rotor.axis;
    const BodyState& state = (*evidence.moments[at(when)].states)[at(r)];
    sum += rotor.axis_inertia * axle.dot(state.angular_velocity) * (orientation * rotor.axis);
  }
  return sum;
}

Vector3 damped_spin(const Evidence& evidence, int i, const Matrix3& inertia,
                    const Vector3& angular_velocity) {
  const double c =
      0.5 * first_part(evidence) * evidence.h * evidence.bodies.definition(i).angular_damping;
  if (c == 0.0) return angular_velocity;
  return (inertia + c * Matrix3::Identity()).inverse() *
         (inertia * angular_velocity - c * angular_velocity);
}

Matrix3 in_world(const Matrix3& own, const Quaternion& orientation) {
  const Matrix3 rotation = orientation.toRotationMatrix();
  return rotation * own * rotation.transpose();
}

}  // namespace sheave::certify
