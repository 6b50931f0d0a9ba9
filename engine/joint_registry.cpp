// The joint types: one line each.

#include <array>

#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"

namespace sheave {

std::span<const TypeEntry<JointDef>> joint_types() {
  static const std::array types{
      type_entry<JointDef, DistanceJoint>(),
      type_entry<JointDef, BallJoint>(),
      type_entry<JointDef, HingeJoint>(),
      type_entry<JointDef, FixedJoint>(),
  };
  return types;
}

}  // namespace sheave
