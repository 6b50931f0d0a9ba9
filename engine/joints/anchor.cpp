#include "engine/joints/anchor.h"

#include "engine/math/turn_between.h"

namespace sheave {

Quaternion frame_along(const Vector3& axis) {
  return turn_between(Vector3::UnitZ(), axis.normalized());
}

}  // namespace sheave
