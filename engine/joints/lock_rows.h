#pragma once
// Locks that several joint types share.
//
// n . (p_b - p_a) with a direction n fixed in A changes by n . d(p_b - p_a) + (d_a x n) . (p_b -
// p_a). The second part is the contribution of the lever between the two points to the torque of -n
// on A: the force n acts at p_b on both bodies.

#include "engine/joints/anchor.h"
#include "engine/joints/joint_terms.h"
#include "engine/math/portable.h"

namespace sheave {

/// The anchors coincide along the world direction e: C = e . (p_a - p_b).
inline void lock_point_along(const Anchor& a, const Anchor& b, const Vector3& direction,
                             JointTerms& terms) {
  const Vector3 at_a = a.position(terms.substep());
  const Vector3 at_b = b.position(terms.substep());
  terms.tell();
  terms.set_value(dot(direction, at_a - at_b));
  terms.add_force(a.body, at_a, direction);
  terms.add_force(b.body, at_b, -direction);
}

/// The displacement of B's anchor along the axis `index` of A's frame: C = n . (p_b - p_a).
inline void offset_along(const Anchor& a, const Anchor& b, int index, JointTerms& terms) {
  const Vector3 at_b = b.position(terms.substep());
  const Vector3 direction = rotated(a.orientation(terms.substep()), Vector3::Unit(index));
  terms.set_value(dot(direction, at_b - a.position(terms.substep())));
  terms.add_force(a.body, at_b, -direction);
  terms.add_force(b.body, at_b, direction);
}

/// The anchors coincide along the direction `index` of the world, or along that of B's frame if one
/// carrier leads both bodies. In that case a rotor cannot close every gap between the anchors.
/// Along directions of the world the gradient has a part of the size of the gap by which turning
/// the carrier would close it, so a rounding error in the gap would turn the carrier far.
inline void lock_point(const MeetingAnchors& anchors, int index, JointTerms& terms) {
  if (anchors.direction_count == 0) return offset_along(anchors.b, anchors.a, index, terms);
  lock_point_along(anchors.a, anchors.b, anchors.directions[static_cast<std::size_t>(index)],
                   terms);
}

/// A's axis `axis` is perpendicular to B's axis `across`: C = u . v. Rotations change it by
/// (d_a x u) . v + u . (d_b x v) = (u x v) . (d_a - d_b).
inline void lock_perpendicular(const Anchor& a, int axis, const Anchor& b, int across,
                               JointTerms& terms) {
  const Vector3 u = a.orientation(terms.substep()) * Vector3::Unit(axis);
  const Vector3 v = b.orientation(terms.substep()) * Vector3::Unit(across);
  terms.set_value(u.dot(v));
  const Vector3 gradient = u.cross(v);
  terms.add_torque(a.body, gradient);
  terms.add_torque(b.body, -gradient);
}

/// No relative rotation. The quaternion E = q_a q_b^-1 of the relative rotation of the frames, with
/// w >= 0, is the identity: C = 2 E_k (the rotation vector for small errors). A world rotation d of
/// A changes E to (1, d/2) E, a rotation d of B to E (1, -d/2), so with E = (w, v)
///   dC_k = (w e_k + v x e_k) . d_a - (w e_k - v x e_k) . d_b.
/// If one carrier leads both bodies, the axes are those of A's frame, as in lock_point(): with
/// q_a^-1 q_b = (w, v) and C = -2 v_k, dC_k = q_a (w e_k + v x e_k) . (d_a - d_b).
inline void lock_rotation(const Anchor& a, const Anchor& b, int index, JointTerms& terms) {
  if (a.shares_carrier) {
    const Quaternion frame = a.orientation(terms.substep());
    Quaternion relative = frame.conjugate() * b.orientation(terms.substep());
    if (relative.w() < 0.0) relative.coeffs() = -relative.coeffs();
    terms.set_value(-2.0 * relative.vec()[index]);
    const Vector3 own = Vector3::Unit(index);
    const Vector3 gradient = frame * Vector3(relative.w() * own + relative.vec().cross(own));
    terms.add_torque(a.body, gradient);
    terms.add_torque(b.body, -gradient);
    return;
  }
  Quaternion error = a.orientation(terms.substep()) * b.orientation(terms.substep()).conjugate();
  if (error.w() < 0.0) error.coeffs() = -error.coeffs();
  const Vector3 axis = Vector3::Unit(index);
  const Vector3 v = error.vec();
  terms.set_value(2.0 * v[index]);
  terms.add_torque(a.body, error.w() * axis + v.cross(axis));
  terms.add_torque(b.body, -error.w() * axis + v.cross(axis));
}

/// The angle by which B has turned about the z axis of A's frame. With the rotation (w, v) from A's
/// to B's frame, expressed in A's frame, the angle is 2 atan2(v_z, w), modulo whole turns. A
/// rotation d of B changes the quaternion by dw = -d . v / 2, dv = (w d + d x v) / 2, and therefore
/// the angle by d . (w^2 z + w v x z + v_z v) / (w^2 + v_z^2). Exact for any tilt but half a turn
/// across the axis, at which the angle is undefined (singular configuration).
inline void angle_about(const Anchor& a, const Anchor& b, JointTerms& terms) {
  const Quaternion frame = a.orientation(terms.substep());
  const Quaternion relative = frame.conjugate() * b.orientation(terms.substep());
  const double w = relative.w();
  const Vector3 v = relative.vec();
  terms.set_value(2.0 * portable::atan2(v.z(), w));
  const double size = w * w + v.z() * v.z();
  if (!(size > 1e-12)) return;
  const Vector3 z = Vector3::UnitZ();
  const Vector3 gradient = frame * Vector3((w * w * z + w * v.cross(z) + v.z() * v) / size);
  terms.add_torque(a.body, -gradient);
  terms.add_torque(b.body, gradient);
}

}  // namespace sheave
