#pragma once

#include "engine/body_id.h"
#include "engine/vector.h"

namespace sheave {

/// A point at which two bodies touch or are about to touch, at the end of the last substep.
struct ContactReport {
  BodyId body_a;
  BodyId body_b;
  Vector3 point = Vector3::Zero();           ///< on the surface of body A [m], world frame
  Vector3 normal = Vector3::UnitY();         ///< unit length, from B to A
  double gap = 0.0;                          ///< [m]; < 0: depth of the overlap
  double normal_force = 0.0;                 ///< force on A along the normal [N], >= 0
  Vector3 friction_force = Vector3::Zero();  ///< force on A across the normal [N]
  bool sticks = false;                       ///< whether static friction holds the point
  /// Points of the bodies' cores in their own frames (origin at the centre of mass) [m]. The
  /// surfaces are a radius away from them along the normal.
  Vector3 core_a = Vector3::Zero();
  Vector3 core_b = Vector3::Zero();
};

}  // namespace sheave
