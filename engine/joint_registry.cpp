// The joint types, one line each.

#include <array>

#include "engine/joints/ball.h"
#include "engine/joints/coupling.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"

namespace sheave {

std::span<const TypeEntry<JointDef>> joint_types() {
  static const std::array types{
      type_entry<JointDef, DistanceJoint>(),    type_entry<JointDef, BallJoint>(),
      type_entry<JointDef, HingeJoint>(),       type_entry<JointDef, SliderJoint>(),
      type_entry<JointDef, CylindricalJoint>(), type_entry<JointDef, UniversalJoint>(),
      type_entry<JointDef, PlaneJoint>(),       type_entry<JointDef, FixedJoint>(),
      type_entry<JointDef, GearJoint>(),        type_entry<JointDef, RackJoint>(),
      type_entry<JointDef, CouplingJoint>(),
  };
  return types;
}

}  // namespace sheave
