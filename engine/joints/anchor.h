#pragma once

#include "engine/substep.h"

namespace sheave {

/// A point of a body and a frame fixed to it, in the body's own frame.
struct Anchor {
  int body = 0;
  Vector3 point = Vector3::Zero();            ///< [m]
  Quaternion frame = Quaternion::Identity();  ///< joint frame to own frame

  /// The anchor at the world point `world_point` [m] with the joint frame `world_frame` at time 0.
  [[nodiscard]] static Anchor at_start(const BodySet& bodies, BodyId body,
                                       const Vector3& world_point,
                                       const Quaternion& world_frame = Quaternion::Identity()) {
    const int index = bodies.index(body);
    const Vector3 own = bodies.initial_local(index, world_point) - bodies[index].center_of_mass;
    return {index, own, bodies.initial_orientation(index).conjugate() * world_frame};
  }
  [[nodiscard]] Vector3 position(const Substep& substep) const {
    return substep.point(body, point);
  }
  [[nodiscard]] Quaternion orientation(const Substep& substep) const {
    return substep.orientation(body) * frame;
  }
};

/// Adds to `row` the gradient of direction . (p_a - p_b), where p_a and p_b are the points of the
/// two bodies that are at `at_a` and `at_b` now, for a fixed direction.
inline void add_relative_translation(const Substep& substep, Row& row, int body_a, int body_b,
                                     const Vector3& at_a, const Vector3& at_b,
                                     const Vector3& direction) {
  substep.add_force(row, body_a, at_a, direction);
  substep.add_force(row, body_b, at_b, -direction);
}

}  // namespace sheave
